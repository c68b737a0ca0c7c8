/* SPDX-License-Identifier: MIT */
/* Blocks of cells, and their keys. Only blocks that hold a particle exist. */
#ifndef SPHGI_BLOCK_H
#define SPHGI_BLOCK_H
#include "passes/passes.h"

/* Three coordinates of a block. Keys rise as blocks do in storage. */
struct sphgi_key {
    uint64_t low, high;
};

struct sphgi_block {
    struct sphgi_key key;
    int32_t first;     /* particle */
    uint32_t occupied; /* a bit per cell that holds somebody */
};

struct sphgi_key sphgi_key_of(const int64_t *at);
void sphgi_key_open(struct sphgi_key key, int64_t *at);
static inline bool sphgi_same_key(struct sphgi_key a, struct sphgi_key b)
{
    return a.low == b.low && a.high == b.high;
}

static inline bool sphgi_is_before(struct sphgi_key a, struct sphgi_key b)
{
    return a.high != b.high ? a.high < b.high : a.low < b.low;
}

#endif
