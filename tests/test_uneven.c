/* SPDX-License-Identifier: MIT */
/* Clouds whose lists are of all lengths, so that lists that stand side by side, lists that stand
 * one after the other and lists of nobody follow one another: kept, found on the way, told by the
 * host, and taken in any company, they give the same bits on every instruction set. */
#include "support/setup.h"
#include <string.h>

enum { COUNT = 1501, CLUSTERS = 9, MOST = 120 };

typedef struct uneven {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    cloud points;
    setup_array positions, volume, field;
} uneven;

/* Half of the points far apart, half in clusters of one to MOST. */
static cloud uneven_cloud(int dimension, random_state *random)
{
    cloud made = {.dimension = dimension, .count = COUNT};
    made.x = test_memory((size_t)(COUNT * dimension) * sizeof *made.x);
    double centre[3] = {0};
    int left = 0;
    for (int i = 0; i < COUNT; ++i) {
        const int alone = !left && random_index(random, 2 * MOST / 3);
        if (!left) {
            left = alone ? 1 : 1 + random_index(random, MOST);
            for (int c = 0; c < dimension; ++c)
                centre[c] = random_between(random, 0, 24);
        }
        --left;
        for (int c = 0; c < dimension; ++c)
            made.x[i * dimension + c] = centre[c] + (alone ? 0 : random_between(random, -.8, .8));
    }
    return made;
}

static uneven uneven_of(const test_case *test, sphg_isa isa)
{
    uneven made = {.test = test, .context = setup_context_on(isa)};
    random_state random = random_seeded(433);
    const sphg_type type = test_field_type(test);
    double numbers[COUNT], volumes[COUNT];
    made.scheme = setup_scheme(test, 1);
    made.points = uneven_cloud(test->dimension, &random);
    made.positions = setup_positions(test, &made.points);
    for (int i = 0; i < COUNT; ++i) {
        numbers[i] = random_between(&random, -1, 1);
        volumes[i] = random_between(&random, .5, 1.5);
    }
    made.field = setup_numbers(type, COUNT, 1, numbers);
    made.volume = setup_numbers(type, COUNT, 1, volumes);
    return made;
}

typedef struct results {
    setup_array gradient, correction, rank;
} results;

static results evaluate(const uneven *on, const sphg_neighbors *neighbors,
                        const sphg_subset *subset)
{
    const sphg_type type = test_field_type(on->test);
    const int width = sphg_correction_width(&on->scheme), d = on->test->dimension;
    results found = {setup_output(type, COUNT, d), setup_output(type, COUNT, width ? width : 1),
                     setup_output(SPHG_U8, COUNT, 1)};
    const sphg_view field = setup_view(&on->field);
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&on->volume)};
    const sphg_field asked = {
        .shape = SPHG_SCALAR, .at_sources = &field, .gradient = setup_view(&found.gradient)};
    sphg_request request = {.sources = &sources,
                            .fields = &asked,
                            .set_count = 1,
                            .field_count = 1,
                            .subset = subset,
                            .target_volume = setup_view(&on->volume)};
    if (width) {
        request.correction = setup_view(&found.correction);
        request.rank = setup_view(&found.rank);
    }
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

static void require_same(const results *a, const results *b, const char *how)
{
    TEST_REQUIRE(setup_same_bits(&a->gradient, &b->gradient), "%s: gradient", how);
    TEST_REQUIRE(setup_same_bits(&a->correction, &b->correction), "%s: correction", how);
    TEST_REQUIRE(setup_same_bits(&a->rank, &b->rank), "%s: rank", how);
}

/* Indices that come with gradients, and those of some of the targets, stand in the same order. */
static void require_same_order(const uneven *on, const sphg_scheme *scheme,
                               const sphg_sources *sources, const sphg_pairs *expected)
{
    const setup_array gradient =
        setup_output(on->volume.type, (int)expected->count, scheme->dimension);
    const size_t bytes = (size_t)(expected->count + 1) * sizeof(int32_t);
    int64_t *offsets = test_memory((COUNT + 1) * sizeof *offsets);
    sphg_pairs pairs = *expected;
    pairs.indices = test_memory(bytes);
    pairs.gradient = setup_view(&gradient);
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, scheme, sources, NULL, sphg_absent(), &pairs));
    TEST_REQUIRE(!memcmp(pairs.indices, expected->indices, bytes), "indices beside gradients");
    const sphg_subset some = sphg_range(COUNT / 3, COUNT - 5);
    const int64_t first = expected->offsets[some.begin];
    pairs.gradient = sphg_absent();
    pairs.offsets = offsets;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, scheme, sources, &some, sphg_absent(), &pairs));
    TEST_REQUIRE(pairs.count == expected->offsets[some.end] - first &&
                     !memcmp(pairs.indices, expected->indices + first,
                             (size_t)pairs.count * sizeof(int32_t)),
                 "indices of some");
}

/* The pairs in the library's order, as a host's lists. */
static sphg_lists lists_of(const uneven *on, const sphg_neighbors *neighbors)
{
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&on->volume)};
    const sphg_scheme plain = {.method = SPHG_PLAIN,
                               .dimension = on->scheme.dimension,
                               .support_radius = on->scheme.support_radius};
    int64_t *offsets = test_memory((COUNT + 1) * sizeof *offsets);
    sphg_pairs pairs = {.offsets = offsets, .any_order = 1};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    pairs.indices = test_memory((size_t)(pairs.count + 1) * sizeof *pairs.indices);
    pairs.capacity = pairs.count;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    require_same_order(on, &plain, &sources, &pairs);
    return (sphg_lists){.offsets = offsets, .indices = pairs.indices};
}

/* Two masks that share out the targets, in pieces that cross groups. */
static void try_masks(const uneven *on, const sphg_neighbors *neighbors, const results *expected,
                      unsigned chance)
{
    uint8_t masks[2][COUNT];
    random_state random = random_seeded(chance);
    for (int i = 0; i < COUNT; ++i) {
        masks[0][i] = random_index(&random, (int)chance) == 0;
        masks[1][i] = !masks[0][i];
    }
    for (int k = 0; k < 2; ++k) {
        const sphg_subset subset = sphg_masked(masks[k], COUNT);
        const results found = evaluate(on, neighbors, &subset);
        for (int i = 0; i < COUNT; ++i)
            for (int c = 0; c < found.gradient.width && masks[k][i]; ++c)
                TEST_REQUIRE(!memcmp(&(double){setup_get(&found.gradient, i, c)},
                                     &(double){setup_get(&expected->gradient, i, c)},
                                     sizeof(double)),
                             "mask of 1 in %u, target %d", chance, i);
    }
}

static results try_instruction_set(const test_case *test, sphg_isa isa)
{
    uneven on = uneven_of(test, isa);
    sphg_geometry geometry = setup_geometry(test, &on.points, &on.positions);
    const sphg_neighbors *kept = setup_search(on.context, &on.scheme, &geometry);
    const results expected = evaluate(&on, kept, NULL);
    const sphg_lists lists = lists_of(&on, kept);
    const sphg_neighbors *told = setup_lists(on.context, &on.scheme, &geometry, &lists);
    const results by_host = evaluate(&on, told, NULL);
    require_same(&by_host, &expected, test_text("path %d, told", (int)isa));
    geometry.list_free = 1;
    const sphg_neighbors *free = setup_search(on.context, &on.scheme, &geometry);
    const results on_the_way = evaluate(&on, free, NULL);
    require_same(&on_the_way, &expected, test_text("path %d, list-free", (int)isa));
    for (unsigned chance = 2; chance < 100; chance *= 6) {
        try_masks(&on, kept, &expected, chance);
        try_masks(&on, free, &expected, chance);
    }
    return expected;
}

static void lists_of_all_lengths_give_the_same_bits(const test_case *test)
{
    results of_fused;
    int fused = 0;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        if (!setup_context_on(isa))
            continue;
        const results found = try_instruction_set(test, isa);
        if (isa != SPHG_ISA_BASE && fused++)
            require_same(&found, &of_fused, test_text("path %d beside another", (int)isa));
        of_fused = found;
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(lists_of_all_lengths_give_the_same_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS) | TEST_BIT(SPHG_PLAIN), 0),
};
TEST_MAIN(entries)
