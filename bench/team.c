/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* sysconf */
#include "team.h"
#ifdef _OPENMP
#include <omp.h>
#else
#include <unistd.h>
#endif

/* Not the affinity of this thread: with OMP_PROC_BIND that is one processor. */
int32_t team_processors(void)
{
#ifdef _OPENMP
    return omp_get_num_procs();
#else
    return (int32_t)sysconf(_SC_NPROCESSORS_ONLN);
#endif
}

int32_t team_threads(void)
{
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

static int32_t boundary(int32_t share, int32_t threads, int32_t count, int32_t grain)
{
    const int64_t grains = ((int64_t)count + grain - 1) / grain;
    const int64_t item = grains * share / threads * grain;
    return (int32_t)(item < count ? item : count);
}

void team_run(int32_t threads, team_task *task, void *data, int32_t count, int32_t grain)
{
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(static, 1)
#endif
    for (int32_t share = 0; share < threads; ++share)
        task(data, boundary(share, threads, count, grain),
             boundary(share + 1, threads, count, grain));
}
