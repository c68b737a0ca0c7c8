/* SPDX-License-Identifier: MIT */
/* Everything the library computes, against the quadruple precision oracle: the error over its
 * bound D stays below one gate for all scenes, precisions, methods and kernels. */
#include "support/scenes.h"
#include <string.h>

/* Some of the targets, spread evenly: the oracle is slow. */
static int sampled(const comparison *on, int k, int samples)
{
    int n = on->points.count;
    return samples >= n ? k : (int)((long)k * n / samples);
}

static int sample_count(const comparison *on, int samples)
{
    return samples < on->points.count ? samples : on->points.count;
}

static void compare_field(const comparison *on, sphg_shape shape, sphg_form form,
                          const setup_array *table, int samples)
{
    comparison_field field = {shape, form, comparison_random_field(on, shape, 3)};
    comparison_result found = comparison_apply(on, &field, table);
    for (int k = 0; k < sample_count(on, samples); k += test_reference_stride())
        comparison_compare(on, &field, &found, sampled(on, k, samples));
}

/* ---- Operators ------------------------------------------------------------------------------- */

static void operators_match_the_oracle(const test_case *test)
{
    comparison on = comparison_of_scene(test, &scenes_hard[0]);
    setup_array table = comparison_table(&on);
    compare_field(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table, 5);
    compare_field(&on, SPHG_SCALAR, SPHG_DIRECT, &table, 5);
    compare_field(&on, SPHG_SCALAR, SPHG_ADJOINT, &table, 1);
}

static void every_shape_in_every_form_matches_the_oracle(const test_case *test)
{
    random_state random = random_seeded(8);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 6 : 3, .125, .3, &random);
    comparison on = comparison_of(test, "small block", points, 2.25 * points.spacing);
    setup_array table = comparison_table(&on);
    for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape)
        for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
            compare_field(&on, (sphg_shape)shape, (sphg_form)form, &table, 4);
}

static void hard_scenes_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        comparison on = comparison_of_scene(test, &scenes_hard[s]);
        setup_array table = comparison_table(&on);
        compare_field(&on, SPHG_VECTOR, SPHG_DIFFERENCE, NULL, 4);
        compare_field(&on, SPHG_VECTOR, SPHG_DIRECT, &table, 4);
        if (scenes_hard[s].support < 3) /* or it would ask for too many of the oracle's points */
            compare_field(&on, SPHG_SCALAR, SPHG_ADJOINT, &table, 1);
    }
}

static void every_instruction_set_matches_the_oracle(const test_case *test)
{
    static const int chosen[] = {0, 7, 12};
    int used = 0;
    for (int s = 0; s < 3; ++s) {
        const comparison made = comparison_of_scene(test, &scenes_hard[chosen[s]]);
        for (int isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
            comparison on = made; /* and its reference */
            on.context = setup_watched_context_on((sphg_isa)isa);
            if (!on.context)
                continue;
            ++used;
            on.neighbors = setup_neighbors(on.context, test, &on.scheme, &on.points);
            setup_array table = comparison_table(&on);
            compare_field(&on, SPHG_VECTOR, SPHG_DIFFERENCE, NULL, 3);
            compare_field(&on, SPHG_VECTOR, SPHG_DIRECT, &table, 3);
            compare_field(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT, &table, 1);
        }
    }
    TEST_REQUIRE(used >= 3, "not even the base set ran");
}

static void every_policy_matches_the_oracle(const test_case *test)
{
    for (int s = 5; s < scenes_hard_count; ++s) {
        comparison made = comparison_of_scene(test, &scenes_hard[s]);
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            comparison on = comparison_under(&made, (sphg_policy)policy, .0625);
            compare_field(&on, SPHG_VECTOR, SPHG_DIFFERENCE, NULL, 3);
        }
    }
}

/* A jittered lattice that repeats with period 1 in all axes but the last; some particles stand a
 * period or two outside. Multiples of 2^-12, so that shifted differences are exact. */
static comparison periodic_stage(const test_case *test)
{
    random_state random = random_seeded(9);
    int d = test->dimension;
    cloud points = cloud_jittered(d, 8, .125, .2, &random);
    cloud_snap(&points, 0x1p-12);
    for (int i = 0; i < points.count; i += 3)
        points.x[i * d] += random_index(&random, 5) - 2;
    comparison on = comparison_of(test, "periodic block", points, .3125);
    setup_array positions = setup_positions(test, &on.points);
    sphg_geometry geometry = setup_geometry(test, &on.points, &positions);
    for (int k = 0; k < d - 1; ++k)
        geometry.period[k] = on.scene.period[k] = 1;
    on.neighbors = setup_search(on.context, &on.scheme, &geometry);
    on.reference = oracle_of(&on.scene);
    return on;
}

static void periodic_neighbours_match_the_oracle(const test_case *test)
{
    comparison on = periodic_stage(test);
    setup_array table = comparison_table(&on);
    compare_field(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table, 7);
    compare_field(&on, SPHG_VECTOR, SPHG_DIRECT, &table, 7);
}

/* ---- Corrections ----------------------------------------------------------------------------- */

static void compare_correction(const comparison *on, const setup_array *table, int i)
{
    const oracle_point *point = oracle_at(on->reference, i);
    int d = on->points.dimension, k = 0;
    quad square = 0;
    if (point->undecided)
        return;
    for (int a = 0; a < d; ++a)
        for (int b = a; b < d; ++b, ++k) {
            quad error = (quad)setup_get(table, i, k) - point->correction[a][b];
            square += error * error * (a == b ? 1 : 2);
        }
    double ratio = (double)(quad_sqrt(square) / point->correction_bound);
    ratio = square != square ? NAN : ratio;
    const char *where =
        test_text("C of particle %d, %s, %s", i, on->name, test_method_name(on->test->method));
    if (point->rank < d)
        TEST_WITHIN(oracle_ratio_touched, ratio, where);
    else
        TEST_WITHIN(oracle_ratio_full, ratio, where);
}

static void corrections_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        comparison on = comparison_of_scene(test, &scenes_hard[s]);
        setup_array table = comparison_table(&on);
        for (int k = 0; k < sample_count(&on, 6); k += test_reference_stride())
            compare_correction(&on, &table, sampled(&on, k, 6));
    }
}

static void require_rank_and_moment(const comparison *on, int i, double rank, double lambda)
{
    const oracle_point *point = oracle_at(on->reference, i);
    double exact = (double)point->filter.lambda_min, u = on->scene.unit;
    double blur = point->scale > 0 ? 16 * u * (double)(point->spread / point->scale) : 0;
    TEST_REQUIRE(oracle_rank_is_open(&on->scene, point) || (int)rank == point->rank,
                 "rank %g, not %d, lambda %g: particle %d, %s", rank, point->rank, exact, i,
                 on->name);
    double lowest = exact / sqrt(on->points.dimension);
    TEST_REQUIRE(lambda >= lowest - blur && lambda <= exact + blur,
                 "lambda_min %g outside [%g, %g]: particle %d, %s", lambda, lowest, exact, i,
                 on->name);
}

static void ranks_and_smallest_moments_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        comparison on = comparison_of_scene(test, &scenes_hard[s]);
        setup_array rank = setup_output(SPHG_U8, on.points.count, 1);
        setup_array lambda = setup_output(test_field_type(test), on.points.count, 1);
        sphg_sources sources = comparison_sources(&on);
        sphg_request request = {.sources = &sources, .set_count = 1};
        sphg_stats stats = {0};
        request.rank = setup_view(&rank);
        request.lambda_min = setup_view(&lambda);
        request.stats = &stats;
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
        double smallest = INFINITY;
        int64_t ranks[4] = {0};
        for (int i = 0; i < on.points.count; ++i) {
            ranks[(int)setup_get(&rank, i, 0) & 3]++;
            smallest = fmin(smallest, setup_get(&lambda, i, 0));
        }
        for (int k = 0; k < sample_count(&on, 8); k += test_reference_stride()) {
            int i = sampled(&on, k, 8);
            require_rank_and_moment(&on, i, setup_get(&rank, i, 0), setup_get(&lambda, i, 0));
        }
        assert_memory_equal(ranks, stats.rank, sizeof ranks);
        assert_int_equal(stats.certified + stats.decomposed, on.points.count);
        TEST_REQUIRE((float)stats.lambda_min == (float)smallest, "stats say %g, items %g",
                     stats.lambda_min, smallest);
    }
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

typedef struct pair_list {
    int64_t *offsets;
    int32_t *indices;
    setup_array gradient;
} pair_list;

static pair_list list_pairs(const comparison *on)
{
    pair_list list = {test_memory(((size_t)on->points.count + 1) * sizeof(int64_t)), NULL, {0}};
    sphg_sources sources = comparison_sources(on);
    sphg_pairs pairs = {.offsets = list.offsets};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, sphg_absent(), &pairs));
    list.indices = test_memory((size_t)pairs.count * sizeof *list.indices);
    list.gradient = setup_output(test_field_type(on->test), (int)pairs.count, on->points.dimension);
    pairs.indices = list.indices;
    pairs.gradient = setup_view(&list.gradient);
    pairs.capacity = pairs.count;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, sphg_absent(), &pairs));
    return list;
}

/* The oracle's pair for one row entry; the target itself stands for its own shape function. */
static oracle_pair expected_pair(const oracle_point *point, int i, int j)
{
    if (i == j) {
        oracle_pair self = {.j = i, .bound = point->self_bound};
        memcpy(self.gradient, point->self_gradient, sizeof self.gradient);
        return self;
    }
    for (int k = 0; k < point->pair_count; ++k)
        if (point->pairs[k].j == j)
            return point->pairs[k];
    fail_msg("%d is no neighbour of %d", j, i);
    return (oracle_pair){0};
}

static void compare_row(const comparison *on, const pair_list *list, int i)
{
    const oracle_point *point = oracle_at(on->reference, i);
    int64_t length = list->offsets[i + 1] - list->offsets[i];
    assert_int_equal(length, point->pair_count + (test_is_classic(on->test) ? 1 : 0));
    for (int64_t p = list->offsets[i]; p < list->offsets[i + 1]; ++p) {
        int j = list->indices[p];
        TEST_REQUIRE(p == list->offsets[i] || list->indices[p - 1] < j, "row %d not ascending", i);
        oracle_pair exact = expected_pair(point, i, j);
        double ratio = comparison_ratio(&list->gradient, (int)p, exact.gradient, exact.bound);
        const char *where = test_text("G of pair %d, %d, %s", i, j, on->name);
        if (point->rank < on->points.dimension)
            TEST_WITHIN(oracle_ratio_touched, ratio, where);
        else
            TEST_WITHIN(oracle_ratio_full, ratio, where);
    }
}

static void pair_gradients_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; s += 3) {
        comparison on = comparison_of_scene(test, &scenes_hard[s]);
        pair_list list = list_pairs(&on);
        for (int k = 0; k < sample_count(&on, 4); k += test_reference_stride())
            compare_row(&on, &list, sampled(&on, k, 4));
    }
}

/* Rows so long that they are sorted in another way. */
static void pair_gradients_of_a_crowd_match_the_oracle(const test_case *test)
{
    random_state random = random_seeded(58);
    comparison on =
        comparison_of(test, "crowd", cloud_random(test->dimension, 200, .5, &random), 1.);
    pair_list list = list_pairs(&on);
    for (int i = 0; i < 200; i += 83)
        compare_row(&on, &list, i);
}

static void one_pair_at_a_time_matches_the_oracle(const test_case *test)
{
    comparison on = comparison_of_scene(test, &scenes_hard[0]);
    setup_array table = comparison_table(&on);
    int width = table.width, d = test->dimension;
    for (int k = 0; k < sample_count(&on, 4); k += test_reference_stride()) {
        int i = sampled(&on, k, 4);
        const oracle_point *point = oracle_at(on.reference, i);
        double correction[16];
        for (int c = 0; c < width; ++c)
            correction[c] = setup_get(&table, i, c);
        for (int p = 0; p < point->pair_count; ++p) {
            const oracle_pair *pair = &point->pairs[p];
            double x_ij[3], gradient[3];
            for (int a = 0; a < d; ++a)
                x_ij[a] = (double)pair->x[a];
            sphg_pair_gradient(&on.scheme, x_ij, on.scene.volume[pair->j],
                               width ? correction : NULL, gradient);
            setup_array found = setup_numbers(SPHG_F64, 1, d, gradient);
            TEST_WITHIN(oracle_ratio_full, comparison_ratio(&found, 0, pair->gradient, pair->bound),
                        test_text("single pair, %s", test_method_name(test->method)));
        }
    }
}

/* ---- The same by other ways ------------------------------------------------------------------ */

static void fused_sweep_equals_table_to_the_bit(const test_case *test)
{
    static const int chosen[] = {0, 5, 7, 10};
    for (int s = 0; s < 4; ++s) {
        comparison on = comparison_of_scene(test, &scenes_hard[chosen[s]]);
        setup_array table = comparison_table(&on);
        for (int form = SPHG_DIFFERENCE; form <= SPHG_DIRECT; ++form) {
            comparison_field field = {SPHG_VECTOR, (sphg_form)form,
                                      comparison_random_field(&on, SPHG_VECTOR, 4)};
            comparison_result fused = comparison_apply(&on, &field, NULL);
            comparison_result stored = comparison_apply(&on, &field, &table);
            TEST_REQUIRE(comparison_results_have_same_bits(&fused, &stored), "form %d, %s", form,
                         on.name);
        }
    }
}

#define KERNELS_AT_THE_EXTREMES                                                                    \
    (TEST_BIT(SPHG_CUBIC_SPLINE) | TEST_BIT(SPHG_WENDLAND_C6) | TEST_BIT(SPHG_SPIKY))

static const test_entry entries[] = {
    TEST_ENTRY(operators_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(every_shape_in_every_form_matches_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(hard_scenes_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, KERNELS_AT_THE_EXTREMES),
    TEST_ENTRY(every_instruction_set_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(every_policy_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(periodic_neighbours_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(corrections_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, KERNELS_AT_THE_EXTREMES),
    TEST_ENTRY(ranks_and_smallest_moments_match_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(pair_gradients_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, KERNELS_AT_THE_EXTREMES),
    TEST_ENTRY(pair_gradients_of_a_crowd_match_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(one_pair_at_a_time_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(fused_sweep_equals_table_to_the_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
};
TEST_MAIN(entries)
