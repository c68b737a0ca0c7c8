/* SPDX-License-Identifier: MIT */
/* Heat problems whose solutions are known, solved with the Laplacian of the adjoint form: their
 * errors are those that an independent program found; and what happens in time to each Laplacian.
 */
#include "support/setup.h"
#include <math.h>

typedef struct plate {
    const test_case *test;
    cloud points;
    double spacing;
    sphg_context *context;
    sphg_scheme scheme;
    sphg_sources sources;
    double *volume, *correction, *k; /* k NULL: 1 */
} plate;

/* side x side particles in [-1, 1]^2. */
static plate plate_of(const test_case *test, int side, double jitter, double support)
{
    random_state random = random_seeded(61);
    plate made = {.test = test, .spacing = 2. / side};
    made.points = cloud_jittered(2, side, made.spacing, jitter, &random);
    for (int k = 0; k < 2 * made.points.count; ++k)
        made.points.x[k] += made.spacing / 2 - 1;
    made.context = setup_context();
    made.scheme = setup_scheme(test, support * made.spacing);
    const setup_array x = setup_positions(test, &made.points);
    sphg_geometry geometry = setup_geometry(test, &made.points, &x);
    geometry.keep_weights = 1;
    made.sources.neighbors = setup_search(made.context, &made.scheme, &geometry);
    return made;
}

static void request_one(const plate *on, const sphg_scheme *scheme, const sphg_field *field)
{
    const sphg_request request = {
        .sources = &on->sources, .fields = field, .set_count = 1, .field_count = 1};
    SETUP_OK(on->context, sphg_evaluate(on->context, scheme, &request));
}

static double *numbers_of(const plate *on, int width)
{
    return test_memory((size_t)(on->points.count * width) * sizeof(double));
}

static void give_table(plate *on)
{
    const sphg_view table = sphg_view_f64(on->correction, 3 * sizeof *on->correction);
    SETUP_OK(on->context,
             sphg_correction(on->context, &on->scheme, &on->sources, NULL, table, sphg_absent()));
    on->sources.correction = table;
}

/* V = 1 / sum W, or all alike; then the table. */
static void give_volumes(plate *on, int alike)
{
    static const double one = 1;
    const int n = on->points.count;
    on->volume = numbers_of(on, 1);
    on->correction = numbers_of(on, 3);
    const sphg_view ones = sphg_same_f64(&one);
    on->sources.volume = ones;
    sphg_field sum = {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &ones};
    sum.value = sphg_view_f64(on->volume, sizeof *on->volume);
    request_one(on, &on->scheme, &sum);
    for (int i = 0; i < n; ++i)
        on->volume[i] = alike ? on->spacing * on->spacing : 1 / on->volume[i];
    on->sources.volume = sphg_view_f64(on->volume, sizeof *on->volume);
    on->sources.same_volumes = 0;
    on->sources.correction = sphg_absent();
    if (on->scheme.method != SPHG_PLAIN)
        give_table(on);
    on->sources.same_volumes = 1;
}

static void flow(const plate *on, const double *u, double *result)
{
    const sphg_view values = sphg_view_f64(u, sizeof *u),
                    k = on->k ? sphg_view_f64(on->k, sizeof *on->k) : sphg_absent();
    sphg_field field = {.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &values};
    field.laplacian = sphg_view_f64(result, sizeof *result);
    field.coefficient = on->k ? &k : NULL;
    request_one(on, &on->scheme, &field);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; ++i)
        sum += a[i] * b[i];
    return sum;
}

/* (V - .1 L) u = V f by conjugate gradients. */
static double *solved(const plate *on, const double *f)
{
    const int n = on->points.count;
    double *u = numbers_of(on, 1), *r = numbers_of(on, 1), *p = numbers_of(on, 1),
           *q = numbers_of(on, 1);
    for (int i = 0; i < n; ++i)
        p[i] = r[i] = on->volume[i] * f[i];
    double square = dot(n, r, r);
    const double end = 1e-16 * square;
    for (int step = 0; square > end; ++step) {
        TEST_REQUIRE(step < 2000, "no solution after %d steps", step);
        flow(on, p, q);
        for (int i = 0; i < n; ++i)
            q[i] = on->volume[i] * p[i] - .1 * q[i];
        const double a = square / dot(n, p, q), before = square;
        for (int i = 0; i < n; ++i) {
            u[i] += a * p[i];
            r[i] -= a * q[i];
        }
        square = dot(n, r, r);
        for (int i = 0; i < n; ++i)
            p[i] = r[i] + square / before * p[i];
    }
    return u;
}

typedef struct errors {
    double rms, most;
} errors;

static errors errors_of(const plate *on, const double *u, const double *exact)
{
    errors found = {0, 0};
    for (int i = 0; i < on->points.count; ++i) {
        const double error = fabs(u[i] - exact[i]);
        found.rms += error * error / on->points.count;
        found.most = test_larger(found.most, error);
    }
    found.rms = sqrt(found.rms);
    return found;
}

/* u = cos pi x cos pi y, whose slope is 0 at the edges. */
static errors wave(plate on, int alike)
{
    const double pi = acos(-1);
    give_volumes(&on, alike);
    double *f = numbers_of(&on, 1), *exact = numbers_of(&on, 1);
    for (int i = 0; i < on.points.count; ++i) {
        exact[i] = cos(pi * on.points.x[2 * i]) * cos(pi * on.points.x[2 * i + 1]);
        f[i] = (1 + .2 * pi * pi) * exact[i];
    }
    return errors_of(&on, solved(&on, f), exact);
}

static void agrees(double found, double printed, double digit, const char *what)
{
    TEST_REQUIRE(fabs(found - printed) <= .51 * digit, "%s: %.6f, not %.6f", what, found, printed);
}

static void errors_of_waves_are_known(const test_case *test)
{
    static const double kgc[2][3] = {{.01405, .00563, .00255}, {.00776, .00265, .00127}},
                        most[3] = {.0547, .0248, .0118}, plain[3] = {.01668, .00660, .00286};
    for (int size = 0; size < 3; ++size) {
        const plate on = plate_of(test, 20 << size, 0, 2);
        for (int alike = 0; alike <= (test->method == SPHG_KGC); ++alike) {
            const errors found = wave(on, alike);
            if (test->method == SPHG_KGC)
                agrees(found.rms, kgc[alike][size], 1e-5, test_text("side %d", 20 << size));
            else if (!alike)
                agrees(found.rms, plain[size], 1e-5, test_text("side %d", 20 << size));
            if (test->method == SPHG_KGC && !alike)
                agrees(found.most, most[size], 1e-4, test_text("largest, side %d", 20 << size));
        }
    }
}

/* On the same disordered particles corrected methods are nearer, and come nearer. */
static void solutions_converge_on_disorder(const test_case *test)
{
    double error[2], plain[2];
    for (int fine = 0; fine < 2; ++fine) {
        plate on = plate_of(test, 20 << fine, .2, 2);
        error[fine] = wave(on, 0).rms;
        on.scheme.method = SPHG_PLAIN;
        plain[fine] = wave(on, 0).rms;
    }
    TEST_REQUIRE(error[1] < .75 * error[0], "%g, then %g", error[0], error[1]);
    for (int fine = 0; fine < 2; ++fine)
        TEST_REQUIRE(error[fine] < .75 * plain[fine], "%g, plain %g", error[fine], plain[fine]);
}

/* Slabs of k = 1 and 10: what flows through both is the same. */
static void slabs_in_series_are_known(const test_case *test)
{
    static const double rms[3] = {.00384, .00192, .00097};
    const double pi = acos(-1);
    for (int size = 0; size < 3; ++size) {
        plate on = plate_of(test, 20 << size, 0, 2);
        give_volumes(&on, 0);
        on.k = numbers_of(&on, 1);
        double *f = numbers_of(&on, 1), *exact = numbers_of(&on, 1);
        for (int i = 0; i < on.points.count; ++i) {
            const double s = sin(pi * on.points.x[2 * i] / 2);
            on.k[i] = on.points.x[2 * i] < 0 ? 1 : 10;
            exact[i] = s / on.k[i];
            f[i] = exact[i] + .1 * pi * pi / 4 * s;
        }
        agrees(errors_of(&on, solved(&on, f), exact).rms, rms[size], 1e-5,
               test_text("slabs, side %d", 20 << size));
    }
}

/* Explicit steps of a tenth of spacing^2: the sum of pairs lets extremes decay, the exact Laplacian
 * blows up at the free edges. */
static void one_decays_and_the_other_blows_up(const test_case *test)
{
    plate on = plate_of(test, 20, .2, 3);
    const int n = on.points.count;
    give_volumes(&on, 0);
    double *u = numbers_of(&on, 1), *rate = numbers_of(&on, 1), largest[2] = {0, 0};
    const double dt = .1 * on.spacing * on.spacing;
    sphg_scheme second = on.scheme;
    second.order = 2;
    for (int exact = 0; exact < 2; ++exact) {
        for (int i = 0; i < n; ++i)
            u[i] = cos(40 * on.points.x[2 * i]) * cos(33 * on.points.x[2 * i + 1]);
        double before = 1;
        for (int step = 0; step < 200; ++step) {
            const sphg_view values = sphg_view_f64(u, sizeof *u);
            sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &values};
            field.laplacian = sphg_view_f64(rate, sizeof *rate);
            plate bare = on; /* order 2 has another table */
            bare.sources.correction = sphg_absent();
            if (exact)
                request_one(&bare, &second, &field);
            else
                flow(&on, u, rate);
            largest[exact] = 0;
            for (int i = 0; i < n; ++i) {
                u[i] += dt * rate[i] / (exact ? 1 : on.volume[i]);
                largest[exact] = test_larger(largest[exact], fabs(u[i]));
            }
            TEST_REQUIRE(exact || largest[0] <= before, "grows in step %d", step);
            before = largest[0];
        }
    }
    TEST_REQUIRE(largest[0] < .1 && largest[1] > 10, "pairs end at %g, order 2 at %g", largest[0],
                 largest[1]);
}

static const test_entry entries[] = {
    TEST_ENTRY(errors_of_waves_are_known, TEST_BIT(TEST_F64), TEST_2D,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(solutions_converge_on_disorder, TEST_BIT(TEST_F64), TEST_2D, TEST_LINEARISED, 0),
    TEST_ENTRY(slabs_in_series_are_known, TEST_BIT(TEST_F64), TEST_2D, TEST_BIT(SPHG_KGC), 0),
    TEST_ENTRY(one_decays_and_the_other_blows_up, TEST_BIT(TEST_F64), TEST_2D, TEST_BIT(SPHG_KGC),
               0),
};
TEST_MAIN(entries)
