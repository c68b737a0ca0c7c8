/* SPDX-License-Identifier: MIT */
/* Blocks whose particles have radii of their own, and the ways in which their pairs are found. */
#ifndef TESTS_SUPPORT_GRADED_H
#define TESTS_SUPPORT_GRADED_H
#include "comparison.h"

typedef struct graded {
    cloud points;
    double *radii;
} graded;

/* A jittered block that is `ratio` times as coarse at its far end, H = support spacings. */
graded graded_block(int dimension, double ratio, double support);

/* How neighbours are found: at once, or before particles moved, with a skin that still holds; on
 * open axes, or around. A bit each. */
typedef enum graded_way {
    GRADED_AT_ONCE,
    GRADED_MOVED = 1,
    GRADED_AROUND = 2,
    GRADED_WAYS = 4
} graded_way;
const char *graded_way_name(graded_way way);

/* Where its particles were before they moved, in numbers that every type holds; and the skin that a
 * search of then had. */
graded graded_before(int dimension, double ratio, double support);
double graded_skin(const graded *before);

/* Such a block with the reference, whose pairs are those of now. Neighbours are mutual. */
comparison graded_stage_of(const test_case *test, double ratio, double support, graded_way way);

/* Compares all that such a field has with the oracle, at five of the particles or fewer. */
void graded_compare(const comparison *on, sphg_shape shape, sphg_form form,
                    const setup_array *table);

/* Exported G_ij beside those of sphg_pair_gradient() with H_i: so many roundings apart at most.
 * Corrections are computed on the way, or those of a table. */
void graded_require_pair_gradients(const comparison *on, int from_table, double roundings);

#endif
