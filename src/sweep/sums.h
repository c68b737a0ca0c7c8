/* SPDX-License-Identifier: MIT */
/* The pairs of a tile into the sums of a plan. */
#ifndef SPHGI_SUMS_H
#define SPHGI_SUMS_H
#include "worker.h"

/* The weights of gathered pairs that came without. */
void sphgi_weigh_tile(struct sphgi_worker *worker);

/* Adds the pairs to the sums of fields of both sides; of a plan that narrows this comes first. */
void sphgi_sum_over_both_ends(struct sphgi_worker *worker);

/* Adds the pairs to the sums of this round, or hands them on one by one. */
void sphgi_evaluate_tile(struct sphgi_worker *worker);

/* What the sums over a field subtract from A_j: A_i in the difference form, -A_i in an
 * antisymmetric one, else 0. Of the targets at work, [number][SPHGI_WIDTH]. */
const char *sphgi_subtracted(const struct sphgi_worker *worker,
                             const struct sphgi_field_plan *field);

#endif
