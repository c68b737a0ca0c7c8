/* SPDX-License-Identifier: MIT */
/* Requests of order 2 in a comparison: every derivative that a field has, and what is lent. */
#ifndef TESTS_SUPPORT_SECOND_ORDER_H
#define TESTS_SUPPORT_SECOND_ORDER_H
#include "oracle_quadratic.h"
#include "comparison.h"

/* Arrays without numbers where the shape has none. */
typedef struct second_order {
    setup_array gradient, divergence, curl, hessian, laplacian, curvature, rank, borrows, table;
    sphg_stats stats;
} second_order;

typedef struct second_order_how {
    const setup_array *table; /* in the place of corrections of this call */
    const setup_array *lent;  /* what an earlier call found; NULL: nobody lends */
    const sphg_subset *subset;
    int no_table; /* leave out correction, rank and stats */
    int lends;    /* ask for what is lent and who borrows, and for no table */
} second_order_how;

static inline int second_order_pairs(int d)
{
    return d * (d + 1) / 2;
}

/* The same of order 2. */
comparison second_order_comparison(comparison on);
second_order second_order_outputs(const comparison *on, sphg_shape shape, int lends);
/* Their places in a field. */
void second_order_ask(const second_order *outputs, sphg_field *field);
second_order second_order_apply(const comparison *on, sphg_shape shape, const double *numbers,
                                second_order_how how);
void second_order_require_same_bits(const second_order *a, const second_order *b,
                                    const char *where);

/* With corrections of the same call, written beside or not, and of a table: the same bits. */
void second_order_require_table_has_all(const comparison *on);

/* |found - exact| / bound of item i. */
double second_order_ratio(const setup_array *found, int i, const quad *exact, quad bound);
/* All of target i, against one tolerance; nothing where rounding decides. */
void second_order_compare(const comparison *on, const second_order *found,
                          const oracle_curved *exact, int i, test_tolerance tolerance);

/* A = c.x + x^T Q x / 2 of small whole numbers, so that values are exact in f32, too; degree 1:
 * c.x.
 */
extern const double second_order_slopes[3], second_order_second[6];
double *second_order_polynomial(const cloud *points, int degree);
void second_order_slope_at(const cloud *points, int i, double *gradient);

#endif
