/* SPDX-License-Identifier: MIT */
/* What a search knows of the place where it is. */
#ifndef SPHGI_FINDER_H
#define SPHGI_FINDER_H
#include "neighbors.h"
#include "halo.h"

enum {
    SPHGI_CANDIDATES_MOST =
        8192, /* of a target; what has more is crowded, and searched in slices */
    SPHGI_LISTS_MOST = 2 * SPHGI_GROUP
};

/* A walk over targets. Lists are found for all targets of a cell at once, and wait until those of a
 * group are together. */
struct sphgi_finder {
    const sphg_neighbors *neighbors;
    const struct sphgi_passes *passes; /* for the positions */
    struct sphgi_find find;
    int32_t room; /* candidates */

    int32_t next;        /* the first target that has not been looked at */
    int32_t block, cell; /* where it is; block -1: nowhere yet */
    int32_t start[SPHGI_BLOCK_CELLS + 1];
    struct sphgi_halo around;
    struct sphgi_runs staged; /* of the cells staged_cells[0] .. [1] - 1 of the block */
    int32_t staged_cells[2];
    int32_t leg[2]; /* of octaves: the cells [0] .. [1] - 1, whose targets share candidates */
    struct sphgi_nearby
        *nearby; /* of octaves: blocks near the targets looked[0] .. looked[1] - 1 */
    int32_t looked[2];
    struct sphgi_packed packed; /* of octaves: candidates of the targets packed_for[0] .. [1] - 1 */
    int32_t packed_for[2];
    int32_t apart_up_to; /* targets before this one have too many candidates to share them */

    /* Lists of targets from `first` up to `next`. That of target t stands in slot t modulo
     * SPHGI_LISTS_MOST, so that those of a group follow one another and nobody moves them. */
    int32_t first;
    uint32_t *slots, *wide_slots; /* for lists of few candidates, and of up to `room` */
    uint32_t *list[SPHGI_LISTS_MOST];
    int32_t length[SPHGI_LISTS_MOST]; /* CROWDED: not collected */
};

/* Takes ids of rows, not padded, at most SPHGI_CANDIDATES_MOST at a time. */
typedef void sphgi_take(void *data, const uint32_t *ids, int32_t count);

#endif
