/* SPDX-License-Identifier: MIT */
/* Factors s_ij that are kept beside the ids of pairs, for sweeps that would form the same again. */
#ifndef SPHGI_WEIGHTS_H
#define SPHGI_WEIGHTS_H
#include "neighbors.h"

/* What makes s_ij what they are, apart from the positions. */
struct sphgi_weights_of {
    sphg_kernel kernel;
    sphg_method method; /* PLAIN's factors are KGC's */
    double radius;
    double volume; /* V / H^d of all sources, or -1: each has its own */
};

/* What a sweep may read and write. number 0: nothing. */
struct sphgi_kept_weights {
    char *factors;   /* of the type of the positions, at the places of the ids */
    uint32_t *marks; /* a group's factors stand there if its mark is `number` */
    uint32_t number;
};

/* Memory beside the lists just built, nothing in it. False: there is none. */
bool sphgi_weights_reserve(sphg_neighbors *neighbors);

/* Takes the memory for one sweep; another sweep that comes meanwhile gets nothing. same_volumes:
 * volumes of their own are those of the sweep before. */
struct sphgi_kept_weights sphgi_weights_take(const sphg_neighbors *neighbors,
                                             const struct sphgi_weights_of *of, bool same_volumes);
/* A sweep goes without. What others have kept is that of the sweep before no more, unless it has
 * the same volumes. */
void sphgi_weights_pass(const sphg_neighbors *neighbors, bool same_volumes);
/* good: what was written is what was asked for. */
void sphgi_weights_give_back(const sphg_neighbors *neighbors,
                             const struct sphgi_kept_weights *weights, bool good);

#endif
