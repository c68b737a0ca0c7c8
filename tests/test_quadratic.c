/* SPDX-License-Identifier: MIT */
/* Order 2: against the oracle, exact on quadratic fields where the rank says so, on linear ones
 * wherever order 1 is, continuous, and never worse than finite. */
#include "support/second_order.h"
#include "support/scenes.h"
#include <string.h>

enum { PAIRS_MOST = 6 };

static int full_rank(int d)
{
    return d + second_order_pairs(d);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void compare(const comparison *on, sphg_shape shape, const second_order *found,
                    const double *numbers, int i)
{
    const oracle_field field = {shape, SPHG_DIFFERENCE, numbers, NULL};
    const oracle_curved exact = oracle_apply_second(on->reference, &field, i);
    second_order_compare(on, found, &exact, i,
                         exact.touched ? TEST_TOLERANCE_quadratic_ratio_touched
                                       : TEST_TOLERANCE_quadratic_ratio_full);
}

static void results_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = second_order_comparison(comparison_of_scene(test, &scenes_hard[s]));
        for (int shape = SPHG_SCALAR; shape <= (s ? SPHG_VECTOR : SPHG_TENSOR); ++shape) {
            const double *numbers = comparison_random_field(&on, (sphg_shape)shape, 3);
            const second_order found =
                second_order_apply(&on, (sphg_shape)shape, numbers, (second_order_how){0});
            const int step =
                test_reference_stride() * (on.points.count < 6 ? 1 : on.points.count / 6);
            for (int i = 0; i < on.points.count; i += step)
                compare(&on, (sphg_shape)shape, &found, numbers, i);
        }
    }
}

/* Forms of both sides, with the table of a call before. */
static void two_sided_forms_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = second_order_comparison(comparison_of_scene(test, &scenes_hard[s]));
        const setup_array table = comparison_table(&on);
        for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape) {
            const sphg_form form = (sphg_form)(shape % 2 ? SPHG_ADJOINT : SPHG_SYMMETRIC);
            const comparison_field field = {(sphg_shape)shape, form,
                                            comparison_random_field(&on, (sphg_shape)shape, 21)};
            const comparison_result found = comparison_apply(&on, &field, &table);
            const oracle_field asked = {field.shape, form, field.numbers, NULL};
            const int step = test_reference_stride() * (1 + on.points.count / 4);
            for (int i = 0; i < on.points.count; i += step) {
                const oracle_curved exact = oracle_apply_second_two_sided(on.reference, &asked, i);
                if (exact.undecided)
                    continue;
                const setup_array *const arrays[] = {&found.gradient, &found.divergence,
                                                     &found.curl};
                const quad *const numbers[] = {exact.gradient, exact.divergence, exact.curl};
                for (int k = 0; k < 3; ++k)
                    TEST_WITHIN(quadratic_two_sided,
                                second_order_ratio(arrays[k], i, numbers[k], exact.gradient_bound),
                                test_text("result %d of particle %d, %s, %s", k, i, on.name,
                                          test_method_name(test->method)));
            }
        }
    }
}

static void every_policy_and_instruction_set_matches_the_oracle(const test_case *test)
{
    static const int chosen[] = {0, 5, 10};
    for (int s = 0; s < 3; ++s)
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            const comparison made = comparison_of_scene(test, &scenes_hard[chosen[s]]);
            const comparison under =
                second_order_comparison(comparison_under(&made, (sphg_policy)policy, .0625));
            for (int isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
                comparison on = under; /* and its reference */
                on.context = setup_watched_context_on((sphg_isa)isa);
                if (!on.context)
                    continue;
                on.neighbors = setup_neighbors(on.context, test, &on.scheme, &on.points);
                const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 5);
                const second_order found =
                    second_order_apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
                for (int i = 0; i < on.points.count;
                     i += test_reference_stride() * (1 + on.points.count / 4))
                    compare(&on, SPHG_VECTOR, &found, numbers, i);
            }
        }
}

/* Where a few volumes outweigh the others, rounding of the large moments raises the threshold. */
static void uneven_volumes_match_the_oracle(const test_case *test)
{
    const comparison even = comparison_of_scene(test, &scenes_hard[0]);
    const double heavy = test_unit_roundoff(test) > 1e-10 ? 0x1p17 : 0x1p46;
    double *volumes = test_memory((size_t)even.points.count * sizeof *volumes);
    for (int i = 0; i < even.points.count; ++i)
        volumes[i] = setup_get(&even.volume, i, 0) * (i % 9 == 4 ? heavy : 1);
    const comparison on = second_order_comparison(comparison_with_volumes(&even, volumes));
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 15);
    const second_order found = second_order_apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
    int raised = 0;
    for (int i = 0; i < on.points.count; i += 3) {
        oracle_second second;
        oracle_solve_second(&on.scene, oracle_at(on.reference, i), &second);
        raised += second.kept > 0 && second.shift > 0 && second.eps > .0015;
        compare(&on, SPHG_VECTOR, &found, numbers, i);
    }
    TEST_REQUIRE(raised > 0, "nowhere does rounding raise the threshold (%d)", raised);
}

/* MLS without volumes takes the mean of the neighbours': of like ones that is their own. */
static void volumes_that_are_alike_need_not_be_told(const test_case *test)
{
    random_state random = random_seeded(17);
    const int d = test->dimension;
    const cloud points = cloud_jittered(d, d == 2 ? 9 : 5, .25, .1, &random);
    const comparison on = second_order_comparison(comparison_of(test, "like volumes", points, .75));
    const double volume = pow(.25, d);
    const float narrow = (float)volume;
    const int f64 = test_field_type(test) == SPHG_F64;
    const setup_array values = setup_numbers(test_field_type(test), points.count, 1,
                                             comparison_random_field(&on, SPHG_SCALAR, 16));
    const sphg_view at_sources = setup_view(&values);
    second_order found[2];
    for (int mean = 0; mean < 2; ++mean) {
        found[mean] = second_order_outputs(&on, SPHG_SCALAR, 0);
        const sphg_view same = f64 ? sphg_same_f64(&volume) : sphg_same_f32(&narrow);
        setup_array positions = setup_positions(test, (cloud *)&on.points);
        sphg_geometry geometry = sphg_targets_apart(setup_view(&positions), points.count,
                                                    setup_view(&positions), points.count);
        geometry.precision = test_field_type(test);
        const sphg_sources sources = {.neighbors = setup_search(on.context, &on.scheme, &geometry),
                                      .volume = same};
        sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &at_sources};
        field.at_targets = at_sources;
        field.gradient = setup_view(&found[mean].gradient);
        field.hessian = setup_view(&found[mean].hessian);
        sphg_request request = {
            .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
        request.target_volume = mean ? sphg_absent() : same;
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    }
    setup_require_close(&found[0].gradient, &found[1].gradient, "gradient by mean volumes");
    setup_require_close(&found[0].hessian, &found[1].hessian, "Hessian by mean volumes");
}

static void rank_is_the_oracles(const test_case *test)
{
    int open = 0, all = 0;
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = second_order_comparison(comparison_of_scene(test, &scenes_hard[s]));
        const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 4);
        const second_order found =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
        int64_t full = 0;
        for (int i = 0; i < on.points.count; ++i)
            full += setup_get(&found.rank, i, 0) == full_rank(on.points.dimension);
        TEST_REQUIRE(found.stats.quadratic == full, "%lld of %lld, %s",
                     (long long)found.stats.quadratic, (long long)full, on.name);
        for (int i = 0; i < on.points.count; i += 1 + on.points.count / 9, ++all) {
            oracle_second second;
            const oracle_point *point = oracle_at(on.reference, i);
            oracle_solve_second(&on.scene, point, &second);
            if (oracle_second_rank_is_open(&on.scene, point, &second))
                ++open;
            else
                TEST_REQUIRE(setup_get(&found.rank, i, 0) == second.rank,
                             "%g, not %d: particle %d, %s", setup_get(&found.rank, i, 0),
                             second.rank, i, on.name);
        }
    }
    TEST_REQUIRE(open * 4 < all, "%d of %d decided by rounding", open, all);
}

/* Around a target on a parabola or paraboloid, off it by a part of any size: all but one direction
 * of curvature is resolved, and that one by as much as they are off. */
static cloud near_quadric(int d, int count, random_state *random)
{
    cloud points = cloud_random(d, count, 1, random);
    points.spacing *= 4; /* volumes that fill what the thin cloud leaves empty */
    const double off = pow(10, random_between(random, -3.5, 0)),
                 bend = random_between(random, -1, 1), tilt = random_between(random, -.5, .5),
                 twist = random_between(random, -1, 1);
    for (int i = 0; i < count; ++i) {
        double *x = points.x + i * d;
        for (int a = 0; a < d; ++a)
            x[a] = i ? 2 * x[a] - 1 : 0;
        x[d - 1] *= off;
        x[d - 1] += tilt * x[0] + bend * x[0] * x[0];
        if (d == 3)
            x[2] += twist * x[0] * x[1] - bend * x[1] * x[1];
    }
    return points;
}

/* Nobody counts as exact whose curvature is not resolved. */
static void targets_on_quadrics_have_the_rank_of_the_oracle(const test_case *test)
{
    const int d = test->dimension, clouds = 200;
    int full = 0, short_of_it = 0;
    for (int k = 0; k < clouds; ++k) {
        random_state random = random_seeded(1000 + (uint64_t)k);
        const int count = (d == 2 ? 5 : 9) + random_index(&random, d == 2 ? 10 : 21);
        const comparison on = second_order_comparison(
            comparison_of(test, test_text("cloud %d", k), near_quadric(d, count, &random), 1.9));
        const second_order found = second_order_apply(
            &on, SPHG_SCALAR, comparison_random_field(&on, SPHG_SCALAR, 4), (second_order_how){0});
        const oracle_point *point = oracle_at(on.reference, 0);
        oracle_second second;
        oracle_solve_second(&on.scene, point, &second);
        if (oracle_second_rank_is_open(&on.scene, point, &second))
            continue;
        const int rank = (int)setup_get(&found.rank, 0, 0);
        TEST_REQUIRE(rank == second.rank, "%d, not %d, of %d near a quadric, %s", rank, second.rank,
                     count, on.name);
        full += rank == full_rank(d);
        short_of_it += rank >= d && rank < full_rank(d);
    }
    TEST_REQUIRE(full > clouds / 20 && full + short_of_it > clouds / 5, "%d full, %d not, of %d",
                 full, short_of_it, clouds);
}

/* ---- Exactness ------------------------------------------------------------------------------- */

static double distance_to(const setup_array *found, int i, const double *exact)
{
    double square = 0;
    for (int k = 0; k < found->width; ++k)
        square += pow(setup_get(found, i, k) - exact[k], 2);
    return sqrt(square);
}

static comparison exact_stage(const test_case *test, double jitter, double support)
{
    random_state random = random_seeded(99);
    const int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 9 : 6, .25, jitter, &random);
    cloud_snap(&points, 0x1p-6);
    return second_order_comparison(
        comparison_of(test, test_text("jitter %g", jitter), points, support * .25));
}

/* In units of u / lambda_q, which t bounds, the gradient over H times the curvature. */
static void quadratic_fields_are_exact_at_full_rank(const test_case *test)
{
    static const double jitters[] = {0, .2, .4}, supports[] = {2, 2.5, 3};
    const double size = 15;
    for (int k = 0; k < 9; ++k) {
        const comparison on = exact_stage(test, jitters[k % 3], supports[k / 3]);
        const int n = on.points.count, d = on.points.dimension;
        const double h = on.scheme.support_radius;
        const second_order found = second_order_apply(
            &on, SPHG_SCALAR, second_order_polynomial(&on.points, 2), (second_order_how){0});
        int full = 0;
        for (int i = 0; i < n; ++i) {
            double exact[3];
            oracle_second second;
            if (setup_get(&found.rank, i, 0) < full_rank(d))
                continue;
            if (full++ % (3 * test_reference_stride()))
                continue;
            second_order_slope_at(&on.points, i, exact);
            oracle_solve_second(&on.scene, oracle_at(on.reference, i), &second);
            const double scale = on.scene.unit / (double)second.t;
            const double slope = distance_to(&found.gradient, i, exact) / (h * size + 6 * h);
            TEST_WITHIN(quadratic_exactness, slope / scale / 4, test_text("gradient, %s", on.name));
            TEST_WITHIN(quadratic_exactness,
                        distance_to(&found.hessian, i, second_order_second) / (size + 24 / h) /
                            scale / 4,
                        test_text("Hessian, %s", on.name));
        }
        TEST_REQUIRE(full > (supports[k / 3] > 2.4 ? .9 : .2) * n, "only %d of %d, %s, H %g", full,
                     n, on.name, supports[k / 3]);
    }
}

static void linear_fields_are_exact_wherever_order_1_is(const test_case *test)
{
    for (int k = 0; k < 3; ++k) {
        const comparison on = exact_stage(test, .2 * k, 2);
        const second_order found = second_order_apply(
            &on, SPHG_SCALAR, second_order_polynomial(&on.points, 1), (second_order_how){0});
        const double none[PAIRS_MOST] = {0}, h = on.scheme.support_radius;
        int partial = 0;
        for (int i = 0; i < on.points.count; ++i) {
            const int rank = (int)setup_get(&found.rank, i, 0);
            oracle_second second;
            if (rank < on.points.dimension)
                continue;
            partial += rank < full_rank(on.points.dimension);
            if (i % (3 * test_reference_stride()))
                continue;
            oracle_solve_second(&on.scene, oracle_at(on.reference, i), &second);
            const double scale = on.scene.unit * (1 + (double)second.norm_f);
            TEST_WITHIN(quadratic_exactness,
                        distance_to(&found.gradient, i, second_order_slopes) / scale / 4,
                        test_text("gradient, %s", on.name));
            TEST_WITHIN(quadratic_exactness, distance_to(&found.hessian, i, none) * h / scale / 24,
                        test_text("Hessian, %s", on.name));
        }
        TEST_REQUIRE(partial > 0, "nobody lacks curvature, %s", on.name);
    }
}

static void constants_have_exactly_no_derivative(const test_case *test)
{
    const comparison on = exact_stage(test, .2, 2);
    double *numbers = test_memory((size_t)on.points.count * sizeof *numbers);
    for (int i = 0; i < on.points.count; ++i)
        numbers[i] = .1;
    const second_order found = second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    for (int i = 0; i < on.points.count; ++i)
        for (int k = 0; k < found.hessian.width; ++k)
            assert_true(setup_get(&found.hessian, i, k) == 0 &&
                        setup_get(&found.gradient, i, k % test->dimension) == 0 &&
                        setup_get(&found.laplacian, i, 0) == 0);
}

/* ---- Relations ------------------------------------------------------------------------------- */

/* Inside a lattice third moments vanish, and with them what curvature adds to the gradient. */
static void order_1_inside_a_lattice_is_order_2(const test_case *test)
{
    const int d = test->dimension;
    const comparison first =
        comparison_of(test, "lattice", cloud_lattice(d, d == 2 ? 9 : 7, .125), .25);
    const double volume = pow(.125, d), *a = comparison_random_field(&first, SPHG_SCALAR, 48);
    double *alike = test_memory((size_t)first.points.count * sizeof *alike);
    for (int i = 0; i < first.points.count; ++i)
        alike[i] = volume;
    const comparison one = comparison_with_volumes(&first, alike),
                     two = second_order_comparison(one);
    const comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, a};
    const oracle_field asked = {SPHG_SCALAR, SPHG_DIFFERENCE, a, NULL};
    const comparison_result expected = comparison_apply(&one, &field, NULL);
    const second_order found = second_order_apply(&two, SPHG_SCALAR, a, (second_order_how){0});
    const int i = cloud_middle(&one.points);
    const oracle_result exact = oracle_apply(one.reference, &asked, i);
    quad gradient[3];
    for (int k = 0; k < d; ++k)
        gradient[k] = setup_get(&found.gradient, i, k);
    TEST_WITHIN(equal_within_bound, comparison_ratio(&expected.gradient, i, gradient, exact.bound),
                one.name);
}

/* Turned by 3-4-5 in the first two axes, which is exact where coordinates are multiples of 5 / 2^k:
 * turned back, results stand within the bounds of the cloud that was not turned, and ranks are its.
 */
static void turned_clouds_have_turned_results(const test_case *test)
{
    const int d = test->dimension, pairs = second_order_pairs(d);
    random_state random = random_seeded(46);
    cloud points = cloud_jittered(d, d == 2 ? 8 : 5, 1, .3, &random);
    cloud_snap(&points, 0x1p-8);
    for (int k = 0; k < points.count * d; ++k)
        points.x[k] *= 5;
    const comparison on = second_order_comparison(comparison_of(test, "block", points, 11.25));
    cloud turned = cloud_copy(&points);
    for (int i = 0; i < points.count; ++i) {
        const double *x = points.x + i * d;
        turned.x[i * d] = (3 * x[0] - 4 * x[1]) / 5;
        turned.x[i * d + 1] = (4 * x[0] + 3 * x[1]) / 5;
    }
    const comparison other = second_order_comparison(comparison_of(test, "turned", turned, 11.25));
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 47);
    const second_order_how how = {.subset = NULL};
    const second_order found = second_order_apply(&on, SPHG_SCALAR, numbers, how),
                       there = second_order_apply(&other, SPHG_SCALAR, numbers, how);
    second_order back = there;
    back.gradient = setup_output(SPHG_F64, points.count, d);
    back.hessian = setup_output(SPHG_F64, points.count, pairs);
    static const double turn[3][3] = {{.6, -.8, 0}, {.8, .6, 0}, {0, 0, 1}};
    for (int i = 0; i < points.count; ++i)
        for (int a = 0, k = 0; a < d; ++a) {
            double slope = 0;
            for (int b = 0; b < d; ++b)
                slope += turn[b][a] * setup_get(&there.gradient, i, b);
            numbers_set(&back.gradient, i, a, slope);
            for (int b = a; b < d; ++b, ++k) {
                double second = 0;
                for (int p = 0, m = 0; p < d; ++p)
                    for (int q = p; q < d; ++q, ++m)
                        second +=
                            (turn[p][a] * turn[q][b] + (p == q ? 0 : turn[q][a] * turn[p][b])) *
                            setup_get(&there.hessian, i, m);
                numbers_set(&back.hessian, i, k, second);
            }
        }
    const oracle_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers, NULL};
    for (int i = 0; i < points.count; i += 9 * test_reference_stride()) {
        const oracle_curved exact = oracle_apply_second(on.reference, &field, i);
        second_order_compare(&on, &back, &exact, i, TEST_TOLERANCE_quadratic_ratio_touched);
        TEST_REQUIRE(exact.undecided ||
                         setup_get(&found.rank, i, 0) == setup_get(&there.rank, i, 0),
                     "rank of particle %d", i);
    }
}

/* ---- Ways to the same bits ------------------------------------------------------------------- */

static void tables_give_the_bits_of_one_sweep(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; s += 5) {
        const comparison on = second_order_comparison(comparison_of_scene(test, &scenes_hard[s]));
        second_order_require_table_has_all(&on);
    }
}

static void laplacians_are_traces_of_hessians(const test_case *test)
{
    const comparison on = exact_stage(test, .3, 2.5);
    const int d = test->dimension, step = second_order_pairs(d);
    const second_order found = second_order_apply(
        &on, SPHG_VECTOR, comparison_random_field(&on, SPHG_VECTOR, 7), (second_order_how){0});
    for (int i = 0; i < on.points.count; ++i)
        for (int c = 0; c < d; ++c) {
            double trace = setup_get(&found.hessian, i, c * step);
            for (int a = 1; a < d; ++a) {
                const int k = c * step + a * d - a * (a - 1) / 2;
                trace += setup_get(&found.hessian, i, k);
                if (test_field_type(test) == SPHG_F32)
                    trace = (double)(float)trace;
            }
            TEST_REQUIRE(trace == setup_get(&found.laplacian, i, c), "particle %d", i);
        }
}

/* Where the Hessian of each component goes, and how: they come out the same. */
static void hessians_of_vectors_stand_where_the_host_wants_them(const test_case *test)
{
    const comparison on = exact_stage(test, .3, 2.5);
    const int d = test->dimension, n = on.points.count, packed = second_order_pairs(d);
    const sphg_type type = test_field_type(test);
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 9);
    const second_order together =
        second_order_apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
    const setup_array values = setup_numbers(type, n, d, numbers);
    const sphg_view at_sources = setup_view(&values);
    const sphg_sources sources = comparison_sources(&on);
    for (int full = 0; full < 2; ++full) {
        const int width = full ? d * d : packed;
        const setup_array one = setup_output(type, n, width), two = setup_output(type, n, width),
                          three = setup_output(type, n, width), beside[] = {one, two, three};
        sphg_field field = {.shape = SPHG_VECTOR, .at_sources = &at_sources};
        field.hessian = setup_view(&one);
        field.hessian.y = two.data;
        field.hessian.z = d == 3 ? three.data : NULL;
        field.hessian.layout = full ? SPHG_FULL : SPHG_AS_SHAPE;
        const sphg_request request = {
            .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
        for (int i = 0; i < n; ++i)
            for (int c = 0; c < d; ++c)
                for (int k = 0; k < width; ++k) {
                    const int a = k / d < k % d ? k / d : k % d, b = k / d + k % d - a;
                    const int at = full ? a * d - a * (a - 1) / 2 + b - a : k;
                    TEST_REQUIRE(setup_get(&beside[c], i, k) ==
                                     setup_get(&together.hessian, i, c * packed + at),
                                 "particle %d, component %d, number %d", i, c, k);
                }
        field.hessian.y = NULL;
        if (d == 2)
            continue;
        TEST_REQUIRE(sphg_evaluate(on.context, &on.scheme, &request) == SPHG_ERROR_ARGUMENT,
                     "one array of three is missing");
    }
}

static void pairs_found_anew_give_the_same_bits(const test_case *test)
{
    const comparison on = exact_stage(test, .3, 2.5);
    comparison other = on;
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 8);
    const second_order kept = second_order_apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
    const setup_array positions = setup_positions(test, &other.points);
    sphg_geometry geometry = setup_geometry(test, &on.points, &positions);
    geometry.list_free = 1;
    other.neighbors = setup_search(on.context, &on.scheme, &geometry);
    const second_order again =
        second_order_apply(&other, SPHG_VECTOR, numbers, (second_order_how){0});
    second_order_require_same_bits(&kept, &again, "list-free");
    TEST_REQUIRE(setup_same_bits(&kept.table, &again.table), "tables");
    int32_t chosen[12];
    for (int k = 0; k < 12; ++k)
        chosen[k] = k * 3;
    const sphg_subset few = sphg_listed(chosen, 12);
    const second_order some =
        second_order_apply(&on, SPHG_VECTOR, numbers, (second_order_how){.subset = &few});
    for (int k = 0; k < 12; ++k)
        for (int c = 0; c < some.hessian.width; ++c)
            TEST_REQUIRE(setup_get(&some.hessian, chosen[k], c) ==
                             setup_get(&kept.hessian, chosen[k], c),
                         "target %d", chosen[k]);
    TEST_REQUIRE(setup_is_canary(&some.hessian, 1), "who is not selected is written");
}

/* Forms of both sides: by themselves or beside a difference, all targets or a few, whose sources'
 * rows are copied one by one. */
static void two_sided_forms_have_the_same_bits_in_any_company(const test_case *test)
{
    const comparison on = exact_stage(test, .3, 2.5);
    const setup_array table = comparison_table(&on);
    const comparison_field stress = {SPHG_SCALAR, SPHG_ADJOINT,
                                     comparison_random_field(&on, SPHG_SCALAR, 22)};
    const comparison_result alone = comparison_apply(&on, &stress, &table);
    const setup_array values =
        setup_numbers(test_field_type(test), on.points.count, 1, stress.numbers);
    const sphg_view at_sources = setup_view(&values);
    const comparison_result force = comparison_outputs(&on, &stress, on.points.count);
    const second_order slope = second_order_outputs(&on, SPHG_SCALAR, 0);
    const second_order expected =
        second_order_apply(&on, SPHG_SCALAR, stress.numbers, (second_order_how){.table = &table});
    sphg_field fields[2] = {{.shape = SPHG_SCALAR, .at_sources = &at_sources},
                            {.shape = SPHG_SCALAR, .at_sources = &at_sources}};
    fields[0].form = SPHG_ADJOINT;
    fields[0].gradient = setup_view(&force.gradient);
    fields[1].gradient = setup_view(&slope.gradient);
    fields[1].hessian = setup_view(&slope.hessian);
    sphg_sources sources = comparison_sources(&on);
    sources.correction = setup_view(&table);
    sphg_request request = {
        .sources = &sources, .fields = fields, .set_count = 1, .field_count = 2};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    TEST_REQUIRE(setup_same_bits(&alone.gradient, &force.gradient), "force in company");
    TEST_REQUIRE(setup_same_bits(&expected.gradient, &slope.gradient), "gradient in company");
    TEST_REQUIRE(setup_same_bits(&expected.hessian, &slope.hessian), "Hessian in company");
    const int32_t chosen[] = {0, 7, on.points.count - 1};
    const sphg_subset few = sphg_listed(chosen, 3);
    const comparison_result some = comparison_apply_to(&on, &stress, &table, &few);
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < test->dimension; ++a)
            TEST_REQUIRE(setup_get(&some.gradient, chosen[k], a) ==
                             setup_get(&alone.gradient, chosen[k], a),
                         "target %d", chosen[k]);
}

/* Half of the particles each: sums of both, moments of third and fourth order included. */
static void two_source_sets_are_one_cloud(const test_case *test)
{
    const comparison on = exact_stage(test, .1, 3);
    const int n = on.points.count, half = n / 2;
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 9);
    const second_order whole = second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const second_order found = second_order_outputs(&on, SPHG_SCALAR, 0);
    comparison moved = on;
    const setup_array positions = setup_positions(test, &moved.points);
    const setup_array values = setup_numbers(test_field_type(test), n, 1, numbers);
    const sphg_view all = setup_view(&positions), volume = setup_view(&on.volume);
    sphg_sources sets[2] = {{0}, {0}};
    sphg_view at_sources[2];
    for (int s = 0; s < 2; ++s) {
        const int first = s ? half : 0, count = s ? n - half : half;
        sphg_view part = all;
        part.x = (const char *)all.x + first * all.stride;
        sphg_geometry geometry = sphg_targets_apart(all, n, part, count);
        geometry.precision = test_field_type(test);
        sets[s].neighbors = setup_search(on.context, &on.scheme, &geometry);
        sets[s].volume = volume;
        sets[s].volume.x = (const char *)volume.x + first * volume.stride;
        at_sources[s] = setup_view(&values);
        at_sources[s].x = (const char *)at_sources[s].x + first * at_sources[s].stride;
    }
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = at_sources};
    field.at_targets = setup_view(&values);
    field.gradient = setup_view(&found.gradient);
    field.hessian = setup_view(&found.hessian);
    sphg_request request = {.sources = sets, .fields = &field, .set_count = 2, .field_count = 1};
    request.target_volume = volume;
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    setup_require_close(&whole.gradient, &found.gradient, "gradient of two sets");
    setup_require_close(&whole.hessian, &found.hessian, "Hessian of two sets");
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void gradients_of_pairs_sum_to_the_gradient(const test_case *test)
{
    const comparison on = exact_stage(test, .3, 2.5);
    const int n = on.points.count, d = test->dimension;
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 10);
    const second_order found = second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    int64_t *offsets = test_memory((size_t)(n + 1) * sizeof *offsets);
    sphg_pairs pairs = {.offsets = offsets, .capacity = 0};
    sphg_sources sources = comparison_sources(&on);
    SETUP_OK(on.context,
             sphg_pair_gradients(on.context, &on.scheme, &sources, NULL, sphg_absent(), &pairs));
    setup_array gradients = setup_output(test_field_type(test), (int)pairs.count, d);
    pairs.capacity = pairs.count;
    pairs.indices = test_memory((size_t)pairs.count * sizeof *pairs.indices);
    pairs.gradient = setup_view(&gradients);
    SETUP_OK(on.context, sphg_pair_gradients(on.context, &on.scheme, &sources, NULL,
                                             setup_view(&found.table), &pairs));
    setup_array sums = setup_output(SPHG_F64, n, d), alone = setup_output(SPHG_F64, n, d);
    const double *table = setup_doubles(&found.table);
    for (int i = 0; i < n; ++i)
        for (int a = 0; a < d; ++a) {
            double sum = 0, one[3], x_ij[3], other = 0;
            for (int64_t k = offsets[i]; k < offsets[i + 1]; ++k) {
                const int j = pairs.indices[k];
                for (int b = 0; b < d; ++b)
                    x_ij[b] = on.points.x[i * d + b] - on.points.x[j * d + b];
                sphg_pair_gradient(&on.scheme, x_ij, setup_get(&on.volume, j, 0),
                                   table + (ptrdiff_t)i * found.table.width, one);
                sum += (numbers[j] - numbers[i]) * setup_get(&gradients, (int)k, a);
                other += (numbers[j] - numbers[i]) * one[a];
            }
            setup_put(&sums, i * d + a, sum);
            setup_put(&alone, i * d + a, other);
        }
    const setup_array f64 = setup_numbers(SPHG_F64, n, d, setup_doubles(&found.gradient));
    double worst = 0, size = 0;
    for (int i = 0; i < n; ++i)
        for (int a = 0; a < d; ++a) {
            const double g = setup_get(&f64, i, a);
            size = fmax(size, fabs(g));
            worst = test_larger(
                worst, fmax(fabs(setup_get(&sums, i, a) - g), fabs(setup_get(&alone, i, a) - g)));
        }
    TEST_WITHIN(order_of_summation, worst / size / on.scene.unit, "gradients of pairs");
}

/* ---- Continuity ------------------------------------------------------------------------------ */

static double smooth_field(int d, const double *x)
{
    const double y = x[1], z = d == 3 ? x[2] : 0;
    return sin(1.3 * x[0]) + .5 * y * y + .3 * x[0] * y + .4 * z * z - .2 * y * z;
}

/* A neighbour slides in from beyond H along a line: nothing jumps, and a step half as long changes
 * half as much. Second derivatives in the units of h, whose basis is some five times longer. */
static double largest_step(const test_case *test, sphg_policy policy, int steps)
{
    random_state random = random_seeded(31);
    const int d = test->dimension, per_axis = d == 2 ? 3 : 2, n = (d == 2 ? 9 : 8) + 1;
    const cloud block = cloud_jittered(d, per_axis, .5, .1, &random);
    cloud points = {.dimension = d, .count = n, .spacing = .5};
    points.x = test_memory((size_t)(n * d) * sizeof *points.x);
    memcpy(points.x, block.x, (size_t)((n - 1) * d) * sizeof *points.x);
    sphg_context *context = setup_context_of(1);
    sphg_scheme scheme = setup_scheme(test, 1.05);
    scheme.order = 2;
    scheme.policy = policy;
    const double h = scheme.support_radius;
    double value[10], gradient[10][3], hessian[10][6], before[10][9], worst = 0;
    const double volume = d == 2 ? .25 : .125;
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    for (int step = 0; step <= steps; ++step) {
        for (int a = 0; a < d; ++a)
            points.x[(n - 1) * d + a] = a ? .31 : 2.5 - 2.2 * step / steps;
        for (int i = 0; i < n; ++i)
            value[i] = smooth_field(d, points.x + i * d);
        sphg_geometry geometry = sphg_all(sphg_view_f64(points.x, 8 * d), n);
        geometry.list_free = 1;
        SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
        const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
        const sphg_view at_sources = sphg_view_f64(value, 8);
        sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &at_sources};
        field.gradient = sphg_view_f64(gradient[0], sizeof gradient[0]);
        field.hessian = sphg_view_f64(hessian[0], sizeof hessian[0]);
        const sphg_request request = {
            .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
        SETUP_OK(context, sphg_evaluate(context, &scheme, &request));
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < d + second_order_pairs(d); ++k) {
                const double now = k < d ? gradient[i][k] : h * h * hessian[i][k - d] / 5;
                if (step)
                    worst = test_larger(worst, fabs(now - before[i][k]));
                before[i][k] = now;
            }
    }
    sphg_neighbors_destroy(neighbors);
    return worst;
}

static void a_sliding_neighbour_makes_no_jump(const test_case *test)
{
    const int steps = test_reference_stride() > 1 ? 2000 : 20000;
    const double once = largest_step(test, SPHG_BLEND, steps / 2);
    const double twice = largest_step(test, SPHG_BLEND, steps);
    const double jump = largest_step(test, SPHG_TRUNCATE, steps / 2);
    TEST_REQUIRE(twice < .01 * 20000 / steps && twice < .6 * once, "%g, then %g", once, twice);
    TEST_REQUIRE(jump > 10 * once * steps / 20000, "%g where it should jump", jump);
}

/* ---- Degenerate clouds ----------------------------------------------------------------------- */

static void require_finite(const setup_array *found, const char *where)
{
    for (int k = 0; k < found->count * found->width; ++k)
        TEST_REQUIRE(isfinite(setup_get(found, k / found->width, k % found->width)), "%s", where);
}

/* Zeros included. */
static void require_close(const setup_array *a, const setup_array *b, const char *where)
{
    if (memcmp(a->data, b->data, (size_t)(a->count * a->width) * (a->type == SPHG_F64 ? 8 : 4)) !=
        0)
        setup_require_close(a, b, where);
}

/* Where the linear rank is short, order 2 is order 1. */
static void degenerate_clouds_have_the_result_of_order_1(const test_case *test)
{
    const int d = test->dimension;
    const cloud clouds[] = {cloud_single(d),
                            cloud_pair(d, .3),
                            cloud_line(d, 5, .125),
                            cloud_plane(d, d == 2 ? 8 : 5, .25),
                            cloud_coincident(d, 4, 0, .25),
                            cloud_coincident(d, 3, 1, .25)};
    for (size_t c = 0; c < sizeof clouds / sizeof *clouds; ++c) {
        const comparison made = comparison_of(test, test_text("cloud %d", (int)c), clouds[c], .6);
        const comparison on = second_order_comparison(made);
        const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 11);
        const second_order found =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
        const comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers};
        const comparison_result linear = comparison_apply(&made, &field, NULL);
        require_finite(&found.gradient, on.name);
        require_finite(&found.hessian, on.name);
        require_finite(&found.table, on.name);
        require_close(&linear.gradient, &found.gradient, on.name);
        for (int i = 0; i < on.points.count; ++i) {
            TEST_REQUIRE(setup_get(&found.rank, i, 0) < d, "rank of %d, %s", i, on.name);
            for (int k = 0; k < found.hessian.width; ++k)
                TEST_REQUIRE(setup_get(&found.hessian, i, k) == 0, "Hessian of %d, %s", i, on.name);
        }
    }
}

/* Few neighbours, more than a plane, fewer than curvature asks for. */
static void few_neighbours_give_numbers(const test_case *test)
{
    const int d = test->dimension;
    for (int count = 2; count < 14; ++count) {
        random_state random = random_seeded((uint64_t)count);
        const comparison on = second_order_comparison(
            comparison_of(test, test_text("%d", count), cloud_random(d, count, 1, &random), 3));
        const second_order found = second_order_apply(
            &on, SPHG_VECTOR, comparison_random_field(&on, SPHG_VECTOR, 12), (second_order_how){0});
        require_finite(&found.gradient, on.name);
        require_finite(&found.hessian, on.name);
        for (int i = 0; i < count; ++i)
            TEST_REQUIRE(setup_get(&found.rank, i, 0) <= count - 1, "rank of %d, %s", i, on.name);
    }
}

/* ---- What is refused ------------------------------------------------------------------------- */

static void require_refused(const comparison *on, sphg_field field, sphg_scheme scheme,
                            const char *words)
{
    const setup_array values =
        setup_numbers(test_field_type(on->test), on->points.count, PAIRS_MOST,
                      comparison_random_field(on, SPHG_SYM_TENSOR, 13));
    const sphg_view at_sources = setup_view(&values);
    const sphg_sources sources = comparison_sources(on);
    field.at_sources = &at_sources;
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    const sphg_result result = sphg_evaluate(on->context, &scheme, &request);
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(result == SPHG_ERROR_UNSUPPORTED && strstr(message, words), "%d: %s", (int)result,
                 message);
}

static void what_order_2_lacks_is_refused_by_name(const test_case *test)
{
    const comparison on = exact_stage(test, .2, 2);
    const second_order found = second_order_outputs(&on, SPHG_SCALAR, 0);
    sphg_scheme first = on.scheme;
    first.order = 1;
    sphg_field field = {.shape = SPHG_SCALAR, .hessian = setup_view(&found.hessian)};
    require_refused(&on, field, first, "hessian needs scheme.order 2");
    field = (sphg_field){.shape = SPHG_SCALAR, .laplacian = setup_view(&found.laplacian)};
    require_refused(&on, field, first, "laplacian needs scheme.order 2");
    field = (sphg_field){.shape = SPHG_SCALAR, .gradient = setup_view(&found.gradient)};
    field.form = SPHG_DIRECT;
    require_refused(&on, field, on.scheme, "direct");
    field.form = SPHG_ADJOINT;
    field.hessian = setup_view(&found.hessian);
    require_refused(&on, field, on.scheme, "hessian outside the difference form");
    field.hessian = sphg_absent();
    field.form = SPHG_SYMMETRIC;
    field.laplacian = setup_view(&found.laplacian);
    require_refused(&on, field, on.scheme, "laplacian outside the difference and adjoint forms");
    field = (sphg_field){.shape = SPHG_SYM_TENSOR, .hessian = setup_view(&found.hessian)};
    require_refused(&on, field, on.scheme, "hessian of a tensor");
    sphg_scheme other = on.scheme;
    other.method = SPHG_CMLS;
    field = (sphg_field){.shape = SPHG_SCALAR, .gradient = setup_view(&found.gradient)};
    require_refused(&on, field, other, "KGC, MLS and RKPM");
    const sphg_inversion inversion = {.correction = setup_view(&found.gradient)};
    TEST_REQUIRE(sphg_invert_moments(on.context, &on.scheme, 0, sphg_absent(), sphg_absent(),
                                     &inversion) == SPHG_ERROR_UNSUPPORTED &&
                     strstr(sphg_last_message(on.context), "more than these moments"),
                 "%s", sphg_last_message(on.context));
}

static const test_entry entries[] = {
    TEST_ENTRY(results_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED,
               0),
    TEST_ENTRY(two_sided_forms_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(every_policy_and_instruction_set_matches_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(uneven_volumes_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM), 0),
    TEST_ENTRY(volumes_that_are_alike_need_not_be_told, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_MLS), 0),
    TEST_ENTRY(rank_is_the_oracles, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(targets_on_quadrics_have_the_rank_of_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(quadratic_fields_are_exact_at_full_rank, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(linear_fields_are_exact_wherever_order_1_is, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(constants_have_exactly_no_derivative, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(order_1_inside_a_lattice_is_order_2, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(turned_clouds_have_turned_results, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(tables_give_the_bits_of_one_sweep, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(laplacians_are_traces_of_hessians, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(hessians_of_vectors_stand_where_the_host_wants_them, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(pairs_found_anew_give_the_same_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(two_sided_forms_have_the_same_bits_in_any_company, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(two_source_sets_are_one_cloud, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(gradients_of_pairs_sum_to_the_gradient, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(a_sliding_neighbour_makes_no_jump, 0, TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(degenerate_clouds_have_the_result_of_order_1, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(few_neighbours_give_numbers, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(what_order_2_lacks_is_refused_by_name, TEST_ALL_PRECISIONS, 0, 0, 0),
};
TEST_MAIN(entries)
