/* The library within its host's process: it prints nothing, leaves locale and signals alone, works
 * on many threads at once and, with one thread, after a fork. */
#include "support/hostile_rows.h"
#include "support/victim_calls.h"
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
    for (int k = 1; k < SIGNALS; k++) {
        struct sigaction action = {0};
        sigaction(k, NULL, &action);
        reactions[k].handler = action.sa_handler;
        reactions[k].flags = action.sa_flags;
    }
}

/* What the calls print, valid and refused ones: bytes in a file that stands for both streams. */
static long printed_by_calls(victim *own)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stdout);
    const int kept[2] = {dup(1), dup(2)};
    for (int k = 0; k < 2; k++)
        dup2(fileno(file), k + 1);
    for (int f = 0; f < hostile_function_count; f++)
        for (int p = 0; p < hostile_functions[f].count; p++) {
            const probe *tested = &hostile_functions[f].probes[p];
            trial made;
            for (int a = 0; tested->call && a < tested->count; a++) {
                victim_reset(own);
                if (tested->prepare)
                    tested->prepare(own);
                if (hostile_spoil(own, tested, a, 0, &made))
                    tested->call(own);
                hostile_restore(&made);
            }
        }
    fflush(stdout);
    for (int k = 0; k < 2; k++) {
        dup2(kept[k], k + 1);
        close(kept[k]);
    }
    const long bytes = (long)lseek(fileno(file), 0, SEEK_END);
    fclose(file);
    return bytes;
}

static void calls_leave_the_process_alone(const test_case *test)
{
    victim *own = victim_create(test, 0);
    reaction before[SIGNALS] = {{0}}, after[SIGNALS] = {{0}};
    sigset_t mask_before, mask_after;
    const char *locale = test_text("%s", setlocale(LC_ALL, NULL));
    remember_signals(before);
    pthread_sigmask(SIG_SETMASK, NULL, &mask_before);
    const long printed = printed_by_calls(own);
    pthread_sigmask(SIG_SETMASK, NULL, &mask_after);
    remember_signals(after);
    assert_int_equal(printed, 0);
    for (int k = 1; k < SIGNALS; k++) {
        assert_true(before[k].handler == after[k].handler && before[k].flags == after[k].flags);
        assert_int_equal(sigismember(&mask_before, k), sigismember(&mask_after, k));
    }
    assert_string_equal(setlocale(LC_ALL, NULL), locale);
}

/* ---- Threads and forks -------------------------------------------------------------------- */

enum { HELPERS = 12, ROUNDS = 5 };

/* The valid call of every function, their outputs mixed into one number. */
static uint64_t digest_of_calls(victim *own)
{
    uint64_t digest = UINT64_C(14695981039346656037);
    for (int f = 0; f < hostile_function_count; f++)
        for (int p = 0; p < hostile_functions[f].count; p++) {
            const probe *tested = &hostile_functions[f].probes[p];
            if (!tested->call)
                continue;
            victim_reset(own);
            if (tested->prepare)
                tested->prepare(own);
            digest = (digest ^ (uint64_t)tested->call(own)) * UINT64_C(1099511628211);
            for (int k = 0; k < VICTIM_SLOTS * VICTIM_SLOT_BYTES; k++)
                digest = (digest ^ own->outputs[k]) * UINT64_C(1099511628211);
        }
    return digest;
}

typedef struct helper {
    victim *own;
    uint64_t expected;
    int same;
} helper;

static void *help(void *given)
{
    helper *job = given;
    job->same = 1;
    for (int round = 0; round < ROUNDS; round++)
        job->same &= digest_of_calls(job->own) == job->expected;
    return NULL;
}

static void contexts_work_side_by_side(const test_case *test)
{
    helper helpers[HELPERS];
    pthread_t threads[HELPERS];
    for (int k = 0; k < HELPERS; k++)
        helpers[k].own = victim_create(test, 0);
    const uint64_t expected = digest_of_calls(helpers[0].own);
    for (int k = 0; k < HELPERS; k++) {
        helpers[k].expected = expected;
        assert_int_equal(pthread_create(&threads[k], NULL, help, &helpers[k]), 0);
    }
    for (int k = 0; k < HELPERS; k++)
        pthread_join(threads[k], NULL);
    for (int k = 0; k < HELPERS; k++)
        TEST_REQUIRE(helpers[k].same, "thread %d has other bits", k);
}

static uint64_t serial_digest(victim *own)
{
    const sphg_config serial = hooks_config(own->host, 1);
    sphg_context *context = NULL, *living = own->valid->context;
    if (sphg_context_create(SPHG_VERSION, &serial, &context) != SPHG_OK)
        return 0;
    own->valid->context = context;
    const uint64_t digest = digest_of_calls(own);
    own->valid->context = living;
    sphg_context_destroy(context);
    return digest;
}

/* So many that the search takes more than one thread. */
static void work_in_parallel(const test_case *test)
{
    random_state random = random_seeded(311);
    cloud points = cloud_random(test->dimension, 20000, test->dimension == 2 ? 140 : 27, &random);
    const sphg_scheme scheme = fixture_scheme(test, 1);
    fixture_neighbors(fixture_context_of(2), test, &scheme, &points);
}

/* The parent has a team of OpenMP threads, which the child has not. */
static void serial_contexts_work_after_a_fork(const test_case *test)
{
    victim *own = victim_create(test, 0);
    const uint64_t expected = serial_digest(own);
    work_in_parallel(test);
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        alarm(60);
        _exit(serial_digest(own) == expected ? 0 : 1);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    TEST_REQUIRE(WIFEXITED(status) && WEXITSTATUS(status) == 0, "the child ended with %d", status);
}

static const test_entry entries[] = {
    TEST_ENTRY(calls_leave_the_process_alone, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(contexts_work_side_by_side, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(serial_contexts_work_after_a_fork, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0,
               0),
};
TEST_MAIN(entries)
