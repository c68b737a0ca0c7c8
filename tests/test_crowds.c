/* SPDX-License-Identifier: MIT */
/* More sources around a target than are searched at once, and many times the pairs that are summed
 * at once: kept or found on the way, with corrections of the same sweep or of a table. And lists of
 * every length up to that, of which pairs are read from memory once or in several rounds. */
#include "support/setup.h"
#include <math.h>

enum { SOURCES = 33000, TARGETS = 6, STEPS = 256 };

typedef struct crowd {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    setup_array sources, targets, volume, linear, at_targets;
    setup_array radii, target_radii;
    int graded; /* neighbours are searched with these, not with the scheme's */
    double slope[3];
} crowd;

/* On a lattice of so few digits that the linear field has no rounding. */
static setup_array places(const test_case *test, int count, random_state *random)
{
    const int d = test->dimension;
    double *x = test_memory((size_t)(count * d) * sizeof *x);
    for (int k = 0; k < count * d; ++k)
        x[k] = random_index(random, STEPS) / (4. * STEPS);
    return setup_numbers(test_position_type(test), count, d, x);
}

static setup_array linear_field(const crowd *on, const setup_array *at)
{
    double *values = test_memory((size_t)at->count * sizeof *values);
    for (int i = 0; i < at->count; ++i)
        for (int c = 0; c < at->width; ++c)
            values[i] += on->slope[c] * setup_get(at, i, c);
    return setup_numbers(test_field_type(on->test), at->count, 1, values);
}

/* All of them reach across the crowd, and none of them the target beside it. */
static setup_array radii_of(const test_case *test, int count, random_state *random)
{
    double *radii = test_memory((size_t)count * sizeof *radii);
    for (int k = 0; k < count; ++k)
        radii[k] = random_between(random, .5, 1);
    return setup_numbers(test_position_type(test), count, 1, radii);
}

static crowd crowd_of(const test_case *test, int graded)
{
    crowd made = {
        .test = test, .context = setup_context(), .graded = graded, .slope = {.5, -1.25, 2}};
    random_state random = random_seeded(977);
    double *volume = test_memory(SOURCES * sizeof *volume);
    for (int k = 0; k < SOURCES; ++k)
        volume[k] = random_between(&random, .5, 1.5) / SOURCES;
    made.scheme = setup_scheme(test, 1);
    made.sources = places(test, SOURCES, &random);
    made.targets = places(test, TARGETS, &random);
    setup_put(&made.targets, (TARGETS - 1) * test->dimension,
              1.5); /* near the crowd, and sees nobody */
    made.volume = setup_numbers(test_field_type(test), SOURCES, 1, volume);
    made.linear = linear_field(&made, &made.sources);
    made.at_targets = linear_field(&made, &made.targets);
    made.radii = radii_of(test, SOURCES, &random);
    made.target_radii = radii_of(test, TARGETS, &random);
    return made;
}

static const sphg_neighbors *neighbors_of(const crowd *on, int own_targets, int list_free)
{
    sphg_geometry geometry = {.sources = setup_view(&on->sources),
                              .source_count = SOURCES,
                              .target_count = own_targets ? TARGETS : SOURCES,
                              .precision = test_field_type(on->test),
                              .list_free = list_free};
    if (own_targets)
        geometry.targets = setup_view(&on->targets);
    if (on->graded)
        geometry.source_support = setup_view(&on->radii);
    if (on->graded && own_targets)
        geometry.target_support = setup_view(&on->target_radii);
    return setup_search(on->context, &on->scheme, &geometry);
}

typedef struct sums {
    setup_array gradient, correction, lambda, rank;
} sums;

/* Of the first TARGETS targets. table: NULL: corrections are computed on the way. */
static sums sum_up(const crowd *on, const sphg_neighbors *neighbors, int own_targets,
                   const setup_array *table)
{
    const sphg_type type = test_field_type(on->test);
    const int width = sphg_correction_width(&on->scheme);
    const int count = own_targets ? TARGETS : SOURCES;
    sums found = {setup_output(type, count, on->test->dimension), setup_output(type, count, width),
                  setup_output(type, count, 1), setup_output(SPHG_U8, count, 1)};
    const sphg_view field = setup_view(&on->linear);
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&on->volume)};
    const sphg_subset first = {0, TARGETS, NULL, NULL};
    sphg_field asked = {
        .shape = SPHG_SCALAR, .at_sources = &field, .gradient = setup_view(&found.gradient)};
    sphg_request request = {
        .sources = &sources, .fields = &asked, .set_count = 1, .field_count = 1, .subset = &first};
    if (own_targets) {
        asked.at_targets = setup_view(&on->at_targets);
        request.target_volume = setup_view(&on->volume);
    }
    if (table) {
        request.target_correction = setup_view(table);
    } else {
        request.correction = setup_view(&found.correction);
        request.lambda_min = setup_view(&found.lambda);
        request.rank = setup_view(&found.rank);
    }
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

/* The first `count` targets. */
static void require_linear(const crowd *on, const sums *found, int count, const char *where)
{
    const double *slope = on->slope;
    const int d = on->test->dimension;
    for (int i = 0; i < count; ++i) {
        double error = 0, scale = 0;
        assert_int_equal((int)setup_get(&found->rank, i, 0), d);
        for (int c = 0; c < d; ++c) {
            error += pow(setup_get(&found->gradient, i, c) - slope[c], 2);
            scale += slope[c] * slope[c];
        }
        TEST_WITHIN(linear_exactness,
                    sqrt(error / scale) * setup_get(&found->lambda, i, 0) /
                        test_unit_roundoff(on->test),
                    where);
    }
}

/* The sweep that computes corrections, and one that is given them. */
static sums require_exact(const crowd *on, const sphg_neighbors *neighbors, int own_targets,
                          const char *where)
{
    const sums fused = sum_up(on, neighbors, own_targets, NULL);
    const sums given = sum_up(on, neighbors, own_targets, &fused.correction);
    TEST_REQUIRE(setup_same_bits(&fused.gradient, &given.gradient), "%s: table", where);
    require_linear(on, &fused, TARGETS - own_targets, where);
    for (int c = 0; c < on->test->dimension && own_targets; ++c)
        assert_true(setup_get(&fused.gradient, TARGETS - 1, c) == 0);
    return fused;
}

static void require_exact_at_targets(const test_case *test, int graded)
{
    const crowd on = crowd_of(test, graded);
    const sums kept = require_exact(&on, neighbors_of(&on, 1, 0), 1, "targets, kept lists");
    const sums found = require_exact(&on, neighbors_of(&on, 1, 1), 1, "targets, list-free");
    assert_true(setup_same_bits(&kept.gradient, &found.gradient));
    assert_true(setup_same_bits(&kept.correction, &found.correction));
}

static void gradient_at_targets_in_a_crowd_is_exact(const test_case *test)
{
    require_exact_at_targets(test, 0);
}

static void gradient_at_targets_in_a_crowd_of_many_radii_is_exact(const test_case *test)
{
    require_exact_at_targets(test, 1);
}

/* Lists of all would not fit. */
static void gradient_at_members_of_a_crowd_is_exact(const test_case *test)
{
    for (int graded = 0; graded < 2; ++graded) {
        const crowd on = crowd_of(test, graded);
        require_exact(&on, neighbors_of(&on, 0, 1), 0, graded ? "members, radii" : "members");
    }
}

/* ---- The same term again and again ----------------------------------------------------------- */

enum { ALIKE = 20000 };

/* One target, and all sources at one place: each pair adds the same number, so that whatever
 * rounding does, it does again and again. */
static setup_array slope_of_alike(const test_case *test, sphg_isa isa, int list_free)
{
    sphg_context *context = setup_watched_context_on(isa);
    if (!context)
        return (setup_array){.count = 0};
    const int d = test->dimension;
    const sphg_type type = test_field_type(test);
    double x[3 * ALIKE], volume[ALIKE], value[ALIKE];
    for (int k = 0; k < ALIKE; ++k) {
        for (int a = 0; a < d; ++a)
            x[k * d + a] = .125 * (a + 1);
        volume[k] = 1. / ALIKE;
        value[k] = 1.7;
    }
    const double none[3] = {0};
    const setup_array sources = setup_numbers(test_position_type(test), ALIKE, d, x);
    const setup_array target = setup_numbers(test_position_type(test), 1, d, none);
    const setup_array volumes = setup_numbers(type, ALIKE, 1, volume);
    const setup_array values = setup_numbers(type, ALIKE, 1, value);
    const setup_array zero = setup_numbers(type, 1, 1, none),
                      one = setup_numbers(type, 1, 1, volume);
    const setup_array gradient = setup_output(type, 1, d);
    const sphg_scheme scheme = setup_scheme(test, 1);
    const sphg_geometry geometry = {.sources = setup_view(&sources),
                                    .targets = setup_view(&target),
                                    .source_count = ALIKE,
                                    .target_count = 1,
                                    .precision = type,
                                    .list_free = list_free};
    const sphg_sources all = {.neighbors = setup_search(context, &scheme, &geometry),
                              .volume = setup_view(&volumes)};
    const sphg_view at_sources = setup_view(&values);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .at_sources = &at_sources,
                              .at_targets = setup_view(&zero),
                              .gradient = setup_view(&gradient)};
    const sphg_request request = {.sources = &all,
                                  .fields = &field,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .target_volume = setup_view(&one)};
    SETUP_OK(context, sphg_evaluate(context, &scheme, &request));
    return gradient;
}

/* Of plain SPH that of one pair so many times; corrected the slope along the only direction there
 * is: 1.7 over the distance. */
static void exact_slope(const test_case *test, double *slope)
{
    const int d = test->dimension;
    const sphg_scheme scheme = setup_scheme(test, 1);
    double x[3], square = 0;
    for (int a = 0; a < d; ++a) {
        x[a] = -.125 * (a + 1);
        square += x[a] * x[a];
    }
    const double value =
        test_field_type(test) == SPHG_F32 ? (double)(float)1.7 : 1.7; /* as it is handed over */
    const double volume =
        test_field_type(test) == SPHG_F32 ? (double)(float)(1. / ALIKE) : 1. / ALIKE;
    sphg_pair_gradient(&scheme, x, volume, NULL, slope);
    for (int a = 0; a < d; ++a)
        slope[a] = test->method == SPHG_PLAIN ? ALIKE * value * slope[a] : -value * x[a] / square;
}

static void equal_terms_are_rounded_as_few(const test_case *test)
{
    static const sphg_isa sets[] = {SPHG_ISA_BASE, SPHG_ISA_X86_V3, SPHG_ISA_X86_V4, SPHG_ISA_NEON};
    double exact[3];
    exact_slope(test, exact);
    for (int k = 0; k < 8; ++k) {
        const setup_array found = slope_of_alike(test, sets[k / 2], k % 2);
        double error = 0, size = 0;
        for (int a = 0; a < test->dimension && found.count; ++a) {
            error += pow(setup_get(&found, 0, a) - exact[a], 2);
            size += exact[a] * exact[a];
        }
        const double ratio = sqrt(error / size) / test_unit_roundoff(test);
        if (found.count && test->method == SPHG_PLAIN)
            TEST_WITHIN(equal_terms, ratio, k % 2 ? "list-free" : "kept");
        else if (found.count)
            TEST_WITHIN(equal_terms_corrected, ratio, k % 2 ? "list-free" : "kept");
    }
}

/* ---- From a few pairs to some dozen times those that are summed at once ---------------------- */

enum { MEMBERS = 641 }; /* the last of them has the lanes to itself */

typedef struct bunch {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    sphg_sources sources;
    setup_array volume, numbers;
} bunch;

/* Found on the way, they all have the first one's volume. */
static bunch bunch_of(const test_case *test, double reach, int list_free)
{
    bunch made = {.test = test, .context = setup_context()};
    random_state random = random_seeded(983);
    cloud points = cloud_random(test->dimension, MEMBERS, 1, &random);
    const setup_array positions = setup_positions(test, &points);
    const sphg_type type = test_field_type(test);
    sphg_geometry geometry = setup_geometry(test, &points, &positions);
    geometry.list_free = list_free;
    made.scheme = setup_scheme(test, reach);
    made.volume = setup_numbers(type, MEMBERS, 1, cloud_volumes(&points, 0.2, &random));
    made.numbers = setup_numbers(type, MEMBERS, 1, cloud_numbers(&points, -1, 1, &random));
    made.sources = (sphg_sources){.neighbors = setup_search(made.context, &made.scheme, &geometry),
                                  .volume = setup_view(&made.volume)};
    if (list_free)
        made.sources.volume.stride = 0;
    return made;
}

/* Gradients of some targets; a table comes into the sources, or goes where `correction` stands. */
static setup_array gradients_of(const bunch *on, const sphg_subset *subset, sphg_view correction)
{
    const setup_array found = setup_output(test_field_type(on->test), MEMBERS, on->test->dimension);
    const sphg_view numbers = setup_view(&on->numbers);
    const sphg_field field = {
        .shape = SPHG_SCALAR, .at_sources = &numbers, .gradient = setup_view(&found)};
    const sphg_request request = {.sources = &on->sources,
                                  .fields = &field,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .subset = subset,
                                  .correction = correction};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

static setup_array pairs_of(const bunch *on)
{
    const int d = on->test->dimension;
    sphg_pairs found = {.offsets = test_memory((MEMBERS + 1) * sizeof(int64_t)), .any_order = 1};
    SETUP_OK(on->context, sphg_pair_gradients(on->context, &on->scheme, &on->sources, NULL,
                                              sphg_absent(), &found));
    const setup_array gradients = setup_output(test_field_type(on->test), (int)found.count, d);
    found.indices = test_memory((size_t)found.count * sizeof(int32_t));
    found.gradient = setup_view(&gradients);
    found.capacity = found.count;
    SETUP_OK(on->context, sphg_pair_gradients(on->context, &on->scheme, &on->sources, NULL,
                                              sphg_absent(), &found));
    return gradients;
}

/* Each target alone, whose list is then spread over a vector. */
static void require_same_alone(const bunch *on, const setup_array *all)
{
    for (int i = 0; i < MEMBERS; i += 197) {
        const sphg_subset one = {i, i + 1, NULL, NULL};
        const setup_array alone = gradients_of(on, &one, sphg_absent());
        for (int c = 0; c < on->test->dimension; ++c)
            assert_true(setup_get(&alone, i, c) == setup_get(all, i, c));
    }
}

static void lists_of_any_length_give_the_bits_of_a_table(const test_case *test)
{
    static const double reach[] = {.4, .7, 2};
    for (size_t k = 0; k < sizeof reach / sizeof reach[0]; ++k) {
        bunch on = bunch_of(test, reach[k], k % 2);
        const setup_array table =
            setup_output(test_field_type(test), MEMBERS, sphg_correction_width(&on.scheme));
        const setup_array fused = gradients_of(&on, NULL, setup_view(&table));
        const setup_array pairs = pairs_of(&on);
        require_same_alone(&on, &fused);
        on.sources.correction = setup_view(&table);
        const setup_array given = gradients_of(&on, NULL, sphg_absent());
        const setup_array given_pairs = pairs_of(&on);
        TEST_REQUIRE(setup_same_bits(&fused, &given), "H = %g", reach[k]);
        TEST_REQUIRE(setup_same_bits(&pairs, &given_pairs), "pairs, H = %g", reach[k]);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(gradient_at_targets_in_a_crowd_is_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(gradient_at_targets_in_a_crowd_of_many_radii_is_exact, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(gradient_at_members_of_a_crowd_is_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(equal_terms_are_rounded_as_few, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(lists_of_any_length_give_the_bits_of_a_table, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
};
TEST_MAIN(entries)
