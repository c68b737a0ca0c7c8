/* Neighbours: a copy of the positions, and who sums over whom. */
#ifndef SPHGI_NEIGHBORS_H
#define SPHGI_NEIGHBORS_H
#include "grid.h"
#include <stdatomic.h>
#include <string.h>

/* Found pairs, target by target in grid order, in groups of SPHGI_LANES_MOST that stand side by
 * side: [step][target], padded with 0. Normally ids are staged numbers (struct sphgi_surroundings)
 * times SPHGI_ID_STEP in 16 bits; in a clump too dense for that ("wide" block) they are 32-bit
 * numbers of rows, and behind each target's length.
 *
 * Lists share one piece of memory with the tables of the grids: these are large where lists are
 * small, in clouds so thin that many particles have a block of their own. Memory grows only when
 * there are more particles or pairs than ever before. What does not fit although there are not,
 * because pairs fall onto the targets in another way or lie in many more blocks, is not kept: such
 * blocks are searched when they are evaluated, like those of a list-free object. */
struct sphgi_found {
    int64_t *lists; /* per block of the targets: place in ids * 2 + wide; < 0: not kept */
    uint16_t *ids;  /* units */
    struct sphgi_buffer lengths; /* uint16_t per target; unused in wide blocks */
    int64_t room;                /* units that ids can hold */
    int64_t pairs, units;        /* of the last search, whether they were kept or not */
    int64_t most_pairs;          /* of any search; < 0: none yet */
    int32_t most_targets, most_sources;
};

/* Targets of a block whose lists stand side by side, as sweeps read them. If one of them is much
 * longer than the others, they follow one another instead, each padded to SPHGI_PAD. */
struct sphgi_list_group {
    int32_t count;   /* targets */
    int32_t longest; /* pairs of one */
    bool side_by_side;
    int64_t units;
};

static inline struct sphgi_list_group sphgi_list_group_of(const uint16_t *lengths, int32_t left)
{
    struct sphgi_list_group group = {.count = sphgi_min32(left, SPHGI_LANES_MOST)};
    int64_t padded = 0;
    for (int32_t k = 0; k < group.count; ++k) {
        group.longest = sphgi_max32(group.longest, lengths[k]);
        padded += (int64_t)sphgi_round_up(lengths[k], SPHGI_PAD);
    }
    const int64_t woven = (int64_t)group.longest * group.count;
    group.side_by_side = group.count > 1 && woven <= 2 * padded;
    group.units = group.side_by_side ? (int64_t)sphgi_round_up((size_t)woven, SPHGI_PAD) : padded;
    return group;
}

enum sphgi_neighbors_kind { SPHGI_NEVER_BUILT, SPHGI_SEARCHED, SPHGI_HOST_LISTS };

struct sphg_neighbors {
    struct sphgi_allocator allocator;
    enum sphgi_neighbors_kind kind;
    int32_t dimension;
    sphg_type position_type, type; /* of positions; of fields and results */
    double radius;                 /* H that the pairs were found for */
    double skin;
    double period[3];
    bool periodic, list_free;
    bool part_of; /* targets are the first sources */
    bool same;    /* ... and all of them: one grid serves both */
    int32_t source_count, target_count;

    struct sphgi_grid sources, targets; /* targets: unused if same */
    struct sphgi_buffer target_place;   /* int32_t: place of each target in grid order */
    atomic_uint_least64_t places;       /* one number for where the targets stand, 0: not known */
    struct sphgi_buffer shared;         /* tables of the grids, then lists */
    struct sphgi_found found;
    struct sphgi_buffer sources_then, targets_then; /* rows at the last search, with a skin */
    bool rebuilt;
    double skin_left;

    sphg_lists lists; /* the host's; rows of sources stand in its order in sources.rows */
};

/* Of the targets: the grid they are sorted in. */
static inline const struct sphgi_grid *sphgi_target_grid(const sphg_neighbors *neighbors)
{
    return neighbors->same ? &neighbors->sources : &neighbors->targets;
}

/* What is staged for one block of the targets, and where the targets of its cells begin. */
static inline void sphgi_block_surroundings(const sphg_neighbors *neighbors, int32_t block,
                                            struct sphgi_surroundings *around)
{
    const struct sphgi_grid *grid = sphgi_target_grid(neighbors);
    around->block = block;
    sphgi_cell_starts(grid, block, around->start);
    sphgi_surroundings_of(&neighbors->sources, grid->blocks[block].key, around);
}

static inline bool sphgi_is_kept(const sphg_neighbors *neighbors, int32_t block)
{
    return !neighbors->list_free && neighbors->found.lists[block] >= 0;
}

/* Of a block that is kept. */
static inline bool sphgi_is_kept_wide(const sphg_neighbors *neighbors, int32_t block)
{
    return neighbors->found.lists[block] & 1;
}

static inline const uint16_t *sphgi_kept_units(const sphg_neighbors *neighbors, int32_t block)
{
    return neighbors->found.ids + (neighbors->found.lists[block] >> 1);
}

/* Of a block that is kept and not wide: its ids, and what is staged for them, ranges alone. */
static inline const uint16_t *sphgi_kept_ids(const sphg_neighbors *neighbors, int32_t block,
                                             struct sphgi_surroundings *around)
{
    const uint16_t *units = sphgi_kept_units(neighbors, block);
    const int32_t *head = (const int32_t *)(const void *)units;
    const size_t ranges = (size_t)head[0];
    around->ranges = head[0];
    around->staged = head[1];
    memcpy(around->begin, head + 2, ranges * sizeof *head);
    memcpy(around->count, head + 2 + ranges, ranges * sizeof *head);
    return units + sphgi_round_up(2 * (2 + 2 * ranges), SPHGI_PAD);
}

/* Row (x y z .) of a target; place: in grid order, with the host's lists the target itself. */
static inline const char *sphgi_target_row(const sphg_neighbors *neighbors, int32_t place)
{
    const size_t size = SPHGI_ROW * sphgi_size_of_type(neighbors->position_type);
    return (const char *)sphgi_target_grid(neighbors)->rows.data + (size_t)place * size;
}

/* Of the host's lists: the target's, and how long it says it is. */
static inline int64_t sphgi_host_row(const sphg_lists *lists, int32_t target, int32_t worker,
                                     const int32_t **ids)
{
    if (lists->offsets) {
        *ids = lists->indices + lists->offsets[target];
        return lists->offsets[target + 1] - lists->offsets[target];
    }
    if (lists->rows) {
        *ids = lists->rows[target];
        return lists->lengths[target];
    }
    *ids = NULL;
    return lists->row(target, worker, ids, lists->user);
}

static inline bool sphgi_is_host_row(const int32_t *ids, int64_t count)
{
    return count >= 0 && count <= INT32_MAX && (count == 0 || ids);
}

#endif
