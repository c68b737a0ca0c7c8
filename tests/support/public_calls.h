/* SPDX-License-Identifier: MIT */
/* The calls of every public function with the arguments of a valid call, and variants of its
 * request. */
#ifndef TESTS_SUPPORT_PUBLIC_CALLS_H
#define TESTS_SUPPORT_PUBLIC_CALLS_H
#include "valid_call.h"

/* Objects that a call makes are destroyed at once. */
sphg_result call_create_context(valid_call *own);
sphg_result call_create_neighbors(valid_call *own);
sphg_result call_search(valid_call *own);
sphg_result call_would_rebuild(valid_call *own);
sphg_result call_use_lists(valid_call *own);
sphg_result call_get_context_info(valid_call *own);
sphg_result call_get_info(valid_call *own);
sphg_result call_get_order(valid_call *own);
sphg_result call_check(valid_call *own);
sphg_result call_evaluate(valid_call *own);
sphg_result call_correction(valid_call *own);
sphg_result call_gradient(valid_call *own);
sphg_result call_jacobian(valid_call *own);
sphg_result call_divergence(valid_call *own);
sphg_result call_curl(valid_call *own);
sphg_result call_force(valid_call *own);
sphg_result call_pair_gradients(valid_call *own);
sphg_result call_invert_moments(valid_call *own);
sphg_result call_eigen(valid_call *own);
sphg_result call_svd(valid_call *own);

/* By lists of the host. */
void prepare_listed(valid_call *own);
/* Targets apart from the sources. */
void prepare_with_targets(valid_call *own);
void prepare_with_radii(valid_call *own);
/* SYMMETRIC, with tables, volumes and densities on both sides. */
void prepare_two_sided(valid_call *own);
/* DIRECT, of a vector, with all its results. */
void prepare_direct(valid_call *own);
void prepare_square(valid_call *own);
void prepare_quadratic(valid_call *own);
void prepare_lending(valid_call *own);
void prepare_diffusion(valid_call *own);
void prepare_values(valid_call *own);
void prepare_with_table(valid_call *own);
void prepare_by_mls(valid_call *own);
/* So that the arrays of pairs suffice. */
void prepare_of_four_targets(valid_call *own);

#endif
