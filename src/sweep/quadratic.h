/* SPDX-License-Identifier: MIT */
/* Order 2: what it sums, corrects and finishes otherwise than order 1 (theory.md, section 9). */
#ifndef SPHGI_QUADRATIC_H
#define SPHGI_QUADRATIC_H
#include "worker.h"

/* Of a field, from the tile into the sums. */
void sphgi_sum_quadratic(struct sphgi_worker *worker, const struct sphgi_field_plan *field,
                         const char *at_target);

/* T of the sources, whose tables stand in rows. */
void sphgi_transpose_quadratic(struct sphgi_worker *worker, const void *density,
                               enum sphgi_weight weight);
/* sum G_ij, or with densities, from sums of s x and s x x from number `sum` on. */
void sphgi_apply_to_vectors(struct sphgi_worker *worker, int32_t sum, char *to);

/* What the linear correction leaves to that of order 2: before it, and from it on. */
void sphgi_keep_all(struct sphgi_worker *worker, struct sphgi_verdict *verdict);
void sphgi_invert_quadratic(struct sphgi_worker *worker, const void *scale,
                            const struct sphgi_verdict *verdict);

/* Of the lane's target, whose linear rank is given. */
uint8_t sphgi_quadratic_rank(const struct sphgi_worker *worker, int32_t lane, uint8_t rank);

/* Gradients into worker->jacobian; Hessians and Laplacians are written. */
void sphgi_finish_quadratic(struct sphgi_worker *worker, const struct sphgi_field_plan *field);

#endif
