/* sphgrad: small matrices, in batches. Part of sphgrad.h, which includes it.
 * SPDX-License-Identifier: MIT */
#ifndef SPHGRAD_SMALL_MATRICES_H
#define SPHGRAD_SMALL_MATRICES_H
#include "sphgrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Small matrices, in batches ----------------------------------------------------------- */

/* What is wanted of sphg_invert_moments; what is absent or NULL is not. */
typedef struct sphg_inversion {
    sphg_view correction; /* C_i, SYM_TENSOR; may be the moments themselves */
    sphg_view rank;       /* U8 */
    sphg_view lambda_min; /* as in sphg_request */
    sphg_stats *stats;
} sphg_inversion;

/* C = f(M) of moments that you summed yourself (M_i as at sphg_method, in units of the host;
 * SYM_TENSOR; linearised methods only). volume: V_i [L^d], read by MLS. A matrix with NaN or Inf
 * gives C = NaN and rank 0; other items are unaffected.
 * Errors: ARGUMENT, TYPE, UNSUPPORTED (classic, PLAIN), MEMORY, VOLUME. */
SPHG_API sphg_result sphg_invert_moments(sphg_context *context, const sphg_scheme *scheme,
                                         int32_t count, sphg_view moments, sphg_view volume,
                                         const sphg_inversion *wanted);

/* A = Q diag(values) Q^T of SYM_TENSOR items, cyclic Jacobi; values (VECTOR) descending, column k
 * of vectors (TENSOR) for value k, det Q = 1. Either may be absent; outputs overlap nothing. Error:
 * a few roundings of the largest |value|. NaN or Inf spoils no other item.
 * Errors: ARGUMENT, TYPE. Cost: O(count). */
SPHG_API sphg_result sphg_eigen(sphg_context *context, int32_t dimension, int32_t count,
                                sphg_view matrices, sphg_view values, sphg_view vectors);

/* A = U diag(sigma) V^T of 3 x 3 TENSOR items, one-sided Jacobi; sigma (VECTOR) descending, >= 0; U
 * and V (TENSOR) orthogonal. Each may be absent; outputs overlap nothing. Where sigma
 * vanishes the signs of u and v are unrelated: to threshold, use sphg_invert_moments.
 * Errors: ARGUMENT, TYPE. Cost: O(count). */
SPHG_API sphg_result sphg_svd(sphg_context *context, int32_t count, sphg_view matrices, sphg_view u,
                              sphg_view sigma, sphg_view v);

#ifdef __cplusplus
}
#endif
#endif
