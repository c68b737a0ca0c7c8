/* SPDX-License-Identifier: MIT */
/* The field v = (-y, x, 2z), in 2D (-y, x), on which a corrected gradient is exact. */
#ifndef SPHGRAD_BENCH_LINEAR_FIELD_H
#define SPHGRAD_BENCH_LINEAR_FIELD_H
#include "numbers.h"

/* In words. */
const char *linear_field_formula(int32_t dimension);

/* At the positions as they are stored: exact in their precision. */
void linear_field_fill(const struct numbers *positions, struct numbers *field);

/* |J - its true gradient|_F / |J|_F of an item of 9 or 4 numbers, row by row. */
double linear_field_error(const struct numbers *jacobians, int32_t item);

/* The largest over items, of those of full rank where ranks are given. NaN is not overlooked, and
 * is what comes out where no item counts. */
double linear_field_worst(const struct numbers *jacobians, const uint8_t *ranks);

int64_t linear_field_not_finite(const struct numbers *jacobians); /* numbers */
#endif
