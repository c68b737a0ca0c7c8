/* SPDX-License-Identifier: MIT */
#include "find.h"
#include "walk.h"
#include <string.h>

enum {
    CROWDED = -1,
    TOGETHER = 8,  /* targets of an octave: more of them stand too far apart to test the same */
    LEG = 40,      /* targets that share candidates, unless the first cell holds more of them ... */
    LEG_CELLS = 8, /* ... and the cells that these are in, at most */
    LOOKED_FOR = 128, /* targets for which blocks are looked up at once, about */
    SLOT = 512, /* candidates of a list in a slot that is not wide. Slots stand close together: the
                   few lines that lists take of each must stay in the L1 cache */
    STAGED = 3072 /* candidates of several cells: their coordinates must stay there, too */
};

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

static size_t candidate_bytes(const sphg_neighbors *neighbors)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t candidates = (size_t)room_of(neighbors) + SPHGI_FIND_SLACK + 2 * SPHGI_ALIGNMENT;
    const size_t numbers = neighbors->graded ? 4 : 3, sets = neighbors->graded ? 2 : 1;
    return sphgi_round_up(sets * candidates * (numbers * size + sizeof(uint32_t) + 1),
                          SPHGI_ALIGNMENT);
}

/* Coordinates of the candidates of some cells, and the vectors in which those of one are scanned:
 * of two lanes at least, with nine numbers or less each. */
static size_t staged_bytes(const sphg_neighbors *neighbors)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    return neighbors->graded ? 0
                             : sphgi_round_up(3 * size * staged_room(neighbors), SPHGI_ALIGNMENT);
}

static size_t scan_bytes(const sphg_neighbors *neighbors)
{
    const size_t vectors = (size_t)room_of(neighbors) / 2 + SPHGI_RUNS_MOST + SPHGI_SCANNED;
    const size_t each = 2 * sizeof(int32_t) + sizeof(uint16_t);
    return neighbors->graded ? 0 : sphgi_round_up(vectors * each, SPHGI_ALIGNMENT);
}

static size_t nearby_bytes(const sphg_neighbors *neighbors)
{
    return neighbors->graded ? sphgi_round_up(sizeof(struct sphgi_nearby), SPHGI_ALIGNMENT) : 0;
}

static size_t slot_of(int32_t candidates)
{
    return (size_t)candidates + SPHGI_FIND_SLACK;
}

static size_t slot_bytes(const sphg_neighbors *neighbors)
{
    const int32_t room = room_of(neighbors);
    return SPHGI_LISTS_MOST * (slot_of(SLOT) + (room > SLOT ? slot_of(room) : 0)) *
           sizeof(uint32_t);
}

size_t sphgi_finder_size(const sphg_neighbors *neighbors)
{
    return candidate_bytes(neighbors) + staged_bytes(neighbors) + scan_bytes(neighbors) +
           nearby_bytes(neighbors) + slot_bytes(neighbors);
}

void sphgi_finder_open(struct sphgi_finder *finder, const sphg_context *context,
                       const sphg_neighbors *neighbors, void *memory)
{
    *finder = (struct sphgi_finder){.neighbors = neighbors, .room = room_of(neighbors)};
    finder->passes = sphgi_passes_of(context, neighbors->position_type);
    finder->find = (struct sphgi_find){.rows = neighbors->sources.rows.data,
                                       .reach = neighbors->radius + neighbors->skin,
                                       .stretch = neighbors->stretch,
                                       .mutual = sphgi_lists_are_mutual(neighbors),
                                       .slack = neighbors->sources.raster.slack,
                                       .periodic = neighbors->periodic,
                                       .dummy = (uint32_t)neighbors->source_count * SPHGI_ID_STEP,
                                       .scratch = memory,
                                       .pack_order = context->pack_order,
                                       .pack_bytes = context->pack_bytes};
    memcpy(finder->find.period, neighbors->period, sizeof finder->find.period);
    finder->find.staged = (char *)memory + candidate_bytes(neighbors);
    finder->find.staged_room = (int32_t)staged_room(neighbors);
    finder->find.scan = (char *)finder->find.staged + staged_bytes(neighbors);
    finder->nearby = (void *)((char *)finder->find.scan + scan_bytes(neighbors));
    finder->slots = (uint32_t *)(void *)((char *)finder->nearby + nearby_bytes(neighbors));
    finder->wide_slots = finder->slots + SPHGI_LISTS_MOST * slot_of(SLOT);
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

static int32_t slot_number(int32_t target)
{
    return target & (SPHGI_LISTS_MOST - 1);
}

/* Slots for the next targets, that share so many candidates. */
static void open_slots(struct sphgi_finder *f, int32_t count, int32_t candidates, uint32_t **lists)
{
    const bool wide = candidates > SLOT;
    for (int32_t k = 0; k < count; ++k) {
        const int32_t s = slot_number(f->next + k);
        f->length[s] = CROWDED;
        f->list[s] = lists[k] = wide ? f->wide_slots + (size_t)s * slot_of(f->room)
                                     : f->slots + (size_t)s * slot_of(SLOT);
    }
}

/* Where any list fits, for one that does not wait. */
static uint32_t *wide_slot(const struct sphgi_finder *f)
{
    return f->room > SLOT ? f->wide_slots : f->slots;
}

static void close_slots(struct sphgi_finder *f, int32_t count, const int32_t *lengths)
{
    for (int32_t k = 0; k < count; ++k)
        f->length[slot_number(f->next + k)] = lengths[k];
}

/* ---- Octaves -------------------------------------------------------------------------------- */

static void open_walk(const struct sphgi_finder *f, struct sphgi_walk *walk, int32_t target,
                      int32_t count)
{
    const sphg_neighbors *n = f->neighbors;
    double low[SPHGI_ROW], high[SPHGI_ROW];
    f->passes->bounds(sphgi_target_row(n, target), count, low, high);
    sphgi_walk_open(walk, &n->sources, low, high, n->stretch, sphgi_lists_are_mutual(n));
}

/* Where targets are some of the sources, a cell's stand in another order there. */
static int32_t row_of_source(const sphg_neighbors *n, int32_t target)
{
    const int32_t *order = sphgi_target_grid(n)->order.data, *place = n->source_place.data;
    return n->same ? target : place[order[target]];
}

static bool look_around(struct sphgi_finder *f, int32_t first, int32_t last)
{
    struct sphgi_walk walk;
    open_walk(f, &walk, first, last - first);
    f->looked[0] = first;
    f->looked[1] = last;
    return sphgi_look_nearby(&walk, f->nearby);
}

/* To the leg of the next target: cells that follow one another, until they hold as many targets as
 * share candidates. Counted from the block's first, so that lists do not depend on where a walk
 * began. */
static void enter_leg(struct sphgi_finder *f)
{
    while (f->next >= f->start[f->leg[1]]) {
        const int32_t first = f->leg[1], most = f->start[first] + LEG;
        const int32_t limit = first - first % LEG_CELLS + LEG_CELLS;
        int32_t end = first + 1;
        while (end < limit && f->start[end + 1] <= most)
            ++end;
        f->leg[0] = first;
        f->leg[1] = end;
    }
}

/* The cells of the block that are looked around at once, those of the next target being among them:
 * all, or where they hold many targets some. */
static void part_of_block(const struct sphgi_finder *f, int32_t *first, int32_t *last)
{
    int32_t cells = SPHGI_BLOCK_CELLS;
    int32_t count = f->start[SPHGI_BLOCK_CELLS] - f->start[0];
    for (; cells > LEG_CELLS && count > LOOKED_FOR; count /= 2)
        cells /= 2;
    *first = f->leg[0] - f->leg[0] % cells;
    *last = *first + cells;
}

/* The blocks near the part of the block where the next target is, unless they are known; if they
 * are too many, those near its leg. False: these are too many, too. */
static bool look_nearby(struct sphgi_finder *f)
{
    int32_t first, last;
    part_of_block(f, &first, &last);
    const bool known = f->next >= f->looked[0] && f->next < f->looked[1];
    return known ? f->nearby->count >= 0
                 : look_around(f, f->start[first], f->start[last]) ||
                       look_around(f, f->start[f->leg[0]], f->start[f->leg[1]]);
}

/* Packs the candidates of the targets [first, last); false: they are too many. */
static bool pack(struct sphgi_finder *f, int32_t first, int32_t last)
{
    const sphg_neighbors *n = f->neighbors;
    struct sphgi_walk walk;
    struct sphgi_runs runs;
    const bool looked = look_nearby(f);
    open_walk(f, &walk, first, last - first);
    const bool more =
        looked ? sphgi_walk_nearby(&walk, f->nearby, &runs) : sphgi_walk_on(&walk, &runs);
    if (more || runs.candidates > f->room)
        return false;
    f->passes->pack_by_radii(&f->find, &runs, sphgi_target_row(n, first), last - first,
                             n->same ? first : -1, &f->packed);
    f->packed_for[0] = first;
    f->packed_for[1] = last;
    return true;
}

/* Where the targets of the leg that are searched for together with the next one begin and end.
 */
static void few_around(const struct sphgi_finder *f, int32_t *first, int32_t *last)
{
    const int32_t begin = f->start[f->leg[0]], end = f->start[f->leg[1]];
    const int32_t parts = sphgi_max32(1, (end - begin + TOGETHER / 2 - 1) / TOGETHER);
    const int32_t part = sphgi_min32((f->next - begin) / TOGETHER, parts - 1);
    *first = begin + part * TOGETHER;
    *last = part + 1 < parts ? *first + TOGETHER : end;
}

/* Those of the leg share candidates, or if these are too many, a few of them. */
static bool have_packed(struct sphgi_finder *f, int32_t first, int32_t last)
{
    const int32_t begin = f->start[f->leg[0]], end = f->start[f->leg[1]];
    if (f->next >= f->packed_for[0] && f->next < f->packed_for[1])
        return true;
    if (f->apart_up_to != end) {
        if (pack(f, begin, end))
            return true;
        f->apart_up_to = end;
    }
    return pack(f, first, last);
}

static void find_in_octaves(struct sphgi_finder *f)
{
    const sphg_neighbors *n = f->neighbors;
    uint32_t *lists[SPHGI_FIND_MOST];
    int32_t selves[SPHGI_FIND_MOST], lengths[SPHGI_FIND_MOST], first, last;
    enter_leg(f);
    few_around(f, &first, &last);
    const int32_t count = last - f->next;
    const bool packed = have_packed(f, first, last);
    for (int32_t k = 0; k < count; ++k)
        selves[k] = n->part_of ? row_of_source(n, f->next + k) : -1;
    const bool follow = packed && f->packed.self >= 0;
    f->find.selves = n->part_of && !follow ? selves : NULL;
    open_slots(f, count, packed ? f->packed.count : 0, lists);
    if (packed) {
        const int32_t self = follow ? f->packed.self + f->next - f->packed_for[0] : -1;
        f->passes->find_by_radii(&f->find, &f->packed, sphgi_target_row(n, f->next), count, self,
                                 lists, lengths);
        close_slots(f, count, lengths);
    }
    f->next += count;
}

/* One target, slice by slice of its runs. */
static void find_target_in_octaves(struct sphgi_finder *f, int32_t target, sphgi_take *take,
                                   void *data)
{
    const sphg_neighbors *n = f->neighbors;
    const int32_t self = n->part_of ? row_of_source(n, target) : -1;
    struct sphgi_walk walk;
    struct sphgi_runs runs, slice = {.count = 1};
    uint32_t *ids = wide_slot(f);
    f->find.selves = NULL;
    f->packed_for[0] = f->packed_for[1] = 0;
    open_walk(f, &walk, target, 1);
    for (bool more = true; more;) {
        more = sphgi_walk_on(&walk, &runs);
        for (int32_t run = 0; run < runs.count; ++run)
            for (int32_t at = 0; at < runs.length[run]; at += f->room) {
                int32_t found;
                slice.candidates = sphgi_min32(runs.length[run] - at, f->room);
                slice.begin[0] = runs.begin[run] + at;
                slice.length[0] = slice.candidates;
                f->passes->pack_by_radii(&f->find, &slice, sphgi_target_row(n, target), 1, self,
                                         &f->packed);
                f->passes->find_by_radii(&f->find, &f->packed, sphgi_target_row(n, target), 1,
                                         f->packed.self, &ids, &found);
                take(data, ids, found);
            }
    }
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
        find_in_octaves(f);
        return;
    }
    candidates_of_cell(f, &runs);
    const int32_t count = sphgi_min32(f->start[f->cell + 1] - f->next, SPHGI_FIND_MOST);
    open_slots(f, count, runs.candidates, lists);
    if (runs.candidates <= f->room) {
        f->passes->find(&f->find, &runs, sphgi_target_row(n, f->next), count,
                        row_of_self(f, &runs, f->next), lists, lengths);
        close_slots(f, count, lengths);
    }
    f->next += count;
}

/* ---- Groups --------------------------------------------------------------------------------- */

bool sphgi_find_group(struct sphgi_finder *f, int32_t group, const uint32_t **lists,
                      int32_t *lengths)
{
    const int32_t first = group * SPHGI_GROUP, count = sphgi_targets_in(f->neighbors, group);
    const int32_t slot = slot_number(first);
    bool collected = true;
    if (f->block < 0 || first < f->first || first > f->next)
        go_to(f, first);
    f->first = first;
    while (f->next < first + count)
        find_some(f);
    for (int32_t k = 0; k < SPHGI_GROUP; ++k) {
        lists[k] = f->list[slot + k];
        lengths[k] = k < count ? f->length[slot + k] : 0;
        collected &= lengths[k] != CROWDED;
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
        find_target_in_octaves(f, target, take, data);
        return;
    }
    enter_cell(f);
    sphgi_candidate_runs(&n->sources.raster, &f->around, f->cell, f->cell + 1, &runs);
    f->staged_cells[0] = f->staged_cells[1] = 0;
    const int32_t self = row_of_self(f, &runs, target);
    uint32_t *ids = wide_slot(f);
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
