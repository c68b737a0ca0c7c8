/* Random numbers that are the same everywhere: splitmix64 (Steele, Lea, Flood 2014,
 * doi:10.1145/2714064.2660195). */
#ifndef SOLVER_RANDOM_H
#define SOLVER_RANDOM_H
#include <stdint.h>

struct random {
    uint64_t state; /* any value is a seed */
};

/* Uniform in [low, high). */
static inline double random_between(struct random *random, double low, double high)
{
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return low + (high - low) * ((double)(z >> 11) * 0x1p-53);
}
#endif
