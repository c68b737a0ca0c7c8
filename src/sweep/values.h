/* SPDX-License-Identifier: MIT */
/* Sums of A_j, or of A_j - A_i, over the weights of values. */
#ifndef SPHGI_VALUES_H
#define SPHGI_VALUES_H
#include "worker.h"

/* Weights of the tile, once W is known; then the sums of a field, at_target subtracted from A_j. */
void sphgi_weigh_values(struct sphgi_worker *worker, int32_t count);
void sphgi_sum_value(struct sphgi_worker *worker, const struct sphgi_field_plan *field,
                     const char *at_target);

void sphgi_finish_value(struct sphgi_worker *worker, const struct sphgi_field_plan *field);

#endif
