/* SPDX-License-Identifier: MIT */
/* Neighbours that the host brings, and the life of a neighbours object: copies, borrowed lists,
 * rebuilds, order and report. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 300 };

/* A jittered block, its scheme, and what a search of it gives. */
typedef struct comparison {
    sphg_context *context;
    cloud points;
    scene particles;
    sphg_scheme scheme;
    sphg_geometry geometry;
    setup_array field, volume;
} comparison;

static comparison comparison_of(const test_case *test)
{
    comparison own = {.context = setup_context()};
    random_state random = random_seeded(83);
    own.points = cloud_random(test->dimension, COUNT, 4, &random);
    own.particles = scene_of_cloud(test, &own.points);
    own.scheme = setup_scheme(test, test->dimension == 2 ? 0.5 : 1);
    own.geometry = scene_geometry(&own.particles);
    own.field =
        setup_numbers(test_field_type(test), COUNT, 1, cloud_numbers(&own.points, -1, 1, &random));
    own.volume =
        setup_numbers(test_field_type(test), COUNT, 1, cloud_volumes(&own.points, 0.1, &random));
    return own;
}

/* The gradient through these neighbours; equal bits mean equal pairs, order and positions. */
static setup_array gradient_through(const comparison *own, const sphg_neighbors *neighbors)
{
    setup_array gradient = setup_output(own->field.type, COUNT, own->points.dimension);
    sphg_sources sources = {0};
    sources.neighbors = neighbors;
    sources.volume = setup_view(&own->volume);
    SETUP_OK(own->context, sphg_gradient(own->context, &own->scheme, &sources, NULL,
                                         setup_view(&own->field), setup_view(&gradient)));
    return gradient;
}

/* ---- Lists of the host -------------------------------------------------------------------- */

static void shuffle(int32_t *items, int64_t count, random_state *random)
{
    for (int64_t k = count - 1; k > 0; --k) {
        const int64_t other = random_index(random, (int)k + 1);
        const int32_t kept = items[k];
        items[k] = items[other];
        items[other] = kept;
    }
}

/* All pairs within the wider radius, i itself now and then, in any order, and bits above the mask
 * that mean something to the host alone. */
typedef struct host_lists {
    rows csr;
    const int32_t **pointers;
    int32_t *lengths;
    int32_t mask;
} host_lists;

static host_lists host_lists_of(const comparison *own, double radius, int32_t mask)
{
    random_state random = random_seeded(89);
    const rows wide = rows_by_brute_force(&own->particles, radius);
    host_lists lists = {{COUNT, wide.offsets, NULL}, NULL, NULL, mask};
    lists.csr.offsets = test_memory((COUNT + 1) * sizeof(int64_t));
    lists.csr.indices = test_memory((size_t)(wide.offsets[COUNT] + COUNT) * sizeof(int32_t));
    lists.pointers = test_memory(COUNT * sizeof *lists.pointers);
    lists.lengths = test_memory(COUNT * sizeof *lists.lengths);
    int64_t next = 0;
    for (int i = 0; i < COUNT; ++i) {
        int32_t *row = lists.csr.indices + next;
        for (int64_t k = wide.offsets[i]; k < wide.offsets[i + 1]; ++k)
            lists.csr.indices[next++] = wide.indices[k];
        if (!own->particles.targets && i % 3)
            lists.csr.indices[next++] = i;
        shuffle(row, lists.csr.indices + next - row, &random);
        for (int32_t *item = row; mask && item < lists.csr.indices + next; ++item)
            *item |= random_index(&random, 4) << 29;
        lists.pointers[i] = row;
        lists.lengths[i] = (int32_t)(lists.csr.indices + next - row);
        lists.csr.offsets[i + 1] = next;
    }
    return lists;
}

static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    const host_lists *lists = user;
    if (worker < 0)
        return -1;
    *indices = lists->pointers[target];
    return lists->lengths[target];
}

enum { CSR, POINTERS, FUNCTION, GROUPS };

static sphg_lists group_of(host_lists *lists, int group)
{
    sphg_lists given = {0};
    given.index_mask = lists->mask;
    if (group == CSR) {
        given.offsets = lists->csr.offsets;
        given.indices = lists->csr.indices;
    } else if (group == POINTERS) {
        given.rows = lists->pointers;
        given.lengths = lists->lengths;
    } else {
        given.row = row_of;
        given.user = lists;
    }
    return given;
}

/* Supersets, any order, self included, masked or not: the pairs are those of the search, and
 * gradients agree up to the order of summation. */
static void lists_of_the_host_give_the_pairs_of_the_search(const test_case *test)
{
    const comparison own = comparison_of(test);
    const double H = own.scheme.support_radius;
    const sphg_neighbors *searched = setup_search(own.context, &own.scheme, &own.geometry);
    const rows expected = rows_by_brute_force(&own.particles, H);
    const setup_array gradient = gradient_through(&own, searched);
    const int32_t masks[] = {0, 0x1fffffff};
    for (int k = 0; k < 2 * GROUPS; ++k) {
        host_lists lists = host_lists_of(&own, k % 2 ? H : 1.5 * H, masks[k / GROUPS]);
        const sphg_lists given = group_of(&lists, k % GROUPS);
        const sphg_neighbors *brought =
            setup_lists(own.context, &own.scheme, &own.geometry, &given);
        const rows found = rows_listed(own.context, brought, &own.scheme, NULL);
        rows_require_equal(&found, &expected, test_text("group %d", k % GROUPS));
        const setup_array other = gradient_through(&own, brought);
        setup_require_close(&gradient, &other, test_method_name(test->method));
    }
}

/* Search, export as CSR, use the export: same pairs, same gradients up to rounding. */
static void exported_pairs_can_be_used_as_lists(const test_case *test)
{
    const comparison own = comparison_of(test);
    const sphg_neighbors *searched = setup_search(own.context, &own.scheme, &own.geometry);
    const rows exported = rows_listed(own.context, searched, &own.scheme, NULL);
    sphg_lists given = {0};
    given.offsets = exported.offsets;
    given.indices = exported.indices;
    const sphg_neighbors *brought = setup_lists(own.context, &own.scheme, &own.geometry, &given);
    const rows again = rows_listed(own.context, brought, &own.scheme, NULL);
    rows_require_equal(&again, &exported, "round trip");
    const setup_array a = gradient_through(&own, searched), b = gradient_through(&own, brought);
    setup_require_close(&a, &b, "exported");
}

/* Lists work across periodic faces and for targets that are not sources. */
static void lists_see_periodic_images_and_targets(const test_case *test)
{
    comparison own = comparison_of(test);
    random_state random = random_seeded(97);
    cloud others = cloud_random(test->dimension, COUNT, 4, &random);
    const scene apart = scene_of_cloud(test, &others);
    own.particles.targets = apart.sources;
    for (int axis = 0; axis < test->dimension; ++axis)
        own.particles.period[axis] = 4;
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const rows expected = rows_by_brute_force(&own.particles, own.scheme.support_radius);
    host_lists lists = host_lists_of(&own, 1.5, 0);
    for (int group = 0; group < GROUPS; ++group) {
        const sphg_lists given = group_of(&lists, group);
        const sphg_neighbors *brought = setup_lists(own.context, &own.scheme, &geometry, &given);
        const rows found = rows_listed(own.context, brought, &own.scheme, NULL);
        rows_require_equal(&found, &expected, "periodic targets");
    }
}

/* ---- Copies ------------------------------------------------------------------------------- */

/* The rest configuration of a solid: the particles move on, the neighbours do not. */
static void built_neighbours_keep_their_positions(const test_case *test)
{
    const comparison own = comparison_of(test);
    const size_t bytes =
        (size_t)(COUNT * test->dimension) * (own.particles.is_double ? sizeof(double) : 4);
    host_lists lists = host_lists_of(&own, 1.25, 0);
    for (int kind = 0; kind < 3; ++kind) {
        sphg_geometry geometry = scene_geometry(&own.particles);
        const sphg_lists given = group_of(&lists, CSR);
        geometry.list_free = kind == 1;
        const sphg_neighbors *rest = kind < 2
                                         ? setup_search(own.context, &own.scheme, &geometry)
                                         : setup_lists(own.context, &own.scheme, &geometry, &given);
        const setup_array before = gradient_through(&own, rest);
        memset((void *)(uintptr_t)geometry.sources.x, 0x7f, bytes);
        const setup_array after = gradient_through(&own, rest);
        assert_true(setup_same_bits(&before, &after));
    }
}

/* ---- Report and order --------------------------------------------------------------------- */

static void info_reports_pairs_counts_and_bytes(const test_case *test)
{
    comparison own = comparison_of(test);
    sphg_neighbors *neighbors = brute_force_neighbors(own.context);
    const rows expected = rows_by_brute_force(&own.particles, own.scheme.support_radius);
    sphg_neighbors_info info = {0};
    SETUP_OK(own.context,
             sphg_neighbors_search(own.context, neighbors, &own.scheme, &own.geometry));
    SETUP_OK(own.context, sphg_neighbors_get_info(own.context, neighbors, &info));
    assert_int_equal(info.pairs, expected.offsets[COUNT]);
    assert_int_equal(info.target_count, COUNT);
    assert_int_equal(info.source_count, COUNT);
    assert_int_equal(info.rebuilt, 1);
    assert_true(info.bytes > COUNT * test->dimension * 4);
    own.geometry.list_free = 1;
    own.geometry.target_count = COUNT - 7;
    SETUP_OK(own.context,
             sphg_neighbors_search(own.context, neighbors, &own.scheme, &own.geometry));
    SETUP_OK(own.context, sphg_neighbors_get_info(own.context, neighbors, &info));
    assert_int_equal(info.pairs, 0);
    assert_int_equal(info.target_count, COUNT - 7);
    own.geometry.list_free = 0;
    own.geometry.target_count = COUNT;
    host_lists lists = host_lists_of(&own, 1.25, 0);
    for (int group = 0; group < GROUPS; ++group) {
        const sphg_lists given = group_of(&lists, group);
        SETUP_OK(own.context, sphg_neighbors_use_lists(own.context, neighbors, &own.scheme,
                                                       &own.geometry, &given));
        SETUP_OK(own.context, sphg_neighbors_get_info(own.context, neighbors, &info));
        assert_int_equal(info.pairs, group == CSR ? lists.csr.offsets[COUNT] : 0);
    }
}

/* The sum of the squared steps along a path through all particles. */
static double path_length(const comparison *own, const int32_t *order)
{
    const int d = own->points.dimension;
    double sum = 0;
    for (int k = 1; k < COUNT; ++k)
        for (int axis = 0; axis < d; ++axis)
            sum +=
                pow(own->points.x[order[k] * d + axis] - own->points.x[order[k - 1] * d + axis], 2);
    return sum;
}

static void order_is_a_permutation_and_a_short_path(const test_case *test)
{
    const comparison own = comparison_of(test);
    int32_t order[COUNT], identity[COUNT], seen[COUNT] = {0};
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &own.geometry);
    SETUP_OK(own.context, sphg_neighbors_get_order(own.context, neighbors, order));
    for (int k = 0; k < COUNT; ++k) {
        assert_in_range(order[k], 0, COUNT - 1);
        ++seen[order[k]];
        identity[k] = k;
    }
    for (int k = 0; k < COUNT; ++k)
        assert_int_equal(seen[k], 1);
    assert_true(path_length(&own, order) < 0.5 * path_length(&own, identity));
}

/* Particles sorted by the order have the same pairs under their new names. */
static void sorting_by_the_order_renames_the_pairs(const test_case *test)
{
    const comparison own = comparison_of(test);
    const int d = test->dimension;
    int32_t order[COUNT];
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &own.geometry);
    SETUP_OK(own.context, sphg_neighbors_get_order(own.context, neighbors, order));
    scene sorted = own.particles;
    sorted.sources = test_memory(COUNT * 3 * sizeof(double));
    for (int k = 0; k < COUNT * d; ++k)
        sorted.sources[k] = own.particles.sources[order[k / d] * d + k % d];
    rows_require_search_exact(own.context, brute_force_neighbors(own.context), &sorted,
                              own.scheme.support_radius, "sorted");
}

/* ---- Life --------------------------------------------------------------------------------- */

/* A build that was refused leaves the old state; the next good one replaces it. */
static void refused_build_keeps_the_old_state(const test_case *test)
{
    const comparison own = comparison_of(test);
    sphg_neighbors *neighbors = brute_force_neighbors(own.context);
    SETUP_OK(own.context,
             sphg_neighbors_search(own.context, neighbors, &own.scheme, &own.geometry));
    const setup_array before = gradient_through(&own, neighbors);
    cloud bad = {test->dimension, COUNT, 1, test_memory(COUNT * 3 * sizeof(double))};
    memcpy(bad.x, own.points.x, (size_t)(COUNT * test->dimension) * sizeof(double));
    bad.x[COUNT] = NAN;
    scene broken = own.particles;
    broken.sources = bad.x;
    const sphg_geometry geometry = scene_geometry(&broken);
    const rows lists = rows_by_brute_force(&own.particles, 1);
    sphg_lists given = {0};
    given.offsets = lists.offsets;
    given.indices = lists.indices;
    assert_int_equal(sphg_neighbors_search(own.context, neighbors, &own.scheme, &geometry),
                     SPHG_ERROR_NOT_FINITE);
    assert_int_equal(
        sphg_neighbors_use_lists(own.context, neighbors, &own.scheme, &geometry, &given),
        SPHG_ERROR_NOT_FINITE);
    const setup_array after = gradient_through(&own, neighbors);
    assert_true(setup_same_bits(&before, &after));
    SETUP_OK(own.context,
             sphg_neighbors_use_lists(own.context, neighbors, &own.scheme, &own.geometry, &given));
    const setup_array third = gradient_through(&own, neighbors);
    setup_require_close(&before, &third, "lists of the host");
}

/* One object serves scenes of any size, dimension and kind in turn; none and one are sizes too. */
static void object_can_be_rebuilt_for_other_scenes(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    const int counts[] = {200, 0, 1, 50, 2, 0, 300};
    for (int k = 0; k < 14; ++k) {
        random_state random = random_seeded(101 + (uint64_t)k);
        test_case other = *test;
        other.dimension = k < 7 ? test->dimension : 5 - test->dimension;
        cloud points = cloud_random(other.dimension, counts[k % 7], 2, &random);
        scene particles = scene_of_cloud(&other, &points);
        particles.list_free = k % 3 == 1;
        rows_require_search_exact(context, neighbors, &particles, 0.5, test_text("build %d", k));
    }
}

static void no_and_one_particle_give_empty_results(const test_case *test)
{
    sphg_context *context = setup_context();
    for (int count = 0; count < 2; ++count) {
        const double zero[3] = {0};
        const setup_array x = setup_numbers(test_position_type(test), count, test->dimension, zero);
        const setup_array field = setup_numbers(test_field_type(test), count, 1, zero);
        const double one = 1;
        const setup_array volume = setup_numbers(test_field_type(test), count, 1, &one);
        setup_array gradient = setup_output(field.type, count, test->dimension);
        cloud points = {test->dimension, count, 1, NULL};
        const sphg_scheme scheme = setup_scheme(test, 1);
        const sphg_geometry geometry = setup_geometry(test, &points, &x);
        sphg_sources sources = {0};
        sources.neighbors = setup_search(context, &scheme, &geometry);
        sources.volume = setup_view(&volume);
        SETUP_OK(context, sphg_gradient(context, &scheme, &sources, NULL, setup_view(&field),
                                        setup_view(&gradient)));
        for (int k = 0; k < count * test->dimension; ++k)
            assert_true(setup_get(&gradient, 0, k) == 0);
    }
}

/* No target, or none with a neighbour: there is no index to point at. */
static void lists_without_pairs_need_no_indices(const test_case *test)
{
    const comparison own = comparison_of(test);
    int64_t *offsets = test_memory((COUNT + 1) * sizeof *offsets);
    const sphg_lists none = {.offsets = offsets};
    const setup_array gradient =
        gradient_through(&own, setup_lists(own.context, &own.scheme, &own.geometry, &none));
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < gradient.width; ++k)
            assert_true(setup_get(&gradient, i, k) == 0);
}

/* A set whose particles are all elsewhere today, as in a host that splits its domain. */
static void targets_without_sources_have_sums_of_nothing(const test_case *test)
{
    const comparison own = comparison_of(test);
    for (int list_free = 0; list_free < 2; ++list_free) {
        sphg_geometry geometry = own.geometry;
        geometry.targets = geometry.sources;
        geometry.target_count = COUNT;
        geometry.sources = sphg_absent();
        geometry.source_count = 0;
        geometry.list_free = list_free;
        const setup_array value = setup_output(own.field.type, COUNT, 1);
        const sphg_view none = sphg_absent();
        const sphg_sources sources = {.neighbors =
                                          setup_search(own.context, &own.scheme, &geometry),
                                      .volume = setup_view(&own.volume)};
        const sphg_field asked = {.shape = SPHG_SCALAR,
                                  .form = SPHG_DIRECT,
                                  .at_sources = &none,
                                  .value = setup_view(&value)};
        const sphg_request request = {
            .sources = &sources, .fields = &asked, .set_count = 1, .field_count = 1};
        SETUP_OK(own.context, sphg_evaluate(own.context, &own.scheme, &request));
        for (int i = 0; i < COUNT; ++i)
            assert_true(setup_get(&value, i, 0) == 0);
    }
}

static void no_dimension_means_three(const test_case *test)
{
    comparison own = comparison_of(test);
    const setup_array expected =
        gradient_through(&own, setup_search(own.context, &own.scheme, &own.geometry));
    own.scheme.dimension = 0;
    const setup_array found =
        gradient_through(&own, setup_search(own.context, &own.scheme, &own.geometry));
    assert_true(setup_same_bits(&found, &expected));
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    TEST_ENTRY(lists_of_the_host_give_the_pairs_of_the_search, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    EACH(exported_pairs_can_be_used_as_lists),
    EACH(lists_see_periodic_images_and_targets),
    EACH(built_neighbours_keep_their_positions),
    EACH(info_reports_pairs_counts_and_bytes),
    EACH(order_is_a_permutation_and_a_short_path),
    EACH(sorting_by_the_order_renames_the_pairs),
    EACH(refused_build_keeps_the_old_state),
    EACH(object_can_be_rebuilt_for_other_scenes),
    EACH(lists_without_pairs_need_no_indices),
    EACH(targets_without_sources_have_sums_of_nothing),
    TEST_ENTRY(no_dimension_means_three, TEST_ALL_PRECISIONS, TEST_3D, TEST_ALL_METHODS, 0),
    TEST_ENTRY(no_and_one_particle_give_empty_results, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
