#include "parallel.h"
#ifdef SPHG_USE_OPENMP
#include <omp.h>
#endif

enum { TASKS_PER_THREAD = 8, MOST_THREADS = 1024 };

int32_t sphgi_thread_count(const sphg_config *config)
{
    int32_t threads = config->threads;
#ifdef SPHG_USE_OPENMP
    if (!threads && !config->parallel_for)
        threads = omp_get_max_threads();
#else
    if (!config->parallel_for)
        threads = 1;
#endif
    return sphgi_min32(sphgi_max32(threads, 1), MOST_THREADS);
}

#ifdef SPHG_USE_OPENMP
static void openmp_for(sphg_task *task, void *data, int32_t count, int32_t grain, int32_t threads)
{
    /* Dynamic: particles differ in cost. Results do not depend on who did what. */
    const int32_t fair = count / (threads * TASKS_PER_THREAD);
    const int32_t size = sphgi_max32(sphgi_max32(grain, fair), 1);
    const int32_t tasks = (int32_t)(((int64_t)count + size - 1) / size);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (int32_t k = 0; k < tasks; ++k) {
        const int64_t end = (int64_t)(k + 1) * size;
        task(data, k * size, end < count ? (int32_t)end : count, omp_get_thread_num());
    }
}
#endif

void sphgi_parallel_for(sphg_context *context, sphg_task *task, void *data, int32_t count,
                        int32_t grain)
{
    const sphg_config *config = &context->config;
    if (count <= 0)
        return;
    if (config->parallel_for)
        config->parallel_for(task, data, count, grain, config->user);
#ifdef SPHG_USE_OPENMP
    else if (context->threads > 1 && count > grain)
        openmp_for(task, data, count, grain, context->threads);
#endif
    else
        task(data, 0, count, 0);
}
