/* SPDX-License-Identifier: MIT */
/* The smoothing functions W and W'/r against the table of docs/theory.md: closed forms, quadrature
 * that is exact for the polynomial pieces, and finite differences. */
#include "support/setup.h"
#include "support/oracle_kernel.h"
#include <complex.h>
#include <float.h>
#include <limits.h>
#include <math.h>

typedef long double complex number;

/* x^n where the real part is positive, else 0. */
static number positive_power(number x, int n)
{
    number power = 1;
    if (creall(x) <= 0)
        return 0;
    for (int k = 0; k < n; ++k)
        power *= x;
    return power;
}

static number cubic_spline(number q)
{
    return 2 * positive_power(1 - q, 3) - 8 * positive_power(0.5L - q, 3);
}
static number quintic_spline(number q)
{
    return positive_power(3 - 3 * q, 5) - 6 * positive_power(2 - 3 * q, 5) +
           15 * positive_power(1 - 3 * q, 5);
}
static number wendland_c2(number q)
{
    return positive_power(1 - q, 4) * (1 + 4 * q);
}
static number wendland_c4(number q)
{
    return positive_power(1 - q, 6) * (1 + 6 * q + 35 * q * q / 3);
}
static number wendland_c6(number q)
{
    return positive_power(1 - q, 8) * (1 + 8 * q + 25 * q * q + 32 * q * q * q);
}
static number poly6(number q)
{
    return positive_power(1 - q * q, 3);
}
static number spiky(number q)
{
    return positive_power(1 - q, 3);
}

#define UNIT 0x1p-53L
#define PI   3.141592653589793238462643383279502884L

/* sigma and mu2 as fractions: sigma = a / (b pi), mu2 = c / d; 2D, 3D. */
static const struct row {
    const char *name;
    sphg_kernel kernel;
    number (*w)(number q);
    long double sigma[2][2], mu2[2][2];
} TABLE[] = {
    {"CUBIC_SPLINE", SPHG_CUBIC_SPLINE, cubic_spline, {{40, 7}, {8, 1}}, {{31, 392}, {3, 40}}},
    {"QUINTIC_SPLINE",
     SPHG_QUINTIC_SPLINE,
     quintic_spline,
     {{63, 478}, {9, 40}},
     {{2771, 51624}, {7, 135}}},
    {"WENDLAND_C2", SPHG_WENDLAND_C2, wendland_c2, {{7, 1}, {21, 2}}, {{5, 72}, {1, 15}}},
    {"WENDLAND_C4", SPHG_WENDLAND_C4, wendland_c4, {{9, 1}, {495, 32}}, {{7, 132}, {2, 39}}},
    {"WENDLAND_C6", SPHG_WENDLAND_C6, wendland_c6, {{78, 7}, {1365, 64}}, {{3, 70}, {1, 24}}},
    {"POLY6", SPHG_POLY6, poly6, {{4, 1}, {315, 64}}, {{1, 10}, {1, 11}}},
    {"SPIKY", SPHG_SPIKY, spiky, {{10, 1}, {15, 1}}, {{1, 14}, {1, 14}}},
};

enum { KERNELS = sizeof TABLE / sizeof *TABLE, NODES = 16 };

static const double RADII[] = {1.0, 0.37, 3.0e-4, 2.0e5};

static const struct row *row_of(const test_case *test)
{
    return &TABLE[test->kernel];
}

static sphg_scheme scheme_of(const struct row *row, int dimension, double support_radius)
{
    sphg_scheme scheme = {0};
    scheme.dimension = dimension;
    scheme.kernel = row->kernel;
    scheme.support_radius = support_radius;
    return scheme;
}

static long double sigma_of(const struct row *row, int dimension)
{
    const long double *fraction = row->sigma[dimension - 2];
    return fraction[0] / (fraction[1] * PI);
}

static double value(const sphg_scheme *scheme, double r)
{
    double w = NAN;
    sphg_kernel_value(scheme, r, &w, NULL);
    return w;
}

static double slope_over_r(const sphg_scheme *scheme, double r)
{
    double s = NAN;
    sphg_kernel_value(scheme, r, NULL, &s);
    return s;
}

/* w'(q) by a finite difference with an imaginary step: no cancellation, so exact to rounding. */
static long double slope(const struct row *row, long double q)
{
    const long double step = 1e-25L;
    return cimagl(row->w(q + step * I)) / step;
}

/* w''(q) by central differences of w', for error bounds only. */
static long double curvature(const struct row *row, long double q)
{
    const long double step = 1e-5L;
    return (slope(row, q + step) - slope(row, q - step)) / (2 * step);
}

/* Gauss-Legendre nodes and weights on [-1, 1] by Newton's method: exact to degree 31. */
static void gauss(long double *node, long double *weight)
{
    for (int k = 0; k < NODES; ++k) {
        long double x = cosl(PI * (k + 0.75L) / (NODES + 0.5L)), derivative = 1;
        for (int step = 0; step < 50; ++step) {
            long double below = 1, here = x;
            for (int n = 2; n <= NODES; ++n) {
                const long double above = ((2 * n - 1) * x * here - (n - 1) * below) / n;
                below = here;
                here = above;
            }
            derivative = NODES * (x * here - below) / (x * x - 1);
            x -= here / derivative;
        }
        node[k] = x;
        weight[k] = 2 / ((1 - x * x) * derivative * derivative);
    }
}

typedef double radial(const sphg_scheme *scheme, double r);

/* int_a^b f(r) r^power dr; a and b inside one polynomial piece. */
static long double integral(const sphg_scheme *scheme, radial *f, int power, long double a,
                            long double b)
{
    long double node[NODES], weight[NODES], sum = 0;
    gauss(node, weight);
    for (int k = 0; k < NODES; ++k) {
        const double r = (double)((a + b) / 2 + (b - a) / 2 * node[k]);
        sum += weight[k] * f(scheme, r) * powl(r, power);
    }
    return sum * (b - a) / 2;
}

/* Over the whole support, piece by piece: every kernel's knots are multiples of H / 6. */
static long double whole_integral(const sphg_scheme *scheme, radial *f, int power)
{
    const long double piece = scheme->support_radius / 6.0L;
    long double sum = 0;
    for (int k = 0; k < 6; ++k)
        sum += integral(scheme, f, power, k * piece, (k + 1) * piece);
    return sum;
}

static void constants_equal_the_rational_values(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, dimension, 1);
    const long double *mu2 = row->mu2[dimension - 2];
    double found_sigma = NAN, found_mu2 = NAN, alone = NAN;
    sphg_kernel_constants(&scheme, &found_sigma, &found_mu2);
    const long double sigma = sigma_of(row, dimension), expected = mu2[0] / mu2[1];
    TEST_WITHIN(kernel_constant, (double)(fabsl(found_sigma - sigma) / sigma / UNIT), row->name);
    TEST_WITHIN(kernel_constant, (double)(fabsl(found_mu2 - expected) / expected / UNIT),
                row->name);
    sphg_kernel_constants(&scheme, &alone, NULL);
    assert_true(alone == found_sigma);
    sphg_kernel_constants(&scheme, NULL, &alone);
    assert_true(alone == found_mu2);
}

/* int W = 1, (1/H^2) int W x_k^2 = mu2, and - int x_k dW/dx_k = 1: KGC's full neighbourhood. */
static void integral_is_one_second_moment_mu2_and_gradient_moment_one(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const long double shell = dimension == 2 ? 2 * PI : 4 * PI;
    for (int k = 0; k < 4; ++k) {
        const sphg_scheme scheme = scheme_of(row, dimension, RADII[k]);
        const long double square = powl(RADII[k], 2), *mu2 = row->mu2[dimension - 2];
        const long double unity = shell * whole_integral(&scheme, value, dimension - 1);
        const long double moment =
            shell / dimension * whole_integral(&scheme, value, dimension + 1) / square;
        const long double gradient =
            -shell / dimension * whole_integral(&scheme, slope_over_r, dimension + 1);
        TEST_WITHIN(kernel_integral, (double)(fabsl(unity - 1) / UNIT), row->name);
        TEST_WITHIN(kernel_integral, (double)(fabsl(moment * mu2[1] / mu2[0] - 1) / UNIT),
                    row->name);
        TEST_WITHIN(kernel_integral, (double)(fabsl(gradient - 1) / UNIT), row->name);
    }
}

/* The error is measured against |f| + q |f'|: q = r/H is rounded before anything else. */
static void values_equal_the_closed_form(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    for (int k = 0; k < 4; ++k) {
        const double H = RADII[k];
        const sphg_scheme scheme = scheme_of(row, dimension, H);
        const long double scale = sigma_of(row, dimension) / powl(H, dimension);
        for (int n = 32; n < 1024; ++n) {
            const double r = H * (n / 1024.0);
            const long double q = (long double)r / H, s = slope(row, q) / q;
            const long double w = creall(row->w(q));
            const long double w_size = fabsl(w) + q * fabsl(slope(row, q));
            const long double s_size = 2 * fabsl(s) + fabsl(curvature(row, q));
            const long double w_error = fabsl(value(&scheme, r) / scale - w);
            const long double s_error = fabsl(slope_over_r(&scheme, r) / scale * H * H - s);
            TEST_WITHIN(kernel_value, (double)(w_error / w_size / UNIT), row->name);
            TEST_WITHIN(kernel_value, (double)(s_error / s_size / UNIT), row->name);
        }
    }
}

/* ---- The same from the centre to the rim, in the passes, too --------------------------------- */

/* Where sums of truncated powers would cancel, near 0, the places stand close. f32 holds them all.
 */
enum { PLACES = 128 + 512 + 1024 };

static double place(int n)
{
    if (n < 128)
        return (double)(float)exp2(-n / 8.0 - 4);
    return n < 128 + 512 ? (double)(float)((n - 127.7) / 8192) : (n - 639.5) / 1024;
}

/* What is found of w(q) and w'(q)/q at place n, beside the reference: over |f| + q |f'|. */
static void require_shape(const struct row *row, int n, double w, double s, double u)
{
    quad exact[3], q = place(n);
    oracle_shape_of(row->kernel, q, exact);
    const quad slope = exact[1] / q, w_size = quad_abs(exact[0]) + q * quad_abs(exact[1]);
    const quad s_size = 2 * quad_abs(slope) + quad_abs(exact[2]);
    TEST_WITHIN(kernel_value, (double)(quad_abs(w - exact[0]) / w_size) / u, row->name);
    TEST_WITHIN(kernel_value, (double)(quad_abs(s - slope) / s_size) / u, row->name);
}

static void values_keep_their_digits_near_the_centre(const test_case *test)
{
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, test->dimension, 1);
    const double sigma = (double)sigma_of(row, test->dimension);
    for (int n = 0; n < PLACES; ++n)
        require_shape(row, n, value(&scheme, place(n)) / sigma,
                      slope_over_r(&scheme, place(n)) / sigma, (double)UNIT);
}

/* One target at 0 for each source at place(n) on the first axis, H = V = 1: what operators sum is
 * a single W or W' each. */
static sphg_neighbors *lonely_pairs(const test_case *test, sphg_context *context,
                                    const sphg_scheme *scheme)
{
    const int d = test->dimension;
    double *sources = test_memory((size_t)(PLACES * d) * sizeof *sources);
    double *targets = test_memory((size_t)(PLACES * d) * sizeof *targets);
    int64_t *offsets = test_memory((PLACES + 1) * sizeof *offsets);
    int32_t *indices = test_memory(PLACES * sizeof *indices);
    for (int n = 0; n < PLACES; ++n) {
        sources[n * d] = place(n);
        indices[n] = n;
        offsets[n + 1] = n + 1;
    }
    const sphg_type type = test_position_type(test);
    const setup_array from = setup_numbers(type, PLACES, d, sources);
    const setup_array to = setup_numbers(type, PLACES, d, targets);
    const sphg_geometry geometry = {.sources = setup_view(&from),
                                    .targets = setup_view(&to),
                                    .source_count = PLACES,
                                    .target_count = PLACES,
                                    .precision = test_field_type(test)};
    const sphg_lists lists = {.offsets = offsets, .indices = indices};
    return setup_lists(context, scheme, &geometry, &lists);
}

/* sum A_j V_j W and sum A_j V_j W'/r x_ij of A = 1. */
static void sum_pairs(const test_case *test, sphg_context *context, const sphg_scheme *scheme,
                      setup_array *values, setup_array *gradients)
{
    const sphg_type type = test_field_type(test);
    const double one = 1;
    const setup_array ones = setup_numbers(type, 1, 1, &one);
    sphg_view everywhere = setup_view(&ones);
    everywhere.stride = 0;
    const sphg_sources sources = {.neighbors = lonely_pairs(test, context, scheme),
                                  .volume = everywhere};
    *values = setup_output(type, PLACES, 1);
    *gradients = setup_output(type, PLACES, test->dimension);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_DIRECT,
                              .at_sources = &everywhere,
                              .value = setup_view(values),
                              .gradient = setup_view(gradients)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    SETUP_OK(context, sphg_evaluate(context, scheme, &request));
}

static void passes_keep_their_digits_on_every_instruction_set(const test_case *test)
{
    const struct row *row = row_of(test);
    const double sigma = (double)sigma_of(row, test->dimension);
    sphg_scheme scheme = scheme_of(row, test->dimension, 1);
    scheme.method = SPHG_PLAIN;
    for (int isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_context_on((sphg_isa)isa);
        setup_array values, gradients;
        if (!context)
            continue;
        sum_pairs(test, context, &scheme, &values, &gradients);
        for (int n = 0; n < PLACES; ++n)
            require_shape(row, n, setup_get(&values, n, 0) / sigma,
                          setup_get(&gradients, n, 0) / (sigma * -place(n)),
                          test_unit_roundoff(test));
    }
}

/* |(W(r + h) - W(r - h)) / 2h - W'| <= h^2/6 max |W'''| + rounding of W / h; the third derivative
 * jumps at knots, hence the factor 2 over its value nearby. */
static void slope_agrees_with_central_differences(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, dimension, 1);
    const long double scale = sigma_of(row, dimension), step = ldexpl(1, -16);
    const long double rounding = 8 * UNIT * creall(row->w(0)) / step;
    for (int n = 8; n < 1000; ++n) {
        const double r = n / 1000.0, above = r + (double)step, below = r - (double)step;
        const long double central = (value(&scheme, above) - value(&scheme, below)) / (2 * step);
        const long double third =
            fabsl(curvature(row, r + 1e-3L) - curvature(row, r - 1e-3L)) / 2e-3L;
        const long double bound = step * step / 3 * (third + 100) + rounding;
        const long double error = fabsl(central - slope_over_r(&scheme, r) * r) / scale;
        if (error > bound)
            fail_msg("%s %dD r = %g: %Lg > %Lg", row->name, dimension, r, error, bound);
    }
}

/* int_a^b W' dr = W(b) - W(a) on 384 intervals: no step to choose, and r -> 0 is included. */
static void slope_integrates_back_to_the_value(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, dimension, 3.0);
    const double top = value(&scheme, 0);
    for (int n = 0; n < 384; ++n) {
        const double a = n / 128.0, b = (n + 1) / 128.0;
        const long double sum = integral(&scheme, slope_over_r, 1, a, b);
        const long double rise = (long double)value(&scheme, b) - value(&scheme, a);
        TEST_WITHIN(kernel_slope, (double)(fabsl(sum - rise) / top / UNIT), row->name);
    }
}

static void kernel_is_zero_from_the_support_radius_on(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    for (int k = 0; k < 200; ++k) { /* radii whose r (1/H) rounds below 1 among them */
        const double H = RADII[k % 4] * (1 + k / 211.0);
        const sphg_scheme scheme = scheme_of(row, dimension, H);
        const double outside[] = {H, nextafter(H, INFINITY), 1.5 * H, 1e300, DBL_MAX, INFINITY};
        for (int n = 0; n < 6; ++n) {
            assert_true(value(&scheme, outside[n]) == 0);
            assert_true(slope_over_r(&scheme, outside[n]) == 0);
        }
        assert_true(value(&scheme, 0.99 * H) > 0);
        assert_true(slope_over_r(&scheme, 0.99 * H) < 0);
    }
}

static void kernel_is_finite_everywhere(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, dimension, 1);
    const double tiny[] = {0, -0.0, 5e-324, DBL_MIN, 1e-200, 1e-30, 1e-8};
    for (int n = 0; n < 7; ++n) {
        const double s = slope_over_r(&scheme, tiny[n]);
        const int unbounded = row->kernel == SPHG_SPIKY && tiny[n] > 0 && tiny[n] < 1e-300;
        assert_true(isfinite(value(&scheme, tiny[n])));
        assert_true(unbounded || isfinite(s));
        if (row->kernel != SPHG_SPIKY) /* smooth: s(q) = s(0) + O(q) */
            assert_true(fabs(s / slope_over_r(&scheme, 0) - 1) <= 1e3 * tiny[n]);
    }
    if (row->kernel == SPHG_SPIKY)
        assert_true(slope_over_r(&scheme, 0) == 0);
    else
        assert_true(slope_over_r(&scheme, 0) < 0);
}

/* Rounding may lift a value over its neighbour's by its own error near H, not by more. */
static void kernel_decreases_and_stays_positive(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme scheme = scheme_of(row, dimension, 0.7);
    double previous = value(&scheme, 0);
    for (int n = 1; n < 4096; ++n) {
        const double r = 0.7 * n / 4096, here = value(&scheme, r);
        assert_true(here < previous);
        assert_true(here > 0);
        assert_true(slope_over_r(&scheme, r) < 0);
        previous = here;
    }
}

static void scaling_by_powers_of_two_is_exact(const test_case *test)
{
    const int dimension = test->dimension;
    const struct row *row = row_of(test);
    const sphg_scheme unit = scheme_of(row, dimension, 1);
    for (int k = -100; k <= 100; k += 25) {
        const sphg_scheme scaled = scheme_of(row, dimension, ldexp(1, k));
        for (int n = 0; n <= 64; ++n) {
            const double r = n / 61.0, far = ldexp(r, k);
            assert_true(ldexp(value(&scaled, far), dimension * k) == value(&unit, r));
            assert_true(ldexp(slope_over_r(&scaled, far), (dimension + 2) * k) ==
                        slope_over_r(&unit, r));
        }
    }
}

static void both_outputs_are_optional(const test_case *test)
{
    (void)test;
    const sphg_scheme scheme = scheme_of(&TABLE[0], 3, 1);
    double w = NAN, s = NAN;
    sphg_kernel_value(&scheme, 0.3, &w, &s);
    assert_true(w == value(&scheme, 0.3));
    assert_true(s == slope_over_r(&scheme, 0.3));
    sphg_kernel_value(&scheme, 0.3, NULL, NULL);
    sphg_kernel_constants(&scheme, NULL, NULL);
}

static void zero_dimension_means_three(const test_case *test)
{
    (void)test;
    for (int k = 0; k < KERNELS; ++k) {
        const sphg_scheme none = scheme_of(&TABLE[k], 0, 2), three = scheme_of(&TABLE[k], 3, 2);
        assert_true(value(&none, 0.5) == value(&three, 0.5));
        assert_true(value(&none, 0.5) > 0);
    }
}

static void expect_nan(int dimension, int kernel, double support_radius, int constants_too)
{
    sphg_scheme scheme = {0};
    double found[4] = {1, 1, 1, 1};
    scheme.dimension = dimension;
    scheme.kernel = (sphg_kernel)kernel;
    scheme.support_radius = support_radius;
    sphg_kernel_value(&scheme, 0.5, &found[0], &found[1]);
    assert_true(isnan(found[0]) && isnan(found[1]));
    sphg_kernel_constants(&scheme, &found[2], &found[3]);
    if (constants_too)
        assert_true(isnan(found[2]) && isnan(found[3]));
}

static void scheme_that_is_not_valid_gives_nan(const test_case *test)
{
    (void)test;
    const int dimensions[] = {1, 4, -1, INT_MIN, INT_MAX}, kernels[] = {-1, 7, INT_MIN, INT_MAX};
    const double radii[] = {0, -0.0, -1, NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 5; ++k)
        expect_nan(dimensions[k], 0, 1, 1);
    for (int k = 0; k < 4; ++k)
        expect_nan(3, kernels[k], 1, 1);
    for (int k = 0; k < 6; ++k)
        expect_nan(2, 1, radii[k], 0);
}

#define EACH(property) TEST_ENTRY(property, 0, TEST_BOTH_DIMENSIONS, 0, TEST_ALL_KERNELS)

static const test_entry entries[] = {
    EACH(constants_equal_the_rational_values),
    EACH(integral_is_one_second_moment_mu2_and_gradient_moment_one),
    EACH(values_equal_the_closed_form),
    EACH(values_keep_their_digits_near_the_centre),
    TEST_ENTRY(passes_keep_their_digits_on_every_instruction_set, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, TEST_ALL_KERNELS),
    EACH(slope_agrees_with_central_differences),
    EACH(slope_integrates_back_to_the_value),
    EACH(kernel_is_zero_from_the_support_radius_on),
    EACH(kernel_is_finite_everywhere),
    EACH(kernel_decreases_and_stays_positive),
    EACH(scaling_by_powers_of_two_is_exact),
    TEST_ONCE(both_outputs_are_optional),
    TEST_ONCE(zero_dimension_means_three),
    TEST_ONCE(scheme_that_is_not_valid_gives_nan),
};
TEST_MAIN(entries)
