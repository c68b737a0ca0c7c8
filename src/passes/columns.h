/* SPDX-License-Identifier: MIT */
/* Memory of the host, as passes read and write it. */
#ifndef SPHGI_COLUMNS_H
#define SPHGI_COLUMNS_H
#include "internal.h"

/* Where the components of the items of a view stand. */
enum { SPHGI_COLUMNS_MOST = 16 };
struct sphgi_columns {
    const char *at[SPHGI_COLUMNS_MOST];
    ptrdiff_t stride;   /* [byte] */
    int32_t count;      /* components; 0: absent. Of more than SPHGI_COLUMNS_MOST only the first has
                           its place: they follow one another (sphgi_some_columns) */
    bool together;      /* they follow one another in memory */
    sphg_layout layout; /* of items that are matrices: d x d numbers from at[0] on, of which
                           at[c] is component c, in FULL one of two */
    int32_t side;       /* d, where a layout is set */
};

/* Index of x_a x_b in an upper triangle. */
static inline int32_t sphgi_pair_index(int32_t a, int32_t b, int32_t d)
{
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    return low * d - low * (low - 1) / 2 + high - low;
}

/* Numbers of an item in memory, and the component that number k of them is. */
static inline int32_t sphgi_numbers_of(const struct sphgi_columns *columns)
{
    return columns->layout ? columns->side * columns->side : columns->count;
}

static inline int32_t sphgi_component_at(const struct sphgi_columns *columns, int32_t k)
{
    const int32_t d = columns->side;
    if (columns->layout == SPHG_AS_SHAPE)
        return k;
    const int32_t a = k / d, b = k % d;
    return columns->layout == SPHG_COLUMN_MAJOR ? b * d + a : sphgi_pair_index(a, b, d);
}

#endif
