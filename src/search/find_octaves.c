/* SPDX-License-Identifier: MIT */
#include "find_octaves.h"
#include "list_slots.h"
#include "walk.h"

enum {
    TOGETHER = 8,  /* targets of an octave: more of them stand too far apart to test the same */
    LEG = 40,      /* targets that share candidates, unless the first cell holds more of them ... */
    LEG_CELLS = 8, /* ... and the cells that these are in, at most */
    LOOKED_FOR = 128 /* targets for which blocks are looked up at once, about */
};

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

void sphgi_find_in_octaves(struct sphgi_finder *f)
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
    sphgi_open_slots(f, count, packed ? f->packed.count : 0, lists);
    if (packed) {
        const int32_t self = follow ? f->packed.self + f->next - f->packed_for[0] : -1;
        f->passes->find_by_radii(&f->find, &f->packed, sphgi_target_row(n, f->next), count, self,
                                 lists, lengths);
        sphgi_close_slots(f, count, lengths);
    }
    f->next += count;
}

void sphgi_find_target_in_octaves(struct sphgi_finder *f, int32_t target, sphgi_take *take,
                                  void *data)
{
    const sphg_neighbors *n = f->neighbors;
    const int32_t self = n->part_of ? row_of_source(n, target) : -1;
    struct sphgi_walk walk;
    struct sphgi_runs runs, slice = {.count = 1};
    uint32_t *ids = sphgi_wide_slot(f);
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
