/* SPDX-License-Identifier: MIT */
/* The reference checked on its own: what the mathematics promises, it keeps to quadruple
 * precision. No call of the library here. */
#include "support/setup.h"
#include "support/oracle.h"

static const double quad_unit = 0x1p-113;

static double in_quad_units(quad error)
{
    return (double)(quad_abs(error) / quad_unit);
}

/* ---- Kernels -------------------------------------------------------------------------------- */

enum { gauss_points = 10 };

/* Nodes and weights of Gauss and Legendre on [-1, 1]: roots of P_n by Newton's method. */
static void gauss(quad *nodes, quad *weights)
{
    for (int k = 0; k < gauss_points; ++k) {
        quad x = cos(3.141592653589793 * (k + .75) / (gauss_points + .5)), slope = 1;
        for (int step = 0; step < 6; ++step) {
            quad last = 1, now = x;
            for (int n = 2; n <= gauss_points; ++n) {
                quad next = ((2 * n - 1) * x * now - (n - 1) * last) / n;
                last = now;
                now = next;
            }
            slope = gauss_points * (x * now - last) / (x * x - 1);
            x -= now / slope;
        }
        nodes[k] = x;
        weights[k] = 2 / ((1 - x * x) * slope * slope);
    }
}

/* The integral of w(q) q^power (or w'(q) q^power) over [0, 1], piece by piece. */
static quad integral(sphg_kernel kernel, int derivative, int power)
{
    quad nodes[gauss_points], weights[gauss_points], sum = 0;
    quad knots[] = {0, (quad)1 / 3, (quad)1 / 2, (quad)2 / 3, 1};
    gauss(nodes, weights);
    for (int piece = 0; piece < 4; ++piece)
        for (int k = 0; k < gauss_points; ++k) {
            quad half = (knots[piece + 1] - knots[piece]) / 2, shape[3];
            quad q = knots[piece] + half * (1 + nodes[k]);
            oracle_shape_of(kernel, q, shape);
            sum += half * weights[k] * shape[derivative] * quad_power(q, power);
        }
    return sum;
}

static quad sphere(int dimension)
{
    return dimension == 2 ? 2 * oracle_pi() : 4 * oracle_pi();
}

static void kernel_has_unit_integral_and_second_moment(const test_case *test)
{
    int d = test->dimension;
    quad full = sphere(d) * oracle_sigma(test->kernel, d), mu2 = oracle_mu2(test->kernel, d);
    quad one = full * integral(test->kernel, 0, d - 1);
    quad second = full * integral(test->kernel, 0, d + 1) / d;
    quad slope = -full * integral(test->kernel, 1, d) / d; /* m_ref of KGC */
    TEST_WITHIN(quad_kernel, in_quad_units(one - 1), test_kernel_name(test->kernel));
    TEST_WITHIN(quad_kernel, in_quad_units(second / mu2 - 1), test_kernel_name(test->kernel));
    TEST_WITHIN(quad_kernel, in_quad_units(slope - 1), test_kernel_name(test->kernel));
}

static void kernel_derivatives_are_difference_quotients(const test_case *test)
{
    const quad step = 0x1p-30;
    for (int k = 1; k < 32; ++k) {
        quad q = (quad)k / 32 + (quad)1 / 1024, here[3], low[3], high[3];
        oracle_shape_of(test->kernel, q, here);
        oracle_shape_of(test->kernel, q - step, low);
        oracle_shape_of(test->kernel, q + step, high);
        for (int n = 0; n < 2; ++n) {
            quad quotient = (high[n] - low[n]) / (2 * step);
            double error = (double)(quad_abs(quotient - here[n + 1]) / (step * step));
            TEST_WITHIN(quad_difference_quotient, error, test_kernel_name(test->kernel));
        }
    }
}

static void radial_weights_are_those_of_the_shape(const test_case *test)
{
    const quad h = .75, step = 0x1p-30;
    for (int k = 3; k < 16; ++k) {
        quad r = h * k / 16 + (quad)1 / 1024;
        int d = test->dimension;
        oracle_weights here = oracle_weights_at(test->kernel, d, h, r);
        oracle_weights low = oracle_weights_at(test->kernel, d, h, r - step);
        oracle_weights high = oracle_weights_at(test->kernel, d, h, r + step);
        quad slope = (high.w - low.w) / (2 * step) / r;
        quad rate = (high.slope - low.slope) / (2 * step);
        double scale = (double)(step * step * oracle_sigma(test->kernel, d));
        TEST_WITHIN(quad_difference_quotient, (double)quad_abs(slope - here.slope) / scale, "W'/r");
        TEST_WITHIN(quad_difference_quotient, (double)quad_abs(rate - here.slope_rate) / scale,
                    "its rate");
    }
}

/* ---- Operators ------------------------------------------------------------------------------ */

typedef struct bench {
    cloud points;
    oracle_scene scene;
    oracle *reference;
} bench;

static bench make_bench(const test_case *test, cloud points, double support)
{
    random_state random = random_seeded(7);
    bench made = {.points = points};
    oracle_scene *scene = &made.scene;
    scene->scheme = setup_scheme(test, support);
    scene->unit = quad_unit;
    scene->source_count = scene->target_count = points.count;
    scene->sources = made.points.x;
    scene->volume = cloud_volumes(&points, .2, &random);
    scene->density = cloud_numbers(&points, .5, 1.5, &random);
    made.reference = oracle_of(scene);
    return made;
}

static bench jittered_bench(const test_case *test)
{
    random_state random = random_seeded(11);
    int per_axis = test->dimension == 2 ? 6 : 4;
    cloud points = cloud_jittered(test->dimension, per_axis, .25, .2, &random);
    cloud_snap(&points, 0x1p-20);
    return make_bench(test, points, .625);
}

static bench sheet_bench(const test_case *test)
{
    return make_bench(test, cloud_sheets(test->dimension, 4, .25, .03125), .625);
}

static double linear(const double *x, int d)
{
    return 3 + 2 * x[0] - x[1] + (d == 3 ? .5 * x[2] : 0);
}

static double *linear_field(const cloud *points)
{
    double *field = test_memory((size_t)points->count * sizeof *field);
    for (int i = 0; i < points->count; ++i)
        field[i] = linear(points->x + i * points->dimension, points->dimension);
    return field;
}

static void require_linear_gradient(const oracle_result *result, int d, quad unit)
{
    static const double slope[] = {2, -1, .5};
    for (int k = 0; k < d; ++k)
        TEST_WITHIN(quad_exactness, in_quad_units((result->gradient[k] - slope[k]) / unit),
                    "gradient");
}

static void linear_fields_are_exact_in_quad(const test_case *test)
{
    bench on = jittered_bench(test);
    int d = test->dimension;
    oracle_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, linear_field(&on.points), NULL};
    int compared = 0;
    for (int i = 0; i < on.points.count; ++i) {
        if (oracle_at(on.reference, i)->rank < d)
            continue;
        ++compared;
        field.form = SPHG_DIFFERENCE;
        oracle_result result = oracle_apply(on.reference, &field, i);
        require_linear_gradient(&result, d, 1);
        if (!test_is_classic(test))
            continue;
        field.form = SPHG_DIRECT;
        result = oracle_apply(on.reference, &field, i);
        require_linear_gradient(&result, d, 1);
        quad exact = field.at_sources[i];
        TEST_WITHIN(quad_exactness, in_quad_units(result.value[0] - exact), "value");
    }
    TEST_REQUIRE(compared > on.points.count / 2, "only %d of full rank", compared);
}

static void partition_of_unity_holds_in_quad(const test_case *test)
{
    bench benches[] = {jittered_bench(test), sheet_bench(test),
                       make_bench(test, cloud_pair(test->dimension, .25), .5),
                       make_bench(test, cloud_single(test->dimension), .5)};
    for (int b = 0; b < 4; ++b) {
        double *ones = test_memory((size_t)benches[b].points.count * sizeof *ones);
        oracle_field field = {SPHG_SCALAR, SPHG_DIRECT, ones, NULL};
        for (int i = 0; i < benches[b].points.count; ++i)
            ones[i] = 1;
        for (int i = 0; i < benches[b].points.count; ++i) {
            oracle_result result = oracle_apply(benches[b].reference, &field, i);
            TEST_WITHIN(quad_exactness, in_quad_units(result.value[0] - 1), "value of 1");
            for (int k = 0; k < test->dimension; ++k)
                TEST_WITHIN(quad_exactness, in_quad_units(result.gradient[k]), "gradient of 1");
        }
    }
}

/* sum V w . grad A = -sum w . (adjoint force of A), for every A and w. */
static void adjoint_is_the_negative_transpose_in_quad(const test_case *test)
{
    bench benches[] = {jittered_bench(test), sheet_bench(test)};
    random_state random = random_seeded(5);
    for (int b = 0; b < 2; ++b) {
        const cloud *points = &benches[b].points;
        int d = test->dimension;
        double *velocity = test_memory((size_t)(points->count * d) * sizeof *velocity);
        for (int k = 0; k < points->count * d; ++k)
            velocity[k] = random_between(&random, -1, 1);
        double *stress = cloud_numbers(points, -1, 1, &random);
        oracle_field motion = {SPHG_VECTOR, SPHG_DIFFERENCE, velocity, NULL};
        oracle_field force = {SPHG_SCALAR, SPHG_ADJOINT, stress, NULL};
        quad work = 0, size = 0;
        for (int i = 0; i < points->count; ++i) {
            oracle_result rate = oracle_apply(benches[b].reference, &motion, i);
            oracle_result push = oracle_apply(benches[b].reference, &force, i);
            quad first = benches[b].scene.volume[i] * stress[i] * rate.divergence[0];
            work += first;
            size += quad_abs(first);
            for (int k = 0; k < d; ++k)
                work += velocity[i * d + k] * push.gradient[k];
        }
        TEST_WITHIN(quad_exactness, in_quad_units(work / size), "work");
    }
}

static void two_sided_forms_conserve_momentum_in_quad(const test_case *test)
{
    bench on = sheet_bench(test);
    random_state random = random_seeded(6);
    double *stress = cloud_numbers(&on.points, -1, 1, &random);
    for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
        oracle_field field = {SPHG_SCALAR, (sphg_form)form, stress, NULL};
        quad sum[3] = {0}, size = 0;
        for (int i = 0; i < on.points.count; ++i) {
            oracle_result push = oracle_apply(on.reference, &field, i);
            quad weight = form == SPHG_SYMMETRIC ? (quad)on.scene.volume[i] : 1;
            for (int k = 0; k < test->dimension; ++k)
                sum[k] += weight * push.gradient[k];
            size += weight * quad_norm(push.gradient, test->dimension);
        }
        TEST_WITHIN(quad_exactness, in_quad_units(quad_norm(sum, 3) / size), "momentum");
    }
}

/* ---- Derivatives of the classic interpolant -------------------------------------------------- */

static quad value_near(const test_case *test, const bench *on, const double *field, const double *x)
{
    oracle_scene moved = on->scene;
    moved.targets = x;
    moved.target_count = 1;
    (void)test;
    oracle_field direct = {SPHG_SCALAR, SPHG_DIRECT, field, NULL};
    return oracle_apply(oracle_of(&moved), &direct, 0).value[0];
}

static void classic_gradient_is_the_derivative_of_the_value(const test_case *test)
{
    bench on = jittered_bench(test);
    random_state random = random_seeded(21);
    double *field = cloud_numbers(&on.points, -1, 1, &random), step = 0x1p-26;
    oracle_field direct = {SPHG_SCALAR, SPHG_DIRECT, field, NULL};
    for (int trial = 0; trial < 4; ++trial) {
        double x[3];
        for (int k = 0; k < test->dimension; ++k)
            x[k] = (double)(float)random_between(&random, .1, .6);
        oracle_scene scene = on.scene;
        scene.targets = x;
        scene.target_count = 1;
        oracle *here = oracle_of(&scene);
        assert_int_equal(oracle_at(here, 0)->rank, test->dimension);
        oracle_result result = oracle_apply(here, &direct, 0);
        for (int k = 0; k < test->dimension; ++k) {
            double low[3] = {x[0], x[1], x[2]}, high[3] = {x[0], x[1], x[2]};
            low[k] -= step;
            high[k] += step;
            quad slope = (value_near(test, &on, field, high) - value_near(test, &on, field, low)) /
                         (2 * (quad)step);
            double error = (double)quad_abs(slope - result.gradient[k]) / (step * step);
            TEST_WITHIN(quad_difference_quotient, error, "classic gradient");
        }
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(kernel_has_unit_integral_and_second_moment, 0, TEST_BOTH_DIMENSIONS, 0,
               TEST_ALL_KERNELS),
    TEST_ENTRY(kernel_derivatives_are_difference_quotients, 0, TEST_BOTH_DIMENSIONS, 0,
               TEST_ALL_KERNELS),
    TEST_ENTRY(radial_weights_are_those_of_the_shape, 0, TEST_BOTH_DIMENSIONS, 0, TEST_ALL_KERNELS),
    TEST_ENTRY(linear_fields_are_exact_in_quad, 0, TEST_BOTH_DIMENSIONS, TEST_CORRECTED,
               TEST_ALL_KERNELS),
    TEST_ENTRY(partition_of_unity_holds_in_quad, 0, TEST_BOTH_DIMENSIONS, TEST_CLASSIC, 0),
    TEST_ENTRY(adjoint_is_the_negative_transpose_in_quad, 0, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS,
               0),
    TEST_ENTRY(two_sided_forms_conserve_momentum_in_quad, 0, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS,
               0),
    TEST_ENTRY(classic_gradient_is_the_derivative_of_the_value, 0, TEST_BOTH_DIMENSIONS,
               TEST_CLASSIC, TEST_ALL_KERNELS),
};
TEST_MAIN(entries)
