#include "lists.h"
#include "find.h"
#include "parallel.h"
#include <string.h>

enum {
    WIDE_HEADER = 8,  /* numbers in front of a wide row: its length, then nothing */
    FIRST_GUESS = 40, /* ids a target, padding included, before anything is known */
    GRAIN = 4         /* blocks */
};

struct build {
    const sphg_context *context;
    sphg_neighbors *neighbors;
    char *memory; /* of the workers */
    size_t memory_each;
    int32_t room;
    int64_t capacity; /* units */
    atomic_int_least64_t units, pairs;
};

/* A place for that many units, or -1; counts them in any case. */
static int64_t claim(struct build *build, int64_t units)
{
    const int64_t place = atomic_fetch_add(&build->units, units);
    return place + units <= build->capacity ? place : -1;
}

static uint32_t *cell_offsets(const struct build *build, int32_t block)
{
    const sphg_neighbors *n = build->neighbors;
    return (uint32_t *)n->found.cell_offset.data + (ptrdiff_t)block * sphgi_target_grid(n)->cells;
}

/* False: the pairs may be more than the scratch holds; nothing was claimed then. */
static bool build_block(struct build *build, const struct sphgi_finder *finder,
                        const struct sphgi_surroundings *around, int32_t block)
{
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells;
    uint16_t *lengths = n->found.lengths.data;
    int64_t used = 0, pairs = 0;
    sphgi_stage_coordinates(finder, n, around);
    for (int32_t c = 0; c < grid->cells; ++c) {
        const int32_t targets = start[c + 1] - start[c];
        const struct sphgi_runs runs = sphgi_candidate_runs(&grid->lattice, around, c);
        if (used + (int64_t)targets * (runs.candidates + SPHGI_PAD) > SPHGI_UNITS_MOST)
            return false;
        cell_offsets(build, block)[c] = (uint32_t)(used / SPHGI_PAD);
        for (int32_t t = start[c]; t < start[c + 1]; t += SPHGI_FIND_MOST) {
            const int32_t end = sphgi_min32(t + SPHGI_FIND_MOST, start[c + 1]);
            used += sphgi_find_targets(finder, n, around, &runs, c, t, end, finder->ids + used,
                                       lengths + t);
            for (int32_t k = t; k < end; ++k)
                pairs += lengths[k];
        }
    }
    const int64_t place = claim(build, used);
    ((int64_t *)n->found.block_list.data)[block] = place;
    if (place >= 0)
        memcpy((uint16_t *)n->found.ids.data + place, finder->ids, (size_t)used * sizeof(uint16_t));
    atomic_fetch_add(&build->pairs, pairs);
    return true;
}

/* ---- Clumps --------------------------------------------------------------------------------- */

static void count_rows(void *data, const uint32_t *rows, int32_t count)
{
    (void)rows;
    *(int64_t *)data += count;
}

struct wide_row {
    uint32_t *to;
    int64_t count;
};

static void append_rows(void *data, const uint32_t *rows, int32_t count)
{
    struct wide_row *row = data;
    memcpy(row->to + row->count, rows, (size_t)count * sizeof *rows);
    row->count += count;
}

static void write_wide_cell(const struct build *build, const struct sphgi_finder *finder,
                            const struct sphgi_surroundings *around, int32_t block, int32_t cell,
                            int64_t place)
{
    const sphg_neighbors *n = build->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start =
        (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells + cell;
    uint32_t *next = (uint32_t *)(void *)((uint16_t *)n->found.ids.data + place);
    for (int32_t t = start[0]; t < start[1]; ++t) {
        struct wide_row row = {next + WIDE_HEADER, 0};
        sphgi_find_wide(finder, n, around, cell, t, append_rows, &row);
        memset(next, 0, WIDE_HEADER * sizeof *next);
        next[0] = (uint32_t)row.count;
        const int64_t padded = (int64_t)sphgi_round_up((size_t)row.count, SPHGI_PAD);
        for (int64_t k = row.count; k < padded; ++k)
            row.to[k] = (uint32_t)n->source_count; /* the row of zeros */
        next = row.to + padded;
    }
}

/* Units that the pairs of one cell take, and how many pairs they are. */
static int64_t measure_wide_cell(const struct build *build, const struct sphgi_finder *finder,
                                 const struct sphgi_surroundings *around, const int32_t *start,
                                 int32_t cell, int64_t *pairs)
{
    int64_t units = 0;
    for (int32_t t = start[0]; t < start[1]; ++t) {
        int64_t count = 0;
        sphgi_find_wide(finder, build->neighbors, around, cell, t, count_rows, &count);
        *pairs += count;
        units += 2 * (WIDE_HEADER + (int64_t)sphgi_round_up((size_t)count, SPHGI_PAD));
    }
    return units;
}

/* Twice through: a block's place must be known before it can be filled. */
static void build_wide_block(struct build *build, const struct sphgi_finder *finder,
                             const struct sphgi_surroundings *around, int32_t block)
{
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells;
    uint32_t *offsets = cell_offsets(build, block);
    int64_t units = 0, pairs = 0;
    for (int32_t c = 0; c < grid->cells; ++c) {
        offsets[c] = (uint32_t)(units / SPHGI_PAD);
        units += measure_wide_cell(build, finder, around, start + c, c, &pairs);
    }
    const bool too_many = units / SPHGI_PAD > UINT32_MAX;
    const int64_t place = claim(build, too_many ? (int64_t)1 << 52 : units);
    ((int64_t *)n->found.block_list.data)[block] = place;
    for (int32_t c = 0; c < grid->cells && place >= 0; ++c)
        write_wide_cell(build, finder, around, block, c, place + (int64_t)offsets[c] * SPHGI_PAD);
    atomic_fetch_add(&build->pairs, pairs);
}

/* ---- All blocks ----------------------------------------------------------------------------- */

static void build_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct build *build = data;
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_finder finder = sphgi_finder_at(
        build->context, n, build->room, build->memory + (size_t)worker * build->memory_each);
    struct sphgi_surroundings around;
    for (int32_t b = begin; b < end; ++b) {
        sphgi_block_surroundings(n, b, &around);
        const bool narrow =
            around.staged <= SPHGI_STAGED_MOST && build_block(build, &finder, &around, b);
        ((uint8_t *)n->found.wide.data)[b] = !narrow;
        if (!narrow)
            build_wide_block(build, &finder, &around, b);
    }
}

/* All pairs if they fit; found->units and ->pairs tell what is needed in any case. */
static bool find_all(sphg_context *context, struct build *build)
{
    struct sphgi_found *found = &build->neighbors->found;
    build->capacity = (int64_t)(found->ids.size / sizeof(uint16_t));
    atomic_store(&build->units, 0);
    atomic_store(&build->pairs, 0);
    sphgi_parallel_for(context, build_task, build, sphgi_target_grid(build->neighbors)->block_count,
                       GRAIN);
    found->units = atomic_load(&build->units);
    found->pairs = atomic_load(&build->pairs);
    return found->units <= build->capacity;
}

sphg_result sphgi_lists_build(sphg_context *context, sphg_neighbors *n)
{
    struct sphgi_found *found = &n->found;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const size_t targets = (size_t)n->target_count;
    /* as many as the grid has room for: no other reason to allocate than the grid's own */
    const size_t blocks_of_grid = grid->blocks.size / sizeof(struct sphgi_block);
    const size_t cells_of_grid = grid->cell_start.size / sizeof(int32_t);
    struct build build = {.context = context, .neighbors = n, .room = sphgi_finder_room(n)};
    build.memory_each = sphgi_finder_size(n, build.room);
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       build.memory_each) ||
        !sphgi_reserve(&n->allocator, &found->lengths, targets, sizeof(uint16_t)) ||
        !sphgi_reserve(&n->allocator, &found->wide, blocks_of_grid, 1) ||
        !sphgi_reserve(&n->allocator, &found->block_list, blocks_of_grid, sizeof(int64_t)) ||
        !sphgi_reserve(&n->allocator, &found->cell_offset, cells_of_grid, sizeof(uint32_t)))
        return SPHG_ERROR_MEMORY;
    if (!found->ids.size &&
        !sphgi_reserve(&n->allocator, &found->ids, targets * FIRST_GUESS + 1, sizeof(uint16_t)))
        return SPHG_ERROR_MEMORY;
    build.memory = context->workers.data;
    const bool all = find_all(context, &build);
    /* The same number of pairs may need this much when they fall differently onto the targets:
     * having it now, later searches allocate nothing. */
    const int64_t clumps = found->units - found->pairs;
    const int64_t padding = (SPHGI_PAD - 1) * (int64_t)n->target_count;
    const int64_t needed = found->pairs + (clumps > padding ? clumps : padding);
    if (all && needed <= build.capacity)
        return SPHG_OK;
    if (!sphgi_reserve(&n->allocator, &found->ids, (size_t)needed, sizeof(uint16_t)))
        return SPHG_ERROR_MEMORY;
    return find_all(context, &build) ? SPHG_OK : SPHG_ERROR_MEMORY;
}
