/* SPDX-License-Identifier: MIT */
/* Small symmetric matrices in quadruple precision, and what a threshold policy makes of them. */
#ifndef TESTS_SUPPORT_ORACLE_MATRIX_H
#define TESTS_SUPPORT_ORACLE_MATRIX_H
#include "quad.h"
#include <sphgrad/sphgrad.h>

enum { oracle_rows = 4 }; /* room for the basis (1, xi) in 3D */
typedef quad oracle_matrix[oracle_rows][oracle_rows];

/* a = Q diag(values) Q^T of the leading n x n part; column k of vectors for value k. */
void oracle_eigen(int n, oracle_matrix a, quad *values, oracle_matrix vectors);
/* The largest |eigenvalue|. */
rough oracle_spectral_norm(int n, oracle_matrix a);

/* f applied to normalised moments. */
typedef struct oracle_filter {
    int n;
    quad eps;                                /* eps_i */
    quad lambda[oracle_rows];                /* ascending is not promised */
    quad f[oracle_rows];                     /* f(lambda) */
    rough divided[oracle_rows][oracle_rows]; /* |f[lambda_k, lambda_l]| */
    oracle_matrix axes;                      /* column k for lambda_k */
    int rank;
    quad lambda_min;
} oracle_filter;

/* below: f of a direction that is dropped, 1 for linearised and 0 for classic methods. blur: how
 * far rounding may move an eigenvalue. */
oracle_filter oracle_filtered(int n, oracle_matrix normalised, sphg_policy policy, quad eps,
                              int below, quad blur);
/* Q diag(f) Q^T. */
void oracle_recompose(const oracle_filter *filter, oracle_matrix result);

#endif
