#include "lists.h"
#include "find.h"
#include "core/parallel.h"
#include <string.h>

enum {
    WIDE_HEADER = 8,     /* numbers in front of a wide row: its length, then nothing */
    LEAST_TARGETS = 256, /* of a task: fewer are not worth a thread */
    MARGIN = 512,        /* units */
    SAMPLE = 64          /* one block of so many is looked at for a first guess */
};

struct build {
    const sphg_context *context;
    sphg_neighbors *neighbors;
    char *memory; /* of the workers */
    size_t memory_each;
    int32_t room;
    int32_t step; /* blocks: every one, or a sample */
    atomic_int_least64_t units, pairs;
};

/* A place for the block's units, if they fit; counts them in any case. */
static int64_t claim(struct build *build, int32_t block, int64_t units, bool wide)
{
    struct sphgi_found *found = &build->neighbors->found;
    const int64_t place = atomic_fetch_add(&build->units, units);
    const bool fits = place + units <= found->room;
    found->lists[block] = fits ? 2 * place + wide : -1;
    return fits ? place : -1;
}

/* What is staged for a block stands in front of its ids: sweeps need not look it up again. Returns
 * the units that this takes. */
static int64_t head_units(const struct sphgi_surroundings *around)
{
    const size_t numbers = 2 + 2 * (size_t)around->ranges;
    return (int64_t)sphgi_round_up(numbers * sizeof(int32_t) / sizeof(uint16_t), SPHGI_PAD);
}

static void write_head(const struct sphgi_surroundings *around, uint16_t *to)
{
    int32_t *head = (int32_t *)(void *)to;
    head[0] = around->ranges;
    head[1] = around->staged;
    memcpy(head + 2, around->begin, (size_t)around->ranges * sizeof *head);
    memcpy(head + 2 + around->ranges, around->count, (size_t)around->ranges * sizeof *head);
}

/* Units that one batch of targets takes at most. */
static int64_t most_units(const struct sphgi_runs *runs)
{
    return (int64_t)SPHGI_FIND_MOST * (runs->candidates + SPHGI_PAD);
}

static int64_t woven_units(const uint16_t *lengths, int32_t targets)
{
    int64_t units = 0;
    for (int32_t t = 0; t < targets; t += SPHGI_LANES_MOST)
        units += sphgi_list_group_of(lengths + t, targets - t).units;
    return units;
}

/* The block's lists, collected one after the other, in the form that is kept. */
static void weave_block(const struct sphgi_finder *finder, const uint16_t *lengths, int32_t targets,
                        uint16_t *to)
{
    const uint16_t *from = finder->ids;
    for (int32_t t = 0; t < targets; t += SPHGI_LANES_MOST) {
        const struct sphgi_list_group group = sphgi_list_group_of(lengths + t, targets - t);
        const uint16_t *list[SPHGI_LANES_MOST], *const first = from;
        int32_t count[SPHGI_LANES_MOST];
        for (int32_t k = 0; k < group.count; ++k) {
            list[k] = from;
            count[k] = lengths[t + k];
            from += sphgi_round_up(lengths[t + k], SPHGI_PAD);
        }
        if (group.side_by_side)
            finder->passes->weave(list, count, group.count, group.longest, to);
        else
            memcpy(to, first, (size_t)group.units * sizeof *to);
        to += group.units;
    }
}

/* False: the lists of the block are too long to be collected at once. */
static bool build_block(struct build *build, const struct sphgi_finder *finder,
                        const struct sphgi_surroundings *around)
{
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = around->start;
    uint16_t *lengths = n->found.lengths.data;
    int64_t used = 0, pairs = 0;
    sphgi_stage_coordinates(finder, n, around);
    for (int32_t c = 0; c < grid->cells; ++c) {
        if (start[c] == start[c + 1])
            continue;
        struct sphgi_runs runs;
        sphgi_candidate_runs(&grid->lattice, around, c, &runs);
        for (int32_t t = start[c]; t < start[c + 1]; t += SPHGI_FIND_MOST) {
            const int32_t end = sphgi_min32(t + SPHGI_FIND_MOST, start[c + 1]);
            if (used && used + most_units(&runs) > SPHGI_UNITS_MOST)
                return false;
            used += sphgi_find_targets(finder, n, around, &runs, c, t, end, finder->ids + used,
                                       lengths + t);
        }
    }
    const int32_t first = start[0], targets = start[grid->cells] - first;
    for (int32_t t = 0; t < targets; ++t)
        pairs += lengths[first + t];
    atomic_fetch_add(&build->pairs, pairs);
    const int64_t head = head_units(around);
    const int64_t units = woven_units(lengths + first, targets);
    const int64_t place = claim(build, around->block, head + units, false);
    if (place < 0)
        return true;
    write_head(around, n->found.ids + place);
    uint16_t *to = n->found.ids + place + head;
    if (units > SPHGI_WOVEN_MOST) {
        weave_block(finder, lengths + first, targets, to);
    } else { /* a copy at once does not read first what it overwrites */
        weave_block(finder, lengths + first, targets, finder->woven);
        memcpy(to, finder->woven, (size_t)units * sizeof *to);
    }
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

/* Returns where the next row goes. */
static uint32_t *write_wide_row(const struct build *build, const struct sphgi_finder *finder,
                                const struct sphgi_surroundings *around, int32_t cell,
                                int32_t target, uint32_t *to)
{
    const sphg_neighbors *n = build->neighbors;
    struct wide_row row = {to + WIDE_HEADER, 0};
    sphgi_find_wide(finder, n, around, cell, target, append_rows, &row);
    memset(to, 0, WIDE_HEADER * sizeof *to);
    to[0] = (uint32_t)row.count;
    const int64_t padded = (int64_t)sphgi_round_up((size_t)row.count, SPHGI_PAD);
    for (int64_t k = row.count; k < padded; ++k)
        row.to[k] = (uint32_t)n->source_count; /* the row of zeros */
    return row.to + padded;
}

/* Units that the row takes; adds to the number of pairs. */
static int64_t measure_wide_row(const struct build *build, const struct sphgi_finder *finder,
                                const struct sphgi_surroundings *around, int32_t cell,
                                int32_t target, int64_t *pairs)
{
    int64_t count = 0;
    sphgi_find_wide(finder, build->neighbors, around, cell, target, count_rows, &count);
    *pairs += count;
    return 2 * (WIDE_HEADER + (int64_t)sphgi_round_up((size_t)count, SPHGI_PAD));
}

/* Twice through: a block's place must be known before it can be filled. */
static void build_wide_block(struct build *build, const struct sphgi_finder *finder,
                             const struct sphgi_surroundings *around)
{
    sphg_neighbors *n = build->neighbors;
    const int32_t cells = sphgi_target_grid(n)->cells, *start = around->start;
    int64_t units = 0, pairs = 0;
    for (int32_t c = 0; c < cells; ++c)
        for (int32_t t = start[c]; t < start[c + 1]; ++t)
            units += measure_wide_row(build, finder, around, c, t, &pairs);
    atomic_fetch_add(&build->pairs, pairs);
    const int64_t place = claim(build, around->block, units, true);
    uint32_t *next = (uint32_t *)(void *)(n->found.ids + (place < 0 ? 0 : place));
    for (int32_t c = 0; c < cells && place >= 0; ++c)
        for (int32_t t = start[c]; t < start[c + 1]; ++t)
            next = write_wide_row(build, finder, around, c, t, next);
}

/* ---- All blocks ----------------------------------------------------------------------------- */

static void build_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct build *build = data;
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_finder finder = sphgi_finder_at(
        build->context, n, build->room, build->memory + (size_t)worker * build->memory_each);
    struct sphgi_surroundings around[2]; /* of a block and of the next */
    sphgi_block_surroundings(n, begin * build->step, &around[begin & 1]);
    for (int32_t b = begin; b < end; ++b) {
        const struct sphgi_surroundings *own = &around[b & 1];
        if (b + 1 < end) {
            sphgi_block_surroundings(n, (b + 1) * build->step, &around[(b + 1) & 1]);
            sphgi_prefetch_rows(n, &around[(b + 1) & 1]);
        }
        if (sphgi_is_crowded(own) || !build_block(build, &finder, own))
            build_wide_block(build, &finder, own);
    }
}

/* Every step-th block, keeping what fits. */
static void find_blocks(sphg_context *context, struct build *build, int32_t step)
{
    struct sphgi_found *found = &build->neighbors->found;
    const int32_t blocks = sphgi_target_grid(build->neighbors)->block_count;
    build->step = step;
    atomic_store(&build->units, 0);
    atomic_store(&build->pairs, 0);
    const int64_t targets = sphgi_max32(build->neighbors->target_count, 1);
    const int32_t grain = (int32_t)((int64_t)blocks * LEAST_TARGETS / targets) + 1;
    sphgi_parallel_for(context, build_task, build, (blocks + step - 1) / step, grain);
    found->units = atomic_load(&build->units);
    found->pairs = atomic_load(&build->pairs);
}

/* ---- Memory --------------------------------------------------------------------------------- */

static size_t tables_of(const struct sphgi_grid *grid)
{
    return sphgi_round_up(sphgi_grid_tables(grid->block_count), SPHGI_ALIGNMENT);
}

/* Puts lists and ids behind the tables, with room for that many units: first what the memory holds
 * already, else more. The tables move along. */
static bool place_lists(sphg_neighbors *n, int64_t units)
{
    struct sphgi_buffer *shared = &n->shared;
    const size_t sources = tables_of(&n->sources);
    const size_t lists = sources + (n->same ? 0 : tables_of(&n->targets));
    const size_t blocks = (size_t)sphgi_target_grid(n)->block_count;
    const size_t used = lists + sphgi_round_up(blocks * sizeof(int64_t), SPHGI_ALIGNMENT);
    if (units > 0 && used + (size_t)units * sizeof(uint16_t) > shared->size) {
        struct sphgi_buffer more = {NULL, 0};
        if (!sphgi_reserve(&n->allocator, &more, used + (size_t)units * sizeof(uint16_t), 1))
            return false;
        memcpy(more.data, shared->data, lists);
        sphgi_free(&n->allocator, shared);
        *shared = more;
    }
    char *base = shared->data;
    sphgi_grid_use_tables(&n->sources, base);
    if (!n->same)
        sphgi_grid_use_tables(&n->targets, base + sources);
    n->found.lists = (int64_t *)(void *)(base + lists);
    n->found.ids = (uint16_t *)(void *)(base + used);
    n->found.room = (int64_t)((shared->size - used) / sizeof(uint16_t));
    return true;
}

/* A little more than needed: pairs come and go from step to step. Once they have outgrown their
 * memory an eighth, lest a slowly rising number asks for more at each step. */
static int64_t with_margin(const struct sphgi_found *found, int64_t units)
{
    return units + units / (found->most_pairs < 0 ? 64 : 8) + MARGIN;
}

/* Before anything is known: as many as a sample of the blocks suggests. */
static bool guess(sphg_context *context, struct build *build)
{
    sphg_neighbors *n = build->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t step = sphgi_min32(SAMPLE, sphgi_max32(1, grid->block_count / SAMPLE));
    n->found.room = 0; /* only count */
    find_blocks(context, build, step);
    int64_t sampled = 0;
    for (int32_t b = 0; b < grid->block_count; b += step)
        sampled += grid->blocks[b + 1].first - grid->blocks[b].first;
    const double each = sampled ? (double)n->found.units / (double)sampled : 0;
    return place_lists(n, with_margin(&n->found, (int64_t)(each * n->target_count)));
}

static bool are_more_than_ever(const sphg_neighbors *n)
{
    const struct sphgi_found *found = &n->found;
    return found->pairs > found->most_pairs || n->target_count > found->most_targets ||
           n->source_count > found->most_sources;
}

static void remember_most(sphg_neighbors *n)
{
    struct sphgi_found *found = &n->found;
    found->most_pairs = found->pairs > found->most_pairs ? found->pairs : found->most_pairs;
    found->most_targets = sphgi_max32(found->most_targets, n->target_count);
    found->most_sources = sphgi_max32(found->most_sources, n->source_count);
}

sphg_result sphgi_lists_build(sphg_context *context, sphg_neighbors *n)
{
    struct sphgi_found *found = &n->found;
    struct build build = {.context = context, .neighbors = n, .room = sphgi_finder_room(n)};
    build.memory_each = sphgi_finder_size(n, build.room);
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       build.memory_each) ||
        !sphgi_reserve(&n->allocator, &found->lengths, (size_t)n->target_count, sizeof(uint16_t)) ||
        !place_lists(n, 0))
        return SPHG_ERROR_MEMORY;
    build.memory = context->workers.data;
    if (found->most_pairs < 0 && !guess(context, &build))
        return SPHG_ERROR_MEMORY;
    find_blocks(context, &build, 1);
    if (found->units > found->room && are_more_than_ever(n)) {
        if (!place_lists(n, with_margin(found, found->units)))
            return SPHG_ERROR_MEMORY;
        find_blocks(context, &build, 1);
    }
    remember_most(n);
    return SPHG_OK;
}
