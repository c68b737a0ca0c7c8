/* SPDX-License-Identifier: MIT */
/* Random numbers that are the same on every machine: splitmix64 (Steele, Lea, Flood 2014,
 * doi:10.1145/2714064.2660195). Any state is a seed. */
#ifndef SHARED_SPLITMIX64_H
#define SHARED_SPLITMIX64_H
#include <stdint.h>

#define SPLITMIX64_STEP UINT64_C(0x9e3779b97f4a7c15)

static inline uint64_t splitmix64(uint64_t *state)
{
    uint64_t z = *state += SPLITMIX64_STEP;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Uniform in [0, 1), a multiple of 2^-53. */
static inline double splitmix64_share(uint64_t *state)
{
    return (double)(splitmix64(state) >> 11) * 0x1p-53;
}

/* Uniform in [low, high), a multiple of 2^-53 (high - low). */
static inline double splitmix64_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * splitmix64_share(state);
}
#endif
