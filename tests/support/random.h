/* SPDX-License-Identifier: MIT */
/* Seeded random numbers for tests. The same seed gives the same cloud on every machine.
 * SPHG_TEST_SEED in the environment draws others everywhere. */
#ifndef TESTS_SUPPORT_RANDOM_H
#define TESTS_SUPPORT_RANDOM_H
#include "splitmix64.h"
#include <stdlib.h>

typedef struct random_state {
    uint64_t counter;
} random_state;

/* 0: the numbers that the tests were written with. */
static inline uint64_t random_chosen(void)
{
    const char *word = getenv("SPHG_TEST_SEED");
    return word ? strtoull(word, NULL, 10) : 0;
}

static inline random_state random_seeded(uint64_t seed)
{
    seed += random_chosen() * UINT64_C(1000003);
    random_state state = {seed * SPLITMIX64_STEP + 1};
    return state;
}

static inline uint64_t random_bits(random_state *state)
{
    return splitmix64(&state->counter);
}

/* Uniform in [low, high); a multiple of 2^-53 (high - low). */
static inline double random_between(random_state *state, double low, double high)
{
    return splitmix64_between(&state->counter, low, high);
}

/* Uniform in [0, count). */
static inline int random_index(random_state *state, int count)
{
    return (int)(random_bits(state) % (uint64_t)count);
}

#endif
