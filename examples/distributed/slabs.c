/* SPDX-License-Identifier: MIT */
#include "boxes.h"
#include "stop.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALVINGS = 48 }; /* of the extent; closer cuts than that part no particles */

/* Of all ranks' particles. Without any, low is above high. */
static struct box extent_of(MPI_Comm ranks, const struct places *places)
{
    double ends[6]; /* the upper ones negative, so that one minimum serves both */
    for (int a = 0; a < 6; ++a)
        ends[a] = INFINITY;
    for (int k = 0; k < places->count; ++k)
        for (int a = 0; a < 3; ++a) {
            const double x = place_of(places, k)[a];
            ends[a] = fmin(ends[a], x);
            ends[3 + a] = fmin(ends[3 + a], -x);
        }
    MPI_Allreduce(MPI_IN_PLACE, ends, 6, MPI_DOUBLE, MPI_MIN, ranks);
    return (struct box){{ends[0], ends[1], ends[2]}, {-ends[3], -ends[4], -ends[5]}};
}

static int longest_axis(const struct box *extent)
{
    int longest = 0;
    for (int a = 1; a < 3; ++a)
        if (extent->high[a] - extent->low[a] > extent->high[longest] - extent->low[longest])
            longest = a;
    return longest;
}

static int in_order(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* How many of the ascending numbers are below x. */
static int below(const double *numbers, int count, double x)
{
    int low = 0, high = count;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (numbers[middle] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* All cuts are bisected at once: each is moved until its share of the particles is below it. */
static void find_cuts(MPI_Comm ranks, const double *along, int count, double low, double high,
                      double *cuts, int cut_count)
{
    const size_t room = (size_t)cut_count;
    long long all = count, *under = resized(NULL, room, sizeof *under);
    double *floors = resized(NULL, room, sizeof *floors);
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_LONG_LONG, MPI_SUM, ranks);
    for (int c = 0; c < cut_count; ++c)
        floors[c] = low;
    for (int halving = 1; halving <= HALVINGS; ++halving) {
        const double step = ldexp(high - low, -halving);
        for (int c = 0; c < cut_count; ++c) {
            cuts[c] = floors[c] + step;
            under[c] = below(along, count, cuts[c]);
        }
        MPI_Allreduce(MPI_IN_PLACE, under, cut_count, MPI_LONG_LONG, MPI_SUM, ranks);
        for (int c = 0; c < cut_count; ++c)
            if (under[c] * (cut_count + 1) <= all * (c + 1))
                floors[c] = cuts[c];
    }
    memcpy(cuts, floors, room * sizeof *cuts);
    free(floors);
    free(under);
}

void cut_into_slabs(MPI_Comm ranks, const struct places *places, struct box *boxes)
{
    int rank_count;
    MPI_Comm_size(ranks, &rank_count);
    struct box extent = extent_of(ranks, places);
    if (!(extent.low[0] <= extent.high[0])) /* nobody is there: any cut will do */
        extent = (struct box){{0, 0, 0}, {0, 0, 0}};
    const int axis = longest_axis(&extent);
    double *along = resized(NULL, (size_t)places->count, sizeof *along);
    double *cuts = resized(NULL, (size_t)rank_count, sizeof *cuts);
    for (int k = 0; k < places->count; ++k)
        along[k] = place_of(places, k)[axis];
    qsort(along, (size_t)places->count, sizeof *along, in_order);
    find_cuts(ranks, along, places->count, extent.low[axis], extent.high[axis], cuts,
              rank_count - 1);
    for (int rank = 0; rank < rank_count; ++rank) {
        boxes[rank] =
            (struct box){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
        if (rank > 0)
            boxes[rank].low[axis] = cuts[rank - 1];
        if (rank < rank_count - 1)
            boxes[rank].high[axis] = cuts[rank];
    }
    free(cuts);
    free(along);
}
