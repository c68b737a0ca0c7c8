/* SPDX-License-Identifier: MIT */
/* One number for the bytes of many results, and where it is known beforehand: it is one on the base
 * path of x86-64, and another on all paths that fuse products and sums, whichever compiler made
 * them. Who changes the order of a sum on purpose finds the new values in the failure. */
#ifndef TESTS_SUPPORT_PINS_H
#define TESTS_SUPPORT_PINS_H
#include <sphgrad/sphgrad.h>
#include <stdbool.h>

#if defined(__x86_64__) || defined(__aarch64__)
#define PINS_HOLD_HERE 1
#else
#define PINS_HOLD_HERE 0
#endif

static inline bool pins_are_of_fused(sphg_isa isa)
{
#ifdef __aarch64__
    (void)isa;
    return true;
#else
    return isa != SPHG_ISA_BASE;
#endif
}

#define FNV1A_BEGIN UINT64_C(14695981039346656037)

static inline uint64_t fnv1a(uint64_t hash, const void *data, size_t bytes)
{
    const unsigned char *at = data;
    for (size_t k = 0; k < bytes; ++k)
        hash = (hash ^ at[k]) * UINT64_C(1099511628211);
    return hash;
}

#endif
