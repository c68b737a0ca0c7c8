/* SPDX-License-Identifier: MIT */
/* The host's views, resolved into one pointer per component. */
#ifndef SPHGI_VIEW_H
#define SPHGI_VIEW_H
#include "passes/passes.h"

static inline bool sphgi_is_absent(const sphg_view *view)
{
    return !view->x;
}

/* Numbers that an item of this shape holds. */
int32_t sphgi_components(sphg_shape shape, int32_t dimension);
struct sphgi_columns sphgi_columns_of(const sphg_view *view, sphg_shape shape, int32_t dimension);

/* Items of `count` numbers that follow one another: tables, rank, lambda_min. */
struct sphgi_columns sphgi_flat_columns(const sphg_view *view, int32_t count);

/* Components [first, first + SPHGI_COLUMNS_MOST) of items whose numbers follow one another, as far
 * as there are. */
struct sphgi_columns sphgi_some_columns(const struct sphgi_columns *columns, int32_t first,
                                        sphg_type type);

/* Items 0, 1, .. of a dense array of items of `count` numbers. */
struct sphgi_columns sphgi_dense_columns(const void *data, int32_t count, int32_t item_numbers,
                                         sphg_type type);

#endif
