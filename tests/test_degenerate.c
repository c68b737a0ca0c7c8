/* SPDX-License-Identifier: MIT */
/* Planes, lines, pairs, loners, coincident particles and closing sheets are ordinary input: never
 * NaN, ranks as geometry has them, each policy as it is defined, and no jump under blend. */
#include "support/comparison.h"

/* ---- Scenes ---------------------------------------------------------------------------------- */

typedef struct flat_scene {
    const char *name;
    cloud points;
    int extent; /* dimensions the points span */
} flat_scene;

enum { flat_scene_count = 8 };

static void make_scenes(int d, flat_scene *scenes)
{
    random_state random = random_seeded(71);
    int wide = d == 2 ? 12 : 5;
    scenes[0] = (flat_scene){"plane", cloud_plane(d, wide, .25), d - 1};
    scenes[1] = (flat_scene){"tilted plane", cloud_tilted_plane(d, wide, .25, &random), d - 1};
    scenes[2] = (flat_scene){"line", cloud_line(d, 10, .25), 1};
    scenes[3] = (flat_scene){"pair", cloud_pair(d, .25), 1};
    scenes[4] = (flat_scene){"single", cloud_single(d), 0};
    scenes[5] = (flat_scene){"coincident", cloud_coincident(d, 3, 0, .25), 0};
    scenes[6] = (flat_scene){"coincident and one", cloud_coincident(d, 3, 1, .25), 1};
    scenes[7] = (flat_scene){"closed sheets", cloud_sheets(d, wide, .25, .002), d - 1};
}

static comparison stage_at(const test_case *test, const flat_scene *scene)
{
    return comparison_of(test, scene->name, scene->points, .625);
}

static setup_array table_and_ranks(const comparison *on, setup_array *rank)
{
    setup_array table = comparison_table(on);
    sphg_sources sources = comparison_sources(on);
    *rank = setup_output(SPHG_U8, on->points.count, 1);
    SETUP_OK(on->context, sphg_correction(on->context, &on->scheme, &sources, NULL,
                                          setup_view(&table), setup_view(rank)));
    return table;
}

/* ---- Finite and of the right rank
 * ------------------------------------------------------------------ */

static void require_finite(const setup_array *found, const char *what, const char *scene)
{
    for (int k = 0; k < found->count * found->width; ++k)
        TEST_REQUIRE(isfinite(setup_get(found, k / found->width, k % found->width)),
                     "%s of particle %d, %s", what, k / found->width, scene);
}

static void nothing_is_ever_infinite(const test_case *test)
{
    flat_scene scenes[flat_scene_count];
    make_scenes(test->dimension, scenes);
    for (int s = 0; s < flat_scene_count; ++s) {
        comparison made = stage_at(test, &scenes[s]);
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            comparison on = comparison_under(&made, (sphg_policy)policy, 0);
            setup_array table = comparison_table(&on);
            require_finite(&table, "C", on.name);
            for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form) {
                comparison_field field = {SPHG_VECTOR, (sphg_form)form,
                                          comparison_random_field(&on, SPHG_VECTOR, 11)};
                comparison_result found = comparison_apply(&on, &field, &table);
                require_finite(&found.gradient, "gradient", on.name);
                require_finite(&found.curl, "curl", on.name);
                if (form == SPHG_DIRECT)
                    require_finite(&found.value, "value", on.name);
                comparison_field scalar = {SPHG_SCALAR, (sphg_form)form,
                                           comparison_random_field(&on, SPHG_SCALAR, 12)};
                found = comparison_apply(&on, &scalar, &table);
                require_finite(&found.square, "square", on.name);
            }
        }
    }
}

static void rank_is_the_dimension_spanned(const test_case *test)
{
    flat_scene scenes[flat_scene_count];
    make_scenes(test->dimension, scenes);
    for (int s = 0; s < flat_scene_count; ++s)
        for (int policy = SPHG_BLEND; policy <= SPHG_TRUNCATE; ++policy) {
            comparison made = stage_at(test, &scenes[s]);
            comparison on = comparison_under(&made, (sphg_policy)policy, 0);
            setup_array rank;
            table_and_ranks(&on, &rank);
            for (int i = 0; i < on.points.count; ++i)
                TEST_REQUIRE((int)setup_get(&rank, i, 0) == scenes[s].extent,
                             "rank %g of particle %d, %s, policy %d", setup_get(&rank, i, 0), i,
                             on.name, policy);
        }
}

/* Under identity rank is all or nothing. */
static void identity_leaves_flat_particles_alone(const test_case *test)
{
    flat_scene scenes[flat_scene_count];
    make_scenes(test->dimension, scenes);
    for (int s = 0; s < flat_scene_count; ++s) {
        comparison made = stage_at(test, &scenes[s]);
        comparison on = comparison_under(&made, SPHG_IDENTITY, 0);
        setup_array rank;
        table_and_ranks(&on, &rank);
        for (int i = 0; i < on.points.count; ++i)
            assert_int_equal(setup_get(&rank, i, 0), 0);
    }
}

/* Volumes that do not tile must not turn the rounding of a tilted plane into a direction. */
static void noise_is_never_inverted(const test_case *test)
{
    random_state random = random_seeded(72);
    int d = test->dimension;
    cloud points = cloud_tilted_plane(d, d == 2 ? 24 : 6, .01, &random);
    comparison made = comparison_of(test, "plane of large volumes", points, .03);
    double *volume = test_memory((size_t)points.count * sizeof *volume);
    for (int i = 0; i < points.count; ++i) /* so that u tr Mhat is far above the threshold */
        volume[i] = cloud_rounded(64 * pow(points.spacing, d) / test_unit_roundoff(test));
    comparison on = comparison_with_volumes(&made, volume);
    setup_array rank;
    table_and_ranks(&on, &rank);
    for (int i = 0; i < points.count; ++i)
        TEST_REQUIRE(setup_get(&rank, i, 0) < d, "particle %d has full rank", i);
}

/* ---- Policies on an exact plane
 * ---------------------------------------------------------------------- */

/* C along the normal of a plane, in units of 1 / m_ref. */
static double normal_correction(const comparison *on, const setup_array *table, int i)
{
    double scale = (double)oracle_at(on->reference, i)->scale;
    return setup_get(table, i, table->width - 1) * scale;
}

static void policies_are_what_they_say_on_a_plane(const test_case *test)
{
    static const double normal[] = {1, 1, 0, 1}; /* blend, replace, truncate, identity */
    flat_scene scenes[flat_scene_count];
    make_scenes(test->dimension, scenes);
    comparison made = stage_at(test, &scenes[0]);
    for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
        comparison on = comparison_under(&made, (sphg_policy)policy, 0);
        setup_array table = comparison_table(&on);
        for (int i = 0; i < on.points.count; ++i) {
            double c = normal_correction(&on, &table, i);
            double error = fabs(c - normal[policy]) / on.scene.unit;
            TEST_WITHIN(policy_value, error, test_text("policy %d, particle %d", policy, i));
        }
    }
}

static void gradients_within_a_plane_are_exact(const test_case *test)
{
    int d = test->dimension;
    flat_scene scenes[flat_scene_count];
    make_scenes(d, scenes);
    comparison made = stage_at(test, &scenes[0]);
    double *numbers = test_memory((size_t)made.points.count * sizeof *numbers);
    for (int i = 0; i < made.points.count; ++i)
        numbers[i] = 3 * made.points.x[i * d] - (d == 3 ? made.points.x[i * d + 1] : 0);
    double slope[3] = {3, d == 3 ? -1 : 0, 0};
    for (int policy = SPHG_BLEND; policy <= SPHG_TRUNCATE; ++policy) {
        comparison on = comparison_under(&made, (sphg_policy)policy, 0);
        comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers};
        comparison_result found = comparison_apply(&on, &field, NULL);
        for (int i = 0; i < on.points.count; ++i)
            for (int k = 0; k < d; ++k) {
                double error = fabs(setup_get(&found.gradient, i, k) - slope[k]);
                TEST_WITHIN(flat_exactness, error / (3 * on.scene.unit), on.name);
            }
    }
}

/* ---- Closing sheets
 * --------------------------------------------------------------------------------- */

typedef struct closing_step {
    double c[9], m[9]; /* C m_ref and Mhat of one particle */
} closing_step;

static closing_step step_at(const test_case *test, sphg_policy policy, double gap)
{
    int d = test->dimension, k = 0;
    cloud points = cloud_sheets(d, 7, .25, gap);
    comparison made = comparison_of(test, "closing sheets", points, .5);
    comparison on = comparison_under(&made, policy, 0);
    int i = points.count / 4; /* within the lower sheet */
    setup_array table = comparison_table(&on);
    const oracle_point *point = oracle_at(on.reference, i);
    closing_step step = {{0}, {0}};
    for (int a = 0; a < d; ++a)
        for (int b = a; b < d; ++b, ++k) {
            double scale = (double)point->scale;
            step.c[a * 3 + b] = step.c[b * 3 + a] = setup_get(&table, i, k) * scale;
            step.m[a * 3 + b] = step.m[b * 3 + a] = (double)(point->moment[a][b] / point->scale);
        }
    return step;
}

static double distance(const double *a, const double *b)
{
    double square = 0;
    for (int k = 0; k < 9; ++k)
        square += pow(a[k] - b[k], 2);
    return sqrt(square);
}

/* The steepest |change of C| per change of Mhat on the way. A function of eigenvalues has, as a
 * function of matrices, the same Lipschitz constant in the Frobenius norm. */
static double steepest(const test_case *test, sphg_policy policy)
{
    enum { steps = 60 };
    double worst = 0, blur = 64 * test_unit_roundoff(test) / .01;
    closing_step last = step_at(test, policy, .25);
    for (int n = 1; n <= steps; ++n) {
        closing_step now = step_at(test, policy, .25 * (1 - (double)n / (steps + 1)));
        double moved = distance(now.m, last.m), changed = distance(now.c, last.c);
        worst = test_larger(worst, fmax(changed - blur, 0) / moved);
        last = now;
    }
    return worst;
}

static const double eps = 1e-2; /* the default threshold */

static void closing_sheets_do_not_jump_under_blend(const test_case *test)
{
    double slope = steepest(test, SPHG_BLEND) * eps * eps;
    TEST_REQUIRE(slope <= .1605, "changes by %g / eps^2", slope);
    TEST_REQUIRE(slope > .01, "the sheets never met the threshold");
}

static void closing_sheets_jump_under_replace(const test_case *test)
{
    double slope = steepest(test, SPHG_REPLACE) * eps * eps;
    TEST_REQUIRE(slope > .2, "changes by %g / eps^2 only", slope);
}

/* ---- What must not leak
 * -------------------------------------------------------------------------------- */

/* A host list holds a pair beyond H whose field is NaN: by selection, not by a weight of 0. */
static void fields_beyond_the_support_do_not_leak(const test_case *test)
{
    int d = test->dimension, n = 4;
    cloud points = cloud_line(d, n, .25);
    for (int k = 0; k < d; ++k)
        points.x[3 * d + k] = 50;
    comparison on = comparison_of(test, "line and a far one", points, .625);
    static const int64_t offsets[] = {0, 3, 6, 9, 12};
    static const int32_t indices[] = {1, 2, 3, 0, 2, 3, 0, 1, 3, 0, 1, 2};
    sphg_lists lists = {.offsets = offsets, .indices = indices};
    setup_array positions = setup_positions(test, &on.points);
    sphg_geometry geometry = setup_geometry(test, &on.points, &positions);
    on.neighbors = setup_lists(on.context, &on.scheme, &geometry, &lists);
    double numbers[] = {1, 2, 3, NAN};
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers};
    comparison_result found = comparison_apply(&on, &field, NULL);
    for (int k = 0; k < 3 * d; ++k)
        assert_true(isfinite(setup_get(&found.gradient, k / d, k % d)));
}

static void sources_without_volume_add_nothing(const test_case *test)
{
    random_state random = random_seeded(73);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 6 : 4, .25, .2, &random);
    comparison made = comparison_of(test, "block with holes", points, .625);
    double *volume = cloud_volumes(&points, .2, &random);
    for (int i = 0; i < points.count; i += 4)
        volume[i] = 0;
    comparison on = comparison_with_volumes(&made, volume);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_SCALAR, 12)};
    comparison_result found = comparison_apply(&on, &field, NULL);
    for (int i = 0; i < points.count; i += 5)
        comparison_compare(&on, &field, &found, i);
}

/* KGC, RKPM, plain and CRKPM weigh by V_j; in MLS and CMLS volume does not matter. */
#define WEIGHED_BY_VOLUME                                                                          \
    (TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM) | TEST_BIT(SPHG_PLAIN) | TEST_BIT(SPHG_CRKPM))

static const test_entry entries[] = {
    TEST_ENTRY(nothing_is_ever_infinite, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(rank_is_the_dimension_spanned, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(identity_leaves_flat_particles_alone, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(noise_is_never_inverted, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED,
               TEST_ALL_KERNELS),
    TEST_ENTRY(policies_are_what_they_say_on_a_plane, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(gradients_within_a_plane_are_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(closing_sheets_do_not_jump_under_blend, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(closing_sheets_jump_under_replace, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(fields_beyond_the_support_do_not_leak, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(sources_without_volume_add_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               WEIGHED_BY_VOLUME, 0),
};
TEST_MAIN(entries)
