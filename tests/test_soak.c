/* SPDX-License-Identifier: MIT */
/* A host that runs for days, in minutes: scenes of all kinds on contexts that live long, with
 * failing allocators, bad numbers and bad arguments in between. What fails is repeated without the
 * fault and has the bits of a fresh context; memory stays flat. SPHG_SOAK_SECONDS says how long. */
#include "support/bad_argument_rows.h"
#include "support/long_counts.h"
#include "support/random.h"
#include "support/public_calls.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 2000, LIST_MOST = 64, ROUNDS_LEAST = 120, ROUNDS_PER_CONTEXT = 40, SAMPLES = 64 };
enum { RSS_GROWTH = 1 << 20 }; /* [byte] allowed from the first half to the second */
enum { WARM = 60 };            /* [s] */

typedef enum fault { NONE, MEMORY, POSITION, FIELD, VOLUME, INDEX, ARGUMENT, FAULTS } fault;
static const char *const fault_names[] = {"none",   "memory", "position", "field",
                                          "volume", "index",  "argument"};

typedef struct world {
    const test_case *test;
    random_state random;
    fake_host host;
    valid_call *hostile;
    sphg_context *context;
    int dimension, count, targets, is_listed;
    sphg_scheme scheme;
    sphg_geometry geometry;
    sphg_subset subset;
    setup_array position, volume, field, gradient, correction, rank; /* of MOST items */
    setup_array kept[3];                                             /* results to compare */
    int64_t *offsets;
    int32_t *indices;
    long rounds, injected[FAULTS], compared;
    double evaluated;
    long resident[SAMPLES];
    int samples;
} world;

/* ---- Scenes ------------------------------------------------------------------------------- */

static void fill(world *own, const setup_array *array, double low, double high)
{
    for (int k = 0; k < own->count * array->width; ++k)
        setup_put(array, k, random_between(&own->random, low, high));
}

/* Random lists that are right as lists: sources i + 1, i + 2, ... without duplicates. */
static void fill_lists(world *own)
{
    const int length = own->count < LIST_MOST ? own->count : LIST_MOST;
    int64_t at = 0;
    for (int i = 0; i < own->targets; ++i) {
        own->offsets[i] = at;
        for (int k = 0; k < length; ++k)
            own->indices[at++] = (i + k) % own->count;
    }
    own->offsets[own->targets] = at;
}

static void choose_scheme(world *own)
{
    random_state *random = &own->random;
    own->scheme = (sphg_scheme){.dimension = own->dimension,
                                .method = (sphg_method)random_index(random, 6),
                                .kernel = (sphg_kernel)random_index(random, 7),
                                .policy = (sphg_policy)random_index(random, 4),
                                .support_radius = random_between(random, .5, 2.5)};
}

/* Now and then the largest scene, so that what memory there is to take is taken early. */
static void choose_scene(world *own)
{
    random_state *random = &own->random;
    const int largest = own->rounds % ROUNDS_PER_CONTEXT < 2;
    own->count = largest ? MOST : random_index(random, MOST + 1);
    own->targets = largest || random_index(random, 2) ? own->count : own->count / 2;
    const double side = pow(own->count + 1, 1. / own->dimension);
    choose_scheme(own);
    fill(own, &own->position, 0, side);
    fill(own, &own->volume, .5, 1.5);
    fill(own, &own->field, -1, 1);
    fill_lists(own);
    own->is_listed = random_index(random, 4) == 0;
    own->geometry = (sphg_geometry){.sources = setup_view(&own->position),
                                    .source_count = own->count,
                                    .target_count = own->targets,
                                    .list_free = !own->is_listed && random_index(random, 4) == 0};
    if (!own->is_listed && !own->geometry.list_free && random_index(random, 2))
        own->geometry.skin = .2;
    if (random_index(random, 4) == 0)
        own->geometry.period[0] = side > 6 ? side : 6;
    const int begin = random_index(random, own->targets + 1);
    own->subset =
        (sphg_subset){begin, begin + random_index(random, own->targets - begin + 1), NULL, NULL};
}

static sphg_result build(world *own, sphg_context *context, sphg_neighbors *neighbors)
{
    const sphg_lists lists = {.offsets = own->offsets, .indices = own->indices};
    return own->is_listed
               ? sphg_neighbors_use_lists(context, neighbors, &own->scheme, &own->geometry, &lists)
               : sphg_neighbors_search(context, neighbors, &own->scheme, &own->geometry);
}

static sphg_result evaluate(world *own, sphg_context *context, const sphg_neighbors *neighbors)
{
    const sphg_view values = setup_view(&own->field);
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&own->volume)};
    const sphg_field field = {.shape = SPHG_VECTOR,
                              .form = own->rounds % 2 ? SPHG_DIRECT : SPHG_DIFFERENCE,
                              .at_sources = &values,
                              .gradient = setup_view(&own->gradient)};
    sphg_request request = {.sources = &sources,
                            .fields = &field,
                            .set_count = 1,
                            .field_count = 1,
                            .subset = own->rounds % 3 ? NULL : &own->subset};
    if (own->scheme.method != SPHG_PLAIN) {
        request.correction = setup_view(&own->correction);
        request.rank = setup_view(&own->rank);
    }
    own->evaluated += own->targets;
    return sphg_evaluate(context, &own->scheme, &request);
}

static setup_array *result_at(world *own, int k)
{
    setup_array *const results[] = {&own->gradient, &own->correction, &own->rank};
    return results[k];
}

static size_t bytes_of(const setup_array *array)
{
    const size_t number = array->type == SPHG_F64 ? 8 : array->type == SPHG_F32 ? 4 : 1;
    return (size_t)array->count * (size_t)array->width * number;
}

static void clear_results(world *own)
{
    for (int k = 0; k < 3; ++k)
        memset(result_at(own, k)->data, 0, bytes_of(result_at(own, k)));
}

/* ---- Faults ------------------------------------------------------------------------------- */

typedef sphg_result step(world *own, sphg_context *context, sphg_neighbors *neighbors);

static sphg_result evaluate_step(world *own, sphg_context *context, sphg_neighbors *neighbors)
{
    return evaluate(own, context, neighbors);
}

static void fails_as(world *own, fault what, sphg_result result, sphg_result expected)
{
    ++own->injected[what];
    TEST_REQUIRE(result == expected || result == SPHG_OK, "round %ld, %s: %s", own->rounds,
                 fault_names[what], sphg_last_message(own->context));
}

static void try_without_memory(world *own, step *act, sphg_neighbors *neighbors)
{
    const int64_t first = 1 + random_index(&own->random, 8);
    fake_host_fail(&own->host, first, random_index(&own->random, 2) ? first + 1 : INT64_MAX);
    fails_as(own, MEMORY, act(own, own->context, neighbors), SPHG_ERROR_MEMORY);
    fake_host_fail(&own->host, INT64_MAX, INT64_MAX);
}

/* With one number of an array spoilt, then put right again. */
static void try_with_number(world *own, fault what, step *act, const setup_array *array, double bad,
                            sphg_result expected, sphg_neighbors *neighbors)
{
    if (own->count == 0)
        return;
    const int k = random_index(&own->random, own->count * array->width);
    const double good = setup_get(array, k / array->width, k % array->width);
    setup_put(array, k, bad);
    fails_as(own, what, act(own, own->context, neighbors), expected);
    setup_put(array, k, good);
}

static void try_with_index(world *own, sphg_neighbors *neighbors)
{
    if (!own->is_listed || own->offsets[own->targets] == 0)
        return;
    int32_t *index = &own->indices[random_index(&own->random, (int)own->offsets[own->targets])];
    const int32_t good = *index;
    *index = random_index(&own->random, 2) ? own->count : -1 - random_index(&own->random, 1000);
    fails_as(own, INDEX, evaluate(own, own->context, neighbors), SPHG_ERROR_INDEX);
    *index = good;
}

static void restart(valid_call *hostile, const probe *tested)
{
    valid_call_reset(hostile);
    if (tested->prepare)
        tested->prepare(hostile);
}

/* Any argument of any function, in any of its ways. */
static void try_with_argument(world *own)
{
    valid_call *hostile = own->hostile;
    const int f = random_index(&own->random, argument_function_count);
    const probe *tested =
        &argument_functions[f].probes[random_index(&own->random, argument_functions[f].count)];
    trial made;
    if (!tested->call || tested->count == 0)
        return;
    restart(hostile, tested);
    const int a = random_index(&own->random, tested->count);
    if (!argument_spoil(hostile, tested, a, random_index(&own->random, 8), &made))
        return;
    const sphg_result result = tested->call(hostile);
    ++own->injected[ARGUMENT];
    argument_restore(&made);
    TEST_REQUIRE(
        made.expected == ARGUMENT_SKIPPED ||
            (made.expected == ARGUMENT_REFUSED ? result > 0 : (int)result == made.expected),
        "round %ld, %s %s: %d", own->rounds, argument_functions[f].name, made.what, (int)result);
    if (result != SPHG_OK)
        return;
    /* What is allowed may have emptied an object (no sources, say) that later calls count on. */
    restart(hostile, tested);
    TEST_REQUIRE(tested->call(hostile) == SPHG_OK, "round %ld, %s as ever: %s", own->rounds,
                 argument_functions[f].name, sphg_last_message(hostile->context));
}

static void try_build(world *own, fault what, sphg_neighbors *neighbors)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    if (what == MEMORY)
        try_without_memory(own, build, neighbors);
    if (what == POSITION)
        try_with_number(own, what, build, &own->position, bad[random_index(&own->random, 3)],
                        SPHG_ERROR_NOT_FINITE, neighbors);
}

static void try_evaluation(world *own, fault what, sphg_neighbors *neighbors)
{
    if (what == MEMORY)
        try_without_memory(own, evaluate_step, neighbors);
    if (what == FIELD)
        try_with_number(own, what, evaluate_step, &own->field, NAN, SPHG_OK, neighbors);
    if (what == VOLUME)
        try_with_number(own, what, evaluate_step, &own->volume, -1, SPHG_ERROR_VOLUME, neighbors);
    if (what == INDEX)
        try_with_index(own, neighbors);
}

/* ---- Rounds ------------------------------------------------------------------------------- */

static void require_bits_of_a_fresh_context(world *own)
{
    sphg_context *fresh = NULL;
    sphg_neighbors *neighbors = NULL;
    for (int k = 0; k < 3; ++k)
        memcpy(own->kept[k].data, result_at(own, k)->data, bytes_of(&own->kept[k]));
    clear_results(own);
    const sphg_config serial = {.isa = test_isa(), .threads = 1};
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &serial, &fresh));
    SETUP_OK(fresh, sphg_neighbors_create(fresh, &neighbors));
    SETUP_OK(fresh, build(own, fresh, neighbors));
    SETUP_OK(fresh, evaluate(own, fresh, neighbors));
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(fresh);
    for (int k = 0; k < 3; ++k)
        TEST_REQUIRE(setup_same_bits(&own->kept[k], result_at(own, k)),
                     "round %ld: other bits in result %d", own->rounds, k);
    ++own->compared;
}

static void open_context(world *own)
{
    const int kind = (int)(own->rounds / ROUNDS_PER_CONTEXT % 3);
    own->host.workers = 3;
    sphg_config config = fake_host_config(&own->host, kind == 0 ? 1 : 3);
    if (kind == 1)
        config.parallel_for = fake_host_pthreads;
    fake_host_fail(&own->host, INT64_MAX, INT64_MAX);
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &own->context));
}

static void close_context(world *own)
{
    sphg_context_destroy(own->context);
    TEST_REQUIRE(own->host.live_blocks == 0 && own->host.faults == 0,
                 "round %ld: %lld blocks left, %lld faults", own->rounds,
                 (long long)own->host.live_blocks, (long long)own->host.faults);
}

static void play_round(world *own, sphg_neighbors *neighbors)
{
    const fault what = (fault)random_index(&own->random, FAULTS);
    own->injected[NONE] += what == NONE;
    choose_scene(own);
    if (what == ARGUMENT)
        try_with_argument(own);
    try_build(own, what, neighbors);
    SETUP_OK(own->context, build(own, own->context, neighbors));
    try_evaluation(own, what, neighbors);
    clear_results(own);
    SETUP_OK(own->context, evaluate(own, own->context, neighbors));
    if (own->rounds % 5 == 0 && own->geometry.skin == 0)
        require_bits_of_a_fresh_context(own);
    ++own->rounds;
}

/* [byte] resident; 0 where there is no such file. */
static long resident_bytes(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%*d %ld", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return pages * sysconf(_SC_PAGESIZE);
}

static void play(world *own)
{
    sphg_neighbors *neighbors = NULL;
    open_context(own);
    SETUP_OK(own->context, sphg_neighbors_create(own->context, &neighbors));
    for (int k = 0; k < ROUNDS_PER_CONTEXT; ++k)
        play_round(own, neighbors);
    sphg_neighbors_destroy(neighbors);
    close_context(own);
}

/* Evenly over the time. */
static void sample_memory(world *own, double begin, double seconds)
{
    const double share = seconds > 0 ? (long_seconds() - begin) / seconds : 0;
    while (own->samples < SAMPLES && own->samples <= share * SAMPLES)
        own->resident[own->samples++] = resident_bytes();
}

static double seconds_wanted(void)
{
    const char *seconds = getenv("SPHG_SOAK_SECONDS");
    return seconds ? atof(seconds) / 4 : 0; /* there are four cases */
}

/* In less than WARM seconds not all kinds of scenes have come in the first half. */
static void require_flat_memory(const world *own)
{
    const int watched = !TEST_SANITIZED && seconds_wanted() >= WARM;
    long most[2] = {0, 0};
    for (int k = 0; k < own->samples; ++k)
        if (own->resident[k] > most[2 * k / SAMPLES])
            most[2 * k / SAMPLES] = own->resident[k];
    print_message("resident: %ld KiB in the first half at most, %ld KiB in the second%s\n",
                  most[0] / 1024, most[1] / 1024, watched ? "" : ", not judged");
    TEST_REQUIRE(!watched || most[1] <= most[0] + RSS_GROWTH, "memory grows");
}

static world *world_of(const test_case *test)
{
    const sphg_type type = test_field_type(test);
    world *own = test_memory(sizeof *own);
    own->test = test;
    own->dimension = test->dimension;
    own->random = random_seeded(227 + (uint64_t)test->dimension);
    fake_host_open(&own->host);
    own->hostile = valid_call_create(test, 0);
    own->position = setup_output(type, MOST, own->dimension);
    own->volume = setup_output(type, MOST, 1);
    own->field = setup_output(type, MOST, own->dimension);
    own->gradient = setup_output(type, MOST, own->dimension * own->dimension);
    own->correction = setup_output(type, MOST, 16);
    own->rank = setup_output(SPHG_U8, MOST, 1);
    for (int k = 0; k < 3; ++k)
        own->kept[k] = setup_output(result_at(own, k)->type, MOST, result_at(own, k)->width);
    own->offsets = test_memory((MOST + 1) * sizeof *own->offsets);
    own->indices = test_memory((size_t)MOST * LIST_MOST * sizeof *own->indices);
    return own;
}

static void days_of_faults_change_neither_results_nor_memory(const test_case *test)
{
    world *own = world_of(test);
    const double seconds = seconds_wanted(), begin = long_seconds();
    while (own->rounds < ROUNDS_LEAST || long_seconds() - begin < seconds) {
        play(own);
        sample_memory(own, begin, seconds);
    }
    for (int k = 0; k < FAULTS; ++k)
        print_message("%s %ld, ", fault_names[k], own->injected[k]);
    print_message("%ld rounds, %.3g particles evaluated, %ld compared\n", own->rounds,
                  own->evaluated, own->compared);
    if (seconds > 0)
        require_flat_memory(own);
    assert_true(own->injected[MEMORY] > 0 && own->injected[INDEX] > 0 && own->compared > 0);
    fake_host_close(&own->host);
}

static const test_entry entries[] = {
    TEST_ENTRY(days_of_faults_change_neither_results_nor_memory, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
