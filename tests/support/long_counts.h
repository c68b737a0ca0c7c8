/* SPDX-License-Identifier: MIT */
/* SPHG_TEST_LONG=1 asks for the long figures: tests/run --long. */
#ifndef TESTS_SUPPORT_LONG_COUNTS_H
#define TESTS_SUPPORT_LONG_COUNTS_H
#include <stdlib.h>
#include <time.h>

static inline int long_is_asked_for(void)
{
    const char *value = getenv("SPHG_TEST_LONG");
    return value && value[0] == '1';
}

static inline int long_or(int long_count, int short_count)
{
    return long_is_asked_for() ? long_count : short_count;
}

/* For reports only: no test asserts a time. */
static inline double long_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
