/* SPDX-License-Identifier: MIT */
/* The classic methods: an interpolant and its full derivative. Partition of unity everywhere,
 * linear exactness in the directions that are kept, Shepard's average in the others. */
#include "support/comparison.h"

/* ---- Scenes: what full neighbourhoods, sheets, strings and loners look like ------------------ */

typedef struct classic_scene {
    const char *name;
    cloud points;
    double support;
} classic_scene;

enum { classic_scene_count = 9 };

static void make_scenes(int d, classic_scene *scenes)
{
    random_state random = random_seeded(61);
    int wide = d == 2 ? 9 : 4;
    scenes[0] = (classic_scene){"block", cloud_jittered(d, d == 2 ? 6 : 4, .25, .2, &random), .625};
    scenes[1] = (classic_scene){"plane", cloud_plane(d, wide, .25), .5};
    scenes[2] = (classic_scene){"tilted plane", cloud_tilted_plane(d, wide, .25, &random), .5};
    scenes[3] = (classic_scene){"line", cloud_line(d, 9, .25), .5};
    scenes[4] = (classic_scene){"pair", cloud_pair(d, .25), .5};
    scenes[5] = (classic_scene){"single", cloud_single(d), .5};
    scenes[6] = (classic_scene){"coincident", cloud_coincident(d, 4, 0, .25), .5};
    scenes[7] = (classic_scene){"sheets", cloud_sheets(d, wide, .25, .05), .5};
    scenes[8] = (classic_scene){"scattered", cloud_random(d, 40, 1, &random), .25};
}

static comparison stage_at(const test_case *test, int s)
{
    classic_scene scenes[classic_scene_count];
    make_scenes(test->dimension, scenes);
    return comparison_of(test, scenes[s].name, scenes[s].points, scenes[s].support);
}

static comparison_result direct_of(const comparison *on, const double *numbers)
{
    comparison_field field = {SPHG_SCALAR, SPHG_DIRECT, numbers};
    return comparison_apply(on, &field, NULL);
}

static double *ones(const comparison *on)
{
    double *numbers = test_memory((size_t)on->points.count * sizeof *numbers);
    for (int i = 0; i < on->points.count; ++i)
        numbers[i] = 1;
    return numbers;
}

/* ---- Partition of unity ---------------------------------------------------------------------- */

static void shape_functions_sum_to_one_and_their_gradients_to_zero(const test_case *test)
{
    for (int s = 0; s < classic_scene_count; ++s) {
        comparison made = stage_at(test, s);
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            comparison on = comparison_under(&made, (sphg_policy)policy, 0);
            comparison_result found = direct_of(&on, ones(&on));
            for (int i = 0; i < on.points.count; ++i) {
                double error = fabs(setup_get(&found.value, i, 0) - 1) / on.scene.unit;
                TEST_WITHIN(partition_of_unity, error, test_text("sum Phi, %s", on.name));
                for (int k = 0; k < test->dimension; ++k) {
                    error = fabs(setup_get(&found.gradient, i, k)) * on.scheme.support_radius;
                    TEST_WITHIN(gradients_of_unity, error / on.scene.unit,
                                test_text("sum grad Phi, %s", on.name));
                }
            }
        }
    }
}

/* ---- Deficient neighbourhoods
 * ---------------------------------------------------------------------- */

static double kernel_at(const comparison *on, double r)
{
    double w;
    sphg_kernel_value(&on->scheme, r, &w, NULL);
    return w;
}

/* sum w A / sum w over a pair, self first. */
static double shepard_of_pair(const comparison *on, int i, const double *field)
{
    const double *x = on->points.x, *v = on->scene.volume;
    int d = on->points.dimension, j = 1 - i;
    double square = 0;
    for (int k = 0; k < d; ++k)
        square += (x[k] - x[d + k]) * (x[k] - x[d + k]);
    double own = kernel_at(on, 0), other = kernel_at(on, sqrt(square));
    if (on->scheme.method == SPHG_CRKPM)
        own *= v[i], other *= v[j];
    return (own * field[i] + other * field[j]) / (own + other);
}

static void nothing_kept_leaves_the_shepard_average(const test_case *test)
{
    comparison made = stage_at(test, 4);
    comparison on =
        comparison_under(&made, SPHG_IDENTITY, 0); /* a pair has no full rank: all is dropped */
    double field[] = {3, -1};
    comparison_result found = direct_of(&on, field);
    for (int i = 0; i < 2; ++i) {
        double error = fabs(setup_get(&found.value, i, 0) - shepard_of_pair(&on, i, field));
        TEST_WITHIN(shepard_value, error / on.scene.unit / 3, "pair");
    }
}

static void lonely_particles_keep_their_value_and_have_no_gradient(const test_case *test)
{
    comparison on = stage_at(test, 5);
    double field[] = {2.5};
    comparison_result found = direct_of(&on, field);
    double error = fabs(setup_get(&found.value, 0, 0) - 2.5);
    TEST_WITHIN(shepard_value, error / on.scene.unit / 2.5, "single");
    for (int k = 0; k < test->dimension; ++k)
        assert_true(setup_get(&found.gradient, 0, k) == 0);
}

static void coincident_particles_share_their_mean(const test_case *test)
{
    comparison on = stage_at(test, 6);
    double *volume = test_memory((size_t)on.points.count * sizeof *volume);
    for (int i = 0; i < on.points.count; ++i)
        volume[i] = .0625;
    on = comparison_with_volumes(&on, volume);
    double field[] = {1, 2, 3, 6};
    comparison_result found = direct_of(&on, field);
    for (int i = 0; i < on.points.count; ++i)
        TEST_WITHIN(shepard_value, fabs(setup_get(&found.value, i, 0) - 3) / on.scene.unit / 6,
                    "coincident");
}

/* On a plane or a line the value of a linear field is exact, and so is its derivative along it. */
static void kept_directions_stay_exact(const test_case *test)
{
    int d = test->dimension;
    static const int flat[] = {1, 3};
    static const double slope[] = {2, -3, .5};
    for (int s = 0; s < 2; ++s) {
        comparison on = stage_at(test, flat[s]);
        const double *x = on.points.x;
        double *field = test_memory((size_t)on.points.count * sizeof *field);
        for (int i = 0; i < on.points.count; ++i) {
            field[i] = 1;
            for (int k = 0; k < d; ++k)
                field[i] += slope[k] * x[i * d + k];
        }
        comparison_result found = direct_of(&on, field);
        for (int i = 0; i < on.points.count; ++i) {
            double error = fabs(setup_get(&found.value, i, 0) - field[i]);
            TEST_WITHIN(linear_value, error / (8 * on.scene.unit), test_text("on a %s", on.name));
            double along = field[0] - field[1]; /* from the first point to the second */
            for (int k = 0; k < d; ++k)
                along += setup_get(&found.gradient, i, k) * (x[d + k] - x[k]);
            TEST_WITHIN(linear_value, fabs(along) / (8 * on.scene.unit),
                        test_text("along a %s", on.name));
        }
    }
}

static void values_of_linear_fields_are_exact_at_full_rank(const test_case *test)
{
    int d = test->dimension;
    random_state random = random_seeded(62);
    cloud points = cloud_jittered(d, d == 2 ? 8 : 5, .25, .15, &random);
    cloud_snap(&points, 0x1p-10);
    comparison on = comparison_of(test, "block", points, .75);
    double *field = test_memory((size_t)points.count * sizeof *field), largest = 0;
    for (int i = 0; i < points.count; ++i) {
        for (int k = 0; k < d; ++k)
            field[i] += (k + 1) * points.x[i * d + k];
        largest = fmax(largest, fabs(field[i]));
    }
    comparison_result found = direct_of(&on, field);
    for (int i = 0; i < points.count; ++i) {
        double error = fabs(setup_get(&found.value, i, 0) - field[i]);
        TEST_WITHIN(linear_value, error / on.scene.unit / largest, "value in a block");
    }
}

/* ---- Self term ------------------------------------------------------------------------------- */

/* The direct gradient of the field that is 1 at i alone is G_ii at i: it must be there. */
static void own_shape_function_has_a_gradient(const test_case *test)
{
    comparison on = stage_at(test, 0);
    double *field = test_memory((size_t)on.points.count * sizeof *field), visible = 0;
    for (int i = 0; i < on.points.count; i += 7) {
        field[i] = 1;
        comparison_field asked = {SPHG_SCALAR, SPHG_DIRECT, field};
        comparison_result found = comparison_apply(&on, &asked, NULL);
        comparison_compare(&on, &asked, &found, i);
        for (int k = 0; k < test->dimension; ++k)
            visible = fmax(visible, fabs(setup_get(&found.gradient, i, k)));
        field[i] = 0;
    }
    TEST_REQUIRE(visible * on.scheme.support_radius > .05, "G_ii is at most %g", visible);
}

/* ---- Nothing to sum
 * ------------------------------------------------------------------------------- */

/* Targets unlike sources, one of them out of everybody's reach. */
static void without_weights_everything_is_zero_and_reported(const test_case *test)
{
    int d = test->dimension;
    sphg_context *context = setup_context();
    sphg_scheme scheme = setup_scheme(test, .5);
    cloud sources = cloud_lattice(d, 4, .25), targets = cloud_pair(d, .25);
    targets.x[d] = 77;
    setup_array places = setup_positions(test, &sources), at = setup_positions(test, &targets);
    sphg_geometry geometry = setup_geometry(test, &sources, &places);
    geometry.targets = setup_view(&at);
    geometry.target_count = targets.count;
    sphg_neighbors *neighbors = setup_search(context, &scheme, &geometry);
    random_state random = random_seeded(63);
    sphg_type type = test_field_type(test);
    double *numbers = cloud_volumes(&sources, 0, &random);
    setup_array volume = setup_numbers(type, sources.count, 1, numbers);
    setup_array value = setup_output(type, 2, 1), gradient = setup_output(type, 2, d);
    setup_array rank = setup_output(SPHG_U8, 2, 1);
    sphg_view a = setup_view(&volume);
    sphg_sources set = {.neighbors = neighbors, .volume = a};
    sphg_field field = {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &a};
    field.value = setup_view(&value);
    field.gradient = setup_view(&gradient);
    sphg_stats stats = {0};
    sphg_request request = {.sources = &set, .fields = &field, .set_count = 1, .field_count = 1};
    request.rank = setup_view(&rank);
    request.stats = &stats;
    SETUP_OK(context, sphg_evaluate(context, &scheme, &request));
    assert_int_equal(stats.empty, 1);
    assert_int_equal(setup_get(&rank, 1, 0), 0);
    assert_true(setup_get(&value, 0, 0) > 0);
    assert_true(setup_get(&value, 1, 0) == 0);
    for (int k = 0; k < d; ++k)
        assert_true(setup_get(&gradient, 1, k) == 0);
}

static const test_entry entries[] = {
    TEST_ENTRY(shape_functions_sum_to_one_and_their_gradients_to_zero, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(nothing_kept_leaves_the_shepard_average, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(lonely_particles_keep_their_value_and_have_no_gradient, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(coincident_particles_share_their_mean, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(kept_directions_stay_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_CLASSIC,
               TEST_ALL_KERNELS),
    TEST_ENTRY(values_of_linear_fields_are_exact_at_full_rank, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(own_shape_function_has_a_gradient, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CLASSIC, TEST_ALL_KERNELS),
    TEST_ENTRY(without_weights_everything_is_zero_and_reported, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, 0),
};
TEST_MAIN(entries)
