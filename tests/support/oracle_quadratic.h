/* SPDX-License-Identifier: MIT */
/* The reference of order 2, on the pairs and moments of oracle_point: docs/theory.md, section 9, in
 * quadruple precision, sharing no code with the library. */
#ifndef TESTS_SUPPORT_ORACLE_QUADRATIC_H
#define TESTS_SUPPORT_ORACLE_QUADRATIC_H
#include "oracle.h"

enum { oracle_pairs = 6 }; /* of axes, in 3D */
typedef quad oracle_block[oracle_pairs][oracle_pairs];

typedef struct oracle_second {
    quad kept;                 /* omega */
    quad k[3][oracle_pairs];   /* K */
    oracle_block s, f;         /* S, F */
    quad t, eps, shift, left;  /* left: tr F S */
    quad norm_k, norm_f, size; /* size: how far S may be off, over u */
    quad inverse_norm;         /* |M2^-1|_F where omega > 0 */
    quad change_of_kept;       /* what u does to omega, over omega and u */
    int full, rank, undecided;
    quad second, third; /* sums of spread |e|^2 and spread |e| |q| */
    quad m3[3][oracle_pairs], trace2;
} oracle_second;

typedef struct oracle_curved {
    quad gradient[9], hessian[18], laplacian[9], divergence[3], curl[3];
    rough gradient_bound, hessian_bound; /* D_g and D_h */
    int touched, undecided;
} oracle_curved;

/* (1/H^4) int W x_a^2 x_b^2 dV of different axes. */
quad oracle_mu4(sphg_kernel kernel, int dimension);
/* Target i. */
void oracle_solve_second(const oracle_scene *scene, const oracle_point *point,
                         oracle_second *second);
/* Its rank, where rounding decides on it. */
int oracle_second_rank_is_open(const oracle_scene *scene, const oracle_point *point,
                               const oracle_second *second);
/* The same, solved once. */
const oracle_second *oracle_second_at(oracle *reference, int i);
/* DIFFERENCE. hessian of vectors: component by component. */
oracle_curved oracle_apply_second(oracle *reference, const oracle_field *field, int i);
/* ADJOINT and SYMMETRIC: gradient, divergence, curl. */
oracle_curved oracle_apply_second_two_sided(oracle *reference, const oracle_field *field, int i);

#endif
