/* SPDX-License-Identifier: MIT */
/* Threads for loops of the benchmark's own: those of OpenMP that the library uses, too, so that
 * neither waits for the other's. */
#ifndef SPHGRAD_BENCH_TEAM_H
#define SPHGRAD_BENCH_TEAM_H
#include <stdint.h>

int32_t team_processors(void); /* that this process may run on */
int32_t team_threads(void);    /* that the library uses if nothing is said */

/* Work on the items [begin, end). */
typedef void team_task(void *data, int32_t begin, int32_t end);

/* Equal shares of [0, count), each from a multiple of grain on, one per thread. Without OpenMP
 * the calling thread does all. */
void team_run(int32_t threads, team_task *task, void *data, int32_t count, int32_t grain);
#endif
