/* SPDX-License-Identifier: MIT */
#include "walk.h"
#include "grid.h"
#include <string.h>

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

/* The first leaf that has blocks of [from, end) in the box; a bit for each of them. 0: none is
 * left, and leaf is not written. */
static unsigned next_blocks(const struct sphgi_tree *tree, const struct sphgi_blocks *box,
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

static bool meet(const struct sphgi_blocks *a, const struct sphgi_blocks *b)
{
    bool apart = false;
    for (int32_t k = 0; k < 3; ++k)
        apart |= a->low[k] > b->high[k] || b->low[k] > a->high[k];
    return !apart;
}

/* ---- The walk ------------------------------------------------------------------------------- */

/* Distances are off by a few units of the type, between images by the slack. */
static double with_margin(double reach, double slack)
{
    return reach * (1 + 0x1p-16) + 2 * slack;
}

/* The cells of the octave that hold what lies in [low, high]: cells rise with coordinates. */
static struct sphgi_span cells_between(const struct sphgi_axis *axis, int32_t octave, double low,
                                       double high)
{
    struct sphgi_span span = {.count = 1};
    if (!axis->cells) {
        sphgi_place_on_axis(axis, octave, low, &span.low[0]);
        sphgi_place_on_axis(axis, octave, high, &span.high[0]);
        return span;
    }
    const int64_t cells = axis->cells << octave;
    const double each = (double)cells / axis->length;
    const double from = __builtin_floor(low * each - 0x1p-10);
    const double to = __builtin_floor(high * each + 0x1p-10);
    span.high[0] = cells - 1;
    if (!(to - from < (double)cells - 1))
        return span;
    const double turns = __builtin_floor(from / (double)cells) * (double)cells;
    span.low[0] = (int64_t)(from - turns);
    span.high[0] = (int64_t)(to - turns);
    if (span.high[0] >= cells) {
        span.count = 2;
        span.high[1] = span.high[0] - cells;
        span.high[0] = cells - 1;
    }
    return span;
}

/* How far the targets look, or are seen from, among sources of an octave. Radii there are at most
 * 2^-octave of the largest; what was too small for the last one stands in it, too. */
static double reach_in(const struct sphgi_walk *walk, int32_t octave)
{
    const struct sphgi_raster *raster = &walk->sources->raster;
    const double theirs = walk->stretch * raster->top / (double)((int64_t)1 << octave);
    return with_margin(theirs > walk->reach ? theirs : walk->reach, raster->slack);
}

static void look_along(struct sphgi_walk *walk, int32_t axis, double reach)
{
    const struct sphgi_raster *raster = &walk->sources->raster;
    if (axis < raster->dimension)
        walk->span[axis] = cells_between(&raster->axis[axis], walk->octave, walk->low[axis] - reach,
                                         walk->high[axis] + reach);
    else
        walk->span[axis] = (struct sphgi_span){.count = 1};
}

void sphgi_walk_open(struct sphgi_walk *walk, const struct sphgi_grid *sources, const double *low,
                     const double *high, double stretch, bool mutual)
{
    walk->sources = sources;
    memcpy(walk->low, low, sizeof walk->low);
    memcpy(walk->high, high, sizeof walk->high);
    walk->reach = high[3] * stretch;
    walk->stretch = mutual ? stretch : 0;
    walk->octave = walk->part = -1;
    walk->inside = 0;
}

/* Parts are numbered in binary: which span of each axis. False: the axes have no such part. */
static bool box_of_part(const struct sphgi_walk *walk, struct sphgi_blocks *box)
{
    for (int32_t a = 0; a < 3; ++a) {
        const int32_t k = walk->part >> a & 1, shift = walk->sources->raster.axis[a].shift;
        const struct sphgi_span *span = &walk->span[a];
        if (k >= span->count)
            return false;
        box->low[a] = sphgi_narrowed(span->low[k] >> shift);
        box->high[a] = sphgi_narrowed(span->high[k] >> shift);
    }
    return true;
}

static void add_run(struct sphgi_runs *runs, int32_t begin, int32_t end)
{
    const int32_t n = runs->count;
    runs->candidates += end - begin;
    if (n && runs->begin[n - 1] + runs->length[n - 1] == begin) {
        runs->length[n - 1] += end - begin;
        return;
    }
    runs->begin[n] = begin;
    runs->length[n] = end - begin;
    ++runs->count;
}

/* What the block at x has of the k-th span along that axis. */
static void add_block(const struct sphgi_walk *walk, int32_t block, int64_t x, int32_t k,
                      struct sphgi_runs *runs)
{
    const struct sphgi_grid *grid = walk->sources;
    const int64_t low = walk->span[0].low[k] - x * SPHGI_BLOCK_CELLS;
    const int64_t high = walk->span[0].high[k] - x * SPHGI_BLOCK_CELLS;
    if (low >= SPHGI_BLOCK_CELLS || high < 0) /* far out several blocks are one to the tree */
        return;
    const int32_t first = low > 0 ? (int32_t)low : 0;
    const int32_t last = high < SPHGI_BLOCK_CELLS - 1 ? (int32_t)high : SPHGI_BLOCK_CELLS - 1;
    const int32_t begin = sphgi_first_of_cell(grid, block, first);
    const int32_t end = sphgi_first_of_cell(grid, block, last + 1);
    if (end > begin)
        add_run(runs, begin, end);
}

/* To the first part of the next octave that has blocks; false: there is none. */
static bool enter_next_octave(struct sphgi_walk *walk)
{
    const struct sphgi_tree *tree = &walk->sources->tree;
    const int32_t octaves = walk->sources->raster.octaves;
    do
        ++walk->octave;
    while (walk->octave < octaves && tree->first[walk->octave] == tree->first[walk->octave + 1]);
    if (walk->octave >= octaves)
        return false;
    const double reach = reach_in(walk, walk->octave);
    for (int32_t a = 0; a < 3; ++a)
        look_along(walk, a, reach);
    walk->part = 0;
    walk->from = tree->first[walk->octave];
    return true;
}

/* The next blocks of the walk's part that stand in one leaf; false: there are none. */
static bool next_of_part(struct sphgi_walk *walk)
{
    const struct sphgi_tree *tree = &walk->sources->tree;
    struct sphgi_blocks box;
    if (!box_of_part(walk, &box) || !meet(&box, &tree->octave[walk->octave]))
        return false;
    walk->inside = next_blocks(tree, &box, walk->from, tree->first[walk->octave + 1], &walk->leaf);
    if (!walk->inside)
        return false;
    walk->from = (walk->leaf + 1) * SPHGI_TREE_WIDTH;
    return true;
}

/* The next block within reach, -1: there is none. */
static int32_t next_of_walk(struct sphgi_walk *walk)
{
    enum { PARTS = 8 };
    while (!walk->inside) {
        if (walk->part < 0 || walk->part == PARTS) {
            if (!enter_next_octave(walk))
                return -1;
        } else if (!next_of_part(walk)) {
            ++walk->part;
            walk->from = walk->sources->tree.first[walk->octave];
        }
    }
    const int32_t block = walk->leaf * SPHGI_TREE_WIDTH + __builtin_ctz(walk->inside);
    walk->inside &= walk->inside - 1;
    return block;
}

/* Leaves know all places but those far out. */
static void place_of(const struct sphgi_walk *walk, int32_t block, int64_t *at)
{
    const struct sphgi_leaf *leaf = &walk->sources->tree.leaves[block / SPHGI_TREE_WIDTH];
    bool far = false;
    for (int32_t a = 0; a < 3; ++a) {
        at[a] = leaf->at[a][block % SPHGI_TREE_WIDTH];
        far |= at[a] == sphgi_narrowed(INT64_MIN) || at[a] == sphgi_narrowed(INT64_MAX);
    }
    if (!far)
        return;
    sphgi_key_open(walk->sources->blocks[block].key, at);
    if (walk->sources->raster.octaves > 1)
        sphgi_lower_octave(at);
}

/* Is that place in the spans across the bars that the walk is at? Far out the tree cannot tell:
 * where a period has two spans, it finds the same block in both. */
static bool is_in_part(const struct sphgi_walk *walk, const int64_t *at)
{
    for (int32_t a = 1; a < 3; ++a) {
        const int32_t k = walk->part >> a & 1;
        if (at[a] < walk->span[a].low[k] || at[a] > walk->span[a].high[k])
            return false;
    }
    return true;
}

bool sphgi_walk_on(struct sphgi_walk *walk, struct sphgi_runs *runs)
{
    runs->count = runs->candidates = 0;
    while (runs->count < SPHGI_RUNS_MOST) {
        const int32_t block = next_of_walk(walk);
        int64_t at[3];
        if (block < 0)
            return false;
        place_of(walk, block, at);
        if (is_in_part(walk, at))
            add_block(walk, block, at[0], walk->part & 1, runs);
    }
    return true;
}

/* ---- Many targets --------------------------------------------------------------------------- */

/* Both ends of a period may lie in one block, which is found twice. */
static bool is_found_again(const struct sphgi_walk *walk, int64_t x)
{
    const struct sphgi_span *span = &walk->span[0];
    return walk->part & 1 && x >= span->low[0] >> SPHGI_BLOCK_SHIFT &&
           x <= span->high[0] >> SPHGI_BLOCK_SHIFT;
}

bool sphgi_look_nearby(struct sphgi_walk *walk, struct sphgi_nearby *nearby)
{
    nearby->count = 0;
    for (int32_t block; (block = next_of_walk(walk)) >= 0;) {
        int64_t at[3];
        place_of(walk, block, at);
        if (!is_in_part(walk, at) || is_found_again(walk, at[0]))
            continue;
        if (nearby->count == SPHGI_NEAR_MOST) {
            nearby->count = -1;
            return false;
        }
        nearby->near[nearby->count++] = (struct sphgi_near){block, walk->octave, at[0]};
    }
    return true;
}

bool sphgi_walk_nearby(struct sphgi_walk *walk, const struct sphgi_nearby *nearby,
                       struct sphgi_runs *runs)
{
    runs->count = runs->candidates = 0;
    walk->octave = -1;
    for (int32_t n = 0; n < nearby->count; ++n) {
        const struct sphgi_near *near = &nearby->near[n];
        if (near->octave != walk->octave) {
            walk->octave = near->octave;
            look_along(walk, 0, reach_in(walk, near->octave));
        }
        if (runs->count + 2 > SPHGI_RUNS_MOST)
            return true;
        for (int32_t k = 0; k < walk->span[0].count; ++k)
            add_block(walk, near->block, near->x, k, runs);
    }
    return false;
}
