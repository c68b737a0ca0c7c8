/* SPDX-License-Identifier: MIT */
/* The method of conjugate gradients (Hestenes, Stiefel 1952, doi:10.6028/jres.049.044) for a
 * symmetric positive definite A that is given as a function. */
#ifndef SOLVER_CONJUGATE_GRADIENT_H
#define SOLVER_CONJUGATE_GRADIENT_H
#include <stdint.h>

struct conjugate_gradient {
    void (*apply)(void *data, double *x, double *result); /* result = A x */
    void *data;
    int32_t count;
    double tolerance; /* |b - A x| <= tolerance |b| */
    int32_t most_iterations;
    double *work; /* 3 count numbers */
};

/* From x as it is given. Returns the number of iterations. */
int32_t conjugate_gradient(const struct conjugate_gradient *system, const double *b, double *x);
#endif
