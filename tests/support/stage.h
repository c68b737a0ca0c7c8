/* One scene twice: before the library and before the oracle, on the same rounded numbers. */
#ifndef TESTS_SUPPORT_STAGE_H
#define TESTS_SUPPORT_STAGE_H
#include "fixture.h"
#include "oracle.h"

typedef struct stage {
    const test_case *test;
    const char *name; /* of the scene, for messages */
    cloud points;
    sphg_scheme scheme;
    sphg_context *context;
    sphg_neighbors *neighbors;
    fixture_array volume, density;
    oracle_scene scene;
    oracle *reference;
} stage;

/* Targets are all points; volumes and densities vary by a fifth. Rounds the points as the case
 * stores them. The support radius is rounded to f32. */
stage stage_of(const test_case *test, const char *name, cloud points, double support);
/* The same for radii of their own, a number per point, rounded to f32; mutual: as the geometry has
 * it. */
stage stage_of_radii(const test_case *test, const char *name, cloud points, double *radii,
                     int mutual);
/* The same under another policy and threshold (0: default). */
stage stage_under(const stage *made, sphg_policy policy, double threshold);
/* The same with other volumes. */
stage stage_with_volumes(const stage *made, const double *volume);

/* Volume and density; correction absent. */
sphg_sources stage_sources(const stage *on);
/* C_i of every target; empty for PLAIN. */
fixture_array stage_table(const stage *on);
sphg_view stage_table_view(const stage *on, const fixture_array *table);

typedef struct stage_field {
    sphg_shape shape;
    sphg_form form;
    const double *numbers; /* rounded to the field type by the caller (stage_random_field does) */
} stage_field;

double *stage_random_field(const stage *on, sphg_shape shape, uint64_t seed);

/* Every operator the shape has; arrays without numbers where it has none. */
typedef struct stage_result {
    fixture_array gradient, divergence, curl, value, square;
} stage_result;

/* Outputs of every operator the shape and form have, for so many targets; and their place in a
 * request. */
stage_result stage_outputs(const stage *on, const stage_field *field, int targets);
void stage_ask_for(const stage_result *outputs, sphg_field *asked);

/* table: NULL: corrections are computed in the same sweep. Two-sided forms need it. */
stage_result stage_apply(const stage *on, const stage_field *field, const fixture_array *table);
stage_result stage_apply_to(const stage *on, const stage_field *field, const fixture_array *table,
                            const sphg_subset *subset);
/* Asks for one of the five results, in the order of stage_result, and for nothing else. */
stage_result stage_apply_alone(const stage *on, const stage_field *field,
                               const fixture_array *table, int which);
int stage_results_have_same_bits(const stage_result *a, const stage_result *b);

/* |found - exact| / bound; 0 / 0 is 0. */
double stage_ratio(const fixture_array *found, int item, const quad *exact, quad bound);
/* Compares all operators of target i with the oracle, against the two gates. */
void stage_compare(const stage *on, const stage_field *field, const stage_result *found, int i);

#endif
