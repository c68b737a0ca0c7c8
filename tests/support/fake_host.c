/* SPDX-License-Identifier: MIT */
#include "fake_host.h"
#include "test.h"
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

/* A guard word beside the size: a block released twice or not ours is seen. */
typedef struct header {
    size_t size, alignment;
    uint64_t guard;
} header;

static const uint64_t LIVE = 0x5b1d0c0ffee0f00dU;
static const uint64_t DEAD = 0xdeadbeefdeadbeefU;

void fake_host_open(fake_host *host)
{
    memset(host, 0, sizeof *host);
    pthread_mutex_init(&host->lock, NULL);
    host->workers = 4;
}

void fake_host_close(fake_host *host)
{
    pthread_mutex_destroy(&host->lock);
}

void fake_host_fail(fake_host *host, int64_t from, int64_t until)
{
    host->allocations = 0;
    host->fail_from = from;
    host->fail_until = until;
}

static size_t header_space(size_t alignment)
{
    size_t space = alignment > alignof(max_align_t) ? alignment : alignof(max_align_t);
    return (sizeof(header) + space - 1) / space * space;
}

/* Fresh memory is filled with NaN-like bytes: reading before writing shows in the results. */
static void *take(fake_host *host, size_t size, size_t alignment)
{
    const size_t space = header_space(alignment);
    const size_t unit = alignment > alignof(max_align_t) ? alignment : alignof(max_align_t);
    char *base = aligned_alloc(unit, (space + size + unit - 1) / unit * unit);
    if (!base)
        return NULL;
    header *head = (header *)(void *)(base + space - sizeof(header));
    head->size = size;
    head->alignment = alignment;
    head->guard = LIVE;
    memset(base + space, 0xff, size);
    ++host->live_blocks;
    host->live_bytes += (int64_t)size;
    if (host->live_bytes > host->peak_bytes)
        host->peak_bytes = host->live_bytes;
    return base + space;
}

static void *fake_host_allocate(size_t size, size_t alignment, void *user)
{
    fake_host *host = user;
    void *memory = NULL;
    pthread_mutex_lock(&host->lock);
    const int64_t ordinal = ++host->allocations;
    if (alignment == 0 || (alignment & (alignment - 1)) != 0)
        ++host->faults;
    else if (ordinal < host->fail_from || ordinal >= host->fail_until)
        memory = take(host, size, alignment);
    pthread_mutex_unlock(&host->lock);
    return memory;
}

static void give_back(fake_host *host, void *memory, size_t size)
{
    header *head = (header *)(void *)((char *)memory - sizeof(header));
    if (head->guard != LIVE) {
        ++host->faults;
        return;
    }
    if (head->size != size)
        ++host->faults;
    --host->live_blocks;
    host->live_bytes -= (int64_t)head->size;
    head->guard = DEAD;
    memset(memory, 0xfe, head->size);
    free((char *)memory - header_space(head->alignment));
}

static void fake_host_release(void *memory, size_t size, void *user)
{
    fake_host *host = user;
    if (!memory)
        return;
    pthread_mutex_lock(&host->lock);
    give_back(host, memory, size);
    pthread_mutex_unlock(&host->lock);
}

static void fake_host_log(sphg_result result, const char *message, void *user)
{
    fake_host *host = user;
    ++host->log_count;
    host->log_result = result;
    strncpy(host->log_message, message, sizeof host->log_message - 1);
}

sphg_config fake_host_config(fake_host *host, int32_t threads)
{
    sphg_config config = {0};
    config.threads = threads;
    config.isa = test_isa();
    config.allocate = fake_host_allocate;
    config.release = fake_host_release;
    config.log = fake_host_log;
    config.user = host;
    return config;
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

void fake_host_odd_splits(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    fake_host *host = user;
    int32_t step = grain, worker = 0;
    ++host->regions;
    for (int32_t begin = 0; begin < count; worker = (worker + 1) % host->workers) {
        const int32_t end = begin + least(step, count - begin);
        task(data, begin, end, worker);
        begin = end;
        step = step % 977 + grain + 13; /* never the same twice in a row */
    }
}

void fake_host_reversed(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    fake_host *host = user;
    ++host->regions;
    for (int32_t end = count; end > 0;) {
        const int32_t begin = end - least(grain, end);
        task(data, begin, end, host->workers - 1);
        end = begin;
    }
}

typedef struct queue {
    pthread_mutex_t lock;
    sphg_task *task;
    void *data;
    int32_t next, count, grain;
} queue;

typedef struct seat {
    queue *work;
    int32_t worker;
} seat;

static void *serve(void *argument)
{
    const seat *own = argument;
    queue *work = own->work;
    for (;;) {
        pthread_mutex_lock(&work->lock);
        const int32_t begin = work->next;
        const int32_t end = begin + least(work->grain, work->count - begin);
        work->next = end;
        pthread_mutex_unlock(&work->lock);
        if (begin >= end)
            return NULL;
        work->task(work->data, begin, end, own->worker);
    }
}

void fake_host_pthreads(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    fake_host *host = user;
    queue work = {PTHREAD_MUTEX_INITIALIZER, task, data, 0, count, grain};
    pthread_t threads[64];
    seat seats[64];
    ++host->regions;
    for (int32_t worker = 0; worker < host->workers; ++worker) {
        seats[worker] = (seat){&work, worker};
        pthread_create(&threads[worker], NULL, serve, &seats[worker]);
    }
    for (int32_t worker = 0; worker < host->workers; ++worker)
        pthread_join(threads[worker], NULL);
    pthread_mutex_destroy(&work.lock);
}
