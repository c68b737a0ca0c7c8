/* SPDX-License-Identifier: MIT */
#include "tree.h"
#include <string.h>

static int32_t groups_of(int32_t items)
{
    return items / SPHGI_TREE_WIDTH + (items % SPHGI_TREE_WIDTH != 0);
}

/* Leaves, and each layer of nodes above them. Returns the bytes. */
static size_t place_tree(struct sphgi_tree *tree, char *base, int32_t blocks)
{
    struct sphgi_layout layout = {base, 0};
    int32_t groups = groups_of(blocks);
    tree->height = 0;
    tree->groups[0] = groups;
    tree->leaves = sphgi_place(&layout, (size_t)groups, sizeof *tree->leaves);
    while (groups > 1) {
        groups = groups_of(groups);
        tree->groups[++tree->height] = groups;
        tree->nodes[tree->height] = sphgi_place(&layout, (size_t)groups, sizeof **tree->nodes);
    }
    return layout.used;
}

size_t sphgi_tree_size(int32_t blocks)
{
    struct sphgi_tree tree;
    return place_tree(&tree, NULL, blocks);
}

void sphgi_tree_use(struct sphgi_tree *tree, int32_t blocks, void *memory)
{
    place_tree(tree, memory, blocks);
}

static void open_octave(struct sphgi_tree *tree, int32_t octave, int32_t first)
{
    tree->first[octave] = first;
    for (int32_t a = 0; a < 3; ++a) {
        tree->octave[octave].low[a] = INT32_MAX;
        tree->octave[octave].high[a] = INT32_MIN;
    }
    tree->cells[octave][0] = INT64_MAX;
    tree->cells[octave][1] = INT64_MIN;
}

static void widen(struct sphgi_blocks *blocks, int32_t axis, int32_t at)
{
    blocks->low[axis] = sphgi_min32(blocks->low[axis], at);
    blocks->high[axis] = sphgi_max32(blocks->high[axis], at);
}

static void widen_cells(int64_t *cells, int64_t at, uint32_t occupied)
{
    const int64_t low = at * SPHGI_BLOCK_CELLS + __builtin_ctz(occupied);
    const int64_t high = at * SPHGI_BLOCK_CELLS + SPHGI_BLOCK_CELLS - 1 - __builtin_clz(occupied);
    cells[0] = low < cells[0] ? low : cells[0];
    cells[1] = high > cells[1] ? high : cells[1];
}

static void fill_leaves(struct sphgi_tree *tree, const struct sphgi_block *blocks, int32_t count,
                        int32_t octaves)
{
    int32_t octave = -1;
    for (int32_t b = 0; b < tree->groups[0] * SPHGI_TREE_WIDTH; ++b) {
        int64_t at[3] = {INT32_MIN, INT32_MIN, INT32_MIN}; /* nobody looks there */
        struct sphgi_leaf *leaf = &tree->leaves[b / SPHGI_TREE_WIDTH];
        if (b < count) {
            sphgi_key_open(blocks[b].key, at);
            const int32_t own = octaves > 1 ? sphgi_lower_octave(at) : 0;
            while (octave < own)
                open_octave(tree, ++octave, b);
        }
        for (int32_t a = 0; a < 3; ++a) {
            leaf->at[a][b % SPHGI_TREE_WIDTH] = b < count ? sphgi_narrowed(at[a]) : INT32_MIN;
            if (b < count)
                widen(&tree->octave[octave], a, sphgi_narrowed(at[a]));
        }
        if (b < count)
            widen_cells(tree->cells[octave], at[0], blocks[b].occupied);
    }
    while (octave + 1 < octaves)
        open_octave(tree, ++octave, count);
    tree->first[octaves] = count;
}

/* What group number g of a height spans along an axis; places without an item span nothing. */
static void span_of(const struct sphgi_tree *tree, int32_t height, int32_t g, int32_t axis,
                    int32_t *low, int32_t *high)
{
    *low = INT32_MAX;
    *high = INT32_MIN;
    for (int32_t k = 0; k < SPHGI_TREE_WIDTH; ++k) {
        const int32_t l =
            height ? tree->nodes[height][g].low[axis][k] : tree->leaves[g].at[axis][k];
        const int32_t h = height ? tree->nodes[height][g].high[axis][k] : l;
        if (h == INT32_MIN)
            continue;
        *low = sphgi_min32(*low, l);
        *high = sphgi_max32(*high, h);
    }
}

void sphgi_tree_build(struct sphgi_tree *tree, const struct sphgi_block *blocks, int32_t count,
                      int32_t octaves)
{
    fill_leaves(tree, blocks, count, octaves);
    for (int32_t height = 1; height <= tree->height; ++height)
        for (int32_t k = 0; k < tree->groups[height] * SPHGI_TREE_WIDTH; ++k) {
            struct sphgi_node *node = &tree->nodes[height][k / SPHGI_TREE_WIDTH];
            const int32_t at = k % SPHGI_TREE_WIDTH;
            for (int32_t a = 0; a < 3; ++a) {
                node->low[a][at] = INT32_MAX;
                node->high[a][at] = INT32_MIN;
                if (k < tree->groups[height - 1])
                    span_of(tree, height - 1, k, a, &node->low[a][at], &node->high[a][at]);
            }
        }
}

/* ---- Blocks in a box ------------------------------------------------------------------------ */

typedef int32_t four __attribute__((vector_size(16), aligned(4), may_alias));
typedef int16_t four_short __attribute__((vector_size(8)));

/* A bit for each of four items that are not outside. */
static unsigned bits_left(four outside)
{
    const four_short narrow = __builtin_convertvector(outside, four_short);
    uint64_t all;
    memcpy(&all, &narrow, sizeof all);
    return (unsigned)(((~all & UINT64_C(0x0008000400020001)) * UINT64_C(0x0001000100010001)) >> 48);
}

/* The items at low[axis] and high[axis], of which each axis has SPHGI_TREE_WIDTH. */
static unsigned items_inside(const int32_t *low, const int32_t *high,
                             const struct sphgi_blocks *box)
{
    unsigned inside = 0;
    for (int32_t first = 0; first < SPHGI_TREE_WIDTH; first += 4) {
        four outside = {0};
        for (int32_t a = 0; a < 3; ++a) {
            const int32_t at = a * SPHGI_TREE_WIDTH + first;
            outside |= (*(const four *)(high + at) < box->low[a]) |
                       (*(const four *)(low + at) > box->high[a]);
        }
        inside |= bits_left(outside) << first;
    }
    return inside;
}

static unsigned group_inside(const struct sphgi_tree *tree, int32_t height, int32_t group,
                             const struct sphgi_blocks *box)
{
    if (!height)
        return items_inside(tree->leaves[group].at[0], tree->leaves[group].at[0], box);
    const struct sphgi_node *node = &tree->nodes[height][group];
    return items_inside(node->low[0], node->high[0], box);
}

unsigned sphgi_next_blocks(const struct sphgi_tree *tree, const struct sphgi_blocks *box,
                           int32_t from, int32_t end, int32_t *leaf)
{
    int32_t height = 0, at = from;
    while (height <= tree->height && (int64_t)at << 3 * height < end) {
        const int32_t group = at / SPHGI_TREE_WIDTH, ahead = at % SPHGI_TREE_WIDTH;
        const unsigned inside = group_inside(tree, height, group, box) >> ahead << ahead;
        if (!inside) {
            at = group + 1;
            ++height;
        } else if (height) {
            at = (group * SPHGI_TREE_WIDTH + __builtin_ctz(inside)) * SPHGI_TREE_WIDTH;
            --height;
        } else {
            const int32_t left = end - group * SPHGI_TREE_WIDTH;
            *leaf = group;
            return left < SPHGI_TREE_WIDTH ? inside & ((1u << left) - 1) : inside;
        }
    }
    return 0;
}

bool sphgi_blocks_meet(const struct sphgi_blocks *a, const struct sphgi_blocks *b)
{
    bool apart = false;
    for (int32_t k = 0; k < 3; ++k)
        apart |= a->low[k] > b->high[k] || b->low[k] > a->high[k];
    return !apart;
}
