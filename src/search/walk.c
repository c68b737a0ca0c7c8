/* SPDX-License-Identifier: MIT */
#include "walk.h"
#include "grid.h"
#include <string.h>

/* ---- Blocks in a box ------------------------------------------------------------------------ */

struct box {
    int32_t low[3], high[3];
};

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
static unsigned items_inside(const int32_t *low, const int32_t *high, const struct box *box)
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
                             const struct box *box)
{
    if (!height)
        return items_inside(tree->leaves[group].at[0], tree->leaves[group].at[0], box);
    const struct sphgi_node *node = &tree->nodes[height][group];
    return items_inside(node->low[0], node->high[0], box);
}

/* The first block in [from, end) that lies in the box, or end. */
static int32_t next_block(const struct sphgi_tree *tree, const struct box *box, int32_t from,
                          int32_t end)
{
    int32_t height = 0, at = from;
    while (height <= tree->height && (int64_t)at << 3 * height < end) {
        const int32_t group = at / SPHGI_TREE_WIDTH, ahead = at % SPHGI_TREE_WIDTH;
        const unsigned inside = group_inside(tree, height, group, box) >> ahead;
        if (!inside) {
            at = group + 1;
            ++height;
            continue;
        }
        at += __builtin_ctz(inside);
        if (!height)
            return sphgi_min32(at, end);
        at *= SPHGI_TREE_WIDTH;
        --height;
    }
    return end;
}

/* ---- The walk ------------------------------------------------------------------------------- */

static double number_at(const void *row, int32_t number, sphg_type type)
{
    return type == SPHG_F64 ? ((const double *)row)[number] : (double)((const float *)row)[number];
}

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

/* To the octave's first part. Radii there are at most 2^-octave of the largest; what was too small
 * for the last one stands in it, too. */
static void enter_octave(struct sphgi_walk *walk, int32_t octave)
{
    const struct sphgi_raster *raster = &walk->sources->raster;
    walk->octave = octave;
    walk->part = 0;
    if (octave >= raster->octaves)
        return;
    const double theirs = walk->stretch * raster->top / (double)((int64_t)1 << octave);
    walk->octave_reach = theirs > walk->reach ? theirs : walk->reach;
    const double reach = with_margin(walk->octave_reach, raster->slack);
    for (int32_t a = 0; a < 3; ++a)
        if (a < raster->dimension)
            walk->span[a] = cells_between(&raster->axis[a], octave, walk->low[a] - reach,
                                          walk->high[a] + reach);
        else
            walk->span[a] = (struct sphgi_span){.count = 1};
    walk->block = walk->sources->tree.first[octave];
}

void sphgi_walk_open(struct sphgi_walk *walk, const struct sphgi_grid *sources, sphg_type type,
                     const void *targets, int32_t count, double stretch, bool mutual)
{
    const size_t size = SPHGI_ROW * sphgi_size_of_type(type);
    walk->sources = sources;
    walk->reach = 0;
    walk->stretch = mutual ? stretch : 0;
    for (int32_t k = 0; k < count; ++k) {
        const char *row = (const char *)targets + (size_t)k * size;
        for (int32_t a = 0; a < 3; ++a) {
            const double x = number_at(row, a, type);
            walk->low[a] = k && walk->low[a] < x ? walk->low[a] : x;
            walk->high[a] = k && walk->high[a] > x ? walk->high[a] : x;
        }
        const double reach = number_at(row, 3, type) * stretch;
        walk->reach = reach > walk->reach ? reach : walk->reach;
    }
    walk->octave = -1;
}

/* Parts are numbered in binary: which span of each axis. False: the axes have no such part. */
static bool box_of_part(const struct sphgi_walk *walk, struct box *box)
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

static void add_run(struct sphgi_runs *runs, int32_t begin, int32_t end, double reach)
{
    const int32_t n = runs->count;
    runs->candidates += end - begin;
    if (n && runs->begin[n - 1] + runs->length[n - 1] == begin && runs->reach[n - 1] == reach) {
        runs->length[n - 1] += end - begin;
        return;
    }
    runs->begin[n] = begin;
    runs->length[n] = end - begin;
    runs->reach[n] = reach;
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
        add_run(runs, begin, end, walk->octave_reach);
}

/* To the next block within reach, -1: there is none. The walk stays there. */
static int32_t next_of_walk(struct sphgi_walk *walk)
{
    const struct sphgi_tree *tree = &walk->sources->tree;
    if (walk->octave < 0)
        enter_octave(walk, 0);
    for (; walk->octave < walk->sources->raster.octaves; enter_octave(walk, walk->octave + 1)) {
        const int32_t begin = tree->first[walk->octave], end = tree->first[walk->octave + 1];
        struct box box;
        for (; walk->part < 8; ++walk->part, walk->block = begin) {
            if (begin < end && box_of_part(walk, &box))
                walk->block = next_block(tree, &box, walk->block, end);
            else
                walk->block = end;
            if (walk->block < end)
                return walk->block;
        }
    }
    return -1;
}

static void place_of(const struct sphgi_walk *walk, int32_t block, int64_t *at)
{
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
    for (int32_t block; (block = next_of_walk(walk)) >= 0; ++walk->block) {
        int64_t at[3];
        if (runs->count == SPHGI_RUNS_MOST)
            return true;
        place_of(walk, block, at);
        if (is_in_part(walk, at))
            add_block(walk, block, at[0], walk->part & 1, runs);
    }
    return false;
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
    for (int32_t block; (block = next_of_walk(walk)) >= 0; ++walk->block) {
        struct sphgi_near *near = &nearby->near[nearby->count];
        if (nearby->count == SPHGI_NEAR_MOST) {
            nearby->count = -1;
            return false;
        }
        *near = (struct sphgi_near){.block = block, .octave = walk->octave};
        place_of(walk, block, near->at);
        nearby->count += is_in_part(walk, near->at) && !is_found_again(walk, near->at[0]);
    }
    return true;
}

static bool is_in_span(const struct sphgi_span *span, int64_t cell)
{
    bool inside = false;
    for (int32_t k = 0; k < span->count; ++k)
        inside |= cell >= span->low[k] && cell <= span->high[k];
    return inside;
}

bool sphgi_walk_nearby(struct sphgi_walk *walk, const struct sphgi_nearby *nearby,
                       struct sphgi_runs *runs)
{
    runs->count = runs->candidates = 0;
    walk->octave = -1;
    for (int32_t n = 0; n < nearby->count; ++n) {
        const struct sphgi_near *near = &nearby->near[n];
        if (near->octave != walk->octave)
            enter_octave(walk, near->octave);
        if (!is_in_span(&walk->span[1], near->at[1]) || !is_in_span(&walk->span[2], near->at[2]))
            continue;
        if (runs->count + 2 > SPHGI_RUNS_MOST)
            return true;
        for (int32_t k = 0; k < walk->span[0].count; ++k)
            add_block(walk, near->block, near->at[0], k, runs);
    }
    return false;
}
