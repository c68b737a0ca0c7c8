/* SPDX-License-Identifier: MIT */
/* Pairs and their gradients as CSR, for loops of the host: whose they are, which of their arrays
 * are wanted, and which targets. Their values are compared with the oracle in test_accuracy.c. */
#include "support/brute_force.h"
#include "support/comparison.h"
#include <math.h>
#include <string.h>

enum { PROBES = 40 };

/* A block, and targets elsewhere in it. */
typedef struct targets {
    comparison on;
    const sphg_neighbors *neighbors;
    int count, are_sources;
    setup_array table;
} targets;

static setup_array table_of(const targets *own)
{
    const comparison *on = &own->on;
    const int width = sphg_correction_width(&on->scheme);
    const setup_array table = setup_output(test_field_type(on->test), own->count, width);
    sphg_sources sources = comparison_sources(on);
    sources.neighbors = own->neighbors;
    const setup_array volume = setup_numbers(table.type, own->count, 1, on->scene.volume);
    const sphg_request request = {.sources = &sources,
                                  .set_count = 1,
                                  .target_volume = setup_view(&volume),
                                  .correction = setup_view(&table)};
    if (width > 0)
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return table;
}

static targets targets_of(const test_case *test, int are_sources)
{
    const int d = test->dimension;
    random_state random = random_seeded(95);
    const cloud points = cloud_jittered(d, d == 2 ? 8 : 5, .125, .25, &random);
    targets own = {.on = comparison_of(test, "block", points, 2.5 * .125),
                   .are_sources = are_sources};
    own.neighbors = own.on.neighbors;
    own.count = points.count;
    if (!are_sources) {
        cloud probes = cloud_random(d, PROBES, .5, &random);
        const setup_array at = setup_positions(test, &own.on.points);
        const setup_array places = setup_positions(test, &probes);
        sphg_geometry geometry = setup_geometry(test, &own.on.points, &at);
        geometry.targets = setup_view(&places);
        geometry.target_count = own.count = PROBES;
        own.neighbors = setup_search(own.on.context, &own.on.scheme, &geometry);
    }
    own.table = table_of(&own);
    return own;
}

typedef struct pair_rows {
    rows listed;
    setup_array gradient;
} pair_rows;

/* The count first, then what is wanted. */
static pair_rows pairs_in_order(const targets *own, const sphg_subset *subset, int with_gradients,
                                int any_order)
{
    const comparison *on = &own->on;
    sphg_sources sources = comparison_sources(on);
    sources.neighbors = own->neighbors;
    pair_rows found = {{own->count, test_memory(((size_t)own->count + 1) * 8), NULL}, {0}};
    sphg_pairs pairs = {.offsets = found.listed.offsets, .any_order = any_order};
    const sphg_view table = comparison_table_view(on, &own->table);
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, subset, table, &pairs));
    found.listed.indices = test_memory((size_t)pairs.count * sizeof(int32_t));
    found.gradient = setup_output(test_field_type(on->test), (int)pairs.count,
                                  with_gradients ? on->points.dimension : 0);
    pairs.indices = found.listed.indices;
    pairs.capacity = pairs.count;
    if (with_gradients)
        pairs.gradient = setup_view(&found.gradient);
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, subset, table, &pairs));
    return found;
}

static pair_rows pairs_of(const targets *own, const sphg_subset *subset, int with_gradients)
{
    return pairs_in_order(own, subset, with_gradients, 0);
}

/* A target stands among its own pairs where the method has a gradient for it. */
static void require_searched(const targets *own, const rows *found)
{
    const comparison *on = &own->on;
    const rows expected = rows_listed(on->context, own->neighbors, &on->scheme, NULL);
    const int self = own->are_sources && test_is_classic(on->test);
    for (int i = 0; i < own->count; ++i) {
        int64_t at = found->offsets[i];
        for (int64_t k = expected.offsets[i]; k < expected.offsets[i + 1]; ++k, ++at) {
            at += self && found->indices[at] == i;
            assert_int_equal(found->indices[at], expected.indices[k]);
        }
        at += self && at < found->offsets[i + 1] && found->indices[at] == i;
        assert_int_equal(found->offsets[i + 1], at);
        assert_int_equal(at - found->offsets[i],
                         expected.offsets[i + 1] - expected.offsets[i] + self);
    }
}

static void pairs_are_those_of_the_search(const test_case *test)
{
    for (int are_sources = 0; are_sources < 2; ++are_sources) {
        const targets own = targets_of(test, are_sources);
        const pair_rows full = pairs_of(&own, NULL, 1), bare = pairs_of(&own, NULL, 0);
        require_searched(&own, &full.listed);
        rows_require_equal(&bare.listed, &full.listed, "without gradients");
    }
}

static void require_row(const pair_rows *all, int target, const pair_rows *some, int row)
{
    const int64_t first = all->listed.offsets[target], at = some->listed.offsets[row];
    const int64_t length = all->listed.offsets[target + 1] - first;
    assert_int_equal(some->listed.offsets[row + 1] - at, length);
    for (int64_t k = 0; k < length; ++k) {
        assert_int_equal(some->listed.indices[at + k], all->listed.indices[first + k]);
        for (int c = 0; c < all->gradient.width; ++c)
            TEST_REQUIRE(setup_get(&some->gradient, (int)(at + k), c) ==
                             setup_get(&all->gradient, (int)(first + k), c),
                         "target %d: other bits", target);
    }
}

static int64_t place_of(const pair_rows *all, int row, int32_t source)
{
    for (int64_t k = all->listed.offsets[row]; k < all->listed.offsets[row + 1]; ++k)
        if (all->listed.indices[k] == source)
            return k;
    return -1;
}

/* The same pairs with the same gradients, in an order that stays. */
static void pairs_in_any_order_are_those_in_order(const test_case *test)
{
    int64_t moved = 0;
    for (int are_sources = 0; are_sources < 2; ++are_sources) {
        const targets own = targets_of(test, are_sources);
        const pair_rows sorted = pairs_of(&own, NULL, 1), any = pairs_in_order(&own, NULL, 1, 1);
        const pair_rows again = pairs_in_order(&own, NULL, 1, 1),
                        bare = pairs_in_order(&own, NULL, 0, 1);
        for (int i = 0; i < own.count; ++i) {
            assert_int_equal(any.listed.offsets[i + 1], sorted.listed.offsets[i + 1]);
            for (int64_t k = any.listed.offsets[i]; k < any.listed.offsets[i + 1]; ++k) {
                const int64_t at = place_of(&sorted, i, any.listed.indices[k]);
                TEST_REQUIRE(at >= 0 && place_of(&any, i, any.listed.indices[k]) == k,
                             "row %d: %d is no pair, or twice", i, any.listed.indices[k]);
                moved += at != k;
                for (int c = 0; c < any.gradient.width; ++c)
                    TEST_REQUIRE(setup_get(&any.gradient, (int)k, c) ==
                                     setup_get(&sorted.gradient, (int)at, c),
                                 "row %d: other bits", i);
            }
        }
        rows_require_equal(&again.listed, &any.listed, "again");
        rows_require_equal(&bare.listed, &any.listed, "without gradients");
    }
    TEST_REQUIRE(moved > 0, "the library's order is that of the host");
}

/* ---- Blocks ---------------------------------------------------------------------------------- */

/* What is exported in blocks, beside the same pairs one after the other. */
typedef struct blocks {
    int block;
    rows listed;
    int32_t *lengths;
    setup_array gradient;
} blocks;

static blocks blocks_of(const targets *own, const sphg_subset *subset, int block, int any_order,
                        int with_indices)
{
    const comparison *on = &own->on;
    const int d = on->points.dimension;
    sphg_sources sources = comparison_sources(on);
    sources.neighbors = own->neighbors;
    blocks found = {
        block, {own->count, test_memory(((size_t)own->count + 1) * 8), NULL}, NULL, {0}};
    const sphg_view table = comparison_table_view(on, &own->table);
    sphg_pairs pairs = {.offsets = found.listed.offsets, .any_order = any_order, .block = block};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, subset, table, &pairs));
    found.listed.indices = test_memory((size_t)pairs.count * sizeof(int32_t));
    found.lengths = test_memory((size_t)own->count * sizeof(int32_t));
    found.gradient = setup_output(test_field_type(on->test), (int)pairs.count, d);
    pairs.indices = with_indices ? found.listed.indices : NULL;
    pairs.lengths = found.lengths;
    pairs.gradient = setup_view(&found.gradient);
    pairs.capacity = pairs.count - 1;
    assert_int_equal(sphg_pair_gradients(on->context, &on->scheme, &sources, subset, table, &pairs),
                     SPHG_ERROR_CAPACITY);
    assert_true(setup_is_canary(&found.gradient, 0));
    pairs.capacity = pairs.count;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, subset, table, &pairs));
    return found;
}

static double in_block(const blocks *found, int64_t place, int component)
{
    const int d = found->gradient.width;
    const int64_t number = place / found->block * found->block * d +
                           (int64_t)component * found->block + place % found->block;
    return setup_get(&found->gradient, (int)(number / d), (int)(number % d));
}

/* Row by row the same, and behind each row what adds nothing. */
static void require_blocks(const blocks *found, const pair_rows *expected, int count,
                           int with_indices)
{
    int64_t next = 0;
    for (int i = 0; i < count; ++i) {
        const int64_t first = expected->listed.offsets[i], at = found->listed.offsets[i];
        const int64_t length = expected->listed.offsets[i + 1] - first;
        assert_int_equal(at, next);
        assert_int_equal(found->lengths[i], length);
        next = at + (length + found->block - 1) / found->block * found->block;
        for (int64_t k = 0; at + k < next; ++k) {
            const int64_t same = first + (k < length ? k : length - 1);
            if (with_indices)
                assert_int_equal(found->listed.indices[at + k], expected->listed.indices[same]);
            for (int c = 0; c < found->gradient.width; ++c)
                TEST_REQUIRE(in_block(found, at + k, c) ==
                                 (k < length ? setup_get(&expected->gradient, (int)same, c) : 0),
                             "row %d, place %d, component %d", i, (int)k, c);
        }
    }
    assert_int_equal(found->listed.offsets[count], next);
}

static void blocks_hold_the_pairs_in_their_order(const test_case *test)
{
    for (int are_sources = 0; are_sources < 2; ++are_sources) {
        const targets own = targets_of(test, are_sources);
        for (int block = 4; block <= 16; block *= 2)
            for (int any_order = 0; any_order < 2; ++any_order) {
                const pair_rows expected = pairs_in_order(&own, NULL, 1, any_order);
                const int with_indices = block != 8 || any_order;
                const blocks found = blocks_of(&own, NULL, block, any_order, with_indices);
                require_blocks(&found, &expected, own.count, with_indices);
            }
        const sphg_subset few = sphg_range(own.count / 4, own.count / 2);
        const pair_rows expected = pairs_of(&own, &few, 1);
        const blocks found = blocks_of(&own, &few, 8, 0, 1);
        require_blocks(&found, &expected, few.end - few.begin, 1);
    }
}

/* Rows so long that they come in pieces, and are sorted by another way. */
static void blocks_hold_long_rows(const test_case *test)
{
    random_state random = random_seeded(96);
    const cloud points = cloud_random(test->dimension, 700, 1, &random);
    targets own = {.on = comparison_of(test, "crowd", points, 1.2), .are_sources = 1};
    own.neighbors = own.on.neighbors;
    own.count = points.count;
    own.table = table_of(&own);
    const sphg_subset few = sphg_range(0, 40);
    const pair_rows expected = pairs_of(&own, &few, 1);
    assert_true(expected.listed.offsets[1] > 200);
    const blocks found = blocks_of(&own, &few, 8, 0, 1);
    require_blocks(&found, &expected, 40, 1);
}

static void refuse_pairs(const targets *own, sphg_pairs pairs, const char *words)
{
    const comparison *on = &own->on;
    const sphg_sources sources = comparison_sources(on);
    const sphg_view table = comparison_table_view(on, &own->table);
    const sphg_result result =
        sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, table, &pairs);
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(result == SPHG_ERROR_ARGUMENT, "%s", sphg_result_string(result));
    TEST_REQUIRE(strstr(message, words), "%s", message);
}

static void what_is_no_block_is_refused(const test_case *test)
{
    const targets own = targets_of(test, 1);
    const int refused[] = {-8, 1, 2, 3, 7, 12, 32};
    for (size_t k = 0; k < sizeof refused / sizeof *refused; ++k)
        refuse_pairs(&own, (sphg_pairs){.block = refused[k]}, "must be 0, 4, 8 or 16");
    const setup_array wide = setup_output(test_field_type(test), 9000, 4);
    sphg_pairs pairs = {.block = 8, .capacity = 9000, .gradient = setup_view(&wide)};
    refuse_pairs(&own, pairs, "must be one array of stride");
    const setup_array whole = setup_output(test_field_type(test), 9000, test->dimension);
    const setup_array apart = setup_output(test_field_type(test), 9000, 1);
    pairs.gradient = setup_view(&whole);
    pairs.gradient.y = apart.data;
    pairs.gradient.z = test->dimension == 3 ? wide.data : NULL;
    refuse_pairs(&own, pairs, "must be one array of stride");
    pairs.gradient.y = pairs.gradient.z = NULL;
    pairs.indices = whole.data;
    refuse_pairs(&own, pairs, "overlap");
    pairs.indices = NULL;
    pairs.lengths = whole.data;
    refuse_pairs(&own, pairs, "pairs.lengths");
}

static void masked_targets_have_the_pairs_they_have_among_all(const test_case *test)
{
    for (int are_sources = 0; are_sources < 2; ++are_sources) {
        const targets own = targets_of(test, are_sources);
        uint8_t *mask = test_memory((size_t)own.count);
        for (int i = 0; i < own.count; ++i)
            mask[i] = i % 4 == 2;
        const sphg_subset subset = {0, own.count, NULL, mask};
        for (int way = 0; way < 4; ++way) { /* without gradients or with; sorted or not */
            const pair_rows all = pairs_in_order(&own, NULL, way & 1, way >> 1),
                            some = pairs_in_order(&own, &subset, way & 1, way >> 1);
            for (int i = 0, row = 0; i < own.count; ++i)
                if (mask[i])
                    require_row(&all, i, &some, row++);
        }
    }
}

/* Of one pair: a place that is not given has no gradient, in as many components as the scheme has.
 * Who forgets the corrections gets something else, but a number. */
static void single_pairs_have_as_many_components_as_the_scheme(const test_case *test)
{
    const sphg_scheme scheme = setup_scheme(test, 1);
    const double x_ij[3] = {.25, -.125, .5};
    double gradient[3] = {-7, -7, -7};
    sphg_pair_gradient(&scheme, NULL, .01, NULL, gradient);
    for (int c = 0; c < 3; ++c)
        assert_true(c < test->dimension ? isnan(gradient[c]) : gradient[c] == -7);
    sphg_pair_gradient(&scheme, x_ij, .01, NULL, gradient);
    for (int c = 0; c < 3; ++c)
        assert_true(c < test->dimension ? isfinite(gradient[c]) : gradient[c] == -7);
}

static const test_entry entries[] = {
    TEST_ENTRY(pairs_are_those_of_the_search, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(pairs_in_any_order_are_those_in_order, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(masked_targets_have_the_pairs_they_have_among_all, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(blocks_hold_the_pairs_in_their_order, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS), 0),
    TEST_ENTRY(blocks_hold_long_rows, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS), 0),
    TEST_ENTRY(what_is_no_block_is_refused, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC), 0),
    TEST_ENTRY(single_pairs_have_as_many_components_as_the_scheme, 0, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
