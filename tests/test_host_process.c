/* SPDX-License-Identifier: MIT */
/* The library within its host's process: it prints nothing, leaves locale and signals alone, works
 * on many threads at once and after a fork. */
#include "support/bad_argument_rows.h"
#include "support/public_calls.h"
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIGNALS = 32 };

typedef struct reaction {
    void (*handler)(int number);
    int flags;
} reaction;

static void remember_signals(reaction *reactions)
{
    for (int k = 1; k < SIGNALS; ++k) {
        struct sigaction action = {0};
        sigaction(k, NULL, &action);
        reactions[k].handler = action.sa_handler;
        reactions[k].flags = action.sa_flags;
    }
}

/* What the calls print, valid and refused ones: bytes in a file that stands for both streams. */
static long printed_by_calls(valid_call *own)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stdout);
    const int kept[2] = {dup(1), dup(2)};
    for (int k = 0; k < 2; ++k)
        dup2(fileno(file), k + 1);
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p) {
            const probe *tested = &argument_functions[f].probes[p];
            trial made;
            for (int a = 0; tested->call && a < tested->count; ++a) {
                valid_call_reset(own);
                if (tested->prepare)
                    tested->prepare(own);
                if (argument_spoil(own, tested, a, 0, &made))
                    tested->call(own);
                argument_restore(&made);
            }
        }
    fflush(stdout);
    for (int k = 0; k < 2; ++k) {
        dup2(kept[k], k + 1);
        close(kept[k]);
    }
    const long bytes = (long)lseek(fileno(file), 0, SEEK_END);
    fclose(file);
    return bytes;
}

static void calls_leave_the_process_alone(const test_case *test)
{
    valid_call *own = valid_call_create(test, 0);
    reaction before[SIGNALS] = {{0}}, after[SIGNALS] = {{0}};
    sigset_t mask_before, mask_after;
    const char *locale = test_text("%s", setlocale(LC_ALL, NULL));
    remember_signals(before);
    pthread_sigmask(SIG_SETMASK, NULL, &mask_before);
    const long printed = printed_by_calls(own);
    pthread_sigmask(SIG_SETMASK, NULL, &mask_after);
    remember_signals(after);
    assert_int_equal(printed, 0);
    for (int k = 1; k < SIGNALS; ++k) {
        assert_true(before[k].handler == after[k].handler && before[k].flags == after[k].flags);
        assert_int_equal(sigismember(&mask_before, k), sigismember(&mask_after, k));
    }
    assert_string_equal(setlocale(LC_ALL, NULL), locale);
}

/* ---- Threads ------------------------------------------------------------------------------ */

enum { HELPERS = 12, ROUNDS = 5 };

/* The valid call of every function, their outputs mixed into one number. */
static uint64_t digest_of_calls(valid_call *own)
{
    uint64_t digest = UINT64_C(14695981039346656037);
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p) {
            const probe *tested = &argument_functions[f].probes[p];
            if (!tested->call)
                continue;
            valid_call_reset(own);
            if (tested->prepare)
                tested->prepare(own);
            digest = (digest ^ (uint64_t)tested->call(own)) * UINT64_C(1099511628211);
            for (int k = 0; k < VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES; ++k)
                digest = (digest ^ own->outputs[k]) * UINT64_C(1099511628211);
        }
    return digest;
}

typedef struct helper {
    valid_call *own;
    uint64_t expected;
    int same;
} helper;

static void *help(void *given)
{
    helper *job = given;
    job->same = 1;
    for (int round = 0; round < ROUNDS; ++round)
        job->same &= digest_of_calls(job->own) == job->expected;
    return NULL;
}

static void contexts_work_side_by_side(const test_case *test)
{
    helper helpers[HELPERS];
    pthread_t threads[HELPERS];
    for (int k = 0; k < HELPERS; ++k)
        helpers[k].own = valid_call_create(test, 0);
    const uint64_t expected = digest_of_calls(helpers[0].own);
    for (int k = 0; k < HELPERS; ++k) {
        helpers[k].expected = expected;
        assert_int_equal(pthread_create(&threads[k], NULL, help, &helpers[k]), 0);
    }
    for (int k = 0; k < HELPERS; ++k)
        pthread_join(threads[k], NULL);
    for (int k = 0; k < HELPERS; ++k)
        TEST_REQUIRE(helpers[k].same, "thread %d has other bits", k);
}

/* ---- Forks -------------------------------------------------------------------------------- */

enum { FORK_COUNT = 20000 }; /* so many that calls take more than one thread */

typedef struct fork_world {
    const test_case *test;
    sphg_scheme scheme;
    sphg_geometry geometry;
    setup_array positions, corrections;
    fake_host *host;
    sphg_context *old;
} fork_world;

/* The correction matrices by a context, search included, as a number; 0 where a call failed.
 * Nothing here ends a case: a child would go on with the parent's. */
static uint64_t digest_by(const fork_world *own, sphg_context *context)
{
    sphg_neighbors *neighbors = NULL;
    const double one = 1;
    const float one_f32 = 1;
    const int width = own->corrections.width;
    memset(own->corrections.data, 0, (size_t)FORK_COUNT * (size_t)width * 8);
    int failed = sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &own->scheme, &own->geometry);
    const sphg_sources sources = {.neighbors = neighbors,
                                  .volume = own->corrections.type == SPHG_F64
                                                ? sphg_view_f64(&one, 0)
                                                : sphg_view_f32(&one_f32, 0)};
    failed = failed || sphg_correction(context, &own->scheme, &sources, NULL,
                                       setup_view(&own->corrections), sphg_absent());
    sphg_neighbors_destroy(neighbors);
    uint64_t digest = UINT64_C(14695981039346656037);
    const unsigned char *bytes = own->corrections.data;
    for (size_t k = 0; k < (size_t)FORK_COUNT * (size_t)width * 8; ++k)
        digest = (digest ^ bytes[k]) * UINT64_C(1099511628211);
    return failed ? 0 : digest | 1;
}

/* A new context: as many threads, or the host's executor. */
static uint64_t digest_by_new(const fork_world *own, int threads, fake_host_executor *executor)
{
    sphg_config config = fake_host_config(own->host, threads);
    config.parallel_for = executor;
    sphg_context *context = NULL;
    if (sphg_context_create(SPHG_VERSION, &config, &context))
        return 0;
    const uint64_t digest = digest_by(own, context);
    sphg_context_destroy(context);
    return digest;
}

static int says_one_thread(sphg_context *context)
{
    sphg_context_info info;
    return sphg_context_get_info(context, &info) == SPHG_OK && info.threads == 1;
}

/* What goes wrong in a child of the process that computed `expected`: 0, or the number of the step.
 */
static int fault_in_child(const fork_world *own, uint64_t expected)
{
    sphg_context_info info;
    if (digest_by(own, own->old) != expected)
        return 1;
    if (!says_one_thread(own->old))
        return 2;
    if (digest_by_new(own, 2, NULL) != expected || digest_by_new(own, 0, NULL) != expected)
        return 3;
    if (digest_by_new(own, 1, NULL) != expected)
        return 4;
    const int64_t regions = own->host->regions;
    if (digest_by_new(own, own->host->workers, fake_host_pthreads) != expected ||
        own->host->regions == regions)
        return 5;
    if (sphg_context_get_info(own->old, &info) || info.isa == SPHG_ISA_BEST)
        return 6;
    sphg_context_destroy(own->old);
    return 0;
}

/* In a child, and in a child of the child: hanging is ended by a signal. */
static int ended_in_child(const fork_world *own, uint64_t expected, int generations)
{
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        alarm(60);
        int fault = generations > 1 ? ended_in_child(own, expected, generations - 1) : 0;
        if (!fault)
            fault = fault_in_child(own, expected);
        _exit(fault);
    }
    int status = -1;
    if (child < 0 || waitpid(child, &status, 0) != child)
        return 100;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

static fork_world fork_world_of(const test_case *test)
{
    random_state random = random_seeded(311);
    cloud points =
        cloud_random(test->dimension, FORK_COUNT, test->dimension == 2 ? 140 : 27, &random);
    fork_world own = {.test = test, .scheme = setup_scheme(test, 1), .host = setup_hooks()};
    own.positions = setup_positions(test, &points);
    own.geometry = setup_geometry(test, &points, &own.positions);
    own.corrections =
        setup_output(SPHG_F64, FORK_COUNT, sphg_correction_width(&own.scheme)); /* room for both */
    own.corrections.type = test_field_type(test);
    own.old = setup_context_of(2);
    return own;
}

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define IS_WATCHED_FOR_RACES 1
#endif
#endif
#ifndef IS_WATCHED_FOR_RACES
#define IS_WATCHED_FOR_RACES 0
#endif

/* The parent has a team of OpenMP threads, which the child has not. The thread sanitizer takes what
 * these have read, before the fork, for a race with what the child writes: it knows nothing of
 * their end. qemu fails an assertion of its own (plugins/core.c) at the child's first new thread.
 */
static void contexts_old_and_new_work_after_a_fork(const test_case *test)
{
    if (IS_WATCHED_FOR_RACES || TEST_IS_EMULATED) {
        print_message("skipped: the thread sanitizer does not follow threads through fork(), "
                      "nor does qemu\n");
        test_skip();
    }
    const fork_world own = fork_world_of(test);
    const uint64_t expected = digest_by(&own, own.old);
    assert_true(expected);
    assert_int_equal(ended_in_child(&own, expected, 2), 0);
    assert_true(digest_by(&own, own.old) == expected); /* the parent goes on */
}

/* ---- What a context is ------------------------------------------------------------------- */

static void contexts_say_what_they_are(const test_case *test)
{
    (void)test;
    const sphg_isa sets[] = {SPHG_ISA_BASE, SPHG_ISA_X86_V3, SPHG_ISA_X86_V4, SPHG_ISA_NEON};
    fake_host *host = setup_hooks();
    sphg_context_info best, info;
    SETUP_OK(NULL, sphg_context_get_info(setup_context_with(NULL), &best));
    assert_int_equal(best.openmp, TEST_OPENMP);
    assert_true(best.isa != SPHG_ISA_BEST && best.threads >= 1 && best.bytes > 0);
    for (int k = 0; k < 4; ++k) {
        sphg_context *const context = setup_context_on(sets[k]);
        if (!context)
            continue;
        SETUP_OK(context, sphg_context_get_info(context, &info));
        assert_int_equal(info.isa, sets[k]);
        assert_true(sets[k] <= best.isa);
    }
    SETUP_OK(NULL, sphg_context_get_info(setup_context_of(3), &info));
    assert_int_equal(info.threads, TEST_OPENMP ? 3 : 1);
    sphg_config config = fake_host_config(host, 5);
    config.parallel_for = fake_host_reversed;
    SETUP_OK(NULL, sphg_context_get_info(setup_context_with(&config), &info));
    assert_int_equal(info.threads, 5);
}

static const test_entry entries[] = {
    TEST_ENTRY(calls_leave_the_process_alone, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(contexts_work_side_by_side, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(contexts_say_what_they_are, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(contexts_old_and_new_work_after_a_fork, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               0, 0),
};
TEST_MAIN(entries)
