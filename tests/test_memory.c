/* SPDX-License-Identifier: MIT */
/* The host's allocator: every allocation may fail and leaves nothing behind, every release names
 * the size that was asked for, and warm calls ask for nothing. */
#include "support/setup.h"
#include "support/fake_host.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>

enum { COUNT = 400, ITEMS = 1000 /* several workers share them */, LISTED = 3000 };

/* A host with one context, its arrays, and neighbours that may or may not be built. */
typedef struct world {
    fake_host *host;
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    scene particles;
    sphg_geometry geometry;
    sphg_lists lists;
    rows pairs;
    setup_array field, volume, matrices;
    setup_array first, second, third; /* outputs */
} world;

static void close_world(void *object)
{
    world *own = object;
    sphg_neighbors_destroy(own->neighbors);
    sphg_context_destroy(own->context);
    own->neighbors = NULL;
    own->context = NULL;
}

/* Arrays of the tests' own; the library is not called yet. */
static world *world_create(const test_case *test)
{
    world *own = test_memory(sizeof *own);
    random_state random = random_seeded(107);
    const int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 20 : 7, 0.25, 0.2, &random);
    double *matrices = test_memory(ITEMS * 9 * sizeof *matrices);
    own->host = setup_hooks();
    test_at_end(close_world, own);
    own->particles = scene_of_cloud(test, &points);
    own->scheme = setup_scheme(test, 0.5);
    own->geometry = scene_geometry(&own->particles);
    own->pairs = rows_by_brute_force(&own->particles, 0.5);
    own->lists.offsets = own->pairs.offsets;
    own->lists.indices = own->pairs.indices;
    for (int k = 0; k < ITEMS * 9; ++k)
        matrices[k] = k % 9 == 0 || k % 9 == 3 || k % 9 == 5 ? 1 : 0.1 / (1 + k % 7);
    const sphg_type type = test_field_type(test);
    own->matrices = setup_numbers(type, ITEMS, 9, matrices);
    own->field = setup_numbers(type, points.count, 1, cloud_numbers(&points, -1, 1, &random));
    own->volume = setup_numbers(type, points.count, 1, cloud_volumes(&points, 0.1, &random));
    return own;
}

/* Zeroed, so that runs can be compared to the bit. */
static void clear_outputs(world *own)
{
    setup_array *const outputs[] = {&own->first, &own->second, &own->third};
    for (int k = 0; k < 3; ++k) {
        *outputs[k] = setup_output(own->field.type, ITEMS, 16);
        memset(outputs[k]->data, 0, (size_t)ITEMS * 16 * 4);
    }
}

static sphg_view items_of(const setup_array *array, int width)
{
    sphg_view view = setup_view(array);
    view.stride = view.stride / array->width * width;
    return view;
}

typedef enum call {
    CREATE_CONTEXT,
    CREATE_NEIGHBORS,
    SEARCH,
    SEARCH_WITH_SKIN,
    SEARCH_LIST_FREE,
    USE_LISTS,
    EVALUATE,
    EVALUATE_LIST_FREE,
    EVALUATE_LISTS,
    PAIRS,
    INVERT,
    EIGEN,
    SVD,
    CALLS
} call;

static const char *const call_names[CALLS] = {"context_create",
                                              "neighbors_create",
                                              "search",
                                              "search, skin",
                                              "search, list-free",
                                              "use_lists",
                                              "evaluate",
                                              "evaluate, free",
                                              "evaluate, CSR",
                                              "pair_gradients",
                                              "invert_moments",
                                              "eigen",
                                              "svd"};

static sphg_result create_context(world *own)
{
    const sphg_config config = fake_host_config(own->host, 2);
    return sphg_context_create(SPHG_VERSION, &config, &own->context);
}

static sphg_result build(world *own, int list_free, double skin)
{
    own->geometry.list_free = list_free;
    own->geometry.skin = skin;
    return sphg_neighbors_search(own->context, own->neighbors, &own->scheme, &own->geometry);
}

static sphg_result bring_lists(world *own)
{
    own->geometry.list_free = 0;
    own->geometry.skin = 0;
    return sphg_neighbors_use_lists(own->context, own->neighbors, &own->scheme, &own->geometry,
                                    &own->lists);
}

/* Correction, rank and a gradient, so that the eigensolver's path is part of it. */
static sphg_result evaluate(world *own)
{
    const int32_t width = sphg_correction_width(&own->scheme);
    const sphg_view field = setup_view(&own->field);
    sphg_sources sources = {0};
    sphg_field wanted = {0};
    sphg_request request = {0};
    sources.neighbors = own->neighbors;
    sources.volume = setup_view(&own->volume);
    wanted.shape = SPHG_SCALAR;
    wanted.at_sources = &field;
    wanted.gradient = items_of(&own->first, own->particles.dimension);
    request.sources = &sources;
    request.set_count = 1;
    request.fields = &wanted;
    request.field_count = 1;
    if (width > 0)
        request.correction = items_of(&own->second, width);
    return sphg_evaluate(own->context, &own->scheme, &request);
}

static sphg_result pair_gradients(world *own)
{
    sphg_sources sources = {0};
    sphg_pairs pairs = {0};
    const sphg_subset subset = {0, 100, NULL, NULL};
    sources.neighbors = own->neighbors;
    sources.volume = setup_view(&own->volume);
    pairs.gradient = items_of(&own->first, own->particles.dimension);
    pairs.capacity = LISTED;
    return sphg_pair_gradients(own->context, &own->scheme, &sources, &subset, sphg_absent(),
                               &pairs);
}

static sphg_result invert(world *own)
{
    sphg_inversion wanted = {0};
    sphg_scheme scheme = own->scheme;
    scheme.method = SPHG_KGC;
    wanted.correction = items_of(&own->first, 6);
    return sphg_invert_moments(own->context, &scheme, ITEMS, setup_view(&own->matrices),
                               sphg_absent(), &wanted);
}

static sphg_result perform(world *own, call which)
{
    switch (which) {
    case CREATE_CONTEXT:
        return create_context(own);
    case CREATE_NEIGHBORS:
        return sphg_neighbors_create(own->context, &own->neighbors);
    case SEARCH:
        return build(own, 0, 0);
    case SEARCH_WITH_SKIN:
        return build(own, 0, 0.125);
    case SEARCH_LIST_FREE:
        return build(own, 1, 0);
    case USE_LISTS:
        return bring_lists(own);
    case EVALUATE:
    case EVALUATE_LIST_FREE:
    case EVALUATE_LISTS:
        return evaluate(own);
    case PAIRS:
        return pair_gradients(own);
    case INVERT:
        return invert(own);
    case EIGEN:
        return sphg_eigen(own->context, own->particles.dimension, ITEMS, setup_view(&own->matrices),
                          items_of(&own->first, 3), items_of(&own->second, 9));
    default:
        return sphg_svd(own->context, ITEMS, setup_view(&own->matrices), items_of(&own->first, 9),
                        items_of(&own->second, 3), items_of(&own->third, 9));
    }
}

/* What must have been done before: each call then meets a context that is as cold as it can be. */
static void prepare(world *own, call which)
{
    own->context = NULL;
    own->neighbors = NULL;
    clear_outputs(own);
    if (which != CREATE_CONTEXT)
        assert_int_equal(create_context(own), SPHG_OK);
    if (which != CREATE_CONTEXT && which != CREATE_NEIGHBORS)
        assert_int_equal(sphg_neighbors_create(own->context, &own->neighbors), SPHG_OK);
    if (which == EVALUATE || which == PAIRS)
        assert_int_equal(build(own, 0, 0), SPHG_OK);
    if (which == EVALUATE_LIST_FREE)
        assert_int_equal(build(own, 1, 0), SPHG_OK);
    if (which == EVALUATE_LISTS)
        assert_int_equal(bring_lists(own), SPHG_OK);
}

/* Everything that depends on the call, as bits: its outputs, or the gradient after a build. */
static void keep_result(world *own, call which, setup_array *kept)
{
    const setup_array *const outputs[] = {&own->first, &own->second, &own->third};
    const size_t bytes = (size_t)ITEMS * 16 * 4;
    if (which >= SEARCH && which <= USE_LISTS)
        SETUP_OK(own->context, evaluate(own));
    *kept = setup_output(SPHG_F32, 3 * ITEMS, 16);
    for (int k = 0; k < 3; ++k)
        memcpy((char *)kept->data + (size_t)k * bytes, outputs[k]->data, bytes);
}

static void require_clean(world *own, const char *where)
{
    close_world(own);
    TEST_REQUIRE(own->host->live_blocks == 0 && own->host->live_bytes == 0,
                 "%s: %lld blocks leaked", where, (long long)own->host->live_blocks);
    TEST_REQUIRE(own->host->faults == 0, "%s: a release named another size", where);
}

/* One run in which allocations [k, until) of the call fail; returns whether any of them did. */
static int run_with_failures(world *own, call which, int64_t k, int64_t until,
                             const setup_array *expected)
{
    const char *where = test_text("%s, allocation %lld", call_names[which], (long long)k);
    setup_array again;
    prepare(own, which);
    fake_host_fail(own->host, k, until);
    const sphg_result result = perform(own, which);
    const int failed = own->host->allocations >= k;
    fake_host_fail(own->host, 0, 0);
    TEST_REQUIRE(result == (failed ? SPHG_ERROR_MEMORY : SPHG_OK), "%s: %s", where,
                 sphg_result_string(result));
    if (which == CREATE_CONTEXT && failed)
        assert_null(own->context);
    if (failed)
        TEST_REQUIRE(perform(own, which) == SPHG_OK, "%s: no recovery", where);
    keep_result(own, which, &again);
    TEST_REQUIRE(which == CREATE_CONTEXT || setup_same_bits(&again, expected),
                 "%s: another result afterwards", where);
    require_clean(own, where);
    return failed;
}

/* The k-th allocation fails, once or from then on, for every k. */
static void any_allocation_may_fail(const test_case *test)
{
    world *own = world_create(test);
    for (int which = 0; which < CALLS; ++which) {
        setup_array expected;
        if (which == SVD && test->dimension == 2)
            continue;
        prepare(own, (call)which);
        assert_int_equal(perform(own, (call)which), SPHG_OK);
        keep_result(own, (call)which, &expected);
        require_clean(own, call_names[which]);
        int64_t k = 1, persistent = 1;
        while (run_with_failures(own, (call)which, k, k + 1, &expected))
            ++k;
        while (run_with_failures(own, (call)which, persistent, INT64_MAX, &expected))
            ++persistent;
        TEST_REQUIRE(k > 1 || which > EVALUATE, "%s allocates nothing", call_names[which]);
    }
}

/* After a build that failed for want of memory, operators refuse until the next good one. */
static void failed_build_must_be_repeated(const test_case *test)
{
    world *own = world_create(test);
    prepare(own, EVALUATE);
    own->scheme.support_radius = 1.5; /* many more pairs than the last build had */
    fake_host_fail(own->host, 1, INT64_MAX);
    assert_int_equal(build(own, 0, 0), SPHG_ERROR_MEMORY);
    fake_host_fail(own->host, 0, 0);
    assert_int_equal(evaluate(own), SPHG_ERROR_STATE);
    assert_int_equal(build(own, 0, 0), SPHG_OK);
    assert_int_equal(evaluate(own), SPHG_OK);
    require_clean(own, "failed build");
}

/* ---- Steady state ------------------------------------------------------------------------- */

/* Moves the particles about and apart: pairs change and become fewer. */
static void stir(world *own, const double *rest, int step, random_state *random)
{
    const int d = own->particles.dimension;
    const double stretch = step ? 1.1 + 0.001 * (step % 5) : 1;
    for (int k = 0; k < own->particles.source_count * d; ++k) {
        const double x = stretch * rest[k] + random_between(random, 0, 0.002 * step);
        own->particles.sources[k] = own->particles.is_double ? x : (double)(float)x;
    }
    own->geometry = scene_geometry(&own->particles);
    own->geometry.source_count -= step % 3;
    own->geometry.target_count = own->geometry.source_count - (d == 3 ? 7 : 0); /* ghosts */
}

/* Everything that a step of a simulation may call. */
static void work(world *own)
{
    int32_t order[COUNT];
    SETUP_OK(own->context, sphg_neighbors_get_order(own->context, own->neighbors, order));
    SETUP_OK(own->context, evaluate(own));
    SETUP_OK(own->context, pair_gradients(own));
    SETUP_OK(own->context, invert(own));
    SETUP_OK(own->context, perform(own, EIGEN));
    if (own->particles.dimension == 3)
        SETUP_OK(own->context, perform(own, SVD));
}

static void warm_calls_allocate_nothing(const test_case *test)
{
    world *own = world_create(test);
    random_state random = random_seeded(109);
    const size_t bytes = (size_t)(own->particles.source_count * test->dimension) * sizeof(double);
    double *rest = memcpy(test_memory(bytes), own->particles.sources, bytes);
    const call kinds[] = {SEARCH, SEARCH_WITH_SKIN, SEARCH_LIST_FREE, USE_LISTS};
    for (int kind = 0; kind < 4; ++kind) {
        prepare(own, kinds[kind]);
        stir(own, rest, 0, &random);
        if (kinds[kind] == USE_LISTS)
            own->geometry = scene_geometry(&own->particles);
        SETUP_OK(own->context, perform(own, kinds[kind]));
        work(own);
        fake_host_fail(own->host, 0, 0);
        for (int step = 1; step < 12; ++step) {
            stir(own, rest, step, &random);
            if (kinds[kind] == USE_LISTS) /* which name all particles */
                own->geometry = scene_geometry(&own->particles);
            SETUP_OK(own->context, perform(own, kinds[kind]));
            work(own);
            TEST_REQUIRE(own->host->allocations == 0, "%s, step %d: %lld allocations",
                         call_names[kinds[kind]], step, (long long)own->host->allocations);
        }
        require_clean(own, "steady state");
    }
}

/* Clouds of the same number of particles and no more pairs than the compact one has: everybody
 * alone in a block, near and very far; as many pairs as ever, but all of them in one place. */
enum { COMPACT, THIN, VAST, CLUMP, CLOUDS };

static void spread(world *own, const double *rest, int which, int64_t pairs)
{
    static const double steps[CLOUDS] = {0, 100, 0x1p90, 100};
    const int d = own->particles.dimension, count = own->particles.source_count;
    const int clump = which == CLUMP ? (int)sqrt((double)pairs) : 0;
    for (int i = 0; i < count; ++i)
        for (int a = 0; a < d; ++a) {
            const double shift = i < count - clump ? steps[which] * (i - 7 * a) : -steps[which];
            const double own_part = which == CLUMP || which == VAST ? 0 : rest[i * d + a];
            const double x = shift + own_part;
            own->particles.sources[i * d + a] = own->particles.is_double ? x : (double)(float)x;
        }
    own->geometry = scene_geometry(&own->particles);
}

/* However the particles spread: memory was there for as many particles and pairs. And what is found
 * there, kept or not, is what brute force finds. */
static void spreading_clouds_allocate_nothing(const test_case *test)
{
    world *own = world_create(test);
    const size_t bytes = (size_t)(own->particles.source_count * test->dimension) * sizeof(double);
    double *rest = memcpy(test_memory(bytes), own->particles.sources, bytes);
    const int64_t pairs = own->pairs.offsets[own->pairs.count];
    const call kinds[] = {SEARCH, SEARCH_WITH_SKIN, SEARCH_LIST_FREE};
    const int order[] = {COMPACT, THIN, CLUMP, VAST, COMPACT, CLUMP};
    for (int kind = 0; kind < 3; ++kind) {
        prepare(own, kinds[kind]);
        for (int step = 0; step < 6; ++step) {
            spread(own, rest, order[step], pairs);
            const char *where = test_text("%s, step %d", call_names[kinds[kind]], step);
            fake_host_fail(own->host, 0, 0);
            SETUP_OK(own->context, perform(own, kinds[kind]));
            work(own);
            const rows found = rows_listed(own->context, own->neighbors, &own->scheme, NULL);
            TEST_REQUIRE(step == 0 || own->host->allocations == 0, "%s: %lld allocations", where,
                         (long long)own->host->allocations);
            const rows expected = rows_by_brute_force(&own->particles, 0.5);
            rows_require_equal(&found, &expected, where);
        }
        require_clean(own, "spreading clouds");
    }
}

/* Matrices and a gradient over the particles and the same ones moved: a second set that is beside
 * all of them, or some, or none. */
static void evaluate_beside(world *own, double distance)
{
    const int d = own->particles.dimension, n = own->particles.source_count;
    sphg_geometry geometry = own->geometry;
    double *x = test_memory((size_t)(n * d) * sizeof *x);
    for (int k = 0; k < n * d; ++k)
        x[k] = own->particles.sources[k] + distance * (k % d == 0);
    const sphg_type type = own->particles.is_double ? SPHG_F64 : SPHG_F32;
    const setup_array moved = setup_numbers(type, n, d, x);
    sphg_neighbors *other = NULL;
    geometry.targets = geometry.sources;
    geometry.target_count = n;
    geometry.sources = setup_view(&moved);
    SETUP_OK(own->context, sphg_neighbors_create(own->context, &other));
    SETUP_OK(own->context, sphg_neighbors_search(own->context, other, &own->scheme, &geometry));
    fake_host_fail(own->host, 0, 0);
    const sphg_sources sources[2] = {
        {.neighbors = own->neighbors, .volume = setup_view(&own->volume)},
        {.neighbors = other, .volume = setup_view(&own->volume)}};
    const sphg_view field = setup_view(&own->field), at_sources[2] = {field, field};
    const sphg_field asked = {
        .shape = SPHG_SCALAR, .at_sources = at_sources, .gradient = items_of(&own->first, d)};
    const sphg_request request = {.sources = sources,
                                  .set_count = 2,
                                  .fields = &asked,
                                  .field_count = 1,
                                  .rank = sphg_view_u8(own->second.data, 1)};
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    sphg_neighbors_destroy(other);
}

static void sets_near_and_far_allocate_nothing(const test_case *test)
{
    static const double distance[2][4] = {{.01, 100, .75, 100}, {100, .75, .01, 100}};
    for (int order = 0; order < 2; ++order) {
        world *own = world_create(test);
        own->scheme.method = test->method;
        prepare(own, SEARCH);
        SETUP_OK(own->context, perform(own, SEARCH));
        for (int k = 0; k < 4; ++k) {
            evaluate_beside(own, distance[order][k]);
            TEST_REQUIRE(k == 0 || own->host->allocations == 0, "%d times as far: %lld allocations",
                         k, (long long)own->host->allocations);
        }
    }
}

/* What an object says it holds is what goes back to the host with it. */
static void neighbors_know_what_they_hold(const test_case *test)
{
    world *own = world_create(test);
    for (call which = SEARCH; which <= USE_LISTS; ++which) {
        prepare(own, which);
        SETUP_OK(own->context, perform(own, which));
        work(own);
        sphg_neighbors_info info;
        SETUP_OK(own->context, sphg_neighbors_get_info(own->context, own->neighbors, &info));
        const int64_t before = own->host->live_bytes;
        sphg_neighbors_destroy(own->neighbors);
        own->neighbors = NULL;
        const int64_t held = before - own->host->live_bytes;
        TEST_REQUIRE(info.bytes == held, "%s: says %lld bytes, held %lld", call_names[which],
                     (long long)info.bytes, (long long)held);
        require_clean(own, call_names[which]);
    }
}

/* The same of a context, whose scratch grew with the work. */
static void contexts_hold_what_they_say(const test_case *test)
{
    world *own = world_create(test);
    for (call which = SEARCH; which <= USE_LISTS; ++which) {
        prepare(own, which);
        SETUP_OK(own->context, perform(own, which));
        work(own);
        sphg_context_info info;
        SETUP_OK(own->context, sphg_context_get_info(own->context, &info));
        sphg_neighbors_destroy(own->neighbors);
        own->neighbors = NULL;
        const int64_t before = own->host->live_bytes;
        sphg_context_destroy(own->context);
        own->context = NULL;
        const int64_t held = before - own->host->live_bytes;
        TEST_REQUIRE(info.bytes == held, "%s: says %lld bytes, held %lld", call_names[which],
                     (long long)info.bytes, (long long)held);
        require_clean(own, call_names[which]);
    }
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    TEST_ENTRY(any_allocation_may_fail, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    EACH(failed_build_must_be_repeated),
    EACH(spreading_clouds_allocate_nothing),
    EACH(neighbors_know_what_they_hold),
    TEST_ENTRY(sets_near_and_far_allocate_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    EACH(contexts_hold_what_they_say),
    TEST_ENTRY(warm_calls_allocate_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
