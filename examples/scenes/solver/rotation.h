/* SPDX-License-Identifier: MIT */
/* The rotation nearest to a matrix, by the library's singular values. */
#ifndef SOLVER_ROTATION_H
#define SOLVER_ROTATION_H
#include "library.h"

struct rotations {
    tensor *left, *right;
    vector *sigma; /* singular values, descending; the last one negative where det < 0 */
};

struct rotations rotations_new(int32_t capacity);
void rotations_free(struct rotations *rotations);

/* R of the polar decompositions F = R S; det R = 1 even where det F < 0. */
void rotations_find(const struct sph *sph, struct rotations *rotations, int32_t count,
                    tensor *matrices, tensor *found);
#endif
