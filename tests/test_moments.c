/* SPDX-License-Identifier: MIT */
/* sphg_invert_moments: C = f(M / m_ref) / m_ref for every policy, the decisions around the
 * threshold, and the certificate that keeps healthy matrices off the eigensolver. */
#include "support/setup.h"
#include "support/spectra.h"
#include <math.h>
#include <string.h>

static const char *const policy_names[] = {"blend", "replace", "truncate", "identity"};

typedef struct setting {
    sphg_scheme scheme;
    int is_double;
    double unit, volume;
} setting;

static setting setting_of(const test_case *test, sphg_policy policy, double threshold)
{
    setting own = {setup_scheme(test, 0.5), test->precision == TEST_F64, 0, 0.0625};
    own.scheme.policy = policy;
    own.scheme.threshold = threshold;
    own.unit = test_unit_roundoff(test);
    return own;
}

/* m_ref: KGC 1, RKPM mu2 H^2, MLS mu2 H^2 / V_i. */
static long double reference_moment(const setting *own)
{
    double mu2 = NAN;
    sphg_kernel_constants(&own->scheme, NULL, &mu2);
    const long double square =
        (long double)mu2 * own->scheme.support_radius * own->scheme.support_radius;
    if (own->scheme.method == SPHG_KGC)
        return 1;
    return own->scheme.method == SPHG_RKPM ? square : square / own->volume;
}

/* ---- What the policies say, in long double ------------------------------------------------ */

typedef struct verdict {
    long double lambda[3], vectors[9], f[3], slope[3]; /* f(lambda), |f'(lambda)| */
    long double eps, full;                             /* eps_i; where full correction begins */
    long double size;                                  /* |Mhat|_F */
    int rank, is_close; /* close: an eigenvalue too near to a threshold to decide by rounding */
} verdict;

static long double blend(long double lambda, long double eps)
{
    const long double t = (lambda - eps) / (3 * eps);
    const long double w = t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
    return w > 0 ? w / lambda + (1 - w) : 1;
}

static void judge_value(verdict *found, sphg_policy policy, int k, int touched)
{
    const long double lambda = found->lambda[k], step = 1e-6L * fabsl(lambda);
    const int kept = policy == SPHG_IDENTITY ? !touched : lambda > found->eps;
    found->f[k] = kept ? 1 / lambda : policy == SPHG_TRUNCATE ? 0 : 1;
    found->slope[k] = kept ? 1 / (lambda * lambda) : 0;
    if (policy == SPHG_BLEND) {
        found->f[k] = blend(lambda, found->eps);
        found->slope[k] =
            fabsl(blend(lambda + step, found->eps) - blend(lambda - step, found->eps)) /
            (2 * step + 1e-30L);
    }
}

/* The matrix is given in the units of the method: `a` holds the rounded M. */
static verdict judge(const setting *own, const double *a)
{
    const int d = own->scheme.dimension;
    verdict found = {0};
    long double trace = 0, gap = INFINITY;
    spectra_eigen(d, a, found.lambda, found.vectors);
    for (int k = 0; k < d; ++k) {
        found.lambda[k] /= reference_moment(own);
        trace += found.lambda[k];
        found.size += found.lambda[k] * found.lambda[k];
    }
    found.size = sqrtl(found.size);
    const long double eps = own->scheme.threshold > 0 ? own->scheme.threshold : 1e-2;
    found.eps = fmaxl(eps, 16 * own->unit * trace);
    found.full = own->scheme.policy == SPHG_BLEND ? 4 * found.eps : found.eps;
    const int touched = found.lambda[d - 1] <= found.eps;
    for (int k = 0; k < d; ++k) {
        judge_value(&found, own->scheme.policy, k, touched);
        found.rank += found.lambda[k] > found.full;
        gap = fminl(gap, fabsl(found.lambda[k] - found.full));
    }
    if (own->scheme.policy == SPHG_IDENTITY)
        found.rank = touched ? 0 : d;
    found.is_close = gap <= 64 * own->unit * (found.size + found.full);
    return found;
}

/* The largest divided difference of f over pairs of eigenvalues: how much C may answer to a
 * rounding of M. */
static long double sensitivity(const verdict *found, int d)
{
    long double worst = 0;
    for (int k = 0; k < d; ++k)
        for (int l = 0; l <= k; ++l) {
            const long double gap = found->lambda[l] - found->lambda[k];
            worst = fmaxl(worst, fmaxl(found->slope[k], found->slope[l]));
            if (gap > 1e-9L * found->size)
                worst = fmaxl(worst, fabsl(found->f[k] - found->f[l]) / gap);
        }
    return worst;
}

/* |C - f(M)|_F in units of u (|C| + |M| max f[., .]). */
static double correction_error(const setting *own, const verdict *expected, const double *c)
{
    const int d = own->scheme.dimension;
    long double sum = 0, size = 0;
    for (int r = 0; r < d; ++r)
        for (int column = 0; column < d; ++column) {
            const int low = r < column ? r : column, high = r + column - low;
            const long double found = c[low * d - low * (low - 1) / 2 + high - low];
            long double exact = 0;
            for (int k = 0; k < d; ++k)
                exact += expected->f[k] * expected->vectors[r * d + k] *
                         expected->vectors[column * d + k];
            sum += powl(found * reference_moment(own) - exact, 2);
            size += exact * exact;
        }
    const long double scale = sqrtl(size) + expected->size * sensitivity(expected, d);
    return sum == 0 ? 0 : (double)(sqrtl(sum) / (own->unit * scale));
}

/* ---- Batches ------------------------------------------------------------------------------ */

typedef struct batch {
    int count;
    double *full; /* 9 numbers each, of which d x d are the matrix */
} batch;

static void round_to(const setting *own, double *a)
{
    for (int k = 0; k < 9 && !own->is_double; ++k)
        a[k] = (double)(float)a[k];
}

static batch batch_of(const setting *own, spectrum set, int count)
{
    batch items = {count, test_memory((size_t)count * 9 * sizeof(double))};
    random_state random = random_seeded(300 + (uint64_t)set);
    const double scale = (double)reference_moment(own);
    for (int i = 0; i < count; ++i) {
        double *a = items.full + 9 * i;
        spectra_matrix(set, own->scheme.dimension, own->is_double, &random, a);
        for (int k = 0; k < 9; ++k)
            a[k] *= scale;
        round_to(own, a);
    }
    return items;
}

static setup_array packed(const setting *own, const batch *items)
{
    const int d = own->scheme.dimension, width = d * (d + 1) / 2;
    double *numbers = test_memory((size_t)(items->count * width) * sizeof *numbers);
    for (int i = 0, next = 0; i < items->count; ++i)
        for (int r = 0; r < d; ++r)
            for (int c = r; c < d; ++c)
                numbers[next++] = items->full[9 * i + r * d + c];
    return setup_numbers(own->is_double ? SPHG_F64 : SPHG_F32, items->count, width, numbers);
}

typedef struct outcome {
    setup_array correction, rank, lambda_min;
    sphg_stats stats;
} outcome;

static outcome outputs_for(const setting *own, int count)
{
    const sphg_type type = own->is_double ? SPHG_F64 : SPHG_F32;
    const int d = own->scheme.dimension;
    return (outcome){.correction = setup_output(type, count, d * (d + 1) / 2),
                     .rank = setup_output(SPHG_U8, count, 1),
                     .lambda_min = setup_output(type, count, 1)};
}

static void invert(sphg_context *context, const setting *own, int count, sphg_view moments,
                   const sphg_inversion *wanted)
{
    const float single = (float)own->volume;
    const sphg_view volume =
        own->is_double ? sphg_view_f64(&own->volume, 0) : sphg_view_f32(&single, 0);
    SETUP_OK(context, sphg_invert_moments(context, &own->scheme, count, moments, volume, wanted));
}

static outcome inverted(sphg_context *context, const setting *own, const batch *items)
{
    const setup_array moments = packed(own, items);
    outcome found = outputs_for(own, items->count);
    const sphg_inversion wanted = {setup_view(&found.correction), setup_view(&found.rank),
                                   setup_view(&found.lambda_min), &found.stats};
    invert(context, own, items->count, setup_view(&moments), &wanted);
    return found;
}

/* ---- Properties --------------------------------------------------------------------------- */

/* A cautious bound for lambda_min: exact where decomposed, else low by at most sqrt(d). */
static void require_lambda_min(const setting *own, const verdict *expected, double found,
                               const char *where)
{
    const int d = own->scheme.dimension;
    const long double lambda = fmaxl(expected->lambda[d - 1], 0);      /* never negative */
    const long double grain = own->is_double ? 0x1p-1074L : 0x1p-149L; /* of denormal moments */
    const long double slack =
        64 * own->unit * expected->size + 16 * grain * (1 + 1 / reference_moment(own));
    TEST_REQUIRE(found <= lambda + slack, "%s: lambda_min %g > %Lg", where, found, lambda);
    TEST_REQUIRE(found >= fminl(lambda, lambda / sqrtl(d)) - slack, "%s: lambda_min %g << %Lg",
                 where, found, lambda);
}

static void check_item(const setting *own, const batch *items, const outcome *found, int i,
                       const char *where)
{
    const verdict expected = judge(own, items->full + 9 * i);
    double c[6] = {0};
    for (int k = 0; k < found->correction.width; ++k)
        c[k] = setup_get(&found->correction, i, k);
    require_lambda_min(own, &expected, setup_get(&found->lambda_min, i, 0), where);
    if (expected.is_close)
        return;
    TEST_REQUIRE((int)setup_get(&found->rank, i, 0) == expected.rank, "%s, item %d: rank %g", where,
                 i, setup_get(&found->rank, i, 0));
    TEST_WITHIN(moment_inversion, correction_error(own, &expected, c), where);
}

static void correction_is_f_of_the_moments(const test_case *test)
{
    sphg_context *context = setup_context();
    const double thresholds[] = {0, 1e-3, 0.2};
    for (int policy = 0; policy < 4; ++policy)
        for (int t = 0; t < 3; ++t)
            for (int set = 0; set < SPECTRA_SYMMETRIC; ++set) {
                const setting own = setting_of(test, (sphg_policy)policy, thresholds[t]);
                const batch items = batch_of(&own, (spectrum)set, 150);
                const outcome found = inverted(context, &own, &items);
                const char *where = test_text("%s %s eps %g", spectra_names[set],
                                              policy_names[policy], thresholds[t]);
                for (int i = 0; i < items.count; ++i)
                    check_item(&own, &items, &found, i, where);
            }
}

/* Scaled by m_ref, the unit matrix is a full neighbourhood: rank d, C = I / m_ref. */
static void full_neighbourhood_is_one(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    const setting own = setting_of(test, SPHG_BLEND, 0);
    batch items = {1, test_memory(9 * sizeof(double))};
    const long double scale = reference_moment(&own);
    for (int k = 0; k < d; ++k)
        items.full[k * d + k] = (double)scale;
    round_to(&own, items.full);
    const outcome found = inverted(context, &own, &items);
    const double first = setup_get(&found.correction, 0, 0);
    TEST_WITHIN(moment_inversion, (double)fabsl(first * scale - 1) / own.unit, "C = I");
    assert_int_equal((int)setup_get(&found.rank, 0, 0), d);
    assert_int_equal(found.stats.certified, 1);
    assert_true(fabs(found.stats.lambda_min * sqrt(d) - 1) < 0.01);
}

/* ---- Certificate -------------------------------------------------------------------------- */

/* Matrices whose smallest eigenvalue gathers around eps_hi (1 +- 1e-7 .. 1), large traces too. */
static void gather(const setting *own, double eps_hi, random_state *random, double *a)
{
    const int d = own->scheme.dimension;
    double values[3];
    for (int k = 0; k < d; ++k)
        values[k] = pow(10, random_between(random, -2, random_index(random, 4) ? 0.5 : 3));
    const double offset = pow(10, random_between(random, -7, 0));
    values[d - 1] = eps_hi * (1 + (random_index(random, 2) ? offset : -offset));
    spectra_compose(d, values, own->is_double, random, a);
}

/* Sorts fresh matrices into those that the rule touches and those far from it, by the reference;
 * of the first none may be certified, of the second all. */
static void check_certificate(sphg_context *context, const setting *own, uint64_t seed, int count)
{
    const int d = own->scheme.dimension;
    random_state random = random_seeded(seed);
    const size_t bytes = (size_t)count * 9 * sizeof(double);
    batch touched = {0, test_memory(bytes)}, healthy = {0, test_memory(bytes)};
    for (int i = 0; i < count; ++i) {
        double a[9] = {0};
        gather(own, own->scheme.threshold * (own->scheme.policy == SPHG_BLEND ? 4 : 1), &random, a);
        const verdict expected = judge(own, a);
        const long double lambda = expected.lambda[d - 1];
        const long double margin = own->scheme.threshold * 4 + 80 * own->unit * expected.size * 2;
        if (lambda < expected.full)
            memcpy(touched.full + 9 * touched.count++, a, sizeof a);
        else if (lambda > 1.01L * sqrtl(d) * margin)
            memcpy(healthy.full + 9 * healthy.count++, a, sizeof a);
    }
    const outcome of_touched = inverted(context, own, &touched);
    assert_int_equal(of_touched.stats.certified, 0);
    assert_int_equal(of_touched.stats.decomposed, touched.count);
    const outcome of_healthy = inverted(context, own, &healthy);
    assert_int_equal(of_healthy.stats.certified, healthy.count);
}

static void certificate_never_accepts_a_touched_matrix(const test_case *test)
{
    sphg_context *context = setup_context();
    const double thresholds[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
    for (int t = 0; t < 5; ++t)
        for (int policy = 0; policy < 4; ++policy) {
            const setting own = setting_of(test, (sphg_policy)policy, thresholds[t]);
            check_certificate(context, &own, 7u + (uint64_t)(4 * t + policy), 3000);
        }
}

/* What the fast path accepts is as exact as what the eigensolver returns, and says so. */
static void certified_lambda_is_a_lower_bound_and_decomposed_is_exact(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    const setting own = setting_of(test, SPHG_BLEND, 1e-2);
    const batch all = batch_of(&own, SPECTRA_one_one_small, 400);
    int ways[2] = {0, 0};
    for (int i = 0; i < all.count; ++i) {
        const batch one = {1, all.full + 9 * i};
        const outcome found = inverted(context, &own, &one);
        const verdict expected = judge(&own, one.full);
        const long double lambda = expected.lambda[d - 1], slack = 16 * own.unit * expected.size;
        const double given = setup_get(&found.lambda_min, 0, 0);
        assert_int_equal(found.stats.certified + found.stats.decomposed, 1);
        assert_true(found.stats.lambda_min == given);
        ++ways[found.stats.certified];
        if (found.stats.certified)
            assert_true(given >= 0.04 && given <= lambda + slack);
        else
            assert_true(fabsl(given - lambda) <= slack);
    }
    assert_true(ways[0] > 50 && ways[1] > 50);
}

/* Volumes that do not tile: moments of a plane in the millions, whose rounding exceeds eps. */
static void noise_of_large_moments_is_not_inverted(const test_case *test)
{
    sphg_context *context = setup_context();
    const int d = test->dimension;
    for (int policy = 0; policy < 4; ++policy) {
        const setting own = setting_of(test, (sphg_policy)policy, 0);
        batch items = {500, test_memory(500 * 9 * sizeof(double))};
        random_state random = random_seeded(997);
        for (int i = 0; i < items.count; ++i) {
            const double large = ldexp(1, own.is_double ? 50 : 20);
            double values[3] = {large, d == 3 ? large * random_between(&random, 0.1, 1) : 0, 0};
            spectra_compose(d, values, own.is_double, &random, items.full + 9 * i);
        }
        const outcome found = inverted(context, &own, &items);
        for (int i = 0; i < items.count; ++i)
            assert_true(setup_get(&found.rank, i, 0) < d);
    }
}

/* ---- Bad items, batches, views ------------------------------------------------------------ */

static void require_same_item(const outcome *a, const outcome *b, int i)
{
    for (int k = 0; k < a->correction.width; ++k)
        assert_true(setup_get(&a->correction, i, k) == setup_get(&b->correction, i, k));
    assert_true(setup_get(&a->rank, i, 0) == setup_get(&b->rank, i, 0));
    assert_true(setup_get(&a->lambda_min, i, 0) == setup_get(&b->lambda_min, i, 0));
}

/* For every policy, place and kind of bad number; half of the others take the fast path. */
static void bad_matrix_spoils_only_itself(const test_case *test)
{
    sphg_context *context = setup_context();
    const double kinds[] = {NAN, INFINITY, -INFINITY};
    for (int bad = 0; bad < 37; ++bad) {
        const setting own = setting_of(test, (sphg_policy)(bad % 4), 0);
        const batch items = batch_of(&own, SPECTRA_one_one_small, 37);
        const outcome clean = inverted(context, &own, &items);
        double *a = items.full + 9 * bad;
        const int d = test->dimension, entry = bad % d; /* diagonal or off it */
        a[entry] = a[entry * d] = kinds[bad / 2 % 3];
        const outcome found = inverted(context, &own, &items);
        for (int i = 0; i < items.count; ++i)
            if (i != bad)
                require_same_item(&found, &clean, i);
        for (int k = 0; k < found.correction.width; ++k)
            assert_true(isnan(setup_get(&found.correction, bad, k)));
        assert_int_equal((int)setup_get(&found.rank, bad, 0), 0);
    }
}

static void stats_add_up(const test_case *test)
{
    sphg_context *context = setup_context();
    for (int policy = 0; policy < 4; ++policy) {
        const setting own = setting_of(test, (sphg_policy)policy, 0);
        const batch items = batch_of(&own, SPECTRA_one_small_small, 1000);
        const outcome found = inverted(context, &own, &items);
        int64_t rank[4] = {0};
        double least = INFINITY;
        for (int i = 0; i < items.count; ++i) {
            rank[(int)setup_get(&found.rank, i, 0)]++;
            least = fmin(least, setup_get(&found.lambda_min, i, 0));
        }
        assert_memory_equal(rank, found.stats.rank, sizeof rank);
        assert_int_equal(found.stats.certified + found.stats.decomposed, items.count);
        assert_true(found.stats.certified > 0 && found.stats.decomposed > 0);
        assert_true(least == found.stats.lambda_min);
    }
}

static void each_output_may_be_asked_for_alone(const test_case *test)
{
    sphg_context *context = setup_context();
    const setting own = setting_of(test, SPHG_BLEND, 0);
    const batch items = batch_of(&own, SPECTRA_one_small_small, 100);
    const setup_array moments = packed(&own, &items);
    const outcome all = inverted(context, &own, &items), alone = outputs_for(&own, items.count);
    const sphg_inversion wanted[] = {{.correction = setup_view(&alone.correction)},
                                     {.rank = setup_view(&alone.rank)},
                                     {.lambda_min = setup_view(&alone.lambda_min)}};
    for (int k = 0; k < 3; ++k)
        invert(context, &own, items.count, setup_view(&moments), &wanted[k]);
    assert_true(setup_same_bits(&alone.correction, &all.correction));
    assert_true(setup_same_bits(&alone.rank, &all.rank));
    assert_true(setup_same_bits(&alone.lambda_min, &all.lambda_min));
}

/* C may replace M, in a record with other members, which keep their bytes. */
static void correction_may_replace_the_moments(const test_case *test)
{
    sphg_context *context = setup_context();
    const setting own = setting_of(test, SPHG_BLEND, 0);
    const batch items = batch_of(&own, SPECTRA_one_one_small, 333);
    const outcome plain = inverted(context, &own, &items);
    const setup_array moments = packed(&own, &items);
    setup_array record = setup_output(moments.type, items.count, 9);
    const size_t size = own.is_double ? 8 : 4, width = (size_t)moments.width * size;
    for (int i = 0; i < items.count; ++i)
        memcpy((char *)record.data + (size_t)i * 9 * size + size,
               (const char *)moments.data + (size_t)i * width, width);
    sphg_view place = setup_view(&record);
    place.x = (const char *)place.x + size;
    const sphg_inversion wanted = {.correction = place};
    invert(context, &own, items.count, place, &wanted);
    const setup_array canary = setup_output(moments.type, 1, 1);
    for (int i = 0; i < items.count; ++i) {
        const char *item = (const char *)record.data + (size_t)i * 9 * size;
        assert_memory_equal(item + size, (const char *)plain.correction.data + (size_t)i * width,
                            width);
        assert_memory_equal(item, canary.data, size);
        assert_memory_equal(item + 8 * size, canary.data, size);
    }
}

#define EACH(property)                                                                             \
    TEST_ENTRY(property, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0)
#define KGC_ONLY(property) TEST_ENTRY(property, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(correction_is_f_of_the_moments),
    TEST_ENTRY(full_neighbourhood_is_one, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, TEST_ALL_KERNELS),
    KGC_ONLY(certificate_never_accepts_a_touched_matrix),
    EACH(certified_lambda_is_a_lower_bound_and_decomposed_is_exact),
    KGC_ONLY(noise_of_large_moments_is_not_inverted),
    EACH(bad_matrix_spoils_only_itself),
    EACH(stats_add_up),
    EACH(each_output_may_be_asked_for_alone),
    EACH(correction_may_replace_the_moments),
};
TEST_MAIN(entries)
