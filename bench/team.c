/* SPDX-License-Identifier: MIT */
#include "team.h"

#ifdef _OPENMP
static int32_t boundary(int32_t share, int32_t threads, int32_t count, int32_t grain)
{
    const int64_t grains = ((int64_t)count + grain - 1) / grain;
    const int64_t item = grains * share / threads * grain;
    return (int32_t)(item < count ? item : count);
}

void team_run(int32_t threads, team_task *task, void *data, int32_t count, int32_t grain)
{
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int32_t share = 0; share < threads; ++share)
        task(data, boundary(share, threads, count, grain),
             boundary(share + 1, threads, count, grain));
}
#else
void team_run(int32_t threads, team_task *task, void *data, int32_t count, int32_t grain)
{
    (void)threads, (void)grain;
    task(data, 0, count);
}
#endif
