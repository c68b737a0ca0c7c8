/* Requests of order 2 on a stage: every derivative that a field has, and what is lent. */
#ifndef TESTS_SUPPORT_CURVED_H
#define TESTS_SUPPORT_CURVED_H
#include "oracle_quadratic.h"
#include "stage.h"

/* Arrays without numbers where the shape has none. */
typedef struct curved {
    fixture_array gradient, divergence, curl, hessian, laplacian, curvature, rank, borrows, table;
    sphg_stats stats;
} curved;

typedef struct curved_how {
    const fixture_array *table; /* in the place of corrections of this call */
    const fixture_array *lent;  /* what an earlier call found; NULL: nobody lends */
    const sphg_subset *subset;
    int no_table; /* leave out correction, rank and stats */
    int lends;    /* ask for what is lent and who borrows, and for no table */
} curved_how;

static inline int curved_pairs(int d)
{
    return d * (d + 1) / 2;
}

/* The same of order 2. */
stage curved_stage(stage on);
curved curved_outputs(const stage *on, sphg_shape shape, int lends);
/* Their places in a field. */
void curved_ask(const curved *outputs, sphg_field *field);
curved curved_apply(const stage *on, sphg_shape shape, const double *numbers, curved_how how);
void curved_require_same_bits(const curved *a, const curved *b, const char *where);

/* |found - exact| / bound of item i. */
double curved_ratio(const fixture_array *found, int i, const quad *exact, quad bound);
/* All of target i, against one tolerance; nothing where rounding decides. */
void curved_compare(const stage *on, const curved *found, const oracle_curved *exact, int i,
                    test_tolerance tolerance);

/* A = c.x + x^T Q x / 2 of small whole numbers, so that values are exact in f32, too; degree 1:
 * c.x.
 */
extern const double curved_slopes[3], curved_second[6];
double *curved_polynomial(const cloud *points, int degree);
void curved_slope_at(const cloud *points, int i, double *gradient);

#endif
