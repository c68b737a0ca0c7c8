/* SPDX-License-Identifier: MIT */
/* Sizes and distances that break grids and 32-bit counts: an escapee, everybody in one cell, more
 * than 2^31 pairs. SPHG_TEST_LONG=1 takes a million particles. */
#include "support/setup.h"
#include "support/fake_host.h"
#include "support/long_counts.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>
#include <sys/mman.h>

/* ---- An allocator with a limit ------------------------------------------------------------ */

/* Refuses what no machine of today has, and remembers how much that was. */
typedef struct limited {
    size_t most, largest;
} limited;

static void *allocate_limited(size_t size, size_t alignment, void *user)
{
    limited *limit = user;
    limit->largest = size > limit->largest ? size : limit->largest;
    return size > limit->most
               ? NULL
               : aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release_limited(void *memory, size_t size, void *user)
{
    (void)size, (void)user;
    free(memory);
}

typedef struct host {
    limited limit;
    sphg_context *context;
    sphg_neighbors *neighbors;
} host;

static void close_host(void *object)
{
    host *own = object;
    sphg_neighbors_destroy(own->neighbors);
    sphg_context_destroy(own->context);
}

static host *host_of(size_t most)
{
    host *own = test_memory(sizeof *own);
    own->limit.most = most;
    const sphg_config config = {.threads = 2,
                                .isa = test_isa(),
                                .allocate = allocate_limited,
                                .release = release_limited,
                                .user = &own->limit};
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &own->context));
    test_at_end(close_host, own);
    SETUP_OK(own->context, sphg_neighbors_create(own->context, &own->neighbors));
    return own;
}

/* ---- One escapee among many --------------------------------------------------------------- */

static double *positions_in_cube(int count, int dimension, double side)
{
    random_state random = random_seeded(401);
    double *x = test_memory((size_t)(count * dimension) * sizeof *x);
    for (int k = 0; k < count * dimension; ++k)
        x[k] = random_between(&random, 0, side);
    return x;
}

typedef struct cost {
    int64_t bytes, pairs;
    double seconds; /* the least of three */
} cost;

/* A search in a fresh context, at its peak. */
static cost cost_of_search(const test_case *test, const setup_array *positions)
{
    cost found = {0, 0, INFINITY};
    const sphg_scheme scheme = setup_scheme(test, 1);
    sphg_geometry geometry = {.sources = setup_view(positions)};
    geometry.source_count = geometry.target_count = positions->count;
    for (int repeat = 0; repeat < 3; ++repeat) {
        fake_host own;
        sphg_context *context = NULL;
        sphg_neighbors *neighbors = NULL;
        sphg_neighbors_info info;
        fake_host_open(&own);
        const sphg_config config = fake_host_config(&own, 2);
        SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &context));
        SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
        SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
        const double start = long_seconds();
        SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
        found.seconds = fmin(found.seconds, long_seconds() - start);
        SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
        found.bytes = own.peak_bytes;
        found.pairs = info.pairs;
        sphg_neighbors_destroy(neighbors);
        sphg_context_destroy(context);
        fake_host_close(&own);
    }
    return found;
}

static void escapee_costs_next_to_nothing(const test_case *test)
{
    const int count = long_or(1000000, 40000), d = test->dimension;
    const double side = d == 2 ? sqrt(count / 6.) : cbrt(count / 8.);
    double *x = positions_in_cube(count, d, side);
    const setup_array before = setup_numbers(test_position_type(test), count, d, x);
    x[count / 2 * d] = 1e30;
    const setup_array after = setup_numbers(test_position_type(test), count, d, x);
    const cost home = cost_of_search(test, &before), away = cost_of_search(test, &after);
    const double memory = (double)away.bytes / (double)home.bytes;
    print_message("%d particles, one at 1e30: memory x %.4f, time x %.3f\n", count, memory,
                  away.seconds / home.seconds);
    TEST_REQUIRE(memory <= 1.05, "memory x %g", memory);
    assert_true(away.pairs <= home.pairs && away.pairs > home.pairs - 1000);
}

/* ---- Everybody in one cell ---------------------------------------------------------------- */

/* All within reach of each other; a tenth of them at one place. */
static setup_array clump(const test_case *test, int count)
{
    double *x = positions_in_cube(count, test->dimension, .25);
    for (int k = 0; k < count / 10 * test->dimension; ++k)
        x[k] = .125;
    return setup_numbers(test_position_type(test), count, test->dimension, x);
}

static sphg_geometry geometry_of(const setup_array *positions, int list_free)
{
    sphg_geometry geometry = {.sources = setup_view(positions), .list_free = list_free};
    geometry.source_count = geometry.target_count = positions->count;
    return geometry;
}

static void clumps_can_be_summed_without_lists(const test_case *test)
{
    const int count = long_or(1000000, 70000);
    const setup_array positions = clump(test, count);
    const sphg_scheme scheme = setup_scheme(test, 1);
    const sphg_geometry geometry = geometry_of(&positions, 1);
    host *own = host_of((size_t)1 << 30);
    SETUP_OK(own->context, sphg_neighbors_search(own->context, own->neighbors, &scheme, &geometry));
    const int32_t picked[] = {0, count / 10, count - 1};
    const sphg_subset subset = {0, 3, picked, NULL};
    int64_t offsets[4] = {0};
    sphg_pairs pairs = {.offsets = offsets};
    const sphg_sources sources = {.neighbors = own->neighbors};
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &scheme, &sources, &subset, sphg_absent(), &pairs));
    for (int k = 0; k < 3; ++k)
        assert_int_equal(offsets[k + 1] - offsets[k], count - 1);
    TEST_REQUIRE(own->limit.largest <= (size_t)count * 512 + (1 << 22), "asked for %zu bytes",
                 own->limit.largest);
}

/* ---- More than 2^31 pairs ----------------------------------------------------------------- */

/* Clumps so small that a block of the grid holds one with its lists, far from each other: pairs in
 * such numbers are counted fastest there. SPHG_TEST_LONG=1: all of them in one cell. */
enum { CLUMP = 700, CLUMPS = 4400, MANY = 47000 }; /* 1.002 and 1.03 * 2^31 pairs */

typedef struct crowd {
    int clumps, each;
} crowd;

static crowd crowd_of_today(void)
{
    if (long_is_asked_for())
        return (crowd){1, MANY};
    return (crowd){TEST_SLOWED || test_is_shared() ? CLUMPS / 25 : CLUMPS, CLUMP};
}

static int64_t count_of(crowd all)
{
    return (int64_t)all.clumps * all.each;
}

static int64_t pairs_of(crowd all)
{
    return count_of(all) * (all.each - 1);
}

static setup_array positions_of(const test_case *test, crowd all)
{
    enum { ROW = 64, APART = 16 };
    const setup_array one = clump(test, all.each);
    const setup_array made = setup_output(one.type, (int)count_of(all), 3);
    const float *from = one.data;
    float *to = made.data;
    for (int c = 0; c < all.clumps; ++c)
        for (int k = 0; k < all.each; ++k, to += 3) {
            to[0] = from[3 * k] + (float)(c % ROW * APART);
            to[1] = from[3 * k + 1] + (float)(c / ROW * APART);
            to[2] = from[3 * k + 2];
        }
    return made;
}

/* Lists of so many do not fit: the request is for all of them, and refused. */
static void lists_that_do_not_fit_are_a_memory_failure(const test_case *test)
{
    const crowd all = crowd_of_today();
    const setup_array positions = positions_of(test, all);
    const sphg_scheme scheme = setup_scheme(test, 1);
    const sphg_geometry listed = geometry_of(&positions, 0), list_free = geometry_of(&positions, 1);
    host *own = host_of((size_t)pairs_of(all)); /* half of what they take */
    assert_int_equal(sphg_neighbors_search(own->context, own->neighbors, &scheme, &listed),
                     SPHG_ERROR_MEMORY);
    assert_true(own->limit.largest >= (size_t)(2 * pairs_of(all)));
    SETUP_OK(own->context,
             sphg_neighbors_search(own->context, own->neighbors, &scheme, &list_free));
}

/* Offsets alone, without memory for the pairs. */
static void pairs_beyond_32_bits_are_counted(const test_case *test)
{
    const crowd all = crowd_of_today();
    const int64_t count = count_of(all);
    const setup_array positions = positions_of(test, all);
    const sphg_scheme scheme = setup_scheme(test, 1);
    const sphg_geometry geometry = geometry_of(&positions, 1);
    host *own = host_of((size_t)1 << 29);
    int64_t *offsets = test_memory((size_t)(count + 1) * sizeof *offsets);
    sphg_pairs pairs = {.offsets = offsets};
    SETUP_OK(own->context, sphg_neighbors_search(own->context, own->neighbors, &scheme, &geometry));
    const sphg_sources sources = {.neighbors = own->neighbors};
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &scheme, &sources, NULL, sphg_absent(), &pairs));
    assert_true(pairs.count == pairs_of(all));
    for (int64_t i = 0; i <= count; ++i)
        TEST_REQUIRE(offsets[i] == i * (all.each - 1), "offset %lld is %lld", (long long)i,
                     (long long)offsets[i]);
}

/* Without memory behind it until it is touched. */
static void *address_space(size_t bytes)
{
    void *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory != MAP_FAILED)
        return memory;
    print_message("skipped: no address space for %zu bytes\n", bytes);
    return NULL;
}

/* The host's CSR: the second target's indices begin behind 2^33 others. Address space for them is
 * reserved; the pages in between are never touched. */
static void offsets_of_the_host_have_64_bits(const test_case *test)
{
    const int64_t far = (int64_t)1 << 33;
    const size_t bytes = (size_t)(far + 4) * sizeof(int32_t);
    int32_t *indices = address_space(bytes);
    if (!indices)
        return;
    cloud points = cloud_line(test->dimension, 4, .25);
    const setup_array positions = setup_positions(test, &points);
    const sphg_scheme scheme = setup_scheme(test, 4);
    const sphg_geometry geometry = geometry_of(&positions, 0);
    const int64_t offsets[] = {0, far, far + 3, far + 3, far + 4};
    const sphg_lists lists = {.offsets = offsets, .indices = indices};
    const int32_t of_second[] = {0, 2, 3, 1};
    memcpy(indices + far, of_second, sizeof of_second);
    host *own = host_of((size_t)1 << 27);
    SETUP_OK(own->context,
             sphg_neighbors_use_lists(own->context, own->neighbors, &scheme, &geometry, &lists));
    sphg_neighbors_info info;
    SETUP_OK(own->context, sphg_neighbors_get_info(own->context, own->neighbors, &info));
    assert_true(info.pairs == far + 4);
    const sphg_sources sources = {.neighbors = own->neighbors};
    const sphg_subset subset = {1, 4, NULL, NULL};
    int64_t found_offsets[4];
    int32_t found[4] = {-1, -1, -1, -1};
    sphg_pairs pairs = {.offsets = found_offsets, .indices = found, .capacity = 4};
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &scheme, &sources, &subset, sphg_absent(), &pairs));
    assert_int_equal(pairs.count, 4);
    assert_memory_equal(found, of_second, sizeof of_second);
    munmap(indices, bytes);
}

/* Memory for more pairs than 2^31 may be offered: address space again, of which a few pages are
 * written. */
static void room_for_more_pairs_than_32_bits_count_may_be_offered(const test_case *test)
{
    const int64_t room = ((int64_t)1 << 31) + 8;
    const size_t size = test_field_type(test) == SPHG_F64 ? 8 : 4, width = (size_t)test->dimension;
    const size_t for_indices = (size_t)room * sizeof(int32_t), bytes = (size_t)room * width * size;
    char *memory = address_space(for_indices + bytes);
    if (!memory)
        return;
    cloud points = cloud_line(test->dimension, 4, .25);
    const setup_array positions = setup_positions(test, &points);
    const setup_array volume =
        setup_numbers(test_field_type(test), 4, 1, (const double[]){1, 1, 1, 1});
    const sphg_scheme scheme = setup_scheme(test, 4);
    sphg_geometry geometry = geometry_of(&positions, 0);
    geometry.precision = test_field_type(test);
    host *own = host_of((size_t)1 << 27);
    SETUP_OK(own->context, sphg_neighbors_search(own->context, own->neighbors, &scheme, &geometry));
    const sphg_sources sources = {.neighbors = own->neighbors, .volume = setup_view(&volume)};
    int64_t offsets[5];
    sphg_pairs pairs = {.offsets = offsets,
                        .indices = (int32_t *)(void *)memory,
                        .gradient = {memory + for_indices, NULL, NULL, (ptrdiff_t)(width * size),
                                     test_field_type(test), SPHG_AS_SHAPE},
                        .capacity = room};
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &scheme, &sources, NULL, sphg_absent(), &pairs));
    assert_int_equal(pairs.count, 12);
    for (int k = 0; k < 12; ++k)
        assert_int_equal(pairs.indices[k], k % 3 + (k % 3 >= k / 3));
    munmap(memory, for_indices + bytes);
}

static const test_entry entries[] = {
    TEST_ENTRY(escapee_costs_next_to_nothing, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(clumps_can_be_summed_without_lists, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0,
               0),
    TEST_ENTRY(lists_that_do_not_fit_are_a_memory_failure, TEST_BIT(TEST_F32), TEST_3D, 0, 0),
    TEST_ENTRY(pairs_beyond_32_bits_are_counted, TEST_BIT(TEST_F32), TEST_3D, 0, 0),
    TEST_ENTRY(offsets_of_the_host_have_64_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(room_for_more_pairs_than_32_bits_count_may_be_offered, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
