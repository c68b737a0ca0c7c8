/* SPDX-License-Identifier: MIT */
/* Pairs of a row in ascending order, and their blocks filled up anew. */
#ifndef SPHGI_PAIR_ORDER_H
#define SPHGI_PAIR_ORDER_H
#include "core/context.h"
#include "sweep/pair_numbers.h"

struct sphgi_pair_order {
    const int64_t *offsets;
    const int32_t *lengths; /* pairs of each row; NULL: up to the next one */
    int32_t *indices;
    struct sphgi_pair_numbers gradient;
};

void sphgi_sort_pairs(sphg_context *context, const struct sphgi_pair_order *order, int32_t rows);

#endif
