/* SPDX-License-Identifier: MIT */
#include "find.h"
#include "find_octaves.h"
#include "list_slots.h"
#include "walk.h"
#include <string.h>

enum { STAGED = 3072 /* candidates of several cells: their coordinates must stay in L1 */ };

/* ---- Scratch -------------------------------------------------------------------------------- */

/* Memory that is not needed is not touched. */
static int32_t room_of(const sphg_neighbors *neighbors)
{
    const int32_t wide = neighbors->graded ? 2 : 1; /* cells of an octave are up to twice H */
    return sphgi_min32(neighbors->source_count, wide * SPHGI_CANDIDATES_MOST);
}

static size_t staged_room(const sphg_neighbors *neighbors)
{
    return sphgi_round_up((size_t)room_of(neighbors) + SPHGI_LANES_MOST, SPHGI_LANES_MOST);
}

/* Of the candidates of a cell, or with radii of their own of a leg and of what is near eight of its
 * targets: coordinates, radii, ids, and marks. */
static size_t candidate_bytes(const sphg_neighbors *neighbors)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t candidates = (size_t)room_of(neighbors) + SPHGI_FIND_SLACK + 2 * SPHGI_ALIGNMENT;
    const size_t numbers = neighbors->graded ? 4 : 3, sets = neighbors->graded ? 2 : 1;
    return sets * candidates * (numbers * size + sizeof(uint32_t) + 1);
}

/* With one radius there are also coordinates of the candidates of some cells, and the vectors in
 * which those of one are scanned: of two lanes at least, with ten bytes each. Returns the bytes. */
static size_t place_finder(struct sphgi_finder *f, const sphg_neighbors *neighbors, char *base)
{
    struct sphgi_layout layout = {base, 0};
    const size_t one_radius = neighbors->graded ? 0 : 1;
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t vectors = (size_t)room_of(neighbors) / 2 + SPHGI_RUNS_MOST + SPHGI_SCANNED;
    f->find.scratch = sphgi_place(&layout, candidate_bytes(neighbors), 1);
    f->find.staged = sphgi_place(&layout, one_radius * staged_room(neighbors), 3 * size);
    f->find.scan =
        sphgi_place(&layout, one_radius * vectors, 2 * sizeof(int32_t) + sizeof(uint16_t));
    f->nearby = sphgi_place(&layout, 1 - one_radius, sizeof *f->nearby);
    f->slots = sphgi_place(&layout, sphgi_slot_bytes(room_of(neighbors)), 1);
    return layout.used;
}

size_t sphgi_finder_size(const sphg_neighbors *neighbors)
{
    struct sphgi_finder finder;
    return place_finder(&finder, neighbors, NULL);
}

void sphgi_finder_open(struct sphgi_finder *finder, const sphg_context *context,
                       const sphg_neighbors *neighbors, void *memory)
{
    *finder = (struct sphgi_finder){.neighbors = neighbors, .room = room_of(neighbors)};
    finder->passes = sphgi_passes_of(context, neighbors->position_type);
    finder->find = (struct sphgi_find){.rows = neighbors->sources.rows.data,
                                       .reach = neighbors->radius + neighbors->skin,
                                       .radii = neighbors->graded,
                                       .stretch = neighbors->stretch,
                                       .mutual = sphgi_lists_are_mutual(neighbors),
                                       .slack = neighbors->sources.raster.slack,
                                       .periodic = neighbors->periodic,
                                       .dummy = (uint32_t)neighbors->source_count * SPHGI_ID_STEP,
                                       .pack_order = context->pack_order,
                                       .pack_bytes = context->pack_bytes};
    memcpy(finder->find.period, neighbors->period, sizeof finder->find.period);
    place_finder(finder, neighbors, memory);
    finder->find.staged_room = (int32_t)staged_room(neighbors);
    finder->wide_slots = finder->slots + SPHGI_LISTS_MOST * sphgi_slot_room(SPHGI_SLOT);
    for (int32_t s = 0; s < SPHGI_LISTS_MOST; ++s)
        finder->list[s] = finder->slots; /* none is nowhere */
    finder->block = -1;
}

/* ---- The walk ------------------------------------------------------------------------------- */

static void enter_block(struct sphgi_finder *f, int32_t block)
{
    const struct sphgi_grid *targets = sphgi_target_grid(f->neighbors);
    f->block = block;
    f->cell = f->leg[0] = f->leg[1] = 0;
    f->staged_cells[0] = f->staged_cells[1] = 0;
    sphgi_cell_starts(targets, block, f->start);
    if (!f->neighbors->graded)
        sphgi_halo_of(&f->neighbors->sources, targets->blocks[block].key, &f->around);
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
    if (f->block < 0 || target < f->start[0] || target >= f->start[SPHGI_BLOCK_CELLS])
        enter_block(f, sphgi_block_of_place(sphgi_target_grid(f->neighbors), target));
    f->cell = f->leg[0] = f->leg[1] = 0;
    f->first = f->next = target;
}

/* Row of a target of the cell, if it is a source, or -1. Targets that are part of the sources come
 * first among them: in a cell, both stand in the order of their numbers. */
static int32_t row_of_self(const struct sphgi_finder *f, const struct sphgi_runs *runs,
                           int32_t target)
{
    return f->neighbors->part_of ? runs->own + target - f->start[f->cell] : -1;
}

/* ---- Cells ---------------------------------------------------------------------------------- */

/* Those of the cell and, as far as they fit, of the cells behind it, so that each row is turned
 * once for all that look at it. */
static void stage_cells(struct sphgi_finder *f)
{
    const struct sphgi_raster *raster = &f->neighbors->sources.raster;
    const int32_t from = f->cell, most = sphgi_min32(STAGED, f->room);
    int32_t to = f->around.cells;
    sphgi_candidate_runs(raster, &f->around, from, to, &f->staged);
    while (f->staged.candidates > most && to > from + 1) {
        to = from + (to - from) / 2;
        sphgi_candidate_runs(raster, &f->around, from, to, &f->staged);
    }
    f->staged_cells[0] = from;
    f->staged_cells[1] = to;
    if (f->staged.candidates <= f->room)
        f->passes->stage(&f->find, &f->staged);
}

/* The candidates of the cell, staged unless they are too many. */
static void candidates_of_cell(struct sphgi_finder *f, struct sphgi_runs *runs)
{
    if (f->cell < f->staged_cells[0] || f->cell >= f->staged_cells[1])
        stage_cells(f);
    sphgi_candidate_runs(&f->neighbors->sources.raster, &f->around, f->cell, f->cell + 1, runs);
    for (int32_t k = 0; k < runs->count; ++k)
        runs->staged[k] = f->staged.staged[k] + runs->begin[k] - f->staged.begin[k];
}

/* Lists for what is left of the cell of the next target, as many as are found at once. */
static void find_some(struct sphgi_finder *f)
{
    const sphg_neighbors *n = f->neighbors;
    struct sphgi_runs runs;
    uint32_t *lists[SPHGI_FIND_MOST];
    int32_t lengths[SPHGI_FIND_MOST];
    enter_cell(f);
    if (n->graded) {
        sphgi_find_in_octaves(f);
        return;
    }
    candidates_of_cell(f, &runs);
    const int32_t count = sphgi_min32(f->start[f->cell + 1] - f->next, SPHGI_FIND_MOST);
    sphgi_open_slots(f, count, runs.candidates, lists);
    if (runs.candidates <= f->room) {
        f->passes->find(&f->find, &runs, sphgi_target_row(n, f->next), count,
                        row_of_self(f, &runs, f->next), lists, lengths);
        sphgi_close_slots(f, count, lengths);
    }
    f->next += count;
}

/* ---- Groups --------------------------------------------------------------------------------- */

bool sphgi_find_group(struct sphgi_finder *f, int32_t group, const uint32_t **lists,
                      int32_t *lengths)
{
    const int32_t first = group * SPHGI_GROUP, count = sphgi_targets_in(f->neighbors, group);
    const int32_t slot = sphgi_slot_number(first);
    bool collected = true;
    if (f->block < 0 || first < f->first || first > f->next)
        go_to(f, first);
    f->first = first;
    while (f->next < first + count)
        find_some(f);
    for (int32_t k = 0; k < SPHGI_GROUP; ++k) {
        lists[k] = f->list[slot + k];
        lengths[k] = k < count ? f->length[slot + k] : 0;
        collected &= lengths[k] != SPHGI_CROWDED;
    }
    return collected;
}

/* ---- Clumps --------------------------------------------------------------------------------- */

void sphgi_find_target(struct sphgi_finder *f, int32_t target, sphgi_take *take, void *data)
{
    const sphg_neighbors *n = f->neighbors;
    struct sphgi_runs runs;
    go_to(f, target);
    if (n->graded) {
        sphgi_find_target_in_octaves(f, target, take, data);
        return;
    }
    enter_cell(f);
    sphgi_candidate_runs(&n->sources.raster, &f->around, f->cell, f->cell + 1, &runs);
    f->staged_cells[0] = f->staged_cells[1] = 0;
    const int32_t self = row_of_self(f, &runs, target);
    uint32_t *ids = sphgi_wide_slot(f);
    for (int32_t run = 0; run < runs.count; ++run)
        for (int32_t at = 0; at < runs.length[run]; at += f->room) {
            const int32_t begin = runs.begin[run] + at;
            const int32_t count = sphgi_min32(runs.length[run] - at, f->room);
            const bool inside = self >= begin && self < begin + count;
            struct sphgi_runs slice = {
                .count = 1, .candidates = count, .own = begin, .begin = {begin}, .length = {count}};
            int32_t found;
            f->passes->stage(&f->find, &slice);
            f->passes->find(&f->find, &slice, sphgi_target_row(n, target), 1, inside ? self : -1,
                            &ids, &found);
            take(data, ids, found);
        }
}
