/* SPDX-License-Identifier: MIT */
/* Space is cut into a box for each rank. Boxes fill space: the outer ones have no end, so that no
 * particle is ever outside. */
#ifndef DISTRIBUTED_BOXES_H
#define DISTRIBUTED_BOXES_H
#include <mpi.h>
#include <stdbool.h>
#include <stddef.h>

struct box {
    double low[3], high[3]; /* low <= x < high */
};

bool box_holds(const struct box *box, const double *x);

/* Whether x, or another box, is within reach of the box. What holds nothing is near nobody. */
bool box_is_near(const struct box *box, const double *x, double reach);
bool boxes_are_near(const struct box *box, const struct box *other, double reach);

/* The particles of this rank: x of the first, and the next `stride` bytes on. */
struct places {
    const double *x;
    size_t stride;
    int count;
};
const double *place_of(const struct places *places, int k);

/* Collective: a box for each rank, equal on all of them, so that they hold about as many particles
 * each. */
typedef void cutter(MPI_Comm ranks, const struct places *places, struct box *boxes);

cutter cut_into_slabs; /* across the longest extent */
#ifdef WITH_ZOLTAN
cutter cut_by_bisection; /* recursive coordinate bisection by Zoltan */
#endif
cutter *best_cut(void); /* of these */

#endif
