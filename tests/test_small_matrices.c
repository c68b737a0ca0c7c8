/* SPDX-License-Identifier: MIT */
/* sphg_eigen and sphg_svd on random and adversarial matrices, judged by residual beside LAPACK:
 * near multiple eigenvalues no vector is right or wrong, but the product must be. */
#include "support/setup.h"
#include "support/spectra.h"
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { BATCH = 1500 };

typedef struct batch {
    int dimension, is_double, count;
    double unit;  /* u */
    double grain; /* the smallest positive number: what rounding to a denormal may lose */
    double *full; /* d x d, row-major */
} batch;

static batch batch_of(const test_case *test, spectrum set)
{
    batch items = {test->dimension, test->precision == TEST_F64, BATCH, 0, 0, NULL};
    random_state random = random_seeded(100 + (uint64_t)set);
    items.unit = test_unit_roundoff(test);
    items.grain = items.is_double ? 0x1p-1074 : 0x1p-149;
    items.full = test_memory((size_t)(items.count * 9) * sizeof(double));
    for (int i = 0; i < items.count; ++i)
        spectra_matrix(set, items.dimension, items.is_double, &random, items.full + 9 * i);
    return items;
}

/* xx xy xz yy yz zz of the symmetric matrices. */
static setup_array packed(const batch *items)
{
    const int d = items->dimension, width = d * (d + 1) / 2;
    double *numbers = test_memory((size_t)(items->count * width) * sizeof *numbers);
    for (int i = 0, next = 0; i < items->count; ++i)
        for (int r = 0; r < d; ++r)
            for (int c = r; c < d; ++c)
                numbers[next++] = items->full[9 * i + r * d + c];
    return setup_numbers(items->is_double ? SPHG_F64 : SPHG_F32, items->count, width, numbers);
}

static long double frobenius(int numbers, const double *a)
{
    long double sum = 0;
    for (int k = 0; k < numbers; ++k)
        sum += (long double)a[k] * a[k];
    return sqrtl(sum);
}

/* |A - U diag(values) V^T|_F / (u |A|_F), without what rounding to denormals explains. */
static double backward_error(const batch *items, const double *a, const double *u,
                             const double *values, const double *v)
{
    const int d = items->dimension;
    const long double size = frobenius(d * d, a);
    long double sum = 0;
    for (int r = 0; r < d; ++r)
        for (int c = 0; c < d; ++c) {
            long double rest = a[r * d + c];
            for (int k = 0; k < d; ++k)
                rest -= (long double)u[r * d + k] * values[k] * v[c * d + k];
            sum += rest * rest;
        }
    const long double excess = sqrtl(sum) - 2 * (long double)items->grain;
    return excess <= 0 ? 0 : (double)(excess / (items->unit * size));
}

/* |Q^T Q - I|_F / u. */
static double orthogonality(const batch *items, const double *q)
{
    const int d = items->dimension;
    long double sum = 0;
    for (int j = 0; j < d; ++j)
        for (int k = 0; k < d; ++k) {
            long double dot = j == k ? -1 : 0;
            for (int r = 0; r < d; ++r)
                dot += (long double)q[r * d + j] * q[r * d + k];
            sum += dot * dot;
        }
    return (double)(sqrtl(sum) / items->unit);
}

static double determinant(int d, const double *q)
{
    if (d == 2)
        return q[0] * q[3] - q[1] * q[2];
    return q[0] * (q[4] * q[8] - q[5] * q[7]) - q[1] * (q[3] * q[8] - q[5] * q[6]) +
           q[2] * (q[3] * q[7] - q[4] * q[6]);
}

/* Two gates, as the arithmetic is double throughout: f32 results carry the rounding of the output
 * alone, f64 results that of four sweeps. A NaN fails. */
static void within_gate(const batch *items, double ratio, const char *where)
{
    if (items->is_double)
        TEST_WITHIN(solver_double, ratio, where);
    else
        TEST_WITHIN(solver_single, ratio, where);
}

static void require_descending(const batch *items, const double *values, int index,
                               const char *where)
{
    for (int k = 1; k < items->dimension; ++k)
        TEST_REQUIRE(values[k - 1] >= values[k], "%s, matrix %d: values rise", where, index);
}

/* ---- Eigendecomposition ------------------------------------------------------------------- */

typedef struct factors {
    double *values, *vectors;
} factors;

static factors eigen_of(sphg_context *context, const batch *items)
{
    const int d = items->dimension;
    const setup_array matrices = packed(items);
    setup_array values = setup_output(matrices.type, items->count, d);
    setup_array vectors = setup_output(matrices.type, items->count, d * d);
    SETUP_OK(context, sphg_eigen(context, d, items->count, setup_view(&matrices),
                                 setup_view(&values), setup_view(&vectors)));
    return (factors){setup_doubles(&values), setup_doubles(&vectors)};
}

static void eigen_is_backward_stable(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    for (int set = 0; set < SPECTRA_SYMMETRIC; ++set) {
        const batch items = batch_of(test, (spectrum)set);
        const factors found = eigen_of(context, &items);
        for (int i = 0; i < items.count; ++i) {
            const double *q = found.vectors + d * d * i, *values = found.values + d * i;
            const double *a = items.full + 9 * i;
            within_gate(&items, backward_error(&items, a, q, values, q), spectra_names[set]);
            within_gate(&items, orthogonality(&items, q), spectra_names[set]);
            require_descending(&items, values, i, spectra_names[set]);
            TEST_REQUIRE(determinant(d, q) > 0.5, "%s: det Q is not 1", spectra_names[set]);
        }
    }
}

static void lapack_eigen(const batch *items, const double *a, double *values, double *vectors)
{
    const int d = items->dimension;
    float single[9], single_values[3];
    memcpy(vectors, a, (size_t)(d * d) * sizeof *a);
    for (int k = 0; k < d * d; ++k)
        single[k] = (float)a[k];
    if (items->is_double) {
        assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'L', d, vectors, d, values), 0);
        return;
    }
    assert_int_equal(LAPACKE_ssyev(LAPACK_ROW_MAJOR, 'V', 'L', d, single, d, single_values), 0);
    for (int k = 0; k < d * d; ++k)
        vectors[k] = (double)single[k];
    for (int k = 0; k < d; ++k)
        values[k] = (double)single_values[k];
}

/* Weyl: eigenvalues differ by no more than both residuals; LAPACK's ascend. */
static void eigenvalues_agree_with_lapack(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    for (int set = 0; set < SPECTRA_SYMMETRIC; ++set) {
        const batch items = batch_of(test, (spectrum)set);
        const factors found = eigen_of(context, &items);
        for (int i = 0; i < items.count; ++i) {
            const double *a = items.full + 9 * i;
            double values[3], vectors[9];
            lapack_eigen(&items, a, values, vectors);
            const double own = (double)frobenius(d * d, a) * items.unit + 2 * items.grain;
            TEST_WITHIN(lapack_residual, backward_error(&items, a, vectors, values, vectors),
                        spectra_names[set]);
            for (int k = 0; k < d; ++k)
                TEST_WITHIN(solver_against_lapack,
                            fabs(found.values[d * i + k] - values[d - 1 - k]) / own,
                            spectra_names[set]);
        }
    }
}

/* The long double reference is better than both by its eleven extra bits. */
static void eigenvalues_agree_with_the_reference(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    for (int set = 0; set < SPECTRA_SYMMETRIC; ++set) {
        const batch items = batch_of(test, (spectrum)set);
        const factors found = eigen_of(context, &items);
        for (int i = 0; i < items.count; ++i) {
            long double values[3], vectors[9];
            spectra_eigen(d, items.full + 9 * i, values, vectors);
            const long double own =
                frobenius(d * d, items.full + 9 * i) * items.unit + 2 * (long double)items.grain;
            for (int k = 0; k < d; ++k) {
                const long double error = fabsl(found.values[d * i + k] - values[k]);
                within_gate(&items, (double)(error / own), spectra_names[set]);
            }
        }
    }
}

/* ---- Singular values ---------------------------------------------------------------------- */

typedef struct singular {
    double *u, *sigma, *v;
} singular;

static singular svd_of(sphg_context *context, const batch *items)
{
    double *numbers = test_memory((size_t)(items->count * 9) * sizeof *numbers);
    memcpy(numbers, items->full, (size_t)(items->count * 9) * sizeof *numbers);
    const sphg_type type = items->is_double ? SPHG_F64 : SPHG_F32;
    const setup_array matrices = setup_numbers(type, items->count, 9, numbers);
    setup_array u = setup_output(type, items->count, 9), v = u;
    setup_array sigma = setup_output(type, items->count, 3);
    v.data = setup_output(type, items->count, 9).data;
    SETUP_OK(context, sphg_svd(context, items->count, setup_view(&matrices), setup_view(&u),
                               setup_view(&sigma), setup_view(&v)));
    return (singular){setup_doubles(&u), setup_doubles(&sigma), setup_doubles(&v)};
}

static void svd_is_backward_stable(const test_case *test)
{
    sphg_context *context = setup_context();
    for (int set = 0; set < SPECTRA_COUNT; ++set) {
        const batch items = batch_of(test, (spectrum)set);
        const singular found = svd_of(context, &items);
        for (int i = 0; i < items.count; ++i) {
            const double *u = found.u + 9 * i, *v = found.v + 9 * i, *sigma = found.sigma + 3 * i;
            const double *a = items.full + 9 * i;
            within_gate(&items, backward_error(&items, a, u, sigma, v), spectra_names[set]);
            within_gate(&items, orthogonality(&items, u), spectra_names[set]);
            within_gate(&items, orthogonality(&items, v), spectra_names[set]);
            require_descending(&items, sigma, i, spectra_names[set]);
            TEST_REQUIRE(sigma[2] >= 0, "%s: sigma < 0", spectra_names[set]);
        }
    }
}

static void lapack_svd(const batch *items, const double *a, double *sigma)
{
    double copy[9], u[9], v[9], spare[3];
    float single[9], single_sigma[3], single_u[9], single_v[9], single_spare[3];
    memcpy(copy, a, sizeof copy);
    for (int k = 0; k < 9; ++k)
        single[k] = (float)a[k];
    if (items->is_double) {
        assert_int_equal(
            LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', 3, 3, copy, 3, sigma, u, 3, v, 3, spare), 0);
        return;
    }
    assert_int_equal(LAPACKE_sgesvd(LAPACK_ROW_MAJOR, 'A', 'A', 3, 3, single, 3, single_sigma,
                                    single_u, 3, single_v, 3, single_spare),
                     0);
    for (int k = 0; k < 3; ++k)
        sigma[k] = (double)single_sigma[k];
}

static void singular_values_agree_with_lapack(const test_case *test)
{
    sphg_context *context = setup_context();
    for (int set = 0; set < SPECTRA_COUNT; ++set) {
        const batch items = batch_of(test, (spectrum)set);
        const singular found = svd_of(context, &items);
        for (int i = 0; i < items.count; ++i) {
            double sigma[3];
            lapack_svd(&items, items.full + 9 * i, sigma);
            const double own =
                (double)frobenius(9, items.full + 9 * i) * items.unit + 2 * items.grain;
            for (int k = 0; k < 3; ++k)
                TEST_WITHIN(solver_against_lapack, fabs(found.sigma[3 * i + k] - sigma[k]) / own,
                            spectra_names[set]);
        }
    }
}

/* ---- Units -------------------------------------------------------------------------------- */

static void require_scaled(const double *found, const double *expected, int count, int exponent,
                           const char *where)
{
    for (int k = 0; k < count; ++k)
        TEST_REQUIRE(found[k] == ldexp(expected[k], exponent), "%s: %.17g, not %.17g", where,
                     found[k], ldexp(expected[k], exponent));
}

/* In another unit, with numbers as large or as small as the type holds, the digits are the same. */
static void units_change_no_digit(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    batch items = batch_of(test, SPECTRA_indefinite);
    items.count = 100;
    for (int k = 0; k < 9 * items.count; ++k) /* eigenvalues below 1 / 2, digits that survive */
        items.full[k] =
            rint(ldexp(tanh(items.full[k]), 18)) * (k % 9 % (d + 1) == 0 ? 7 * 0x1p-22 : 0x1p-24);
    batch other = items;
    other.full = test_memory((size_t)(9 * items.count) * sizeof *other.full);
    const int f64[] = {-990, -900, -502, -498, 498, 502, 900, 1025};
    const int f32[] = {-95, -90, -50, 50, 100, 120, 126, 129};
    const factors expected = eigen_of(context, &items);
    const singular expected_svd = d == 3 ? svd_of(context, &items) : (singular){0};
    for (int k = 0; k < 8; ++k) {
        const int exponent = items.is_double ? f64[k] : f32[k];
        const char *where = test_text("times 2^%d", exponent);
        for (int i = 0; i < 9 * items.count; ++i)
            other.full[i] = ldexp(items.full[i], exponent);
        const factors found = eigen_of(context, &other);
        require_scaled(found.values, expected.values, d * items.count, exponent, where);
        require_scaled(found.vectors, expected.vectors, d * d * items.count, 0, where);
        if (d < 3)
            continue;
        const singular svd = svd_of(context, &other);
        require_scaled(svd.sigma, expected_svd.sigma, 3 * items.count, exponent, where);
        require_scaled(svd.u, expected_svd.u, 9 * items.count, 0, where);
        require_scaled(svd.v, expected_svd.v, 9 * items.count, 0, where);
    }
}

/* ---- Batches ------------------------------------------------------------------------------ */

/* A NaN or infinite matrix at each place in turn: all other items keep their bits. */
static void bad_matrix_spoils_only_itself(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    batch items = batch_of(test, SPECTRA_indefinite);
    items.count = 37;
    const factors clean = eigen_of(context, &items);
    for (int bad = 0; bad < items.count; ++bad) {
        double *a = items.full + 9 * bad, kept = a[d];
        a[1] = a[d] = bad % 3 == 0 ? NAN : bad % 3 == 1 ? INFINITY : -INFINITY;
        const factors found = eigen_of(context, &items);
        const singular other = d == 3 ? svd_of(context, &items) : (singular){0};
        for (int i = 0; i < items.count; ++i) {
            const size_t values = (size_t)d * sizeof(double), vectors = (size_t)d * values;
            if (i == bad)
                continue;
            assert_memory_equal(found.values + d * i, clean.values + d * i, values);
            assert_memory_equal(found.vectors + d * d * i, clean.vectors + d * d * i, vectors);
            if (d == 3)
                assert_true(isfinite(other.sigma[3 * i]) && isfinite(other.u[9 * i + 8]));
        }
        a[1] = a[d] = kept;
    }
}

/* One by one, the results have the same bits as in a batch. */
static void batches_do_not_change_results(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    const batch items = batch_of(test, SPECTRA_indefinite);
    const factors all = eigen_of(context, &items);
    batch one = items;
    one.count = 1;
    for (int i = 0; i < 100; ++i) {
        one.full = items.full + 9 * i;
        const factors found = eigen_of(context, &one);
        assert_memory_equal(found.values, all.values + d * i, (size_t)d * sizeof(double));
        assert_memory_equal(found.vectors, all.vectors + d * d * i,
                            (size_t)(d * d) * sizeof(double));
    }
}

static void invert(sphg_context *context, const batch *items)
{
    const int d = items->dimension, width = d * (d + 1) / 2;
    const setup_array moments = packed(items);
    const setup_array table = setup_output(moments.type, items->count, width);
    const setup_array rank = setup_output(SPHG_U8, items->count, 1);
    const setup_array lambda = setup_output(moments.type, items->count, 1);
    const setup_array volume = setup_output(moments.type, items->count, 1);
    const sphg_scheme scheme = {.dimension = d, .method = SPHG_MLS, .support_radius = 1};
    const sphg_inversion wanted = {.correction = setup_view(&table),
                                   .rank = setup_view(&rank),
                                   .lambda_min = setup_view(&lambda)};
    memset(volume.data, 0, (size_t)items->count * (items->is_double ? 8 : 4));
    SETUP_OK(context, sphg_invert_moments(context, &scheme, items->count, setup_view(&moments),
                                          setup_view(&volume), &wanted));
}

/* The arrays of a set-up end at a page that nobody may touch. Groups of lanes end, or do not end,
 * with the last matrix. */
static void nothing_behind_the_last_matrix_is_touched(const test_case *test)
{
    sphg_context *const contexts[] = {setup_context_of(1), setup_context()};
    batch items = batch_of(test, SPECTRA_indefinite);
    for (items.count = 1; items.count <= 100; ++items.count)
        for (int k = 0; k < 2; ++k) {
            eigen_of(contexts[k], &items);
            svd_of(contexts[k], &items);
            invert(contexts[k], &items);
        }
}

/* Values, vectors and matrices inside larger records, the matrices back to front. */
static void strided_views_hold_matrices_and_factors(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension, width = d * (d + 1) / 2;
    const batch items = batch_of(test, SPECTRA_tenth_to_one);
    const factors plain = eigen_of(context, &items);
    const setup_array matrices = packed(&items);
    setup_array record = setup_output(matrices.type, items.count, 20);
    const ptrdiff_t size = items.is_double ? 8 : 4, step = setup_view(&record).stride;
    sphg_view in = setup_view(&matrices), values = setup_view(&record), vectors = values;
    in.x = (const char *)in.x + (items.count - 1) * width * size;
    in.stride = -in.stride;
    values.x = (const char *)values.x + size;
    vectors.x = (const char *)vectors.x + 5 * size;
    SETUP_OK(context, sphg_eigen(context, d, items.count, in, values, vectors));
    for (int i = 0; i < items.count; ++i) {
        const int mirror = items.count - 1 - i;
        for (int k = 0; k < d; ++k)
            assert_true(setup_get(&record, i, 1 + k) == plain.values[d * mirror + k]);
        for (int k = 0; k < d * d; ++k)
            assert_true(setup_get(&record, i, 5 + k) == plain.vectors[d * d * mirror + k]);
        const char *item = (const char *)record.data + i * step;
        for (ptrdiff_t byte = (5 + d * d) * size; byte < 20 * size; ++byte)
            assert_int_equal(item[byte], (char)0xA5);
    }
}

static void empty_batches_succeed(const test_case *test)
{
    (void)test;
    sphg_context *context = setup_context();
    const sphg_view none = sphg_view_f64(NULL, 8);
    assert_int_equal(sphg_eigen(context, 3, 0, none, none, none), SPHG_OK);
    assert_int_equal(sphg_svd(context, 0, none, none, none, none), SPHG_OK);
}

static const test_entry entries[] = {
    TEST_ENTRY(eigen_is_backward_stable, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(eigenvalues_agree_with_lapack, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(eigenvalues_agree_with_the_reference, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               0, 0),
    TEST_ENTRY(svd_is_backward_stable, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(singular_values_agree_with_lapack, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(bad_matrix_spoils_only_itself, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(units_change_no_digit, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(batches_do_not_change_results, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(nothing_behind_the_last_matrix_is_touched, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(strided_views_hold_matrices_and_factors, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ONCE(empty_batches_succeed),
};
TEST_MAIN(entries)
