/* SPDX-License-Identifier: MIT */
/* Lists of the host among particles with radii of their own: results against the oracle, the bits
 * of a search where the lists are those of a search, and what lies beyond the radii, or lacks. */
#include "support/brute_force.h"
#include "support/graded.h"
#include "support/second_order.h"
#include <math.h>
#include <string.h>

/* ---- Lists ---------------------------------------------------------------------------------- */

/* The positions and radii of a comparison, as the host hands them over. */
static sphg_geometry geometry_of(const comparison *on)
{
    cloud points = on->points;
    const setup_array x = setup_positions(on->test, &points);
    const setup_array h =
        setup_numbers(test_position_type(on->test), on->points.count, 1, on->scene.support);
    sphg_geometry geometry = setup_geometry(on->test, &on->points, &x);
    geometry.source_support = setup_view(&h);
    geometry.mutual = on->scene.mutual;
    return geometry;
}

/* Everybody who is near somebody with the largest radius, each list from anywhere on. */
static sphg_lists wide_lists(const comparison *on)
{
    scene particles = scene_of_cloud(on->test, &on->points);
    const int n = on->points.count;
    double largest = 0;
    for (int i = 0; i < n; ++i)
        largest = fmax(largest, on->scene.support[i]);
    const rows near = rows_by_brute_force(&particles, 1.1 * largest);
    int32_t *turned = test_memory((size_t)near.offsets[n] * sizeof *turned);
    for (int i = 0; i < n; ++i) {
        const int64_t begin = near.offsets[i], length = near.offsets[i + 1] - begin;
        for (int64_t k = 0; k < length; ++k)
            turned[begin + k] = near.indices[begin + (k + i) % length];
    }
    return (sphg_lists){.offsets = near.offsets, .indices = turned};
}

static comparison over_lists(const comparison *on, const sphg_lists *lists, int copy)
{
    comparison made = *on;
    const sphg_geometry geometry = geometry_of(on);
    sphg_lists given = *lists;
    given.copy = copy;
    made.neighbors = setup_lists(on->context, &on->scheme, &geometry, &given);
    return made;
}

static comparison stage(const test_case *test, double ratio, int mutual)
{
    const graded block = graded_block(test->dimension, ratio, 2.4);
    return comparison_of_radii(test, "graded block", block.points, block.radii, mutual);
}

/* ---- The oracle ----------------------------------------------------------------------------- */

static void derivatives_match_the_oracle(const test_case *test)
{
    for (int way = 0; way < 4; ++way) {
        const comparison on = stage(test, way & 1 ? 8 : 1.5, way >> 1);
        const sphg_lists lists = wide_lists(&on);
        const comparison listed = over_lists(&on, &lists, way == 1 || way == 2);
        const setup_array table = comparison_table(&listed);
        graded_compare(&listed, SPHG_SCALAR, SPHG_DIFFERENCE, NULL);
        graded_compare(&listed, SPHG_SCALAR, SPHG_DIRECT, &table);
        graded_compare(&listed, SPHG_VECTOR, SPHG_DIFFERENCE, &table);
        graded_compare(&listed, SPHG_TENSOR, SPHG_DIRECT, NULL);
    }
}

/* Pairs that only the source's radius reaches are among them. */
static void forces_match_the_oracle(const test_case *test)
{
    for (int copy = 0; copy < 2; ++copy) {
        const comparison on = stage(test, 8, 1);
        const sphg_lists lists = wide_lists(&on);
        const comparison listed = over_lists(&on, &lists, copy);
        const setup_array table = comparison_table(&listed);
        for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form)
            for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; shape += 1 + copy)
                graded_compare(&listed, (sphg_shape)shape, (sphg_form)form, &table);
    }
}

static void order_two_matches_the_oracle(const test_case *test)
{
    for (int copy = 0; copy < 2; ++copy) {
        const comparison on = second_order_comparison(stage(test, 8, 1));
        const sphg_lists lists = wide_lists(&on);
        const comparison listed = over_lists(&on, &lists, copy);
        const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 3);
        const second_order found =
            second_order_apply(&listed, SPHG_VECTOR, numbers, (second_order_how){0});
        const oracle_field field = {SPHG_VECTOR, SPHG_DIFFERENCE, numbers, NULL};
        const setup_array table = comparison_table(&listed);
        const comparison_field force = {SPHG_VECTOR, SPHG_ADJOINT, numbers};
        const comparison_result forces = comparison_apply(&listed, &force, &table);
        const oracle_field asked = {SPHG_VECTOR, SPHG_ADJOINT, numbers, NULL};
        for (int i = 0; i < on.points.count; i += on.points.count / 5) {
            const oracle_curved exact = oracle_apply_second(on.reference, &field, i);
            const oracle_curved push = oracle_apply_second_two_sided(on.reference, &asked, i);
            second_order_compare(&listed, &found, &exact, i,
                                 exact.touched ? TEST_TOLERANCE_quadratic_ratio_touched
                                               : TEST_TOLERANCE_quadratic_ratio_full);
            if (!push.undecided)
                TEST_WITHIN(
                    quadratic_two_sided,
                    second_order_ratio(&forces.gradient, i, push.gradient, push.gradient_bound),
                    test_text("particle %d, copy %d", i, copy));
        }
    }
}

/* ---- The lists of a search ------------------------------------------------------------------ */

/* In the order that the library sums in. */
static sphg_lists lists_of_search(const comparison *on)
{
    const sphg_sources sources = comparison_sources(on);
    const sphg_scheme plain = {.dimension = on->test->dimension, .method = SPHG_PLAIN};
    sphg_pairs pairs = {.offsets = test_memory(((size_t)on->points.count + 1) * sizeof(int64_t)),
                        .any_order = 1};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    pairs.indices = test_memory((size_t)pairs.count * sizeof *pairs.indices);
    pairs.capacity = pairs.count;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    return (sphg_lists){.offsets = pairs.offsets, .indices = pairs.indices};
}

static void require_bits_of_search(const comparison *on, const comparison *listed, int mutual,
                                   const char *where)
{
    const setup_array table = comparison_table(on), other = comparison_table(listed);
    TEST_REQUIRE(setup_same_bits(&table, &other), "table, %s", where);
    const int last = mutual ? SPHG_ADJOINT : SPHG_DIRECT;
    for (int form = SPHG_DIFFERENCE; form <= last; ++form) {
        if (form == SPHG_DIRECT && on->scheme.order == 2)
            continue;
        const comparison_field field = {SPHG_VECTOR, (sphg_form)form,
                                        comparison_random_field(on, SPHG_VECTOR, 4)};
        const comparison_result a = comparison_apply(on, &field, &table),
                                b = comparison_apply(listed, &field, &table);
        TEST_REQUIRE(comparison_results_have_same_bits(&a, &b), "form %d, %s", form, where);
    }
}

static void lists_of_a_search_give_its_bits(const test_case *test)
{
    const int orders = test->method <= SPHG_RKPM ? 2 : 1;
    for (int way = 0; way < 4; ++way) {
        comparison on = stage(test, 8, way & 1);
        const sphg_lists lists = lists_of_search(&on);
        comparison listed = over_lists(&on, &lists, way >> 1);
        for (int order = 1; order <= orders; ++order) {
            on.scheme.order = listed.scheme.order = order;
            require_bits_of_search(&on, &listed, way & 1,
                                   test_text("order %d, way %d", order, way));
        }
    }
}

static setup_array heat_of(const comparison *on, const setup_array *table)
{
    const int n = on->points.count;
    const setup_array field = setup_numbers(test_field_type(on->test), n, 1,
                                            comparison_random_field(on, SPHG_SCALAR, 11)),
                      out = setup_output(test_field_type(on->test), n, 1);
    const sphg_view values = setup_view(&field);
    sphg_sources sources = comparison_sources(on);
    sources.correction = comparison_table_view(on, table);
    const sphg_field asked = {.shape = SPHG_SCALAR,
                              .form = SPHG_ADJOINT,
                              .at_sources = &values,
                              .laplacian = setup_view(&out)};
    const sphg_request request = {
        .sources = &sources, .fields = &asked, .set_count = 1, .field_count = 1};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return out;
}

/* Diffusion, over the lists of a search and over wider ones. */
static void heat_flows_as_over_a_search(const test_case *test)
{
    for (int copy = 0; copy < 2; ++copy) {
        const comparison on = stage(test, 8, 1);
        const setup_array table = comparison_table(&on), expected = heat_of(&on, &table);
        const sphg_lists same = lists_of_search(&on), wide = wide_lists(&on);
        const comparison listed = over_lists(&on, &same, copy),
                         wider = over_lists(&on, &wide, copy);
        const setup_array found = heat_of(&listed, &table), close = heat_of(&wider, &table);
        TEST_REQUIRE(setup_same_bits(&found, &expected), "copy %d", copy);
        setup_require_close(&close, &expected, test_text("copy %d", copy));
    }
}

/* Targets apart with their own radii, and sources of two sets, by a search and by lists. */
static void sets_of_lists_and_searches_add_up(const test_case *test)
{
    const comparison on = stage(test, 8, 0);
    const int n = on.points.count, half = n / 2;
    const setup_array field =
        setup_numbers(test_field_type(test), n, 1, comparison_random_field(&on, SPHG_SCALAR, 7));
    setup_array results[2];
    for (int way = 0; way < 2; ++way) {
        sphg_geometry apart = geometry_of(&on);
        apart.targets = apart.sources;
        apart.target_support = apart.source_support;
        sphg_sources sources[2] = {comparison_sources(&on), comparison_sources(&on)};
        sphg_view values[2] = {setup_view(&field), setup_view(&field)};
        apart.source_count = half;
        sources[0].neighbors = setup_search(on.context, &on.scheme, &apart);
        apart.source_count = n - half;
        apart.sources.x = (const char *)apart.sources.x + half * apart.sources.stride;
        apart.source_support.x =
            (const char *)apart.source_support.x + half * apart.source_support.stride;
        sphg_lists all = {.offsets = NULL};
        int64_t *offsets = test_memory(((size_t)n + 1) * sizeof *offsets);
        int32_t *indices = test_memory((size_t)n * (size_t)(n - half) * sizeof *indices);
        for (int i = 0; i < n; ++i) {
            for (int k = 0; k < n - half; ++k)
                indices[i * (n - half) + k] = k;
            offsets[i + 1] = (i + 1) * (int64_t)(n - half);
        }
        all.offsets = offsets;
        all.indices = indices;
        sources[1].neighbors = way ? setup_lists(on.context, &on.scheme, &apart, &all)
                                   : setup_search(on.context, &on.scheme, &apart);
        sources[1].volume.x = (const char *)sources[1].volume.x + half * sources[1].volume.stride;
        values[1].x = (const char *)values[1].x + half * values[1].stride;
        results[way] = setup_output(test_field_type(test), n, test->dimension);
        const sphg_field asked = {.shape = SPHG_SCALAR,
                                  .at_sources = values,
                                  .at_targets = setup_view(&field),
                                  .gradient = setup_view(&results[way])};
        const sphg_request request = {.sources = sources,
                                      .fields = &asked,
                                      .set_count = 2,
                                      .field_count = 1,
                                      .target_volume = setup_view(&on.volume)};
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    }
    setup_require_close(&results[0], &results[1], "two sets");
}

/* ---- Beyond the radii ----------------------------------------------------------------------- */

static double distance(const comparison *on, int i, int j)
{
    const int d = on->points.dimension;
    double square = 0;
    for (int a = 0; a < d; ++a)
        square += pow(on->points.x[i * d + a] - on->points.x[j * d + a], 2);
    return sqrt(square);
}

/* The particle with the largest radius; sign -1: with the smallest. */
static int extreme_of(const comparison *on, int sign)
{
    int most = 0;
    for (int i = 1; i < on->points.count; ++i)
        most = sign * (on->scene.support[i] - on->scene.support[most]) > 0 ? i : most;
    return most;
}

/* A value that is not finite does not pass through pairs that the radii do not make; the forms of
 * both sides have those of either. */
static void nothing_comes_from_beyond_the_radii(const test_case *test)
{
    for (int way = 0; way < 4; ++way) {
        const sphg_form form = way & 1 ? SPHG_ADJOINT : SPHG_DIFFERENCE;
        const comparison on = stage(test, 8, 1);
        const sphg_lists lists = wide_lists(&on);
        const comparison listed = over_lists(&on, &lists, way >> 1);
        const setup_array table = comparison_table(&listed);
        double *numbers = comparison_random_field(&on, SPHG_SCALAR, 5);
        const int bad = extreme_of(&on, -1);
        const double *support = on.scene.support;
        int touched = 0, listed_far = 0;
        numbers[bad] = (double)NAN;
        const comparison_field field = {SPHG_SCALAR, form, numbers};
        const comparison_result found = comparison_apply(&listed, &field, &table);
        for (int i = 0; i < on.points.count; ++i) {
            const double r = distance(&on, i, bad);
            const double reach = form == SPHG_ADJOINT ? fmax(support[i], support[bad]) : support[i];
            const int near = r < reach * (1 + 1e-6);
            touched += near;
            listed_far += !near && r < support[extreme_of(&on, 1)];
            const double result = setup_get(&found.gradient, i, 0);
            TEST_REQUIRE(near || isfinite(result), "particle %d, way %d", i, way);
            TEST_REQUIRE(r > .9 * reach || i == bad || isnan(result), "particle %d, way %d", i,
                         way);
        }
        TEST_REQUIRE(touched > 1 && listed_far > 1, "way %d: %d near, %d far", way, touched,
                     listed_far);
    }
}

/* ---- Pairs ---------------------------------------------------------------------------------- */

/* Of wide lists, those that a search of the same radii finds. */
static void pairs_are_those_of_a_search(const test_case *test)
{
    for (int way = 0; way < 4; ++way) {
        const comparison on = stage(test, 8, way & 1);
        const sphg_lists lists = wide_lists(&on);
        const comparison listed = over_lists(&on, &lists, way >> 1);
        const sphg_scheme plain = {.dimension = test->dimension, .method = SPHG_PLAIN};
        const rows expected = rows_listed(on.context, on.neighbors, &plain, NULL);
        const rows found = rows_listed(on.context, listed.neighbors, &plain, NULL);
        rows_require_equal(&found, &expected, test_text("way %d", way));
    }
}

/* ---- What lacks ----------------------------------------------------------------------------- */

static void drop(sphg_lists *lists, int n, int target, int source)
{
    int64_t *offsets = (int64_t *)(uintptr_t)lists->offsets, k = offsets[target];
    int32_t *indices = (int32_t *)(uintptr_t)lists->indices;
    while (indices[k] != source)
        ++k;
    for (; k + 1 < offsets[n]; ++k)
        indices[k] = indices[k + 1];
    for (int i = target + 1; i <= n; ++i)
        --offsets[i];
}

/* A pair of which one radius alone reaches the other particle, and the larger one's target. */
static int one_sided_pair(const comparison *on, int *small)
{
    for (int i = on->points.count - 1; i >= 0; --i)
        for (int j = 0; j < on->points.count; ++j) {
            const double r = distance(on, i, j);
            if (i != j && r < .9 * on->scene.support[i] && r > 1.1 * on->scene.support[j]) {
                *small = j;
                return i;
            }
        }
    fail();
    return -1;
}

static void require_checked(const comparison *on, sphg_lists *lists, sphg_fault kind, int target,
                            int source)
{
    for (int copy = 0; copy < 2; ++copy) {
        const comparison listed = over_lists(on, lists, copy);
        sphg_list_fault fault;
        const sphg_result result =
            sphg_neighbors_check(on->context, &on->scheme, listed.neighbors, &fault);
        assert_int_equal(result, kind ? SPHG_ERROR_LISTS : SPHG_OK);
        TEST_REQUIRE(fault.kind == kind && fault.target == target && fault.source == source,
                     "fault %d, target %d, source %d, copy %d", (int)fault.kind, fault.target,
                     fault.source, copy);
    }
}

/* By the target's radius, or by the larger one where lists are mutual. */
static void the_check_knows_whose_radius_counts(const test_case *test)
{
    for (int mutual = 0; mutual < 2; ++mutual) {
        const comparison on = stage(test, 8, mutual);
        const int n = on.points.count;
        int small = -1;
        const int large = one_sided_pair(&on, &small);
        sphg_lists lists = wide_lists(&on);
        require_checked(&on, &lists, SPHG_FAULT_NONE, -1, -1);
        drop(&lists, n, small, large); /* which only the larger radius reaches */
        if (mutual)
            require_checked(&on, &lists, SPHG_FAULT_ONE_SIDED, small, large);
        else
            require_checked(&on, &lists, SPHG_FAULT_NONE, -1, -1);
        drop(&lists, n, large, small);
        require_checked(&on, &lists, SPHG_FAULT_MISSING, mutual && small < large ? small : large,
                        mutual && small < large ? large : small);
    }
}

static void bad_radii_are_named(const test_case *test)
{
    const comparison on = stage(test, 2, 0);
    const sphg_lists lists = wide_lists(&on);
    static const double bad[] = {0, -1, (double)NAN, (double)INFINITY};
    for (int k = 0; k < 4; ++k) {
        comparison other = on;
        double *radii = test_memory((size_t)on.points.count * sizeof *radii);
        memcpy(radii, on.scene.support, (size_t)on.points.count * sizeof *radii);
        radii[3] = bad[k];
        other.scene.support = radii;
        const sphg_geometry geometry = geometry_of(&other);
        assert_int_equal(
            sphg_neighbors_use_lists(on.context, on.neighbors, &on.scheme, &geometry, &lists),
            SPHG_ERROR_ARGUMENT);
        TEST_REQUIRE(strstr(sphg_last_message(on.context), "geometry.source_support[3] is"), "%s",
                     sphg_last_message(on.context));
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(derivatives_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(forces_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS,
               0),
    TEST_ENTRY(order_two_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(lists_of_a_search_give_its_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(heat_flows_as_over_a_search, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(sets_of_lists_and_searches_add_up, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(nothing_comes_from_beyond_the_radii, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(pairs_are_those_of_a_search, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(the_check_knows_whose_radius_counts, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0,
               0),
    TEST_ENTRY(bad_radii_are_named, TEST_ALL_PRECISIONS, 0, 0, 0),
};
TEST_MAIN(entries)
