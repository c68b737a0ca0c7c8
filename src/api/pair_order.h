/* SPDX-License-Identifier: MIT */
/* Pairs of a row in ascending order. */
#ifndef SPHGI_PAIR_ORDER_H
#define SPHGI_PAIR_ORDER_H
#include "core/context.h"
#include "passes/columns.h"

struct sphgi_pair_order {
    const int64_t *offsets;
    int32_t *indices;
    struct sphgi_columns gradient;
    size_t number_size;
};

void sphgi_sort_pairs(sphg_context *context, const struct sphgi_pair_order *order, int32_t rows);

#endif
