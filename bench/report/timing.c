/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* clock_gettime, isatty */
#include "timing.h"
#include "numbers.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

static double read_clock(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

struct moment now(void)
{
    return (struct moment){read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_PROCESS_CPUTIME_ID)};
}

struct moment since(struct moment start)
{
    const struct moment end = now();
    return (struct moment){end.wall - start.wall, end.cpu - start.cpu};
}

static int compare_numbers(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

double median_of(double *values, int32_t count)
{
    qsort(values, (size_t)count, sizeof *values, compare_numbers);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* ---- On the terminal ------------------------------------------------------------------------- */

void progress_clear(void)
{
    if (isatty(STDERR_FILENO))
        fputs("\r\033[K", stderr);
}

void progress_show(const char *format, ...)
{
    va_list arguments;
    progress_clear();
    va_start(arguments, format);
    if (isatty(STDERR_FILENO))
        vfprintf(stderr, format, arguments);
    va_end(arguments);
    fflush(stderr);
}

/* ---- Rounds ---------------------------------------------------------------------------------- */

void rounds_measure(const struct rounds *rounds, struct samples *times)
{
    for (int32_t item = 0; item < rounds->items; ++item)
        times[item].values = allocate_to_the_end((size_t)rounds->count, sizeof(struct moment));
    for (int32_t round = 0; round < rounds->count; ++round)
        for (int32_t item = 0; item < rounds->items; ++item) {
            progress_show("%s: round %d of %d, %d of %d", rounds->name, round + 1, rounds->count,
                          item + 1, rounds->items);
            if (rounds->prepare)
                rounds->prepare(rounds->data, item);
            const struct moment start = now();
            const double often = rounds->run(rounds->data, item);
            const struct moment all = since(start);
            if (often > 0)
                times[item].values[times[item].count++] =
                    (struct moment){all.wall / often, all.cpu / often};
        }
    progress_clear();
}
