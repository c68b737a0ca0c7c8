/* SPDX-License-Identifier: MIT */
/* How far results are from what they should be; and the field v = (-y, x, 2z), in 2D (-y, x), on
 * which a corrected gradient is exact. */
#ifndef SPHGRAD_BENCH_ERRORS_H
#define SPHGRAD_BENCH_ERRORS_H
#include "numbers.h"

/* |A|_F of an item less what was expected, or NULL; and that over |expected|_F. */
double norm_of(const struct numbers *found, int32_t item, const double *expected);
double relative_error(const struct numbers *found, int32_t item, const double *expected);
int64_t count_not_finite(const struct numbers *found); /* numbers */

/* At the positions as they are stored: exact in their precision. */
void linear_field_fill(const struct numbers *positions, struct numbers *field);

/* Of a Jacobian, 9 or 4 numbers row by row: relative. The largest is over items of full rank where
 * ranks are given; NaN is not overlooked, and is what comes out where no item counts. */
double linear_field_error(const struct numbers *jacobians, int32_t item);
double linear_field_worst(const struct numbers *jacobians, const uint8_t *ranks);
#endif
