/* SPDX-License-Identifier: MIT */
/* Neighbours: a copy of the positions, and who sums over whom. */
#ifndef SPHGI_NEIGHBORS_H
#define SPHGI_NEIGHBORS_H
#include "grid.h"
#include <stdatomic.h>
#include <string.h>

/* Found pairs, in groups of SPHGI_GROUP targets that follow one another in storage: ids of rows,
 * [step][target], padded with the dummy's. Groups that hold a list much longer than the others, or
 * a very long one, are kept "apart": a header of SPHGI_GROUP lengths, then list after list, each
 * padded to SPHGI_PAD.
 *
 * Lists share one piece of memory with the tables of the grids: these are large where lists are
 * small, in clouds so thin that many particles have a block of their own. Memory grows only when
 * there are more particles or pairs than ever before. What does not fit although there are not,
 * because pairs fall onto the targets in another way or lie in many more blocks, is not kept: such
 * groups are searched when they are evaluated, like those of a list-free object. */
struct sphgi_found {
    int64_t *groups; /* place in ids << SPHGI_STEPS_BITS | steps; < 0: not kept */
    uint32_t *ids;
    struct sphgi_buffer lengths; /* uint16_t per target; unused in groups kept apart */
    int64_t room;                /* ids that there is room for */
    int64_t pairs, ids_used;     /* of the last search, whether they were kept or not */
    bool crowded;                /* lengths of some lists are not known, or not all of them pairs */
    int64_t most_pairs;          /* of any search; < 0: none yet */
    int32_t most_targets, most_sources;
};

enum { SPHGI_STEPS_BITS = 16, SPHGI_APART = (1 << SPHGI_STEPS_BITS) - 1 };

enum sphgi_neighbors_kind {
    SPHGI_NEVER_BUILT,
    SPHGI_SEARCHED,
    SPHGI_HOST_LISTS,  /* borrowed: rows stand in the host's order, and there are no groups */
    SPHGI_COPIED_LISTS /* the host's, kept like found ones; rows stand in its order, which `order`
                          and `target_place` say like any other */
};

struct sphg_neighbors {
    struct sphgi_allocator allocator;
    enum sphgi_neighbors_kind kind;
    int32_t dimension;
    sphg_type position_type, type; /* of positions; of fields and results */
    double radius;                 /* H that the pairs were found for */
    double skin;
    double period[3];
    bool radii;     /* particles have their own, the 4th numbers of rows; `radius` is the largest */
    bool graded;    /* ... and not all the same */
    bool mutual;    /* the larger one of a pair counts */
    double least;   /* radius */
    double stretch; /* 1 + skin / radius at the last search: lists hold so many times each radius */
    double largest[3]; /* |coordinate| at the last search, if periodic or graded */
    bool periodic, list_free, keeps_weights;
    bool part_of; /* targets are the first sources */
    bool same;    /* ... and all of them: one grid serves both */
    int32_t source_count, target_count;

    struct sphgi_grid sources, targets;      /* targets: unused if same */
    const struct sphg_neighbors *targets_of; /* whose grid of targets `targets` and `target_place`
                                                are; NULL: the object's own */
    uint64_t builds, builds_of_targets; /* its own, and those of targets_of when it was built */
    bool dummy_is_far;                  /* farther from all targets than pairs reach, else NaN */
    struct sphgi_buffer target_place;   /* int32_t: place of each target in grid order */
    struct sphgi_buffer source_place;   /* the same of sources: radii, for targets among them */
    atomic_uint_least64_t places;       /* one number for where the targets stand, 0: not known */
    struct sphgi_buffer shared;         /* tables of the grids, then lists */
    struct sphgi_found found;
    struct sphgi_buffer sources_then, targets_then; /* rows at the last search, with a skin */
    struct sphgi_buffer weights, weight_book;       /* weights.h; empty: none are kept */
    bool rebuilt;
    double skin_left;

    sphg_lists lists; /* the host's; rows of sources stand in its order in sources.rows */
};

/* Of the targets: the grid they are sorted in. */
static inline const struct sphgi_grid *sphgi_target_grid(const sphg_neighbors *neighbors)
{
    return neighbors->same ? &neighbors->sources : &neighbors->targets;
}

/* Targets that are other particles than the sources, and were sorted by this object. */
static inline bool sphgi_sorts_targets(const sphg_neighbors *neighbors)
{
    return !neighbors->same && !neighbors->targets_of;
}

/* Whether the object whose grid the targets stand in, if it is another one, is as it was. */
static inline bool sphgi_has_its_targets(const sphg_neighbors *neighbors)
{
    return !neighbors->targets_of || neighbors->targets_of->builds == neighbors->builds_of_targets;
}

/* With a skin a source may come farther than the margin of a small target. */
static inline bool sphgi_lists_are_mutual(const sphg_neighbors *neighbors)
{
    return neighbors->mutual || neighbors->skin > 0;
}

/* ---- Groups --------------------------------------------------------------------------------- */

static inline int32_t sphgi_group_count(int32_t targets)
{
    return targets / SPHGI_GROUP + (targets % SPHGI_GROUP != 0);
}

/* Targets of a group: all but the last are full. */
static inline int32_t sphgi_targets_in(const sphg_neighbors *neighbors, int32_t group)
{
    return sphgi_min32(SPHGI_GROUP, neighbors->target_count - group * SPHGI_GROUP);
}

static inline bool sphgi_is_kept(const sphg_neighbors *neighbors, int32_t group)
{
    return !neighbors->list_free && neighbors->found.groups[group] >= 0;
}

/* Of a group that is kept: the longest list rounded up, or SPHGI_APART. */
static inline int32_t sphgi_kept_steps(const sphg_neighbors *neighbors, int32_t group)
{
    return (int32_t)(neighbors->found.groups[group] & SPHGI_APART);
}

static inline const uint32_t *sphgi_kept_ids(const sphg_neighbors *neighbors, int32_t group)
{
    return neighbors->found.ids + (neighbors->found.groups[group] >> SPHGI_STEPS_BITS);
}

/* One of the lists of a group that is kept: id k stands at ids + k * stride. Side by side they are
 * [step][list]; apart their lengths stand first, then list after list, each rounded up. */
struct sphgi_kept_list {
    const uint32_t *ids, *length; /* NULL: they stand side by side */
    int32_t stride;
};

/* Of a group whose lists stand apart. */
static inline struct sphgi_kept_list sphgi_first_apart(const sphg_neighbors *neighbors,
                                                       int32_t group)
{
    const uint32_t *lengths = sphgi_kept_ids(neighbors, group);
    return (struct sphgi_kept_list){lengths + SPHGI_GROUP, lengths, 1};
}

/* Of any group. */
static inline struct sphgi_kept_list sphgi_first_list(const sphg_neighbors *neighbors,
                                                      int32_t group)
{
    if (sphgi_kept_steps(neighbors, group) == SPHGI_APART)
        return sphgi_first_apart(neighbors, group);
    return (struct sphgi_kept_list){sphgi_kept_ids(neighbors, group), NULL, SPHGI_GROUP};
}

static inline void sphgi_to_next_list(struct sphgi_kept_list *list)
{
    list->ids += list->length ? sphgi_round_up(*list->length++, SPHGI_PAD) : 1;
}

/* Row (x y z .) of a target; place: in grid order, with the host's lists the target itself. */
static inline const char *sphgi_target_row(const sphg_neighbors *neighbors, int32_t place)
{
    const size_t size = SPHGI_ROW * sphgi_size_of_type(neighbors->position_type);
    return (const char *)sphgi_target_grid(neighbors)->rows.data + (size_t)place * size;
}

/* The radius in a row. */
static inline double sphgi_radius_in(const void *rows, sphg_type type, int32_t number)
{
    const size_t at = SPHGI_ROW * (size_t)number + SPHGI_ROW - 1;
    return type == SPHG_F64 ? ((const double *)rows)[at] : (double)((const float *)rows)[at];
}
static inline double sphgi_row_radius(const sphg_neighbors *neighbors, const void *rows,
                                      int32_t number)
{
    return sphgi_radius_in(rows, neighbors->position_type, number);
}

/* Of the host's lists: the target's, and how long it says it is. */
static inline int64_t sphgi_host_row(const sphg_lists *lists, int32_t target, int32_t worker,
                                     const int32_t **ids)
{
    if (lists->offsets) {
        *ids =
            lists->indices ? lists->indices + lists->offsets[target] : NULL; /* no pairs at all */
        return lists->offsets[target + 1] - lists->offsets[target];
    }
    if (lists->rows) {
        *ids = lists->rows[target];
        return lists->lengths[target];
    }
    *ids = NULL;
    return lists->row(target, worker, ids, lists->user);
}

/* Which numbers of a host's list count, and what they are. */
static inline struct sphgi_cleaning sphgi_cleaning_of(const sphg_neighbors *neighbors,
                                                      const sphg_lists *lists)
{
    return (struct sphgi_cleaning){.mask =
                                       lists->index_mask ? (uint32_t)lists->index_mask : UINT32_MAX,
                                   .sources = (uint32_t)neighbors->source_count};
}

/* What a target's list may hold of itself. */
static inline uint32_t sphgi_self_of(const sphg_neighbors *neighbors, int32_t target)
{
    return neighbors->part_of ? (uint32_t)target : UINT32_MAX;
}

static inline bool sphgi_is_host_row(const int32_t *ids, int64_t count)
{
    return count >= 0 && count <= INT32_MAX && (count == 0 || ids);
}

#endif
