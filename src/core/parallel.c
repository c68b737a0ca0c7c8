/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* getpid */
#include "parallel.h"
#ifdef SPHG_USE_OPENMP
#include <omp.h>
#endif
#if defined(SPHG_USE_OPENMP) && !defined(_WIN32)
#define HAS_FORK 1
#include <unistd.h>
#else
#define HAS_FORK 0
#endif

enum { TASKS_PER_THREAD = 8, MOST_THREADS = 1024 };

/* fork() copies OpenMP's belief in its threads, but none of them: the next region of the child
 * would wait for ever. So the library remembers the process in which it began its first region, the
 * one number that it keeps outside of contexts: a new context of the child has to know, too. A
 * number to compare, since a handler of fork() could not be taken back when the library is
 * unloaded. */
#if HAS_FORK
static atomic_long first_region;

static bool lost_threads(void)
{
    const long process = atomic_load_explicit(&first_region, memory_order_relaxed);
    return process && process != (long)getpid();
}

static bool may_begin_region(void)
{
    const long self = (long)getpid();
    long process = 0;
    return atomic_compare_exchange_strong_explicit(&first_region, &process, self,
                                                   memory_order_relaxed, memory_order_relaxed) ||
           process == self;
}
#else
static bool lost_threads(void)
{
    return false;
}

static bool may_begin_region(void)
{
    return true;
}
#endif

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
    if (!config->parallel_for && lost_threads())
        threads = 1;
    return sphgi_min32(sphgi_max32(threads, 1), MOST_THREADS);
}

int32_t sphgi_threads_left(const sphg_context *context)
{
    return !context->config.parallel_for && lost_threads() ? 1 : context->threads;
}

int32_t sphgi_has_openmp(void)
{
#ifdef SPHG_USE_OPENMP
    return 1;
#else
    return 0;
#endif
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

/* A task in the default floating-point environment, on whichever thread it runs. */
struct float_task {
    sphg_task *task;
    void *data;
};

static void run_in_default_floats(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct float_task *own = data;
    const struct sphgi_floats before = sphgi_floats_enter();
    own->task(own->data, begin, end, worker);
    sphgi_floats_leave(before);
}

/* Executors run in the host's environment: threads that they create inherit it, and keep it. What a
 * host's executor does to it stays; the flags that OpenMP's arithmetic raises do not. */
static void run_by_executor(sphg_context *context, struct float_task *own, int32_t count,
                            int32_t grain)
{
    const sphg_config *config = &context->config;
    const struct sphgi_floats before = context->host_floats;
    sphgi_floats_leave(before);
    if (config->parallel_for)
        config->parallel_for(run_in_default_floats, own, count, grain, config->user);
#ifdef SPHG_USE_OPENMP
    else
        openmp_for(run_in_default_floats, own, count, grain, context->threads);
#endif
    context->host_floats = sphgi_floats_enter();
    if (!config->parallel_for)
        context->host_floats = before;
}

void sphgi_parallel_for(sphg_context *context, sphg_task *task, void *data, int32_t count,
                        int32_t grain)
{
    struct float_task own = {task, data};
    if (count <= 0)
        return;
    if (context->config.parallel_for ||
        (context->threads > 1 && count > grain && may_begin_region()))
        run_by_executor(context, &own, count, grain);
    else
        task(data, 0, count, 0);
}
