/* SPDX-License-Identifier: MIT */
#include "block.h"

/* Numbers of cells reach to 3 2^40 on either side, those of blocks along x to a 32nd of that. */
enum { X_BITS = 40, Y_BITS = 44, Z_BITS = 44, Y_LOW_BITS = 64 - X_BITS };

/* Coordinates count from the lowest there can be, so that keys rise with them. */
static uint64_t raised(int64_t at, int32_t bits)
{
    return (uint64_t)(at + ((int64_t)1 << (bits - 1)));
}

struct sphgi_key sphgi_key_of(const int64_t *at)
{
    const uint64_t x = raised(at[0], X_BITS), y = raised(at[1], Y_BITS), z = raised(at[2], Z_BITS);
    return (struct sphgi_key){x | y << X_BITS, y >> Y_LOW_BITS | z << (Y_BITS - Y_LOW_BITS)};
}

static int64_t lowered(uint64_t number, int32_t bits)
{
    return (int64_t)(number & (((uint64_t)1 << bits) - 1)) - ((int64_t)1 << (bits - 1));
}

void sphgi_key_open(struct sphgi_key key, int64_t *at)
{
    at[0] = lowered(key.low, X_BITS);
    at[1] = lowered(key.low >> X_BITS | key.high << Y_LOW_BITS, Y_BITS);
    at[2] = lowered(key.high >> (Y_BITS - Y_LOW_BITS), Z_BITS);
}
