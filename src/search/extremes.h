/* SPDX-License-Identifier: MIT */
/* The least and the largest of numbers >= 0 that several workers look at: their bits rise as the
 * numbers do. */
#ifndef SPHGI_EXTREMES_H
#define SPHGI_EXTREMES_H
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

typedef atomic_int_least64_t sphgi_extreme;

static inline int64_t sphgi_bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline void sphgi_extreme_set(sphgi_extreme *number, double to)
{
    atomic_store(number, sphgi_bits_of(to));
}

static inline double sphgi_extreme_get(sphgi_extreme *number)
{
    const int64_t bits = atomic_load(number);
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline void sphgi_lower(sphgi_extreme *number, double to)
{
    const int64_t bits = sphgi_bits_of(to);
    int_least64_t seen = atomic_load(number);
    while (bits < seen && !atomic_compare_exchange_weak(number, &seen, bits))
        ;
}

static inline void sphgi_raise(sphgi_extreme *number, double to)
{
    const int64_t bits = sphgi_bits_of(to);
    int_least64_t seen = atomic_load(number);
    while (seen < bits && !atomic_compare_exchange_weak(number, &seen, bits))
        ;
}

#endif
