/* SPDX-License-Identifier: MIT */
/* Whatever rounding mode, flushing of denormals and traps the host has set, on whichever thread:
 * the same bits, no trap, and the host finds its environment and errno as they were. */
#include "support/bad_argument_rows.h"
#include "support/fake_host.h"
#include "support/long_counts.h"
#include "support/brute_force.h"
#include <dlfcn.h>
#include <errno.h>
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/* ---- Environments of a thread ------------------------------------------------------------- */

/* Rounding modes times: nothing, inputs to zero, results to zero, both, every trap. */
enum { ENVIRONMENTS = 20, TRAPS = 4 };

static int was_lost; /* an environment that a task or a call did not leave as it was */

#if defined(__SSE2__)

typedef unsigned int environment;

static environment environment_of(int number)
{
    static const unsigned int extras[] = {0x1f80, 0x1fc0, 0x9f80, 0x9fc0, 0};
    return extras[number % 5] | (unsigned int)(number / 5) << 13;
}

static void set_environment(environment wanted)
{
    _mm_setcsr(wanted);
}

static environment get_environment(void)
{
    return _mm_getcsr();
}

#elif defined(__aarch64__)

typedef uint64_t environment; /* the register FPCR */

static void set_environment(environment wanted)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(wanted) : "memory");
}

static environment get_environment(void)
{
    environment here;
    __asm__ volatile("mrs %0, fpcr" : "=r"(here) : : "memory");
    return here;
}

/* Zeros for denormals, a default NaN, both, every trap; what the processor lacks reads as 0. */
static environment environment_of(int number)
{
    static const environment extras[] = {0, 1u << 24, 1u << 25, 3u << 24, 0x9f00};
    const environment here = get_environment();
    set_environment(extras[number % 5] | (environment)(number / 5) << 22);
    const environment kept = get_environment();
    set_environment(here);
    return kept;
}

#else

typedef int environment;

static environment environment_of(int number)
{
    static const int modes[] = {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO};
    return modes[number / 5];
}

static void set_environment(environment wanted)
{
    fesetround(wanted);
}

static environment get_environment(void)
{
    return fegetround();
}

#endif

/* ---- A scene for many threads ------------------------------------------------------------- */

enum { COUNT = 3000, RECORD = 32 };

typedef struct world {
    const test_case *test;
    scene particles;
    sphg_scheme scheme;
    setup_array field, tiny, volume, matrices;
} world;

static world world_of(const test_case *test)
{
    random_state random = random_seeded(307);
    world own = {.test = test};
    cloud points = cloud_random(test->dimension, COUNT, test->dimension == 2 ? 60 : 15, &random);
    const sphg_type type = test_field_type(test);
    const double small = type == SPHG_F32 ? 1e-38 : 1e-308;
    double *numbers = cloud_numbers(&points, -1, 1, &random);
    double *matrices = test_memory(COUNT * 9 * sizeof *matrices);
    own.particles = scene_of_cloud(test, &points);
    own.scheme = setup_scheme(test, 2);
    own.field = setup_numbers(type, COUNT, 1, numbers);
    own.volume = setup_numbers(type, COUNT, 1, cloud_volumes(&points, .2, &random));
    for (int k = 0; k < COUNT * 9; ++k)
        matrices[k] = random_between(&random, -small, small);
    for (int k = 0; k < COUNT; ++k)
        numbers[k] *= small;
    own.tiny = setup_numbers(type, COUNT, 1, numbers);
    own.matrices = setup_numbers(type, COUNT, 9, matrices);
    return own;
}

typedef struct run {
    const world *own;
    sphg_config config;
    environment around;
    double skin;
    sphg_result result;
    setup_array record;
} run;

static sphg_view member(const run *job, int first)
{
    sphg_view view = setup_view(&job->record);
    view.x = (const char *)view.x + first * (view.type == SPHG_F64 ? 8 : 4);
    return view;
}

static sphg_result operate(const run *job, sphg_context *context, const sphg_neighbors *neighbors)
{
    const world *own = job->own;
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&own->volume)};
    sphg_result result = sphg_gradient(context, &own->scheme, &sources, NULL,
                                       setup_view(&own->field), member(job, 0));
    if (!result)
        result = sphg_gradient(context, &own->scheme, &sources, NULL, setup_view(&own->tiny),
                               member(job, 3));
    if (!result)
        result =
            sphg_correction(context, &own->scheme, &sources, NULL, member(job, 6), sphg_absent());
    if (!result && own->test->dimension == 3)
        result = sphg_svd(context, COUNT, setup_view(&own->matrices), sphg_absent(),
                          member(job, 22), sphg_absent());
    if (!result)
        result = sphg_eigen(context, own->test->dimension, COUNT, setup_view(&own->matrices),
                            member(job, 25), sphg_absent());
    return result;
}

/* A thread of its own: its team of OpenMP threads is created in its environment. */
static void *work(void *given)
{
    run *job = given;
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    sphg_geometry geometry = scene_geometry(&job->own->particles);
    geometry.skin = job->skin;
    set_environment(job->around);
    job->result = sphg_context_create(SPHG_VERSION, &job->config, &context);
    if (!job->result)
        job->result = sphg_neighbors_create(context, &neighbors);
    for (int step = 0; step < 2 && !job->result; ++step)
        job->result = sphg_neighbors_search(context, neighbors, &job->own->scheme, &geometry);
    if (!job->result)
        job->result = operate(job, context, neighbors);
    was_lost |= get_environment() != job->around;
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return NULL;
}

static setup_array run_around(const world *own, const sphg_config *config, environment around,
                              double skin, const char *where)
{
    run job = {own, *config, around, skin, SPHG_OK, setup_output(own->field.type, COUNT, RECORD)};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, work, &job), 0);
    pthread_join(thread, NULL);
    TEST_REQUIRE(job.result == SPHG_OK, "%s: %s", where, sphg_result_string(job.result));
    return job.record;
}

/* Three threads, each in the environment that its number says, look at theirs after every task. */
typedef struct errand {
    sphg_task *task;
    void *data;
    int32_t begin, end, worker;
    environment around;
    int lost;
} errand;

static void *do_errand(void *given)
{
    errand *own = given;
    set_environment(own->around);
    errno = 4711;
    own->task(own->data, own->begin, own->end, own->worker);
    own->lost = get_environment() != own->around || errno != 4711;
    return NULL;
}

static void each_in_its_own(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    enum { workers = 3 };
    errand errands[workers];
    pthread_t threads[workers];
    (void)grain, (void)user;
    for (int32_t w = 0; w < workers; ++w) {
        const int32_t begin = (int32_t)((int64_t)count * w / workers);
        const int32_t end = (int32_t)((int64_t)count * (w + 1) / workers);
        errands[w] = (errand){task, data, begin, end, w, environment_of(7 * w + 2), 0};
        pthread_create(&threads[w], NULL, do_errand, &errands[w]);
    }
    for (int w = 0; w < workers; ++w) {
        pthread_join(threads[w], NULL);
        was_lost |= errands[w].lost;
    }
}

static void results_do_not_depend_on_the_float_environment(const test_case *test)
{
    const world own = world_of(test);
    fake_host host;
    fake_host_open(&host);
    const sphg_config configs[] = {
        {.threads = 1, .isa = test_isa()},
        {.threads = 2, .isa = test_isa()},
        {.threads = 3, .isa = test_isa(), .parallel_for = fake_host_pthreads, .user = &host},
        {.threads = 3, .isa = test_isa(), .parallel_for = each_in_its_own, .user = &host}};
    host.workers = 3;
    const setup_array expected[] = {
        run_around(&own, &configs[0], environment_of(0), 0, "default"),
        run_around(&own, &configs[0], environment_of(0), .5, "default")};
    was_lost = 0;
    for (int number = 0; number < ENVIRONMENTS; number += TEST_SLOWED ? 3 : 1)
        for (int k = 0; k < 4; ++k) {
            const char *where = test_text("environment %d, executor %d", number, k);
            const setup_array found =
                run_around(&own, &configs[k], environment_of(number), number % 2 * .5, where);
            TEST_REQUIRE(setup_same_bits(&found, &expected[number % 2]), "%s: other bits", where);
            TEST_REQUIRE(!was_lost, "%s: the environment was changed", where);
        }
    fake_host_close(&host);
}

/* A library with -ffast-math is loaded into the process: see support/fast_math_host.c. */
static void fast_math_elsewhere_changes_nothing(const test_case *test)
{
    const world own = world_of(test);
    const sphg_config config = {.threads = 2, .isa = test_isa()};
    const setup_array expected = run_around(&own, &config, environment_of(0), 0, "before");
    void *library = dlopen(FAST_MATH_HOST, RTLD_NOW);
    assert_non_null(library);
    const environment around = get_environment();
    const setup_array found = run_around(&own, &config, around, 0, "after");
    set_environment(environment_of(0));
    dlclose(library);
    if (around == environment_of(0))
        print_message("this compiler's -ffast-math leaves the environment alone\n");
    assert_true(setup_same_bits(&found, &expected));
}

/* ---- Every public function ---------------------------------------------------------------- */

static void every_function_leaves_the_environment_alone(const test_case *test)
{
    valid_call *own = valid_call_create(test, 0);
    unsigned char *expected = test_memory(VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES);
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p)
            for (int number = 0; number < ENVIRONMENTS; ++number) {
                const probe *tested = &argument_functions[f].probes[p];
                const environment around = environment_of(number);
                if (!tested->call)
                    continue;
                valid_call_reset(own);
                if (tested->prepare)
                    tested->prepare(own);
                errno = 4711;
                set_environment(around);
                const sphg_result result = tested->call(own);
                const int kept = get_environment() == around && errno == 4711;
                set_environment(environment_of(0));
                TEST_REQUIRE(result == SPHG_OK || number > 0, "%s", argument_functions[f].name);
                if (number == 0)
                    memcpy(expected, own->outputs, VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES);
                TEST_REQUIRE(kept, "%s in environment %d", argument_functions[f].name, number);
                TEST_REQUIRE(
                    memcmp(expected, own->outputs, VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES) == 0,
                    "%s: other bits in environment %d", argument_functions[f].name, number);
            }
}

static void functions_of_numbers_do_not_depend_on_it(const test_case *test)
{
    const sphg_scheme scheme = setup_scheme(test, 1.25);
    const double x[3] = {.1, .3, .7}, table[6] = {1.1, .2, .3, .9, .1, 1.3};
    double expected[8] = {0};
    for (int number = 0; number < ENVIRONMENTS; ++number) {
        double found[8] = {0};
        const environment around = environment_of(number);
        set_environment(around);
        sphg_kernel_value(&scheme, .6180339887, &found[0], &found[1]);
        sphg_kernel_constants(&scheme, &found[2], &found[3]);
        sphg_pair_gradient(&scheme, x, .7, table, &found[4]);
        const int kept = get_environment() == around;
        set_environment(environment_of(0));
        if (number == 0)
            memcpy(expected, found, sizeof found);
        assert_true(kept);
        assert_memory_equal(found, expected, sizeof found);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(results_do_not_depend_on_the_float_environment, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0,
               0),
    TEST_ENTRY(fast_math_elsewhere_changes_nothing, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(every_function_leaves_the_environment_alone, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ONCE(functions_of_numbers_do_not_depend_on_it),
};
TEST_MAIN(entries)
