/* What every file of the library may rely on: the compiler, and nothing else.
 * SPDX-License-Identifier: MIT */
#ifndef SPHGI_INTERNAL_H
#define SPHGI_INTERNAL_H
#include <sphgrad/sphgrad.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __FAST_MATH__
#error "sphgrad relies on IEEE arithmetic: build it without -ffast-math"
#endif

#define SPHGI_ALIGNMENT 64 /* [byte] of every internal array: a cache line, the widest vector */

/* A C "template": called with constant arguments, so that the compiler removes branches on them.
 * One that does not optimise would only write all of them down, which takes twenty times as long;
 * so do tests that watch every access (SPHGI_KEEP_CALLS). The numbers are the same. */
#if defined(__OPTIMIZE__) && !defined(SPHGI_KEEP_CALLS)
#define SPHGI_TEMPLATE static inline __attribute__((always_inline))
#else
#define SPHGI_TEMPLATE static inline
#endif

/* A function that takes a format, and what it names from argument `first` on, as printf does. */
#if defined(__MINGW32__) && !defined(__clang__) /* "printf" means the system's there */
#define SPHGI_FORMAT(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define SPHGI_FORMAT(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

static inline int32_t sphgi_min32(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t sphgi_max32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static inline size_t sphgi_round_up(size_t value, size_t multiple)
{
    return (value + multiple - 1) / multiple * multiple;
}

static inline size_t sphgi_size_of_type(sphg_type type)
{
    return type == SPHG_F64 ? 8 : type == SPHG_F32 ? 4 : 1;
}

#endif
