/* SPDX-License-Identifier: MIT */
/* One scene twice: before the library and before the oracle, on the same rounded numbers. */
#ifndef TESTS_SUPPORT_COMPARISON_H
#define TESTS_SUPPORT_COMPARISON_H
#include "setup.h"
#include "oracle.h"

typedef struct comparison {
    const test_case *test;
    const char *name; /* of the scene, for messages */
    cloud points;
    sphg_scheme scheme;
    sphg_context *context;
    sphg_neighbors *neighbors;
    setup_array volume, density;
    oracle_scene scene;
    oracle *reference;
} comparison;

/* Targets are all points; volumes and densities vary by a fifth. Rounds the points as the case
 * stores them. The support radius is rounded to f32. */
comparison comparison_of(const test_case *test, const char *name, cloud points, double support);
/* The same for radii of their own, a number per point, rounded to f32; mutual: as the geometry has
 * it. */
comparison comparison_of_radii(const test_case *test, const char *name, cloud points, double *radii,
                               int mutual);
/* The same under another policy and threshold (0: default). */
comparison comparison_under(const comparison *made, sphg_policy policy, double threshold);
/* The same with other volumes. */
comparison comparison_with_volumes(const comparison *made, const double *volume);

/* Volume and density; correction absent. */
sphg_sources comparison_sources(const comparison *on);
/* C_i of every target; empty for PLAIN. */
setup_array comparison_table(const comparison *on);
sphg_view comparison_table_view(const comparison *on, const setup_array *table);

typedef struct comparison_field {
    sphg_shape shape;
    sphg_form form;
    const double
        *numbers; /* rounded to the field type by the caller (comparison_random_field does) */
} comparison_field;

double *comparison_random_field(const comparison *on, sphg_shape shape, uint64_t seed);

/* Every operator the shape has; arrays without numbers where it has none. */
typedef struct comparison_result {
    setup_array gradient, divergence, curl, value, square;
} comparison_result;

/* Outputs of every operator the shape and form have, for so many targets; and their place in a
 * request. */
comparison_result comparison_outputs(const comparison *on, const comparison_field *field,
                                     int targets);
void comparison_ask_for(const comparison_result *outputs, sphg_field *asked);

/* table: NULL: corrections are computed in the same sweep. Two-sided forms need it. */
comparison_result comparison_apply(const comparison *on, const comparison_field *field,
                                   const setup_array *table);
comparison_result comparison_apply_to(const comparison *on, const comparison_field *field,
                                      const setup_array *table, const sphg_subset *subset);
/* Asks for one of the five results, in the order of comparison_result, and for nothing else. */
comparison_result comparison_apply_alone(const comparison *on, const comparison_field *field,
                                         const setup_array *table, int which);
int comparison_results_have_same_bits(const comparison_result *a, const comparison_result *b);

/* |found - exact| / bound; 0 / 0 is 0. */
double comparison_ratio(const setup_array *found, int item, const quad *exact, quad bound);
/* Compares all operators of target i with the oracle, against the two gates. */
void comparison_compare(const comparison *on, const comparison_field *field,
                        const comparison_result *found, int i);

#endif
