/* SPDX-License-Identifier: MIT */
/* What the parts of the reference of order 2 share. */
#ifndef TESTS_SUPPORT_ORACLE_SECOND_H
#define TESTS_SUPPORT_ORACLE_SECOND_H
#include "oracle_quadratic.h"

typedef struct oracle_basis {
    int d, n, a[oracle_pairs], b[oracle_pairs];
    quad off, deviator, trace; /* what makes the unit matrix of a full neighbourhood's moments */
} oracle_basis;

oracle_basis oracle_basis_of(const oracle_scene *scene);
void oracle_whitened(const oracle_basis *of, const quad *pairs, quad *q);
void oracle_offsets_of(const oracle_point *point, const oracle_basis *of, const oracle_pair *pair,
                       quad *e, quad *q);
quad oracle_weight_unit(const oracle_point *point);
int oracle_inverse_of(int n, oracle_block given, quad shift, oracle_block inverse);
quad oracle_norm_of(int n, oracle_block a);
quad oracle_smooth(quad x, quad low, quad high, quad *slope);
quad oracle_shift_at(sphg_policy policy, quad t, quad eps);

typedef struct oracle_change {
    quad first[3], second[oracle_pairs];
    rough first_size, second_size; /* sums of spread |dA| |e| and spread |dA| |q| */
} oracle_change;

oracle_change oracle_sum_changes(const oracle_basis *of, const oracle_point *point,
                                 const oracle_field *field, int i, int component, int width);
/* |M2^-1 b1| */
rough oracle_slope_norm(const oracle_basis *of, const oracle_point *point,
                        const oracle_change *sums);
/* Second derivatives from h; over: 1 / H. */
void oracle_hessian_of(const oracle_basis *of, const quad *h, quad over, quad *hessian);
/* Gradient and Hessian of a component from its changes; their bounds are added, but for that of the
 * linear part. */
void oracle_curve_component(const oracle_scene *scene, const oracle_basis *of,
                            const oracle_point *point, const oracle_second *second,
                            const oracle_change *sums, quad *g, quad *hessian,
                            oracle_curved *found);
void oracle_contract_second(const oracle_basis *of, const oracle_field *field, quad gradient[9][3],
                            oracle_curved *found);

#endif
