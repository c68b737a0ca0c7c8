/* SPDX-License-Identifier: MIT */
/* What becomes of rows of pairs once they are written: ascending order, full blocks. */
#ifndef SPHGI_PAIR_ORDER_H
#define SPHGI_PAIR_ORDER_H
#include "core/context.h"
#include "sweep/pair_numbers.h"

struct sphgi_pair_order {
    const int64_t *offsets;
    const int32_t *lengths; /* pairs of each row; NULL: up to the next one */
    int32_t *indices;
    struct sphgi_pair_numbers gradient;
    bool sorted; /* wanted so */
};

void sphgi_order_pairs(sphg_context *context, const struct sphgi_pair_order *order, int32_t rows);

#endif
