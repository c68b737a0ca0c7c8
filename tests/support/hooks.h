/* The host's side of sphg_config: an allocator that counts, checks and fails on demand, a log that
 * remembers the last failure, and executors that split and order work in awkward ways. */
#ifndef TESTS_SUPPORT_HOOKS_H
#define TESTS_SUPPORT_HOOKS_H
#include <pthread.h>
#include <stdint.h>
#include <sphgrad/sphgrad.h>

typedef struct hooks {
    pthread_mutex_t lock;
    int64_t allocations; /* asked for so far, refused ones included */
    int64_t live_blocks, live_bytes, peak_bytes;
    int64_t faults; /* wrong size at release, broken guard, alignment that is no power of two */
    int64_t fail_from, fail_until; /* allocations [from, until), counted from 1, return NULL */
    int32_t workers;               /* of the executors below */
    int64_t regions;               /* calls of the executor */
    int32_t log_count;
    sphg_result log_result;
    char log_message[512];
} hooks;

void hooks_open(hooks *host);
void hooks_close(hooks *host);

/* Forgets the count and lets allocations [from, until) of those to come fail. */
void hooks_fail(hooks *host, int64_t from, int64_t until);

/* Allocator and log of `host`, one thread. */
sphg_config hooks_config(hooks *host, int32_t threads);

typedef void hooks_executor(sphg_task *task, void *data, int32_t count, int32_t grain, void *user);

hooks_executor hooks_odd_splits; /* one thread, uneven ranges, workers in turn */
hooks_executor hooks_reversed;   /* one thread, the last range first */
hooks_executor hooks_pthreads;   /* as many threads as workers, ranges taken from a queue */

#endif
