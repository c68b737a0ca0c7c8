/* SPDX-License-Identifier: MIT */
/* The pairs of a neighbourhood with their gradients, for loops that the library has no operator
 * for. */
#ifndef SOLVER_PAIRS_H
#define SOLVER_PAIRS_H
#include "library.h"

struct pairs {
    int64_t *offsets; /* those of particle first + k: [offsets[k], offsets[k + 1]) */
    int32_t *indices;
    vector *gradient; /* G_ij */
    int64_t capacity;
};

struct pairs pairs_new(int32_t count);
void pairs_free(struct pairs *pairs);
/* Of the particles [first, end). */
void pairs_update(const struct sph *sph, const sphg_sources *sources, int32_t first, int32_t end,
                  struct pairs *pairs);
#endif
