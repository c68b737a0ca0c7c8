/* SPDX-License-Identifier: MIT */
/* Batches of small matrices with chosen spectra. */
#ifndef SPHGRAD_BENCH_SOLVER_BATCH_H
#define SPHGRAD_BENCH_SOLVER_BATCH_H
#include "numbers.h"
#include <stdbool.h>

enum spectrum {
    SPECTRUM_NONE,    /* whatever is copied */
    SPECTRUM_MOMENTS, /* eigenvalues of a particle inside a fluid, or, for a share of them, at its
                         surface */
    SPECTRUM_RANDOM,  /* entries in [-1, 1) */
    SPECTRUM_NEAR,    /* a thousandth away from the identity, if not symmetric: from a rotation */
    SPECTRUM_GRADED   /* 1, 1e-3, 1e-6 */
};

/* Items as the library takes them: symmetric ones d (d + 1) / 2 numbers. */
struct numbers batch_create(enum spectrum spectrum, double share, bool symmetric, sphg_type type,
                            int32_t dimension, int32_t count);
/* An item of such a table as a full matrix. */
void batch_matrix(const struct numbers *table, int32_t item, int32_t dimension, double a[3][3]);
#endif
