/* SPDX-License-Identifier: MIT */
/* A tree over the blocks of a grid with octaves. Where many small cells are within the reach of a
 * large particle, most of them empty, it finds the blocks that count. */
#ifndef SPHGI_TREE_H
#define SPHGI_TREE_H
#include "core/memory.h"
#include "block.h"
#include "octaves.h"

enum {
    SPHGI_TREE_WIDTH = 8,
    SPHGI_TREE_HEIGHT = 11 /* more than any count of blocks needs */
};

/* Coordinates of SPHGI_TREE_WIDTH blocks, and what as many items of the height below span. */
struct sphgi_leaf {
    int32_t at[3][SPHGI_TREE_WIDTH];
    float radius[SPHGI_TREE_WIDTH]; /* the largest in each, up to rounding */
};
struct sphgi_node {
    int32_t low[3][SPHGI_TREE_WIDTH], high[3][SPHGI_TREE_WIDTH];
};

/* What the blocks of an octave span, or where blocks are looked for. */
struct sphgi_blocks {
    int32_t low[3], high[3];
};

/* Item number k of a height has the items 8 k .. 8 k + 7 of the height below; those of height 0 are
 * the blocks, in the order of storage. */
struct sphgi_tree {
    int32_t height;                    /* the largest: of one node, or 0 */
    int32_t groups[SPHGI_TREE_HEIGHT]; /* leaves, then nodes of each height */
    struct sphgi_leaf *leaves;
    struct sphgi_node *nodes[SPHGI_TREE_HEIGHT]; /* [0]: unused */
    int32_t first[SPHGI_OCTAVES_MOST + 1];       /* block of each octave */
    struct sphgi_blocks octave[SPHGI_OCTAVES_MOST];
    int64_t cells[SPHGI_OCTAVES_MOST][2]; /* along bars: the lowest and highest with somebody */
};

size_t sphgi_tree_size(int32_t blocks);
/* The tree stands there. */
void sphgi_tree_use(struct sphgi_tree *tree, int32_t blocks, void *memory);
/* Over so many blocks of so many octaves, in the order of storage. */
void sphgi_tree_build(struct sphgi_tree *tree, const struct sphgi_block *blocks, int32_t count,
                      int32_t octaves);

/* The first leaf that has blocks of [from, end) in the box; a bit for each of them. 0: none is
 * left, and leaf is not written. */
unsigned sphgi_next_blocks(const struct sphgi_tree *tree, const struct sphgi_blocks *box,
                           int32_t from, int32_t end, int32_t *leaf);
bool sphgi_blocks_meet(const struct sphgi_blocks *a, const struct sphgi_blocks *b);

/* A place as the tree has it. Far out, places that are neighbours may become one: the order stays.
 */
static inline int32_t sphgi_narrowed(int64_t at)
{
    const int64_t most = 1 << 30;
    return (int32_t)(at < -most ? -most : at > most ? most : at);
}

#endif
