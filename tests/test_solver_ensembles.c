/* SPDX-License-Identifier: MIT */
/* Eigenvalues, singular values and thresholds of many small matrices, adversarial ones included,
 * against quadruple precision. SPHG_TEST_LONG=1 takes ten million for each precision. */
#include "support/setup.h"
#include "support/long_counts.h"
#include "support/oracle_matrix.h"
#include "support/spectra.h"
#include <math.h>
#include <string.h>

enum { BATCH = 1000 };

typedef struct ensemble {
    int dimension, is_double;
    sphg_type type;
    double unit, grain; /* u; the smallest positive number */
    sphg_context *context;
    random_state random;
    setup_array matrices, full; /* packed; row-major for the SVD */
    double numbers[BATCH * 9];  /* row-major, d x d */
    quad exact[BATCH * 3];      /* eigenvalues of symmetric matrices, descending */
    setup_array values, vectors, u, sigma, v, correction, rank;
} ensemble;

static ensemble *ensemble_of(const test_case *test, uint64_t seed)
{
    ensemble *own = test_memory(sizeof *own);
    const int d = test->dimension, width = d * (d + 1) / 2;
    own->dimension = d;
    own->is_double = test->precision == TEST_F64;
    own->type = test_field_type(test);
    own->unit = test_unit_roundoff(test);
    own->grain = own->is_double ? 0x1p-1074 : 0x1p-149;
    own->context = setup_context_of(2);
    own->random = random_seeded(seed);
    own->matrices = setup_output(own->type, BATCH, width);
    own->full = setup_output(own->type, BATCH, 9);
    own->values = setup_output(own->type, BATCH, d);
    own->vectors = setup_output(own->type, BATCH, d * d);
    own->u = setup_output(own->type, BATCH, 9);
    own->sigma = setup_output(own->type, BATCH, 3);
    own->v = setup_output(own->type, BATCH, 9);
    own->correction = setup_output(own->type, BATCH, width);
    own->rank = setup_output(SPHG_U8, BATCH, 1);
    return own;
}

/* In quad, descending. */
static void exact_values(int d, const double *a, quad *values)
{
    oracle_matrix matrix = {{0}}, vectors;
    quad found[oracle_rows] = {0};
    for (int k = 0; k < d * d; ++k)
        matrix[k / d][k % d] = (quad)a[k];
    oracle_eigen(d, matrix, found, vectors);
    for (int k = 0; k < d; ++k) {
        int place = 0;
        for (int l = 0; l < d; ++l)
            place += found[l] > found[k] || (found[l] == found[k] && l < k);
        values[place] = found[k];
    }
}

static void fill(ensemble *own, spectrum set)
{
    const int d = own->dimension;
    for (int i = 0, next = 0; i < BATCH; ++i) {
        double *a = own->numbers + 9 * i;
        spectra_matrix(set, d, own->is_double, &own->random, a);
        for (int r = 0; r < d; ++r)
            for (int c = r; c < d; ++c)
                setup_put(&own->matrices, next++, a[r * d + c]);
        for (int k = 0; k < 9 && d == 3; ++k)
            setup_put(&own->full, 9 * i + k, a[k]);
        if ((int)set < (int)SPECTRA_SYMMETRIC)
            exact_values(d, a, own->exact + 3 * i);
    }
}

/* ---- Residuals ---------------------------------------------------------------------------- */

static long double size_of(const ensemble *own, const double *a)
{
    long double sum = 0;
    for (int k = 0; k < own->dimension * own->dimension; ++k)
        sum += (long double)a[k] * a[k];
    return sqrtl(sum);
}

/* |A - U diag(values) V^T| / (u |A|), less what rounding to denormals explains. */
static double residual(const ensemble *own, const double *a, const double *u, const double *values,
                       const double *v)
{
    const int d = own->dimension;
    long double sum = 0;
    for (int r = 0; r < d; ++r)
        for (int c = 0; c < d; ++c) {
            long double rest = a[r * d + c];
            for (int k = 0; k < d; ++k)
                rest -= (long double)u[r * d + k] * values[k] * v[c * d + k];
            sum += rest * rest;
        }
    const long double excess = sqrtl(sum) - 2 * (long double)own->grain;
    return excess <= 0 ? 0 : (double)(excess / (own->unit * size_of(own, a)));
}

static double skew(const ensemble *own, const double *q)
{
    const int d = own->dimension;
    long double sum = 0;
    for (int j = 0; j < d; ++j)
        for (int k = 0; k < d; ++k) {
            long double dot = j == k ? -1 : 0;
            for (int r = 0; r < d; ++r)
                dot += (long double)q[r * d + j] * q[r * d + k];
            sum += dot * dot;
        }
    return (double)(sqrtl(sum) / own->unit);
}

static void within(const ensemble *own, double ratio, const char *where)
{
    if (own->is_double)
        TEST_WITHIN(solver_double, ratio, where);
    else
        TEST_WITHIN(solver_single, ratio, where);
}

static void numbers_of(const setup_array *array, int item, double *numbers)
{
    for (int k = 0; k < array->width; ++k)
        numbers[k] = setup_get(array, item, k);
}

/* ---- Eigenvalues -------------------------------------------------------------------------- */

static void check_eigen(const ensemble *own, const char *where)
{
    const int d = own->dimension;
    SETUP_OK(own->context, sphg_eigen(own->context, d, BATCH, setup_view(&own->matrices),
                                      setup_view(&own->values), setup_view(&own->vectors)));
    for (int i = 0; i < BATCH; ++i) {
        const double *a = own->numbers + 9 * i;
        double values[3], q[9];
        const quad *exact = own->exact + 3 * i;
        numbers_of(&own->values, i, values);
        numbers_of(&own->vectors, i, q);
        within(own, residual(own, a, q, values, q), where);
        within(own, skew(own, q), where);
        const long double scale = own->unit * size_of(own, a) + 2 * (long double)own->grain;
        for (int k = 0; k < d && scale > 0; ++k)
            within(own, (double)(quad_abs(exact[k] - (quad)values[k]) / (quad)scale), where);
    }
}

/* ---- Singular values ---------------------------------------------------------------------- */

static void check_svd(const ensemble *own, const char *where)
{
    SETUP_OK(own->context,
             sphg_svd(own->context, BATCH, setup_view(&own->full), setup_view(&own->u),
                      setup_view(&own->sigma), setup_view(&own->v)));
    for (int i = 0; i < BATCH; ++i) {
        double u[9], sigma[3], v[9];
        numbers_of(&own->u, i, u);
        numbers_of(&own->sigma, i, sigma);
        numbers_of(&own->v, i, v);
        within(own, residual(own, own->numbers + 9 * i, u, sigma, v), where);
        within(own, skew(own, u), where);
        within(own, skew(own, v), where);
        TEST_REQUIRE(sigma[0] >= sigma[1] && sigma[1] >= sigma[2] && sigma[2] >= 0,
                     "%s: sigma of matrix %d", where, i);
    }
}

/* ---- Thresholds --------------------------------------------------------------------------- */

/* Under KGC the moments are normalised as they are. */
typedef struct decision {
    int rank, is_close, is_touched;
} decision;

static decision decide(const ensemble *own, const sphg_scheme *scheme, int i)
{
    const quad *values = own->exact + 3 * i;
    const int d = own->dimension;
    decision made = {0, 0, 0};
    quad trace = 0;
    for (int k = 0; k < d; ++k)
        trace += values[k];
    const quad eps = quad_max((quad)scheme->threshold, 16 * (quad)own->unit * trace);
    const quad full = scheme->policy == SPHG_BLEND ? 4 * eps : eps;
    for (int k = 0; k < d; ++k) {
        const quad gap = quad_abs(values[k] - full);
        made.rank += values[k] > full;
        made.is_close |= gap <= 64 * (quad)own->unit * (quad)size_of(own, own->numbers + 9 * i) +
                                    (quad)own->grain;
    }
    made.is_touched = values[d - 1] < full;
    if (scheme->policy == SPHG_IDENTITY && made.is_touched)
        made.rank = 0;
    return made;
}

/* Ranks of all; and of the matrices that the rule touches, by themselves, none is certified. */
static int64_t check_thresholds(ensemble *own, sphg_policy policy, const char *where)
{
    const int d = own->dimension, width = own->matrices.width;
    const size_t item = (size_t)width * (own->is_double ? 8 : 4);
    sphg_scheme scheme = {.dimension = d, .support_radius = 1, .policy = policy};
    scheme.threshold = random_index(&own->random, 2) ? SPECTRA_THRESHOLD : 1e-4;
    sphg_stats stats;
    sphg_inversion wanted = {.rank = setup_view(&own->rank)};
    SETUP_OK(own->context, sphg_invert_moments(own->context, &scheme, BATCH,
                                               setup_view(&own->matrices), sphg_absent(), &wanted));
    int touched = 0;
    for (int i = 0; i < BATCH; ++i) {
        const decision expected = decide(own, &scheme, i);
        TEST_REQUIRE(expected.is_close || setup_get(&own->rank, i, 0) == expected.rank,
                     "%s, policy %d, eps %g, matrix %d: rank %g, not %d", where, (int)policy,
                     scheme.threshold, i, setup_get(&own->rank, i, 0), expected.rank);
        if (expected.is_touched)
            memmove((char *)own->matrices.data + (size_t)touched++ * item,
                    (const char *)own->matrices.data + (size_t)i * item, item);
    }
    wanted = (sphg_inversion){.stats = &stats};
    SETUP_OK(own->context, sphg_invert_moments(own->context, &scheme, touched,
                                               setup_view(&own->matrices), sphg_absent(), &wanted));
    TEST_REQUIRE(stats.certified == 0, "%s: %lld touched matrices were certified", where,
                 (long long)stats.certified);
    return touched;
}

/* ---- Properties --------------------------------------------------------------------------- */

/* A share of the matrices in 2D, and fewer under sanitizers. */
static int batches_of(const test_case *test)
{
    const int all = long_or(10000, TEST_SLOWED ? 21 : 100);
    return test->dimension == 3 ? all : (all + 4) / 5;
}

static void solvers_and_thresholds_are_right_on_any_spectrum(const test_case *test)
{
    ensemble *own = ensemble_of(test, 701);
    int64_t touched = 0;
    const int batches = batches_of(test);
    for (int k = 0; k < batches; ++k) {
        const spectrum set = (spectrum)(k % SPECTRA_COUNT);
        fill(own, set);
        if (test->dimension == 3)
            check_svd(own, spectra_names[set]);
        if ((int)set >= (int)SPECTRA_SYMMETRIC)
            continue;
        check_eigen(own, spectra_names[set]);
        touched += check_thresholds(own, (sphg_policy)(k / SPECTRA_COUNT % 4), spectra_names[set]);
    }
    print_message("%lld matrices; %lld were touched, none of them certified\n",
                  (long long)batches * BATCH, (long long)touched);
    assert_true(touched > batches);
}

static const test_entry entries[] = {
    TEST_ENTRY(solvers_and_thresholds_are_right_on_any_spectrum, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
