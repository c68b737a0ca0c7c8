#include "find.h"
#include <string.h>

enum {
    CROWDED = -1,
    SLACK = 2 * SPHGI_LANES_MOST /* candidates, and ids, that passes write beyond the last */
};

/* ---- Scratch -------------------------------------------------------------------------------- */

/* Memory that is not needed is not touched. */
static int32_t room_of(const sphg_neighbors *neighbors)
{
    return sphgi_min32(neighbors->source_count, SPHGI_CANDIDATES_MOST);
}

static size_t candidate_bytes(const sphg_neighbors *neighbors)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t candidates = (size_t)room_of(neighbors) + SLACK + 2 * SPHGI_ALIGNMENT;
    return sphgi_round_up(candidates * (3 * size + sizeof(uint32_t) + 1), SPHGI_ALIGNMENT);
}

/* Of all lists that can wait. */
static size_t id_bytes(const sphg_neighbors *neighbors)
{
    const size_t list = (size_t)room_of(neighbors) + SPHGI_PAD;
    return (SPHGI_LISTS_MOST * list + SLACK) * sizeof(uint32_t);
}

size_t sphgi_finder_size(const sphg_neighbors *neighbors)
{
    return candidate_bytes(neighbors) + id_bytes(neighbors);
}

void sphgi_finder_open(struct sphgi_finder *finder, const sphg_context *context,
                       const sphg_neighbors *neighbors, void *memory)
{
    *finder = (struct sphgi_finder){.neighbors = neighbors, .room = room_of(neighbors)};
    finder->passes = sphgi_passes_of(context, neighbors->position_type);
    finder->find = (struct sphgi_find){.rows = neighbors->sources.rows.data,
                                       .reach = neighbors->radius + neighbors->skin,
                                       .slack = neighbors->sources.lattice.slack,
                                       .periodic = neighbors->periodic,
                                       .dummy = (uint32_t)neighbors->source_count * SPHGI_ID_STEP,
                                       .scratch = memory,
                                       .pack_order = context->pack_order,
                                       .pack_bytes = context->pack_bytes};
    memcpy(finder->find.period, neighbors->period, sizeof finder->find.period);
    finder->ids = (uint32_t *)(void *)((char *)memory + candidate_bytes(neighbors));
    finder->block = -1;
}

/* ---- The walk ------------------------------------------------------------------------------- */

static void enter_block(struct sphgi_finder *f, int32_t block)
{
    const struct sphgi_grid *targets = sphgi_target_grid(f->neighbors);
    f->block = block;
    f->cell = 0;
    sphgi_cell_starts(targets, block, f->start);
    sphgi_surroundings_of(&f->neighbors->sources, targets->blocks[block].key, &f->around);
}

/* To the cell of the next target. */
static void enter_cell(struct sphgi_finder *f)
{
    const struct sphgi_block *blocks = sphgi_target_grid(f->neighbors)->blocks;
    while (f->next >= blocks[f->block + 1].first)
        enter_block(f, f->block + 1);
    while (f->next >= f->start[f->cell + 1])
        ++f->cell;
}

static void go_to(struct sphgi_finder *f, int32_t target)
{
    f->lists = f->taken = 0;
    f->used = 0;
    if (f->block < 0 || target < f->start[0] || target >= f->start[SPHGI_BLOCK_CELLS])
        enter_block(f, sphgi_block_of_place(sphgi_target_grid(f->neighbors), target));
    f->cell = 0;
    f->next = target;
}

/* Row of a target of the cell, if it is a source, or -1. Targets that are part of the sources come
 * first among them: in a cell, both stand in the order of their numbers. */
static int32_t row_of_self(const struct sphgi_finder *f, const struct sphgi_runs *runs,
                           int32_t target)
{
    return f->neighbors->part_of ? runs->own + target - f->start[f->cell] : -1;
}

/* Lists for what is left of the cell of the next target, as many as are found at once. */
static void find_some(struct sphgi_finder *f)
{
    const sphg_neighbors *n = f->neighbors;
    struct sphgi_runs runs;
    enter_cell(f);
    sphgi_candidate_runs(&n->sources.lattice, &f->around, f->cell, &runs);
    const int32_t count = sphgi_min32(f->start[f->cell + 1] - f->next, SPHGI_FIND_MOST);
    if (runs.candidates > f->room)
        for (int32_t k = 0; k < count; ++k)
            f->length[f->lists + k] = CROWDED;
    else
        f->used +=
            f->passes->find(&f->find, &runs, sphgi_target_row(n, f->next), count,
                            row_of_self(f, &runs, f->next), f->ids + f->used, f->length + f->lists);
    f->lists += count;
    f->next += count;
}

/* ---- Groups --------------------------------------------------------------------------------- */

static int64_t padded(int32_t length)
{
    return length < 0 ? 0 : (int64_t)sphgi_round_up((size_t)length, SPHGI_PAD);
}

/* The lists that were handed out make room for those behind them. */
static void drop_taken(struct sphgi_finder *f)
{
    int64_t out = 0;
    for (int32_t k = 0; k < f->taken; ++k)
        out += padded(f->length[k]);
    f->lists -= f->taken;
    f->used -= out;
    memmove(f->length, f->length + f->taken, (size_t)f->lists * sizeof *f->length);
    memmove(f->ids, f->ids + out, (size_t)f->used * sizeof *f->ids);
    f->taken = 0;
}

bool sphgi_find_group(struct sphgi_finder *f, int32_t group, const uint32_t **lists,
                      int32_t *lengths)
{
    const int32_t first = group * SPHGI_GROUP, count = sphgi_targets_in(f->neighbors, group);
    bool collected = true;
    drop_taken(f);
    if (f->block < 0 || f->next - f->lists != first)
        go_to(f, first);
    while (f->lists < count)
        find_some(f);
    const uint32_t *list = f->ids;
    for (int32_t k = 0; k < SPHGI_GROUP; ++k) {
        lists[k] = list;
        lengths[k] = k < count ? f->length[k] : 0;
        collected &= lengths[k] != CROWDED;
        list += padded(lengths[k]);
    }
    f->taken = count;
    return collected;
}

/* ---- Clumps --------------------------------------------------------------------------------- */

void sphgi_find_target(struct sphgi_finder *f, int32_t target, sphgi_take *take, void *data)
{
    const sphg_neighbors *n = f->neighbors;
    struct sphgi_runs runs;
    go_to(f, target);
    enter_cell(f);
    sphgi_candidate_runs(&n->sources.lattice, &f->around, f->cell, &runs);
    const int32_t self = row_of_self(f, &runs, target);
    for (int32_t run = 0; run < runs.count; ++run)
        for (int32_t at = 0; at < runs.length[run]; at += f->room) {
            const int32_t begin = runs.begin[run] + at;
            const int32_t count = sphgi_min32(runs.length[run] - at, f->room);
            const bool inside = self >= begin && self < begin + count;
            const struct sphgi_runs slice = {
                .count = 1, .candidates = count, .own = begin, .begin = {begin}, .length = {count}};
            int32_t found;
            f->passes->find(&f->find, &slice, sphgi_target_row(n, target), 1, inside ? self : -1,
                            f->ids, &found);
            take(data, f->ids, found);
        }
}
