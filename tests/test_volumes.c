/* SPDX-License-Identifier: MIT */
/* Volumes that differ by twelve orders of magnitude: sums whose terms cancel, and moments of which
 * one source is all. */
#include "support/random.h"
#include "support/comparison.h"
#include <math.h>
#include <string.h>

/* Volumes between a particle's share and 10^decades times that; each twentieth 10^12 times. */
static comparison uneven_stage(const test_case *test, const char *name, cloud points,
                               double decades, uint64_t seed)
{
    random_state random = random_seeded(seed);
    const comparison even = comparison_of(test, name, points, 2.25 * points.spacing);
    double *volume = test_memory((size_t)points.count * sizeof *volume);
    for (int i = 0; i < points.count; ++i) {
        const double share = pow(points.spacing, test->dimension);
        const double grown = i % 20 ? pow(10, random_between(&random, 0, decades)) : 1e12;
        const double given = share * grown;
        volume[i] = test->precision == TEST_F64 ? given : (double)(float)given;
    }
    return comparison_with_volumes(&even, volume);
}

static void smallest_moments_are_never_negative(const test_case *test)
{
    random_state random = random_seeded(70);
    const int d = test->dimension;
    const comparison on =
        uneven_stage(test, "block", cloud_jittered(d, d == 2 ? 30 : 10, .125, .3, &random), 1, 71);
    const setup_array lambda = setup_output(test_field_type(test), on.points.count, 1);
    const sphg_sources sources = comparison_sources(&on);
    sphg_stats stats = {0};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .lambda_min = setup_view(&lambda), .stats = &stats};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    for (int i = 0; i < on.points.count; ++i) {
        const double found = setup_get(&lambda, i, 0);
        TEST_REQUIRE(found >= 0 && !signbit(found), "lambda_min %g of particle %d", found, i);
    }
    assert_true(stats.lambda_min >= 0);
}

/* Targets of rank 0 and of full rank in percent when all volumes are `share` of what is right. */
static void ranks_at(const comparison *even, double share, double *none, double *full)
{
    const int count = even->points.count, d = even->points.dimension;
    double *volume = test_memory((size_t)count * sizeof *volume);
    for (int i = 0; i < count; ++i)
        volume[i] = share * pow(even->points.spacing, d);
    const comparison on = comparison_with_volumes(even, volume);
    const sphg_sources sources = comparison_sources(&on);
    sphg_stats stats = {0};
    const sphg_request request = {.sources = &sources, .set_count = 1, .stats = &stats};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    *none = 100.0 * (double)stats.rank[0] / count;
    *full = 100.0 * (double)stats.rank[d] / count;
}

/* The figures of docs/theory.md, section 3: lambda is proportional to the volumes, but for classic
 * methods. */
static void volumes_in_a_wrong_unit_take_the_rank(const test_case *test)
{
    const int d = test->dimension;
    random_state random = random_seeded(75);
    cloud points = cloud_jittered(d, d == 2 ? 40 : 12, .125, .2, &random);
    const comparison even = comparison_of(test, "block", points, 2 * points.spacing);
    const double shares[] = {1000, 1, .5, .02, .001};
    double none, full;
    for (int k = 0; k < 5; ++k) {
        ranks_at(&even, shares[k], &none, &full);
        const int kept = shares[k] >= .5 || sphg_correction_width(&even.scheme) > 6;
        TEST_REQUIRE(kept ? full == 100 : none == 100, "volumes times %g: rank 0 %g %%, full %g %%",
                     shares[k], none, full);
    }
    if (d == 2 || test->method != SPHG_KGC)
        return;
    ranks_at(&even, .3, &none, &full);
    TEST_REQUIRE(full >= 99.8, "three tenths: %g %%", full);
    ranks_at(&even, .1, &none, &full);
    TEST_REQUIRE(fabs(full - 90) < 2.5, "a tenth: %g %%", full);
    ranks_at(&even, .05, &none, &full);
    TEST_REQUIRE(fabs(full - 48) < 3, "a twentieth: %g %%", full);
    ranks_at(&even, .03, &none, &full);
    TEST_REQUIRE(none >= 99.4, "three hundredths: %g %%", none);
}

static void compare(const comparison *on, sphg_shape shape, sphg_form form,
                    const setup_array *table, int samples)
{
    const comparison_field field = {shape, form, comparison_random_field(on, shape, 6)};
    const comparison_result found = comparison_apply(on, &field, table);
    for (int k = 0; k < samples; k += test_reference_stride())
        comparison_compare(on, &field, &found, (int)((long)k * on->points.count / samples));
}

static void every_form_matches_the_oracle(const test_case *test)
{
    const int d = test->dimension, side = d == 2 ? 10 : 5;
    random_state random = random_seeded(72);
    const comparison stages[] = {
        uneven_stage(test, "uneven block", cloud_jittered(d, side, .125, .3, &random), 12, 73),
        uneven_stage(test, "uneven layers", cloud_sheets(d, side, .125, .01), 12, 74)};
    for (int s = 0; s < 2; ++s)
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; policy += SPHG_IDENTITY) {
            const comparison on = comparison_under(&stages[s], (sphg_policy)policy, 0);
            const setup_array table = comparison_table(&on);
            compare(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table, 12);
            compare(&on, SPHG_SCALAR, SPHG_DIRECT, &table, 12);
            compare(&on, SPHG_SCALAR, SPHG_ADJOINT, &table, 2);
            compare(&on, SPHG_SCALAR, SPHG_SYMMETRIC, &table, 2);
        }
}

/* Two layers whose distance the blend takes in: the smallest eigenvalue in their middle is
 * `lambda`. */
static comparison layers_with(const test_case *test, double lambda, double threshold,
                              random_state *random)
{
    const int d = test->dimension, side = d == 2 ? 10 : 5;
    double gap = .125 * sqrt(threshold);
    for (int round = 0;; ++round) {
        cloud points = cloud_sheets(d, side, .125, gap);
        double *volume = test_memory((size_t)points.count * sizeof *volume);
        for (int i = 0; i < points.count; ++i)
            volume[i] = (double)(float)pow(.125, d);
        cloud_rotate(&points, random);
        const comparison even = comparison_of(test, "layers", points, .28);
        const comparison given = comparison_with_volumes(&even, volume);
        const comparison on = comparison_under(&given, SPHG_BLEND, threshold);
        const oracle_point *middle = oracle_at(on.reference, points.count / 4);
        if (round == 1)
            return on;
        gap *= sqrt(lambda / (double)middle->filter.lambda_min);
    }
}

/* Where f rises from 1 it is far steeper than the C that it gives tells, and what rounding does to
 * M_i and to M_j counts in the forces of both. */
static void forces_stay_within_their_bounds_where_the_blend_begins(const test_case *test)
{
    static const double above[] = {.003, .01, .03, .1};
    const double threshold = 1e-4;
    random_state random = random_seeded(76);
    int blended = 0;
    for (int k = 0; k < 4; ++k) {
        const comparison on = layers_with(test, threshold * (1 + 3 * above[k]), threshold, &random);
        const setup_array table = comparison_table(&on);
        const int half = on.points.count / 2;
        const oracle_point *middle = oracle_at(on.reference, half / 2);
        blended += middle->filter.lambda_min > threshold && middle->rank < test->dimension;
        for (int shape = SPHG_SCALAR; shape <= SPHG_VECTOR; ++shape) {
            const comparison_field forces[] = {
                {(sphg_shape)shape, SPHG_ADJOINT,
                 comparison_random_field(&on, (sphg_shape)shape, 6)},
                {(sphg_shape)shape, SPHG_SYMMETRIC,
                 comparison_random_field(&on, (sphg_shape)shape, 7)}};
            for (int f = 0; f < 2; ++f) {
                const comparison_result found = comparison_apply(&on, &forces[f], &table);
                comparison_compare(&on, &forces[f], &found, half / 2);
                comparison_compare(&on, &forces[f], &found, half + half / 2);
            }
        }
    }
    TEST_REQUIRE(blended == 4, "%d of 4 in the band", blended);
}

/* A target that is given the volume 0 has Mhat = M V_i / (mu2 H^2) = 0 under MLS: nothing can be
 * corrected, and C = f(0) V_i / (mu2 H^2) is 0, too. The others do not read it. */
static void targets_without_extent_match_the_oracle(const test_case *test)
{
    const int d = test->dimension, side = d == 2 ? 10 : 5;
    random_state random = random_seeded(77);
    const cloud points = cloud_jittered(d, side, .125, .2, &random);
    const comparison even = comparison_of(test, "block", points, .28);
    double *volume = test_memory((size_t)points.count * sizeof *volume);
    for (int i = 0; i < points.count; ++i)
        volume[i] = i % 3 ? even.scene.volume[i] : 0;
    const comparison filled = comparison_with_volumes(&even, volume);
    for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
        const comparison on = comparison_under(&filled, (sphg_policy)policy, 0);
        const setup_array table = comparison_table(&on);
        for (int i = 0; i < points.count; i += 3)
            for (int k = 0; k < table.width && test->method == SPHG_MLS; ++k)
                TEST_REQUIRE(setup_get(&table, i, k) == 0, "C of particle %d is not 0", i);
        compare(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table, 24);
        compare(&on, SPHG_SCALAR, SPHG_DIRECT, &table, 24);
        compare(&on, SPHG_SCALAR, SPHG_ADJOINT, &table, 6);
    }
}

/* ---- Few particles, thin, some of which outweigh all others ---------------------------------- */

enum { FEW = 7, KINDS = 5 };

/* The first in the middle, each two of the others opposite one another. */
static cloud mirrored_cloud(int d, random_state *random)
{
    cloud points = cloud_random(d, FEW, .5, random);
    for (int k = 0; k < FEW * d; ++k)
        if (k / d % 2 == 0)
            points.x[k] = k < d ? 0 : -points.x[k - d];
    return points;
}

/* On a line, at one place but for one, in two layers, anywhere, all with a thickness from a
 * millionth of the spacing on; or mirrored up to rounding. */
static cloud few_particles(int d, int kind, random_state *random)
{
    cloud points = kind == 0   ? cloud_line(d, FEW, .125)
                   : kind == 1 ? cloud_coincident(d, FEW - 1, 1, .25)
                   : kind == 2 ? cloud_sheets(d, d == 2 ? FEW / 2 : 2, .25, .001)
                   : kind == 3 ? cloud_random(d, FEW, .5, random)
                               : mirrored_cloud(d, random);
    const double thick = kind == 4 ? 0 : .25 * pow(10, random_between(random, -6, -1));
    for (int k = 0; k < points.count * d; ++k)
        points.x[k] += thick * random_between(random, -1, 1);
    cloud_rotate(&points, random);
    return points;
}

/* 1 at the first, 0 at the others: all that is seen is w_0 z_k, in which mirror images cancel. */
static void compare_first(const comparison *on, const setup_array *table)
{
    double *numbers = test_memory((size_t)on->points.count * sizeof *numbers);
    numbers[0] = 1;
    const comparison_field field = {SPHG_SCALAR, SPHG_DIRECT, numbers};
    const comparison_result found = comparison_apply(on, &field, table);
    comparison_compare(on, &field, &found, 0);
}

/* y, z_k and gradients of terms that cancel are far smaller than what rounding does to the terms:
 * bounds from their size alone are passed by a factor of thousands. */
static void few_particles_stay_within_their_bounds(const test_case *test)
{
    random_state random = random_seeded(80);
    for (int k = 0; k < 2 * KINDS; ++k) {
        const comparison even =
            uneven_stage(test, "few particles", few_particles(test->dimension, k % KINDS, &random),
                         k % 3 * 6, random_bits(&random));
        const comparison on = comparison_under(&even, k < KINDS ? SPHG_BLEND : SPHG_IDENTITY,
                                               pow(10, random_between(&random, -4, -.7)));
        const setup_array table = comparison_table(&on);
        const int all = on.points.count;
        compare_first(&on, &table);
        compare(&on, SPHG_SCALAR, SPHG_DIRECT, &table, all);
        compare(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table, all);
        compare(&on, SPHG_SCALAR, SPHG_ADJOINT, &table, all);
        compare(&on, SPHG_SYM_TENSOR, SPHG_SYMMETRIC, &table, all);
    }
}

/* The worst found by climbing: W alone is off by nearly its limit, and A_j V_j by more. */
static void a_value_of_one_pair_stays_within_its_bound(const test_case *test)
{
    cloud pair = cloud_pair(test->dimension, .25);
    const double place[] = {0x1.9e58e6p-7, 0x1.93a78p-7, 0}, volume[] = {.25, 0x1.2f1ca8p-2};
    double numbers[] = {0, 0x1.0b6d0cp-1};
    memcpy(pair.x + test->dimension, place, (size_t)test->dimension * sizeof *place);
    const comparison even = comparison_of(test, "pair", pair, 1),
                     on = comparison_with_volumes(&even, volume);
    const comparison_field field = {SPHG_SCALAR, SPHG_DIRECT, numbers};
    const comparison_result found = comparison_apply(&on, &field, NULL);
    comparison_compare(&on, &field, &found, 0);
}

static const test_entry entries[] = {
    TEST_ENTRY(smallest_moments_are_never_negative, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(volumes_in_a_wrong_unit_take_the_rank, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(every_form_matches_the_oracle, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS,
               TEST_BIT(SPHG_CUBIC_SPLINE) | TEST_BIT(SPHG_QUINTIC_SPLINE) | TEST_BIT(SPHG_POLY6)),
    TEST_ENTRY(forces_stay_within_their_bounds_where_the_blend_begins, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(targets_without_extent_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(a_value_of_one_pair_stays_within_its_bound, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, TEST_BIT(SPHG_WENDLAND_C6)),
    TEST_ENTRY(few_particles_stay_within_their_bounds, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED,
               TEST_BIT(SPHG_CUBIC_SPLINE) | TEST_BIT(SPHG_WENDLAND_C6) | TEST_BIT(SPHG_POLY6)),
};
TEST_MAIN(entries)
