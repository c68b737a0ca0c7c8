/* SPDX-License-Identifier: MIT */
/* Work on [0, count) by the context's executor: the host's, OpenMP, or the calling thread. */
#ifndef SPHGI_PARALLEL_H
#define SPHGI_PARALLEL_H
#include "context.h"

/* Threads that the configuration asks for; at least 1. */
int32_t sphgi_thread_count(const sphg_config *config);

/* Threads that the context's calls take by now: 1 in a child of fork() that OpenMP's did not
 * follow. */
int32_t sphgi_threads_left(const sphg_context *context);

int32_t sphgi_has_openmp(void); /* 1: compiled in */

/* grain: the fewest items worth a task. */
void sphgi_parallel_for(sphg_context *context, sphg_task *task, void *data, int32_t count,
                        int32_t grain);

#endif
