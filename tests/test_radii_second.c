/* SPDX-License-Identifier: MIT */
/* Order 2 with a support radius per particle: derivatives, both sides of pairs, tables, pairs and
 * what is lent, over lists that hold the pairs of now or, with a skin, more than these. */
#include "support/graded_halves.h"
#include "support/oracle_borrowed.h"
#include "support/second_order.h"
#include <math.h>
#include <string.h>

static comparison stage_of(const test_case *test, double ratio, double support, int way)
{
    return second_order_comparison(graded_stage_of(test, ratio, support, (graded_way)way));
}

static int step_of(const comparison *on)
{
    return test_reference_stride() * (1 + on->points.count / 6);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void results_match_the_oracle(const test_case *test)
{
    static const double ratios[] = {1.5, 8, 64};
    for (int k = 0; k < 3; ++k)
        for (int way = 0; way < GRADED_WAYS; ++way) {
            const comparison on = stage_of(test, ratios[k], k == 1 ? 2 : 3, way);
            const sphg_shape shape = (sphg_shape)(SPHG_SCALAR + (k + way) % 4);
            const double *numbers = comparison_random_field(&on, shape, 3);
            const second_order found =
                second_order_apply(&on, shape, numbers, (second_order_how){0});
            const oracle_field field = {shape, SPHG_DIFFERENCE, numbers, NULL};
            for (int i = 0; i < on.points.count; i += step_of(&on)) {
                const oracle_curved exact = oracle_apply_second(on.reference, &field, i);
                const oracle_second *second = oracle_second_at(on.reference, i);
                second_order_compare(&on, &found, &exact, i,
                                     exact.touched ? TEST_TOLERANCE_quadratic_ratio_touched
                                                   : TEST_TOLERANCE_quadratic_ratio_full);
                if (!oracle_second_rank_is_open(&on.scene, oracle_at(on.reference, i), second))
                    assert_int_equal(setup_get(&found.rank, i, 0), second->rank);
            }
        }
}

static void both_sides_match_the_oracle(const test_case *test)
{
    static const double ratios[] = {1.5, 8, 64};
    for (int k = 0; k < 3; ++k)
        for (int way = 0; way < GRADED_WAYS; ++way) {
            const comparison on = stage_of(test, ratios[k], 2.5, way);
            const setup_array table = comparison_table(&on);
            const sphg_shape shape = (sphg_shape)(SPHG_SCALAR + (k + way) % 4);
            for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
                const comparison_field field = {shape, (sphg_form)form,
                                                comparison_random_field(&on, shape, 21)};
                const comparison_result found = comparison_apply(&on, &field, &table);
                const oracle_field asked = {shape, (sphg_form)form, field.numbers, NULL};
                for (int i = 0; i < on.points.count; i += 2 * step_of(&on)) {
                    const oracle_curved exact =
                        oracle_apply_second_two_sided(on.reference, &asked, i);
                    const setup_array *const arrays[] = {&found.gradient, &found.divergence,
                                                         &found.curl};
                    const quad *const numbers[] = {exact.gradient, exact.divergence, exact.curl};
                    for (int r = 0; r < 3 && !exact.undecided; ++r)
                        TEST_WITHIN(
                            quadratic_two_sided,
                            second_order_ratio(arrays[r], i, numbers[r], exact.gradient_bound),
                            test_text("result %d of particle %d, %s", r, i, on.name));
                }
            }
        }
}

/* Targets apart, whose sums come from two source sets. */
static void halves_apart_match_the_oracle(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        const comparison on = stage_of(test, 8, 2.5, way);
        const setup_array table = comparison_table(&on);
        const sphg_shape shape = way & 1 ? SPHG_SCALAR : SPHG_VECTOR;
        const double *numbers = comparison_random_field(&on, shape, 8);
        const setup_array values = setup_numbers(test_field_type(test), on.points.count,
                                                 setup_width(shape, test->dimension), numbers);
        const graded_halves of = graded_halves_of(&on, 8, 2.5, (graded_way)way, &table, &values);
        for (int k = 0; k < 4; ++k) {
            const sphg_form form = k & 1 ? SPHG_ADJOINT : SPHG_DIFFERENCE;
            const comparison_field field = {shape, form, numbers};
            const comparison_result found =
                graded_apply_to_halves(&on, &of, &field, &table, k >> 1);
            const oracle_field asked = {shape, form, numbers, NULL};
            for (int i = 0; i < on.points.count; i += 2 * step_of(&on)) {
                const oracle_curved exact =
                    k & 1 ? oracle_apply_second_two_sided(on.reference, &asked, i)
                          : oracle_apply_second(on.reference, &asked, i);
                if (!exact.undecided)
                    TEST_WITHIN(quadratic_two_sided,
                                second_order_ratio(&found.gradient, i, exact.gradient,
                                                   exact.gradient_bound),
                                test_text("form %d of particle %d, %s", (int)form, i, on.name));
            }
        }
    }
}

/* Hessians are lent in units of length, and borrowed in those of each. */
static void borrowed_curvature_matches_the_oracle(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        const comparison on = stage_of(test, 8, 2, way);
        const sphg_shape shape = way & 1 ? SPHG_VECTOR : SPHG_SCALAR;
        const double *numbers = comparison_random_field(&on, shape, 3);
        const oracle_field field = {shape, SPHG_DIFFERENCE, numbers, NULL};
        const second_order first =
            second_order_apply(&on, shape, numbers, (second_order_how){.lends = 1});
        const second_order found = second_order_apply(
            &on, shape, numbers, (second_order_how){.lends = 1, .lent = &first.curvature});
        const double *lent = setup_doubles(&first.curvature);
        int borrowers = 0;
        for (int i = 0; i < on.points.count; ++i)
            borrowers += setup_get(&first.borrows, i, 0) == 1;
        assert_true(borrowers > 5);
        for (int i = 0; i < on.points.count; i += step_of(&on)) {
            const oracle_curved exact = oracle_apply_borrowed(on.reference, &field, lent, i);
            second_order_compare(&on, &found, &exact, i, TEST_TOLERANCE_borrowed_ratio);
        }
    }
}

/* ---- Exact -------------------------------------------------------------------------------------
 */

/* In units of u / lambda_q, the gradient over H times the curvature. */
static void quadratic_fields_are_exact_at_full_rank(const test_case *test)
{
    for (int way = 0; way < GRADED_AROUND; ++way) {
        const comparison on = stage_of(test, 4, 3, way);
        const int n = on.points.count, d = on.points.dimension, full = d + second_order_pairs(d);
        for (int i = 0; i < n * d; ++i) /* values must be those of the places, whatever rounds */
            on.points.x[i] = on.scene.sources[i];
        double *numbers = test_memory((size_t)n * sizeof *numbers);
        for (int i = 0; i < n; ++i)
            for (int a = 0; a < d; ++a)
                numbers[i] += pow(on.points.x[i * d + a] - 1, 2) / 2;
        const second_order found =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
        int some = 0;
        for (int i = 0; i < n; ++i) {
            if (setup_get(&found.rank, i, 0) < full)
                continue;
            ++some;
            const double h = on.scene.support[i];
            const double u = test_unit_roundoff(test),
                         t = (double)oracle_second_at(on.reference, i)->t;
            double off = 0, second = 0, size = 0;
            for (int a = 0; a < d; ++a) {
                const double slope = on.points.x[i * d + a] - 1;
                off += pow(setup_get(&found.gradient, i, a) - slope, 2);
                size += slope * slope;
            }
            for (int a = 0, k = 0; a < d; ++a)
                for (int b = a; b < d; ++b, ++k)
                    second += pow(setup_get(&found.hessian, i, k) - (a == b), 2);
            /* Values are rounded, too, to u times themselves. */
            const double value = (fabs(numbers[i]) + sqrt(size) * h + h * h) / (h * h);
            TEST_REQUIRE(sqrt(second) < 400 * u / t * (value + 1), "%s: Hessian of %d is off by %g",
                         on.name, i, sqrt(second));
            TEST_REQUIRE(sqrt(off) < 400 * u / t * h * (value + 1),
                         "%s: gradient of %d is off by %g", on.name, i, sqrt(off));
        }
        TEST_REQUIRE(some > n / 3, "only %d of %d", some, n);
    }
}

/* ---- The same bits -----------------------------------------------------------------------------
 */

static void tables_give_the_bits_of_one_sweep(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        const comparison on = stage_of(test, 8, 2.5, way);
        second_order_require_table_has_all(&on);
    }
}

/* Lists that are not mutual, and so need no test, go the short way. */
static void the_short_way_matches_the_oracle(const test_case *test)
{
    graded block = graded_before(test->dimension, 8, 2.5);
    const comparison on = second_order_comparison(
        comparison_of_radii(test, "gathered block", block.points, block.radii, 0));
    for (int shape = SPHG_SCALAR; shape <= SPHG_VECTOR; ++shape) {
        const double *numbers = comparison_random_field(&on, (sphg_shape)shape, 3);
        const second_order found =
            second_order_apply(&on, (sphg_shape)shape, numbers, (second_order_how){.no_table = 1});
        const oracle_field field = {(sphg_shape)shape, SPHG_DIFFERENCE, numbers, NULL};
        for (int i = 0; i < on.points.count; i += step_of(&on)) {
            const oracle_curved exact = oracle_apply_second(on.reference, &field, i);
            second_order_compare(&on, &found, &exact, i,
                                 exact.touched ? TEST_TOLERANCE_quadratic_ratio_touched
                                               : TEST_TOLERANCE_quadratic_ratio_full);
        }
    }
}

/* Lengths and radii times a power of two: every bit but the exponents stays. */
static void results_scale_with_the_unit_of_length(const test_case *test)
{
    for (int k = -3; k <= 5; k += 8) {
        graded block = graded_before(test->dimension, 8, 2.5), other = block;
        const int n = block.points.count, d = test->dimension;
        const comparison on = second_order_comparison(
            comparison_of_radii(test, "block", block.points, block.radii, 1));
        other.points = cloud_copy(&block.points);
        other.points.spacing = ldexp(block.points.spacing, k);
        other.radii = test_memory((size_t)n * sizeof *other.radii);
        for (int i = 0; i < n * d; ++i)
            other.points.x[i] = ldexp(block.points.x[i], k);
        for (int i = 0; i < n; ++i)
            other.radii[i] = ldexp(on.scene.support[i], k);
        const comparison scaled = second_order_comparison(
            comparison_of_radii(test, "scaled block", other.points, other.radii, 1));
        const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 6);
        const second_order a =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lends = 1});
        const second_order b =
            second_order_apply(&scaled, SPHG_SCALAR, numbers, (second_order_how){.lends = 1});
        for (int i = 0; i < n; ++i) {
            for (int c = 0; c < d; ++c)
                assert_true(setup_get(&a.gradient, i, c) == ldexp(setup_get(&b.gradient, i, c), k));
            for (int c = 0; c < a.hessian.width; ++c)
                assert_true(setup_get(&a.hessian, i, c) ==
                            ldexp(setup_get(&b.hessian, i, c), 2 * k));
        }
    }
}

/* ---- Pairs -------------------------------------------------------------------------------------
 */

static void gradients_of_pairs_are_those_of_one_pair(const test_case *test)
{
    for (int way = 0; way < 2; ++way) {
        const comparison on = stage_of(test, 8, 2.5, way);
        graded_require_pair_gradients(&on, 1, 1e5);
    }
}

/* ---- What is not finite ------------------------------------------------------------------------
 */

static void nothing_comes_from_beyond_the_targets_radius(const test_case *test)
{
    for (int way = 0; way < GRADED_AROUND; ++way) {
        const comparison on = stage_of(test, 8, 2.5, way);
        const int n = on.points.count, d = on.points.dimension;
        double *numbers = comparison_random_field(&on, SPHG_SCALAR, 5);
        int largest = 0, touched = 0;
        for (int i = 1; i < n; ++i)
            largest = on.scene.support[i] > on.scene.support[largest] ? i : largest;
        numbers[largest] = (double)NAN;
        const second_order found =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
        for (int i = 0; i < n; ++i) {
            double square = 0;
            for (int a = 0; a < d; ++a)
                square += pow(on.points.x[i * d + a] - on.points.x[largest * d + a], 2);
            const int near = sqrt(square) < on.scene.support[i] * (1 + 1e-6);
            touched += near;
            for (int c = 0; c < d; ++c)
                TEST_REQUIRE(near || isfinite(setup_get(&found.gradient, i, c)), "particle %d", i);
        }
        assert_true(touched > 1);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(results_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED,
               0),
    TEST_ENTRY(both_sides_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(halves_apart_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(borrowed_curvature_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(quadratic_fields_are_exact_at_full_rank, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(tables_give_the_bits_of_one_sweep, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(the_short_way_matches_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(results_scale_with_the_unit_of_length, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(gradients_of_pairs_are_those_of_one_pair, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(nothing_comes_from_beyond_the_targets_radius, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
};
TEST_MAIN(entries)
