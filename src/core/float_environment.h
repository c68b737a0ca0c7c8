/* SPDX-License-Identifier: MIT */
/* Results must not depend on the rounding mode, on flushing of denormals or on traps that the host
 * (or anything linked with -ffast-math into its process) has set for a thread. So arithmetic runs
 * in the default environment of IEEE 754, and what was there before, sticky flags included, is put
 * back; so is errno, which functions of libm set. Threads have an environment each: see
 * sphgi_parallel_for(). */
#ifndef SPHGI_FLOAT_ENVIRONMENT_H
#define SPHGI_FLOAT_ENVIRONMENT_H
#include "internal.h"
#include <errno.h>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>

/* x87 stays as it is: the library has no long double, and SSE2 does the rest. */
struct sphgi_floats {
    unsigned int control;
    int error;
};

enum { SPHGI_FLOATS_DEFAULT = 0x1f80 }; /* to nearest, denormals kept, all traps masked */

static inline struct sphgi_floats sphgi_floats_enter(void)
{
    const struct sphgi_floats before = {_mm_getcsr(), errno};
    if (before.control != SPHGI_FLOATS_DEFAULT)
        _mm_setcsr(SPHGI_FLOATS_DEFAULT);
    return before;
}

static inline void sphgi_floats_leave(struct sphgi_floats before)
{
    if (_mm_getcsr() != before.control)
        _mm_setcsr(before.control);
    errno = before.error;
}

#elif defined(__aarch64__) && defined(__GNUC__)

struct sphgi_floats {
    uint64_t control, status;
    int error;
};

static inline struct sphgi_floats sphgi_floats_enter(void)
{
    struct sphgi_floats before;
    const uint64_t none = 0; /* to nearest, denormals kept, no traps */
    before.error = errno;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before.control) : : "memory");
    __asm__ volatile("mrs %0, fpsr" : "=r"(before.status) : : "memory");
    __asm__ volatile("msr fpcr, %0" : : "r"(none) : "memory");
    return before;
}

static inline void sphgi_floats_leave(struct sphgi_floats before)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(before.control) : "memory");
    __asm__ volatile("msr fpsr, %0" : : "r"(before.status) : "memory");
    errno = before.error;
}

#else
#include <fenv.h>

struct sphgi_floats {
    fenv_t all;
    int error;
};

static inline struct sphgi_floats sphgi_floats_enter(void)
{
    struct sphgi_floats before;
    before.error = errno;
    fegetenv(&before.all);
    fesetenv(FE_DFL_ENV);
    return before;
}

static inline void sphgi_floats_leave(struct sphgi_floats before)
{
    fesetenv(&before.all);
    errno = before.error;
}

#endif

#endif
