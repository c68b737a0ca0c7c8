/* SPDX-License-Identifier: MIT */
/* What may change without changing the results (docs/theory.md, errors): to the bit where only
 * exact operations are involved and sums keep their order, within the error bound elsewhere. */
#include "support/comparison.h"
#include <string.h>

static cloud unit_block(int d)
{
    random_state random = random_seeded(51);
    cloud points = cloud_jittered(d, d == 2 ? 6 : 4, 1, .3, &random);
    cloud_snap(&points, 0x1p-8);
    return points;
}

/* ---- Sums in a given order: host lists
 * ------------------------------------------------------------ */

typedef struct host_lists {
    int64_t *offsets;
    int32_t *indices;
} host_lists;

/* Everybody else is a candidate; the library leaves out who is too far. */
static host_lists everybody(int count)
{
    host_lists lists;
    lists.offsets = test_memory(((size_t)count + 1) * sizeof *lists.offsets);
    lists.indices = test_memory((size_t)count * (size_t)count * sizeof *lists.indices);
    int64_t used = 0;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j)
            if (j != i)
                lists.indices[used++] = j;
        lists.offsets[i + 1] = used;
    }
    return lists;
}

/* The comparison with neighbours from lists, so that sums run in the order of the indices. */
static comparison in_list_order(const comparison *made)
{
    comparison on = *made;
    int n = on.points.count;
    host_lists host = everybody(n);
    sphg_lists lists = {.offsets = host.offsets, .indices = host.indices};
    setup_array positions = setup_positions(on.test, &on.points);
    sphg_geometry geometry = setup_geometry(on.test, &on.points, &positions);
    on.neighbors = setup_lists(on.context, &on.scheme, &geometry, &lists);
    return on;
}

static comparison listed_stage(const test_case *test, cloud points, double support)
{
    comparison made = comparison_of(test, "listed block", points, support);
    return in_list_order(&made);
}

/* ---- Scaling by powers of two
 * ----------------------------------------------------------------------- */

static double *scaled(const double *numbers, int count, int exponent)
{
    double *result = test_memory((size_t)count * sizeof *result);
    for (int k = 0; k < count; ++k)
        result[k] = ldexp(numbers[k], exponent);
    return result;
}

/* found * 2^exponent equals expected, to the bit. */
static void require_scaled(const setup_array *expected, const setup_array *found, int exponent,
                           const char *what, int k)
{
    for (int n = 0; n < expected->count * expected->width; ++n) {
        int i = n / expected->width, c = n % expected->width;
        double exact = ldexp(setup_get(expected, i, c), exponent);
        TEST_REQUIRE(exact == setup_get(found, i, c), "%s at 2^%d, item %d: %a, not %a", what, k, i,
                     setup_get(found, i, c), exact);
    }
}

static comparison scaled_stage(const comparison *made, int k)
{
    cloud points = cloud_copy(&made->points);
    int d = points.dimension;
    for (int n = 0; n < points.count * d; ++n)
        points.x[n] = ldexp(points.x[n], k);
    points.spacing = ldexp(points.spacing, k);
    comparison on =
        comparison_of(made->test, "scaled", points, ldexp(made->scheme.support_radius, k));
    return comparison_with_volumes(&on, scaled(made->scene.volume, points.count, d * k));
}

static void require_scaled_field(const comparison *small, const comparison *large,
                                 const comparison_field *field, int with_table, int k)
{
    enum { a = 3 };
    int d = small->points.dimension;
    int width = setup_width(field->shape, d), total = small->points.count * width;
    setup_array table = comparison_table(small), large_table = comparison_table(large);
    comparison_field times = *field;
    times.numbers = scaled(field->numbers, total, a);
    comparison_result one = comparison_apply(small, field, with_table ? &table : NULL);
    comparison_result two = comparison_apply(large, &times, with_table ? &large_table : NULL);
    int power = field->form == SPHG_ADJOINT ? a + (d - 1) * k : a - k;
    require_scaled(&one.gradient, &two.gradient, power, "gradient", k);
    require_scaled(&one.divergence, &two.divergence, power, "divergence", k);
    require_scaled(&one.curl, &two.curl, power, "curl", k);
    require_scaled(&one.value, &two.value, a, "value", k);
    require_scaled(&one.square, &two.square, a - 2 * k, "square", k);
}

/* As far as V and 1 / H^d are normal numbers, and so are the entries of the table, which has the
 * host's units: C of RKPM is 1 / L^2, the interpolant's coefficients of CMLS are L^d. */
static int largest_exponent(const test_case *test, int sign)
{
    static const int limits[2][2] = {{62, 510}, {41, 340}};       /* [3D][f64] */
    static const int table_limits[2][2] = {{48, 480}, {32, 320}}; /* [3D][f64] */
    int is_double = test->precision == TEST_F64, is_space = test->dimension == 3;
    if ((test->method == SPHG_RKPM && !is_space) || (test->method == SPHG_CMLS && sign < 0))
        return table_limits[is_space][is_double];
    return limits[is_space][is_double];
}

static void powers_of_two_scale_to_the_bit(const test_case *test)
{
    int most = largest_exponent(test, 1), least = -largest_exponent(test, -1);
    int exponents[] = {1, -7, most / 2, most, least};
    cloud points = unit_block(test->dimension);
    for (int k = 0; k < points.count * points.dimension; ++k)
        points.x[k] *= .6875; /* so that 1 / H^d and V are normal numbers at both limits */
    points.spacing = .6875;
    comparison small = comparison_of(test, "block", points, 1.5);
    for (int e = 0; e < 5; ++e) {
        int k = exponents[e];
        comparison large = scaled_stage(&small, k);
        comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                                  comparison_random_field(&small, SPHG_VECTOR, 1)};
        require_scaled_field(&small, &large, &field, 0, k);
        field.form = SPHG_DIRECT;
        require_scaled_field(&small, &large, &field, 1, k);
        field.form = SPHG_ADJOINT;
        require_scaled_field(&small, &large, &field, 1, k);
        field = (comparison_field){SPHG_SCALAR, SPHG_DIRECT,
                                   comparison_random_field(&small, SPHG_SCALAR, 3)};
        if (e < 3) /* at the limits 1 / H^2 is no normal number */
            require_scaled_field(&small, &large, &field, 0, k);
    }
}

static void powers_of_two_keep_ranks_and_scale_corrections(const test_case *test)
{
    comparison small = comparison_of(test, "block", unit_block(test->dimension), 1.5);
    int d = test->dimension, exponents[] = {5, -9, 20};
    for (int e = 0; e < 3; ++e) {
        int k = exponents[e];
        comparison stages[] = {small, scaled_stage(&small, k)};
        setup_array table[2], rank[2];
        for (int s = 0; s < 2; ++s) {
            table[s] = comparison_table(&stages[s]);
            rank[s] = setup_output(SPHG_U8, small.points.count, 1);
            sphg_sources sources = comparison_sources(&stages[s]);
            SETUP_OK(small.context,
                     sphg_correction(small.context, &stages[s].scheme, &sources, NULL,
                                     setup_view(&table[s]), setup_view(&rank[s])));
        }
        int power = test->method == SPHG_KGC ? 0 : test->method == SPHG_RKPM ? -2 * k : (d - 2) * k;
        require_scaled(&table[0], &table[1], power, "C", k);
        assert_true(setup_same_bits(&rank[0], &rank[1]));
    }
}

/* ---- Translation, constants, mirror
 * ---------------------------------------------------------------- */

static void require_same_bits(const comparison *a, const comparison *b, sphg_form form)
{
    comparison_field field = {SPHG_VECTOR, form, comparison_random_field(a, SPHG_VECTOR, 2)};
    comparison_result one = comparison_apply(a, &field, NULL),
                      two = comparison_apply(b, &field, NULL);
    assert_true(comparison_results_have_same_bits(&one, &two));
}

static void exact_translation_keeps_every_bit(const test_case *test)
{
    static const double vector[] = {1024, -512, 2048};
    comparison here = listed_stage(test, unit_block(test->dimension), 2.25);
    cloud moved = cloud_copy(&here.points);
    cloud_shift(&moved, vector);
    comparison there = listed_stage(test, moved, 2.25);
    require_same_bits(&here, &there, SPHG_DIFFERENCE);
    require_same_bits(&here, &there, SPHG_DIRECT);
}

static void exact_constants_added_keep_every_bit(const test_case *test)
{
    comparison on = comparison_of(test, "block", unit_block(test->dimension), 2.25);
    int total = on.points.count * test->dimension;
    double *numbers = test_memory((size_t)total * sizeof *numbers);
    double *raised = test_memory((size_t)total * sizeof *raised);
    random_state random = random_seeded(52);
    for (int k = 0; k < total; ++k) {
        numbers[k] = random_index(&random, 4096) * 0x1p-10;
        raised[k] = numbers[k] + 24;
    }
    comparison_field one = {SPHG_VECTOR, SPHG_DIFFERENCE, numbers};
    comparison_field two = {SPHG_VECTOR, SPHG_DIFFERENCE, raised};
    comparison_result a = comparison_apply(&on, &one, NULL), b = comparison_apply(&on, &two, NULL);
    assert_true(comparison_results_have_same_bits(&a, &b));
}

/* Mirrored at x = 0: d/dx changes sign, the rest stays. */
static void mirror_images_have_mirrored_bits(const test_case *test)
{
    int d = test->dimension;
    comparison here = listed_stage(test, unit_block(d), 2.25);
    cloud mirrored = cloud_copy(&here.points);
    for (int i = 0; i < mirrored.count; ++i)
        mirrored.x[i * d] = -mirrored.x[i * d];
    comparison there = listed_stage(test, mirrored, 2.25);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&here, SPHG_SCALAR, 5)};
    comparison_result one = comparison_apply(&here, &field, NULL),
                      two = comparison_apply(&there, &field, NULL);
    for (int n = 0; n < mirrored.count * d; ++n) {
        double expected = setup_get(&one.gradient, n / d, n % d) * (n % d == 0 ? -1 : 1);
        TEST_REQUIRE(expected == setup_get(&two.gradient, n / d, n % d), "item %d", n / d);
    }
}

/* ---- Subsets and threads ------------------------------------------------------------------ */

static void require_subset(const comparison *on, const comparison_field *field,
                           const comparison_result *full, const sphg_subset *subset,
                           const uint8_t *expected)
{
    comparison_result part = comparison_apply_to(on, field, NULL, subset);
    int width = full->gradient.width;
    for (int i = 0; i < on->points.count; ++i) {
        if (!expected[i]) {
            TEST_REQUIRE(setup_is_canary(&part.gradient, i), "%d was not selected", i);
            continue;
        }
        for (int c = 0; c < width; ++c)
            TEST_REQUIRE(setup_get(&part.gradient, i, c) == setup_get(&full->gradient, i, c),
                         "item %d", i);
    }
}

/* One of so many, by mask and by list, picked at random and in a row. */
static void require_share(const comparison *on, const comparison_field *field,
                          const comparison_result *full, int share, random_state *random)
{
    const int n = on->points.count;
    uint8_t *mask = test_memory((size_t)n), *range = test_memory((size_t)n);
    int32_t *indices = test_memory((size_t)n * sizeof *indices), count = 0;
    int32_t *listed = test_memory((size_t)n * sizeof *listed), entries = 0;
    const int32_t begin = random_index(random, n - n / share), end = begin + n / share;
    for (int i = n - 1; i >= 0; --i) {
        mask[i] = (uint8_t)(random_index(random, share) == 0);
        range[i] = i >= begin && i < end;
        if (mask[i])
            indices[count++] = i;
    }
    const sphg_subset by_mask = {0, n, NULL, mask}, by_range = {begin, end, NULL, NULL};
    const sphg_subset by_list = sphg_listed(indices, count);
    require_subset(on, field, full, &by_mask, mask);
    require_subset(on, field, full, &by_range, range);
    require_subset(on, field, full, &by_list, mask);
    for (int k = 0; k < count; ++k) { /* each, and its successor if that is masked out */
        const int32_t next = (indices[k] + 1) % n;
        listed[entries++] = indices[k];
        if (!mask[next])
            listed[entries++] = next;
    }
    sphg_subset by_both = sphg_listed(listed, entries);
    by_both.mask = entries ? mask : NULL;
    require_subset(on, field, full, &by_both, mask);
}

static void subsets_have_the_bits_of_the_full_run(const test_case *test)
{
    static const int shares[] = {2, 3, 40, 300, 800};
    random_state jitter = random_seeded(52);
    const int d = test->dimension;
    const cloud points = cloud_jittered(d, d == 2 ? 40 : 12, 1, .3, &jitter); /* several blocks */
    comparison on = comparison_of(test, "several blocks", points, 2.25);
    comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_VECTOR, 6)};
    comparison_result full = comparison_apply(&on, &field, NULL);
    random_state random = random_seeded(53);
    for (size_t k = 0; k < sizeof shares / sizeof shares[0]; ++k)
        require_share(&on, &field, &full, shares[k], &random);
}

/* So many targets that follow one another, of which several share a group in storage. */
static void each_target_is_counted_once(const test_case *test)
{
    static const int counts[] = {2, 5, 20, 200, 1000};
    const int d = test->dimension;
    random_state random = random_seeded(54);
    const cloud points = cloud_jittered(d, d == 2 ? 40 : 12, 1, .3, &random);
    comparison on = comparison_of(test, "several blocks", points, 2.25);
    comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_VECTOR, 6)};
    comparison_result results = comparison_outputs(&on, &field, on.points.count);
    setup_array numbers = setup_numbers(test_field_type(test), points.count, d, field.numbers);
    const sphg_view values = setup_view(&numbers);
    const sphg_sources sources = comparison_sources(&on);
    int32_t *indices = test_memory((size_t)points.count * sizeof *indices);
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; ++k) {
        const int begin = points.count / 3;
        for (int i = 0; i < counts[k]; ++i)
            indices[i] = begin + i;
        const sphg_subset subsets[] = {sphg_range(begin, begin + counts[k]),
                                       sphg_listed(indices, counts[k])};
        for (int kind = 0; kind < 2; ++kind) {
            sphg_field asked = {.shape = SPHG_VECTOR, .at_sources = &values};
            comparison_ask_for(&results, &asked);
            sphg_stats stats;
            const sphg_request request = {.sources = &sources,
                                          .set_count = 1,
                                          .fields = &asked,
                                          .field_count = 1,
                                          .subset = &subsets[kind],
                                          .stats = &stats};
            SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
            const int64_t counted = stats.rank[0] + stats.rank[1] + stats.rank[2] + stats.rank[3];
            TEST_REQUIRE(counted == counts[k], "%lld of %d", (long long)counted, counts[k]);
        }
    }
}

static void threads_do_not_change_a_bit(const test_case *test)
{
    comparison on = comparison_of(test, "block", unit_block(test->dimension), 2.25);
    comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_VECTOR, 6)};
    comparison_result two = comparison_apply(&on, &field, NULL);
    static const int threads[] = {1, 3, 5};
    for (int t = 0; t < 3; ++t) {
        comparison other = on;
        other.context = setup_context_of(threads[t]);
        other.neighbors = setup_neighbors(other.context, test, &other.scheme, &other.points);
        comparison_result found = comparison_apply(&other, &field, NULL);
        TEST_REQUIRE(comparison_results_have_same_bits(&two, &found), "%d threads", threads[t]);
    }
}

/* ---- Within the error bound
 * ------------------------------------------------------------------------- */

/* Items of `found` taken from particle[i], component[c]; compared on a few particles. */
static void require_near(const comparison *on, const comparison_field *field,
                         const comparison_result *exact, const comparison_result *found,
                         const int *particle, const int *component, const char *what)
{
    int d = on->points.dimension;
    oracle_field asked = {field->shape, field->form, field->numbers, NULL};
    for (int i = 0; i < on->points.count; i += 9) {
        quad moved[3], bound = oracle_apply(on->reference, &asked, i).bound;
        for (int c = 0; c < d; ++c)
            moved[c] = setup_get(&found->gradient, particle ? particle[i] : i,
                                 component ? component[c] : c);
        TEST_WITHIN(equal_within_bound, comparison_ratio(&exact->gradient, i, moved, bound),
                    test_text("%s, %s", what, test_method_name(on->test->method)));
    }
}

static double *gathered(const double *numbers, const int *from, int count, int width)
{
    double *result = test_memory((size_t)(count * width) * sizeof *result);
    for (int k = 0; k < count * width; ++k)
        result[k] = numbers[from[k / width] * width + k % width];
    return result;
}

static void order_of_particles_matters_within_the_bound(const test_case *test)
{
    comparison on = comparison_of(test, "block", unit_block(test->dimension), 2.25);
    int n = on.points.count, d = test->dimension;
    int *from = test_memory((size_t)n * sizeof *from), *to = test_memory((size_t)n * sizeof *to);
    random_state random = random_seeded(54);
    for (int i = 0; i < n; ++i) {
        int j = random_index(&random, i + 1);
        from[i] = from[j];
        from[j] = i;
    }
    for (int i = 0; i < n; ++i)
        to[from[i]] = i;
    cloud shuffled = on.points;
    shuffled.x = gathered(on.points.x, from, n, d);
    comparison other = comparison_of(test, "shuffled", shuffled, 2.25);
    other = comparison_with_volumes(&other, gathered(on.scene.volume, from, n, 1));
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_SCALAR, 7)};
    comparison_field moved = field;
    moved.numbers = gathered(field.numbers, from, n, 1);
    comparison_result one = comparison_apply(&on, &field, NULL),
                      two = comparison_apply(&other, &moved, NULL);
    require_near(&on, &field, &one, &two, to, NULL, "shuffled");
}

static void axes_may_be_swapped_within_the_bound(const test_case *test)
{
    int d = test->dimension, next[] = {1, d == 2 ? 0 : 2, 0};
    comparison on = comparison_of(test, "block", unit_block(d), 2.25);
    cloud turned = cloud_copy(&on.points);
    for (int k = 0; k < turned.count * d; ++k)
        turned.x[k / d * d + next[k % d]] = on.points.x[k];
    comparison other = comparison_of(test, "axes swapped", turned, 2.25);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_SCALAR, 7)};
    comparison_result one = comparison_apply(&on, &field, NULL),
                      two = comparison_apply(&other, &field, NULL);
    require_near(&on, &field, &one, &two, NULL, next, "axes swapped");
}

/* Turned by 3-4-5 in the first two axes: exact where coordinates are multiples of 5 / 2^k. */
static void rotations_turn_gradients_within_the_bound(const test_case *test)
{
    int d = test->dimension;
    cloud points = unit_block(d);
    for (int k = 0; k < points.count * d; ++k)
        points.x[k] *= 5;
    comparison on = comparison_of(test, "block", points, 11.25);
    cloud turned = cloud_copy(&points);
    for (int i = 0; i < points.count; ++i) {
        const double *x = points.x + i * d;
        turned.x[i * d] = (3 * x[0] - 4 * x[1]) / 5;
        turned.x[i * d + 1] = (4 * x[0] + 3 * x[1]) / 5;
    }
    comparison other = comparison_of(test, "turned", turned, 11.25);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_SCALAR, 8)};
    comparison_result one = comparison_apply(&on, &field, NULL),
                      two = comparison_apply(&other, &field, NULL);
    double *back = setup_doubles(&two.gradient);
    for (int i = 0; i < points.count; ++i) {
        double gx = back[i * d], gy = back[i * d + 1];
        back[i * d] = (3 * gx + 4 * gy) / 5;
        back[i * d + 1] = (-4 * gx + 3 * gy) / 5;
    }
    two.gradient = setup_numbers(SPHG_F64, points.count, d, back);
    require_near(&on, &field, &one, &two, NULL, NULL, "turned");
}

static void far_translation_stays_within_the_bound(const test_case *test)
{
    static const double vector[] = {-37, 91, 13.5};
    comparison on = comparison_of(test, "block", unit_block(test->dimension), 2.25);
    cloud moved = cloud_copy(&on.points);
    cloud_shift(&moved, vector);
    comparison other = comparison_of(test, "moved", moved, 2.25);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(&on, SPHG_SCALAR, 9)};
    comparison_result one = comparison_apply(&on, &field, NULL),
                      two = comparison_apply(&other, &field, NULL);
    require_near(&on, &field, &one, &two, NULL, NULL, "other cells");
}

static void mls_is_rkpm_at_unit_volume(const test_case *test)
{
    test_case cases[] = {*test, *test};
    cases[1].method = SPHG_RKPM;
    comparison stages[2];
    comparison_result found[2];
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, NULL};
    for (int s = 0; s < 2; ++s) {
        comparison made =
            comparison_of(&cases[s], "unit volumes", unit_block(test->dimension), 2.25);
        double *volume = test_memory((size_t)made.points.count * sizeof *volume);
        for (int i = 0; i < made.points.count; ++i)
            volume[i] = 1;
        stages[s] = comparison_with_volumes(&made, volume);
        field.numbers = comparison_random_field(&stages[s], SPHG_SCALAR, 10);
        found[s] = comparison_apply(&stages[s], &field, NULL);
    }
    require_near(&stages[0], &field, &found[0], &found[1], NULL, NULL, "MLS against RKPM");
}

static const test_entry entries[] = {
    TEST_ENTRY(powers_of_two_scale_to_the_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(powers_of_two_keep_ranks_and_scale_corrections, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, TEST_ALL_KERNELS),
    TEST_ENTRY(exact_translation_keeps_every_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(exact_constants_added_keep_every_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(mirror_images_have_mirrored_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(subsets_have_the_bits_of_the_full_run, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(each_target_is_counted_once, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(threads_do_not_change_a_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(order_of_particles_matters_within_the_bound, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(axes_may_be_swapped_within_the_bound, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(rotations_turn_gradients_within_the_bound, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(far_translation_stays_within_the_bound, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(mls_is_rkpm_at_unit_volume, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_MLS), 0),
};
TEST_MAIN(entries)
