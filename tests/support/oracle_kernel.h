/* SPDX-License-Identifier: MIT */
/* The smoothing functions in quadruple precision, from docs/theory.md alone. */
#ifndef TESTS_SUPPORT_ORACLE_KERNEL_H
#define TESTS_SUPPORT_ORACLE_KERNEL_H
#include "quad.h"
#include <sphgrad/sphgrad.h>

typedef struct oracle_weights {
    quad w;          /* W(r) */
    quad slope;      /* W'(r) / r, 0 at r = 0 */
    quad slope_rate; /* d(W'(r) / r) / dr, 0 at r = 0 */
} oracle_weights;

quad oracle_pi(void);
quad oracle_sigma(sphg_kernel kernel, int dimension);
quad oracle_mu2(sphg_kernel kernel, int dimension);
/* w(q) and its first two derivatives. */
void oracle_shape_of(sphg_kernel kernel, quad q, quad shape[3]);
oracle_weights oracle_weights_at(sphg_kernel kernel, int dimension, quad support, quad r);

#endif
