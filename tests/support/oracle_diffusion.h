/* SPDX-License-Identifier: MIT */
/* The reference of diffusion and of sums of values, pair by pair from docs/theory.md, section 11.
 */
#ifndef TESTS_SUPPORT_ORACLE_DIFFUSION_H
#define TESTS_SUPPORT_ORACLE_DIFFUSION_H
#include "oracle.h"

typedef struct oracle_flow {
    quad sum[9]; /* sum k_ij L_ij (A_j - A_i) */
    quad bound;
    quad least; /* the smallest L_ij */
    int touched, undecided;
} oracle_flow;

/* coefficient: of each particle; NULL: 1. Targets are the sources. */
oracle_flow oracle_diffuse(oracle *reference, const oracle_field *field, const double *coefficient,
                           int i);

typedef struct oracle_mean {
    quad value[9], bound;
} oracle_mean;

/* sum V_j (A_j - A_i) W, or in the direct form sum V_j A_j W. volume: NULL: the scene's; shepard:
 * over the sum of the weights. */
oracle_mean oracle_value(oracle *reference, const oracle_field *field, const double *volume,
                         int shepard, int i);

#endif
