/* SPDX-License-Identifier: MIT */
/* Where the numbers of pairs stand in the host's memory: pair after pair, or in blocks of so many.
 */
#ifndef SPHGI_PAIR_NUMBERS_H
#define SPHGI_PAIR_NUMBERS_H
#include "passes/columns.h"

struct sphgi_pair_numbers {
    struct sphgi_columns columns; /* count 0: not wanted */
    size_t size;                  /* of a number */
    int32_t block; /* pairs, a power of two: all first components of a block, then all
                      second ones; 0: columns as they are */
};

/* So many pairs fill up so many places. */
static inline int64_t sphgi_in_blocks(int64_t count, int32_t block)
{
    return block ? (count + block - 1) & -(int64_t)block : count;
}

static inline char *sphgi_pair_number(const struct sphgi_pair_numbers *numbers, int32_t component,
                                      int64_t place)
{
    const struct sphgi_columns *columns = &numbers->columns;
    const int64_t block = numbers->block;
    if (!block)
        return (char *)(uintptr_t)(columns->at[component] + place * columns->stride);
    const int64_t at =
        (place & -block) * columns->count + component * block + (place & (block - 1));
    return (char *)(uintptr_t)(columns->at[0] + at * (int64_t)numbers->size);
}

/* What stands behind the `count` pairs of a row, from place `first` on, is read along with them,
 * and adds nothing. */
void sphgi_fill_up_row(const struct sphgi_pair_numbers *gradient, int32_t *indices, int64_t first,
                       int64_t count);

#endif
