/* SPDX-License-Identifier: MIT */
#include "public_calls.h"
#include <string.h>

/* ---- Calls -------------------------------------------------------------------------------- */

sphg_result call_create_context(valid_call *own)
{
    const sphg_result result =
        sphg_context_create(own->version, own->config_given, own->context_out);
    TEST_REQUIRE(result == SPHG_OK || !own->context_out || !*own->context_out,
                 "a context was made all the same");
    if (result == SPHG_OK)
        sphg_context_destroy(*own->context_out);
    return result;
}

sphg_result call_create_neighbors(valid_call *own)
{
    const sphg_result result = sphg_neighbors_create(own->context, own->neighbors_out);
    if (result == SPHG_OK)
        sphg_neighbors_destroy(*own->neighbors_out);
    return result;
}

sphg_result call_search(valid_call *own)
{
    return sphg_neighbors_search(own->context, own->neighbors, own->scheme_given,
                                 own->geometry_given);
}

sphg_result call_would_rebuild(valid_call *own)
{
    return sphg_neighbors_would_rebuild(own->context, own->neighbors, own->scheme_given,
                                        own->geometry_given, own->rebuild);
}

sphg_result call_use_lists(valid_call *own)
{
    return sphg_neighbors_use_lists(own->context, own->neighbors, own->scheme_given,
                                    own->geometry_given, own->lists_given);
}

sphg_result call_get_context_info(valid_call *own)
{
    const sphg_result result = sphg_context_get_info(own->context, own->context_info);
    if (result == SPHG_OK) /* it depends on what the context did before */
        memset(own->context_info, 0, sizeof *own->context_info);
    return result;
}

sphg_result call_get_info(valid_call *own)
{
    return sphg_neighbors_get_info(own->context, own->neighbors, own->info);
}

sphg_result call_get_order(valid_call *own)
{
    return sphg_neighbors_get_order(own->context, own->neighbors, own->order);
}

sphg_result call_check(valid_call *own)
{
    return sphg_neighbors_check(own->context, own->scheme_given, own->neighbors, own->list_fault);
}

sphg_result call_evaluate(valid_call *own)
{
    return sphg_evaluate(own->context, own->scheme_given, own->request_given);
}

sphg_result call_correction(valid_call *own)
{
    return sphg_correction(own->context, own->scheme_given, own->sources_given, own->subset_given,
                           own->table_out, own->rank_out);
}

sphg_result call_gradient(valid_call *own)
{
    return sphg_gradient(own->context, own->scheme_given, own->sources_given, own->subset_given,
                         own->scalars, own->vector_out);
}

sphg_result call_jacobian(valid_call *own)
{
    return sphg_jacobian(own->context, own->scheme_given, own->sources_given, own->subset_given,
                         own->vectors, own->tensor_out);
}

sphg_result call_divergence(valid_call *own)
{
    return sphg_divergence(own->context, own->scheme_given, own->sources_given, own->subset_given,
                           own->vectors, own->scalar_out);
}

sphg_result call_curl(valid_call *own)
{
    return sphg_curl(own->context, own->scheme_given, own->sources_given, own->subset_given,
                     own->vectors, own->test->dimension == 2 ? own->scalar_out : own->vector_out);
}

sphg_result call_force(valid_call *own)
{
    return sphg_force(own->context, own->scheme_given, own->sources_given, own->subset_given,
                      own->shape, own->tensors, own->vector_out);
}

sphg_result call_pair_gradients(valid_call *own)
{
    return sphg_pair_gradients(own->context, own->scheme_given, own->sources_given,
                               own->subset_given, own->target_correction, own->pairs_given);
}

sphg_result call_invert_moments(valid_call *own)
{
    return sphg_invert_moments(own->context, own->scheme_given, own->count, own->symmetric,
                               own->volume_view, own->wanted_given);
}

sphg_result call_eigen(valid_call *own)
{
    return sphg_eigen(own->context, own->dimension, own->count, own->symmetric, own->vector_out,
                      own->tensor_out);
}

sphg_result call_svd(valid_call *own)
{
    return sphg_svd(own->context, own->count, own->squares, own->u, own->sigma, own->v);
}

/* ---- Variants of the valid call ----------------------------------------------------------- */

void prepare_listed(valid_call *own)
{
    own->neighbors = own->listed;
}

void prepare_with_targets(valid_call *own)
{
    own->geometry.targets = own->vectors;
}

void prepare_with_radii(valid_call *own)
{
    own->geometry.targets = own->vectors;
    own->geometry.source_support = own->radii;
    own->geometry.target_support = own->target_radii;
}

void prepare_two_sided(valid_call *own)
{
    own->field.form = SPHG_SYMMETRIC;
    own->request.correction = own->request.rank = own->request.lambda_min = sphg_absent();
    own->request.stats = NULL;
    own->sources[0].correction = own->request.target_correction = own->table;
    own->request.target_volume = own->volume_view;
    own->request.target_density = own->densities;
}

void prepare_direct(valid_call *own)
{
    own->field.form = SPHG_DIRECT;
    own->field.shape = SPHG_VECTOR;
    own->at_sources[0] = own->vectors;
    own->field.at_targets = sphg_absent();
    own->field.gradient = own->tensor_out;
    own->field.divergence = own->scalar_out;
    const ptrdiff_t size = own->scalar_out.stride;
    own->field.value = own->u;
    own->field.value.stride = own->test->dimension * size;
    own->field.curl = own->v;
    own->field.curl.stride = own->test->dimension == 2 ? size : 3 * size;
    own->request.fields = &own->field;
}

void prepare_square(valid_call *own)
{
    own->field.form = SPHG_DIRECT;
    own->field.at_targets = own->field.gradient = sphg_absent();
    own->field.square = own->scalar_out;
    own->request.fields = &own->field;
}

/* Hessians, one after the other where tensors have room for more. */
void prepare_quadratic(valid_call *own)
{
    const int d = own->test->dimension;
    own->scheme.order = 2;
    own->request.correction = sphg_absent();
    own->field.hessian = own->tensor_out;
    own->field.hessian.stride = own->tensor_out.stride / (d * d) * (d * (d + 1) / 2);
    own->field.laplacian = own->scalar_out;
    own->request.fields = &own->field;
}

/* What is lent has one number more than a symmetric tensor. */
void prepare_lending(valid_call *own)
{
    const int d = own->test->dimension, width = 1 + d * (d + 1) / 2;
    own->scheme.order = 2;
    own->request.correction = own->request.rank = sphg_absent();
    own->field.curvature = own->u;
    own->field.curvature.stride = own->scalar_out.stride * width;
    own->field.lenders = own->lenders;
    own->lenders[0] = own->squares;
    own->request.borrows = own->rank_out;
    own->request.fields = &own->field;
}

void prepare_diffusion(valid_call *own)
{
    prepare_two_sided(own);
    own->field.form = SPHG_ADJOINT;
    own->field.gradient = sphg_absent();
    own->field.laplacian = own->scalar_out;
    own->field.coefficient = own->coefficient;
    own->coefficient[0] = own->densities;
    own->field.coefficient_at_targets = own->densities;
    own->request.fields = &own->field;
}

void prepare_values(valid_call *own)
{
    prepare_direct(own);
    own->field.curl = own->field.divergence = sphg_absent();
    own->field.shepard = 1;
    own->field.value_volume = own->volumes;
    own->volumes[0] = own->densities;
    own->field.tensor = own->squares;
    own->field.contraction = own->scalar_out;
}

void prepare_with_table(valid_call *own)
{
    own->sources[0].correction = own->table;
    own->shape = SPHG_TENSOR;
}

void prepare_by_mls(valid_call *own)
{
    own->scheme.method = SPHG_MLS;
}

void prepare_of_four_targets(valid_call *own)
{
    own->subset.end = 4;
    own->target_correction = own->table;
}
