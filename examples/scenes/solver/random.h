/* SPDX-License-Identifier: MIT */
/* Random numbers that are the same everywhere. */
#ifndef SOLVER_RANDOM_H
#define SOLVER_RANDOM_H
#include "splitmix64.h"

struct random {
    uint64_t state; /* any value is a seed */
};

/* Uniform in [low, high). */
static inline double random_between(struct random *random, double low, double high)
{
    return splitmix64_between(&random->state, low, high);
}
#endif
