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

/* The rank whose box holds x; -1 if x is not finite. */
int box_with(const struct box *boxes, int count, const double *x);

/* Whether x is closer to the box than reach; a box that holds nothing is near nobody. */
bool box_is_near(const struct box *box, const double *x, double reach);

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

#endif
