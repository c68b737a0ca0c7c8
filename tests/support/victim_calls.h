/* The valid calls of a victim, and variants of its request. */
#ifndef TESTS_SUPPORT_VICTIM_CALLS_H
#define TESTS_SUPPORT_VICTIM_CALLS_H
#include "victim.h"

/* Objects that a call makes are destroyed at once. */
sphg_result call_create_context(victim *own);
sphg_result call_create_neighbors(victim *own);
sphg_result call_search(victim *own);
sphg_result call_use_lists(victim *own);
sphg_result call_get_context_info(victim *own);
sphg_result call_get_info(victim *own);
sphg_result call_get_order(victim *own);
sphg_result call_check(victim *own);
sphg_result call_evaluate(victim *own);
sphg_result call_correction(victim *own);
sphg_result call_gradient(victim *own);
sphg_result call_jacobian(victim *own);
sphg_result call_divergence(victim *own);
sphg_result call_curl(victim *own);
sphg_result call_force(victim *own);
sphg_result call_pair_gradients(victim *own);
sphg_result call_invert_moments(victim *own);
sphg_result call_eigen(victim *own);
sphg_result call_svd(victim *own);

/* By lists of the host. */
void prepare_listed(victim *own);
/* Targets apart from the sources. */
void prepare_with_targets(victim *own);
void prepare_with_radii(victim *own);
/* SYMMETRIC, with tables, volumes and densities on both sides. */
void prepare_two_sided(victim *own);
/* DIRECT, of a vector, with all its results. */
void prepare_direct(victim *own);
void prepare_square(victim *own);
void prepare_quadratic(victim *own);
void prepare_lending(victim *own);
void prepare_with_table(victim *own);
void prepare_by_mls(victim *own);
/* So that the arrays of pairs suffice. */
void prepare_of_four_targets(victim *own);

#endif
