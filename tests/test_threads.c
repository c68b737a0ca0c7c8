/* SPDX-License-Identifier: MIT */
/* Same input, same bits: for any number of threads, any executor, any split into subsets, and for
 * contexts that work at the same time on shared neighbours. */
#include "support/setup.h"
#include "support/fake_host.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>

enum { COUNT = 1600, RECORD = 64 };

/* The particles and fields of all runs. */
typedef struct comparison {
    const test_case *test;
    scene particles;
    sphg_scheme scheme;
    setup_array scalar, vector, tensor, volume, density;
} comparison;

static setup_array numbers_of(const test_case *test, int width, double low, double high,
                              random_state *random)
{
    double *numbers = test_memory((size_t)(COUNT * width) * sizeof *numbers);
    for (int k = 0; k < COUNT * width; ++k)
        numbers[k] = random_between(random, low, high);
    return setup_numbers(test_field_type(test), COUNT, width, numbers);
}

static comparison comparison_of(const test_case *test)
{
    const int d = test->dimension;
    random_state random = random_seeded(113);
    comparison own = {.test = test};
    cloud points = cloud_random(d, COUNT, d == 2 ? 40 : 11, &random);
    own.particles = scene_of_cloud(test, &points);
    own.scheme = setup_scheme(test, 2);
    own.scalar = numbers_of(test, 1, -1, 1, &random);
    own.vector = numbers_of(test, d, -1, 1, &random);
    own.tensor = numbers_of(test, d * d, -1, 1, &random);
    own.volume = numbers_of(test, 1, 0.5, 1.5, &random);
    own.density = numbers_of(test, 1, 0.5, 1.5, &random);
    return own;
}

/* All outputs of a run: one item of RECORD numbers per particle. */
typedef struct results {
    setup_array record, rank;
    sphg_stats stats;
    int next; /* the next free number of an item */
} results;

static results results_for(const comparison *own)
{
    results found = {.record = setup_output(own->scalar.type, COUNT, RECORD),
                     .rank = setup_output(SPHG_U8, COUNT, 1)};
    return found;
}

static sphg_view member(results *found, int width)
{
    const ptrdiff_t size = found->record.type == SPHG_F64 ? 8 : 4;
    sphg_view view = setup_view(&found->record);
    view.x = (const char *)view.x + found->next * size;
    found->next += width;
    return view;
}

static int is_linearised(const comparison *own)
{
    return own->scheme.method <= SPHG_RKPM;
}

/* One sweep: corrections, fields in DIFFERENCE and DIRECT form, a mean and a contraction. */
static sphg_result sweep(sphg_context *context, const comparison *own, const sphg_sources *sources,
                         const sphg_subset *subset, results *found)
{
    const int d = own->particles.dimension;
    const sphg_view scalar = setup_view(&own->scalar), vector = setup_view(&own->vector);
    const sphg_view tensor = setup_view(&own->tensor), density = setup_view(&own->density);
    sphg_field fields[6] = {{.shape = SPHG_SCALAR, .at_sources = &scalar},
                            {.shape = SPHG_VECTOR, .at_sources = &vector},
                            {.shape = SPHG_TENSOR, .at_sources = &tensor},
                            {.shape = SPHG_VECTOR, .form = SPHG_DIRECT, .at_sources = &vector},
                            {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &scalar},
                            {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &scalar}};
    sphg_request request = {.sources = sources, .set_count = 1, .subset = subset};
    fields[0].gradient = member(found, d);
    fields[1].gradient = member(found, d * d);
    fields[1].divergence = member(found, 1);
    fields[1].curl = member(found, d == 2 ? 1 : 3);
    fields[2].divergence = member(found, d);
    fields[3].value = member(found, d);
    fields[3].gradient = member(found, d * d);
    fields[4].square = member(found, 1);
    request.fields = fields;
    request.field_count = 5;
    if (own->scheme.method != SPHG_PLAIN) {
        request.correction = member(found, sphg_correction_width(&own->scheme));
        request.lambda_min = member(found, 1);
        request.rank = setup_view(&found->rank);
        request.stats = &found->stats;
    }
    fields[1].tensor = tensor;
    fields[1].contraction = member(found, 1);
    if (!test_is_classic(own->test)) {
        request.field_count = 6;
        fields[5].shepard = 1;
        fields[5].value_volume = &density;
        fields[5].value = member(found, 1);
    }
    return sphg_evaluate(context, &own->scheme, &request);
}

/* The two-sided forms, with the table of the first sweep. */
static sphg_result forces(sphg_context *context, const comparison *own, const sphg_sources *sources,
                          const sphg_subset *subset, sphg_view table, results *found)
{
    const sphg_view scalar = setup_view(&own->scalar), density = setup_view(&own->density);
    sphg_field fields[3] = {{.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &scalar},
                            {.shape = SPHG_SCALAR, .form = SPHG_SYMMETRIC, .at_sources = &scalar},
                            {.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &scalar}};
    sphg_sources with_table = *sources;
    const sphg_request request = {.sources = &with_table,
                                  .set_count = 1,
                                  .fields = fields,
                                  .field_count = test_is_classic(own->test) ? 2 : 3,
                                  .subset = subset};
    with_table.correction = table;
    if (request.field_count == 3) {
        fields[2].coefficient = &density;
        fields[2].laplacian = member(found, 1);
    }
    fields[0].gradient = member(found, own->particles.dimension);
    fields[1].gradient = member(found, own->particles.dimension);
    return sphg_evaluate(context, &own->scheme, &request);
}

/* Order 2, and once more with what the first call lends. */
static sphg_result curved(sphg_context *context, const comparison *own, const sphg_sources *sources,
                          results *found)
{
    const int d = own->particles.dimension;
    const sphg_view scalar = setup_view(&own->scalar), lent = member(found, d == 2 ? 4 : 7);
    sphg_scheme scheme = own->scheme;
    scheme.order = 2;
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &scalar};
    const sphg_request request = {
        .sources = sources, .set_count = 1, .fields = &field, .field_count = 1};
    field.curvature = lent;
    field.gradient = member(found, d);
    const sphg_result result = sphg_evaluate(context, &scheme, &request);
    field.curvature = sphg_absent();
    field.lenders = &lent;
    field.gradient = member(found, d);
    field.laplacian = member(found, 1);
    return result ? result : sphg_evaluate(context, &scheme, &request);
}

static sphg_sources sources_of(const comparison *own, const sphg_neighbors *neighbors)
{
    sphg_sources sources = {0};
    sources.neighbors = neighbors;
    sources.volume = setup_view(&own->volume);
    sources.density = setup_view(&own->density);
    return sources;
}

/* The table lies where sweep() put it. */
static sphg_view table_of(const comparison *own, const results *found)
{
    results again = *found;
    const int d = own->particles.dimension;
    again.next = d + d * d + 1 + (d == 2 ? 1 : 3) + d + d + d * d;
    return own->scheme.method == SPHG_PLAIN ? sphg_absent()
                                            : member(&again, sphg_correction_width(&own->scheme));
}

/* Everything, in one context with this configuration. */
static results run_under(const comparison *own, const sphg_config *config, int list_free,
                         rows *pairs)
{
    results found = results_for(own);
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    sphg_geometry geometry = scene_geometry(&own->particles);
    geometry.list_free = list_free;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, config, &context));
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    SETUP_OK(context, sphg_neighbors_search(context, neighbors, &own->scheme, &geometry));
    const sphg_sources sources = sources_of(own, neighbors);
    *pairs = rows_listed(context, neighbors, &own->scheme, NULL);
    SETUP_OK(context, sweep(context, own, &sources, NULL, &found));
    SETUP_OK(context, forces(context, own, &sources, NULL, table_of(own, &found), &found));
    if (is_linearised(own))
        SETUP_OK(context, curved(context, own, &sources, &found));
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return found;
}

static void require_same(const results *a, const results *b, const char *where)
{
    TEST_REQUIRE(setup_same_bits(&a->record, &b->record), "%s: other bits", where);
    TEST_REQUIRE(setup_same_bits(&a->rank, &b->rank), "%s: other ranks", where);
    TEST_REQUIRE(memcmp(&a->stats, &b->stats, sizeof a->stats) == 0, "%s: other stats", where);
}

static results serial_results(const comparison *own, int list_free, rows *pairs)
{
    const sphg_config serial = {.threads = 1, .isa = test_isa()};
    return run_under(own, &serial, list_free, pairs);
}

static void results_do_not_depend_on_the_number_of_threads(const test_case *test)
{
    const comparison own = comparison_of(test);
    for (int list_free = 0; list_free < 2; ++list_free) {
        rows expected_pairs, pairs;
        const results expected = serial_results(&own, list_free, &expected_pairs);
        const int32_t threads[] = {3, 16, 0, 2, 4, 7, 8};
        for (int k = 0; k < (TEST_SLOWED ? 2 : 7); ++k) {
            const sphg_config config = {.threads = threads[k], .isa = test_isa()};
            const results found = run_under(&own, &config, list_free, &pairs);
            const char *where = test_text("%d threads", threads[k]);
            rows_require_equal(&pairs, &expected_pairs, where);
            require_same(&found, &expected, where);
        }
    }
}

static void results_do_not_depend_on_the_executor(const test_case *test)
{
    const comparison own = comparison_of(test);
    fake_host_executor *const executors[] = {fake_host_odd_splits, fake_host_reversed,
                                             fake_host_pthreads};
    rows expected_pairs, pairs;
    const results expected = serial_results(&own, 0, &expected_pairs);
    for (int k = 0; k < 9; k += TEST_SLOWED ? 4 : 1) { /* each executor and number at least once */
        fake_host host;
        fake_host_open(&host);
        host.workers = (int32_t[]){1, 3, 8}[k / 3];
        sphg_config config = fake_host_config(&host, host.workers);
        config.parallel_for = executors[k % 3];
        const results found = run_under(&own, &config, k % 2, &pairs);
        const char *where = test_text("executor %d, %d workers", k % 3, host.workers);
        rows_require_equal(&pairs, &expected_pairs, where);
        require_same(&found, &expected, where);
        assert_true(host.regions > 0);
        assert_true(host.live_blocks == 0 && host.faults == 0);
        fake_host_close(&host);
    }
}

/* ---- Search -------------------------------------------------------------------------------- */

enum { MANY = 20000 };

static scene many_particles(const test_case *test)
{
    random_state random = random_seeded(137);
    cloud points = cloud_random(test->dimension, MANY, test->dimension == 2 ? 140 : 27, &random);
    return scene_of_cloud(test, &points);
}

typedef struct found {
    rows pairs;
    int32_t order[MANY];
} found;

static void search_under(const test_case *test, const sphg_config *config, found *result)
{
    const scene particles = many_particles(test);
    const sphg_geometry geometry = scene_geometry(&particles);
    const sphg_scheme scheme = setup_scheme(test, 2);
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, config, &context));
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
    SETUP_OK(context, sphg_neighbors_get_order(context, neighbors, result->order));
    result->pairs = rows_listed(context, neighbors, &scheme, NULL);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
}

/* Enough particles for every thread to sort a share of its own. */
static void search_does_not_depend_on_threads(const test_case *test)
{
    found *serial = test_memory(sizeof *serial), *other = test_memory(sizeof *other);
    const int32_t threads[] = {3, 16, 2, 4, 7, 8};
    search_under(test, &(sphg_config){.threads = 1, .isa = test_isa()}, serial);
    for (int k = 0; k < (TEST_SLOWED ? 2 : 6); ++k) {
        search_under(test, &(sphg_config){.threads = threads[k], .isa = test_isa()}, other);
        rows_require_equal(&other->pairs, &serial->pairs, test_text("%d threads", threads[k]));
        assert_memory_equal(other->order, serial->order, sizeof serial->order);
    }
}

/* Of several bad positions the first is named, whoever finds which first. */
static void first_bad_position_is_named_for_any_executor(const test_case *test)
{
    fake_host_executor *const executors[] = {NULL, fake_host_odd_splits, fake_host_reversed,
                                             fake_host_pthreads};
    const scene particles = many_particles(test);
    for (int k = 19999; k > 5000; k -= 1777)
        particles.sources[k * test->dimension] = NAN;
    const sphg_geometry geometry = scene_geometry(&particles);
    const sphg_scheme scheme = setup_scheme(test, 2);
    for (int k = 0; k < 4; ++k) {
        fake_host host;
        fake_host_open(&host);
        sphg_config config = fake_host_config(&host, host.workers);
        config.parallel_for = executors[k];
        sphg_context *context = NULL;
        SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &context));
        sphg_neighbors *neighbors = NULL;
        SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
        assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry),
                         SPHG_ERROR_NOT_FINITE);
        assert_non_null(strstr(sphg_last_message(context), "[5783]"));
        sphg_neighbors_destroy(neighbors);
        sphg_context_destroy(context);
        fake_host_close(&host);
    }
}

/* Of several lists that hold what is no source, the first is named. */
static void first_bad_index_is_named_for_any_executor(const test_case *test)
{
    fake_host_executor *const executors[] = {NULL, fake_host_odd_splits, fake_host_reversed,
                                             fake_host_pthreads};
    const comparison own = comparison_of(test);
    rows pairs;
    serial_results(&own, 0, &pairs);
    for (int32_t target = 211; target < COUNT; target += 97)
        for (int64_t k = pairs.offsets[target]; k < pairs.offsets[target + 1]; ++k)
            pairs.indices[k] = COUNT + target;
    for (int k = 0; k < 4; ++k) {
        fake_host host;
        fake_host_open(&host);
        sphg_config config = fake_host_config(&host, host.workers);
        config.parallel_for = executors[k];
        sphg_context *context = NULL;
        sphg_neighbors *neighbors = NULL;
        SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &context));
        SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
        const sphg_geometry geometry = scene_geometry(&own.particles);
        const sphg_lists lists = {.offsets = pairs.offsets, .indices = pairs.indices};
        SETUP_OK(context,
                 sphg_neighbors_use_lists(context, neighbors, &own.scheme, &geometry, &lists));
        const sphg_sources sources = sources_of(&own, neighbors);
        results unused = results_for(&own);
        assert_int_equal(sweep(context, &own, &sources, NULL, &unused), SPHG_ERROR_INDEX);
        TEST_REQUIRE(strstr(sphg_last_message(context), "target 211 holds 1811"), "%s",
                     sphg_last_message(context));
        sphg_neighbors_destroy(neighbors);
        sphg_context_destroy(context);
        fake_host_close(&host);
    }
}

/* ---- Contexts at the same time ------------------------------------------------------------ */

typedef struct helper {
    const comparison *own;
    const sphg_neighbors *shared;
    sphg_subset subset;
    results found;
    sphg_result result;
} helper;

static void *help(void *argument)
{
    helper *own = argument;
    const sphg_config serial = {.threads = 1, .isa = test_isa()};
    const sphg_sources sources = sources_of(own->own, own->shared);
    sphg_context *context = NULL;
    own->result = sphg_context_create(SPHG_VERSION, &serial, &context);
    for (int repeat = 0; repeat < 3 && own->result == SPHG_OK; ++repeat) {
        own->found.next = 0;
        own->result = sweep(context, own->own, &sources, &own->subset, &own->found);
    }
    sphg_context_destroy(context);
    return NULL;
}

enum { HELPERS = 4 };

static void run_helpers(helper *helpers)
{
    pthread_t threads[HELPERS];
    for (int k = 0; k < HELPERS; ++k)
        assert_int_equal(pthread_create(&threads[k], NULL, help, &helpers[k]), 0);
    for (int k = 0; k < HELPERS; ++k)
        pthread_join(threads[k], NULL);
    for (int k = 0; k < HELPERS; ++k)
        assert_int_equal(helpers[k].result, SPHG_OK);
}

/* Each of four contexts takes a part of the targets; they write to the same arrays. */
static void contexts_may_share_neighbours_and_split_the_targets(const test_case *test)
{
    const comparison own = comparison_of(test);
    for (int list_free = 0; list_free < 2; ++list_free) {
        sphg_context *context = setup_context_of(1);
        sphg_geometry geometry = scene_geometry(&own.particles);
        geometry.list_free = list_free;
        const sphg_neighbors *shared = setup_search(context, &own.scheme, &geometry);
        const sphg_sources sources = sources_of(&own, shared);
        results whole = results_for(&own), split = results_for(&own);
        SETUP_OK(context, sweep(context, &own, &sources, NULL, &whole));
        helper helpers[HELPERS];
        for (int k = 0; k < HELPERS; ++k) {
            const sphg_subset part = {COUNT * k / HELPERS - (k % 2) * 13,
                                      COUNT * (k + 1) / HELPERS - ((k + 1) % 2) * 13, NULL, NULL};
            helpers[k] = (helper){&own, shared, part, split, SPHG_OK};
        }
        run_helpers(helpers);
        split.stats = whole.stats;
        require_same(&split, &whole, "four parts");
    }
}

/* ---- Subsets ------------------------------------------------------------------------------ */

/* Masks, lists and ranges give the bits of the whole and touch nothing else. */
static void subsets_have_the_bits_of_the_whole(const test_case *test)
{
    const comparison own = comparison_of(test);
    sphg_context *context = setup_context();
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_neighbors *neighbors = setup_search(context, &own.scheme, &geometry);
    const sphg_sources sources = sources_of(&own, neighbors);
    results whole = results_for(&own), parts = results_for(&own);
    uint8_t *mask = test_memory(COUNT);
    int32_t *picked = test_memory(COUNT * sizeof *picked), chosen = 0;
    for (int32_t i = 0; i < COUNT; ++i) {
        const int32_t reverse = COUNT - 1 - i;
        mask[reverse] = reverse % 7 == 3 || (reverse > 500 && reverse < 900) ? 255 : 0;
        if (!mask[reverse])
            picked[chosen++] = reverse;
    }
    const sphg_subset masked = {0, COUNT, NULL, mask}, listed = {0, chosen, picked, NULL};
    SETUP_OK(context, sweep(context, &own, &sources, NULL, &whole));
    SETUP_OK(context, sweep(context, &own, &sources, &masked, &parts));
    for (int32_t i = 0; i < COUNT; ++i)
        assert_int_equal(setup_is_canary(&parts.record, i) != 0, !mask[i]);
    parts.next = 0;
    SETUP_OK(context, sweep(context, &own, &sources, &listed, &parts));
    parts.stats = whole.stats;
    require_same(&parts, &whole, "mask, then list");
}

#define EACH(property)                                                                             \
    TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0)

static const test_entry entries[] = {
    EACH(results_do_not_depend_on_the_number_of_threads),
    EACH(results_do_not_depend_on_the_executor),
    TEST_ENTRY(search_does_not_depend_on_threads, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(first_bad_position_is_named_for_any_executor, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(first_bad_index_is_named_for_any_executor, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    EACH(contexts_may_share_neighbours_and_split_the_targets),
    EACH(subsets_have_the_bits_of_the_whole),
};
TEST_MAIN(entries)
