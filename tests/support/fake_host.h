/* SPDX-License-Identifier: MIT */
/* The host's side of sphg_config: an allocator that counts, checks and fails on demand, a log that
 * remembers the last failure, and executors that split and order work in awkward ways. */
#ifndef TESTS_SUPPORT_FAKE_HOST_H
#define TESTS_SUPPORT_FAKE_HOST_H
#include <pthread.h>
#include <stdint.h>
#include <sphgrad/sphgrad.h>

typedef struct fake_host {
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
} fake_host;

void fake_host_open(fake_host *host);
void fake_host_close(fake_host *host);

/* Forgets the count and lets allocations [from, until) of those to come fail. */
void fake_host_fail(fake_host *host, int64_t from, int64_t until);

/* Allocator and log of `host`, one thread. */
sphg_config fake_host_config(fake_host *host, int32_t threads);

typedef void fake_host_executor(sphg_task *task, void *data, int32_t count, int32_t grain,
                                void *user);

fake_host_executor fake_host_odd_splits; /* one thread, uneven ranges, workers in turn */
fake_host_executor fake_host_reversed;   /* one thread, the last range first */
fake_host_executor fake_host_pthreads;   /* as many threads as workers, ranges taken from a queue */

#endif
