/* SPDX-License-Identifier: MIT */
#include "errors.h"
#include <math.h>

double norm_of(const struct numbers *found, int32_t item, const double *expected)
{
    double squares = 0;
    for (int32_t k = 0; k < found->width; ++k)
        squares += pow(numbers_get(found, item, k) - (expected ? expected[k] : 0), 2);
    return sqrt(squares);
}

double relative_error(const struct numbers *found, int32_t item, const double *expected)
{
    double squares = 0;
    for (int32_t k = 0; k < found->width; ++k)
        squares += expected[k] * expected[k];
    return norm_of(found, item, expected) / sqrt(squares);
}

int64_t count_not_finite(const struct numbers *found)
{
    int64_t count = 0;
    for (int32_t i = 0; i < found->count; ++i)
        for (int32_t k = 0; k < found->width; ++k)
            count += !isfinite(numbers_get(found, i, k));
    return count;
}

void linear_field_fill(const struct numbers *positions, struct numbers *field)
{
    for (int32_t i = 0; i < positions->count; ++i) {
        numbers_set(field, i, 0, -numbers_get(positions, i, 1));
        numbers_set(field, i, 1, numbers_get(positions, i, 0));
        if (positions->width == 3)
            numbers_set(field, i, 2, 2 * numbers_get(positions, i, 2));
    }
}

double linear_field_error(const struct numbers *jacobians, int32_t item)
{
    static const double volume[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2}, plane[4] = {0, -1, 1, 0};
    return relative_error(jacobians, item, jacobians->width == 9 ? volume : plane);
}

double linear_field_worst(const struct numbers *jacobians, const uint8_t *ranks)
{
    const int32_t full = jacobians->width == 9 ? 3 : 2;
    double most = -1;
    for (int32_t i = 0; i < jacobians->count; ++i)
        if (!ranks || ranks[i] >= full)
            most = numbers_larger(most, linear_field_error(jacobians, i));
    return most < 0 ? (double)NAN : most;
}
