/* SPDX-License-Identifier: MIT */
#include "walk.h"
#include "grid.h"
#include <float.h>
#include <math.h>

enum { PARTS = 8 }; /* spans of three axes, two of each */

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
    for (int32_t a = 0; a < 3; ++a) {
        walk->low[a] = low[sphgi_number_of_axis(&sources->raster, a)];
        walk->high[a] = high[sphgi_number_of_axis(&sources->raster, a)];
    }
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

/* The cells along x that are looked at in the octave. False: nobody is there. */
static bool look_along_bars(struct sphgi_walk *walk, double reach)
{
    const int64_t *cells = walk->sources->tree.cells[walk->octave];
    bool some = false;
    look_along(walk, 0, reach);
    for (int32_t k = 0; k < walk->span[0].count; ++k)
        some |= walk->span[0].low[k] <= cells[1] && walk->span[0].high[k] >= cells[0];
    return some;
}

/* To the first part of the next octave that may have blocks; false: there is none. */
static bool enter_next_octave(struct sphgi_walk *walk)
{
    const struct sphgi_tree *tree = &walk->sources->tree;
    const int32_t octaves = walk->sources->raster.octaves;
    double reach = 0;
    for (bool some = false; !some;) {
        if (++walk->octave >= octaves)
            return false;
        if (tree->first[walk->octave] == tree->first[walk->octave + 1])
            continue;
        reach = reach_in(walk, walk->octave);
        some = look_along_bars(walk, reach);
    }
    for (int32_t a = 1; a < 3; ++a)
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
    if (!box_of_part(walk, &box) || !sphgi_blocks_meet(&box, &tree->octave[walk->octave]))
        return false;
    walk->inside =
        sphgi_next_blocks(tree, &box, walk->from, tree->first[walk->octave + 1], &walk->leaf);
    if (!walk->inside)
        return false;
    walk->from = (walk->leaf + 1) * SPHGI_TREE_WIDTH;
    return true;
}

/* The next block within reach, -1: there is none. */
static int32_t next_of_walk(struct sphgi_walk *walk)
{
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

/* Beyond the range of f32 nothing is known. */
static double radius_of(const struct sphgi_walk *walk, int32_t block)
{
    const struct sphgi_leaf *leaf = &walk->sources->tree.leaves[block / SPHGI_TREE_WIDTH];
    const double radius = (double)leaf->radius[block % SPHGI_TREE_WIDTH];
    return radius > (double)FLT_MIN && radius < (double)FLT_MAX ? radius : (double)INFINITY;
}

/* How far the particles of a block reach, where that counts: less than their octave could. */
static double reach_of_block(const struct sphgi_walk *walk, int32_t block)
{
    const double octave = walk->sources->raster.top / (double)((int64_t)1 << walk->octave);
    const double radius = radius_of(walk, block);
    return with_margin(walk->stretch * (radius < octave ? radius : octave),
                       walk->sources->raster.slack);
}

/* Where bars at that place of an axis begin and end. Far out, cells are no longer where they seem
 * to be, and a period goes round. */
static void look_across(const struct sphgi_walk *walk, int32_t axis, int64_t at, double *low,
                        double *high)
{
    const struct sphgi_axis *across = &walk->sources->raster.axis[axis];
    const int64_t far = (int64_t)1 << 39;
    const double margin = 0x1p-10;
    *low = -(double)INFINITY;
    *high = (double)INFINITY;
    if (axis >= walk->sources->raster.dimension || across->cells || at <= -far || at >= far)
        return;
    const double width = 1 / (across->inverse * (double)((int64_t)1 << walk->octave));
    *low = ((double)at - margin) * width;
    *high = ((double)at + 1 + margin) * width;
}

/* False: there is no room for more. */
static bool note_block(const struct sphgi_walk *walk, int32_t block, const int64_t *at,
                       struct sphgi_nearby *nearby)
{
    if (is_found_again(walk, at[0]))
        return true;
    if (nearby->count == SPHGI_NEAR_MOST)
        return false;
    struct sphgi_near *near = &nearby->near[nearby->count++];
    const int32_t *starts = walk->sources->cell_start.data;
    __builtin_prefetch(starts + walk->sources->blocks[block].first); /* add_block reads them */
    *near = (struct sphgi_near){block, walk->octave, at[0], {0}, {0}, reach_of_block(walk, block)};
    for (int32_t a = 1; a < 3; ++a)
        look_across(walk, a, at[a], &near->low[a - 1], &near->high[a - 1]);
    return true;
}

/* The block with that key, -1: there is none. known: one that stands before it, or -1. */
static int32_t block_behind(const struct sphgi_grid *grid, int32_t known, const int64_t *at)
{
    const struct sphgi_key key = sphgi_key_of(at);
    const int32_t next = known + 1;
    if (known >= 0 && next == grid->block_count)
        return -1;
    if (known >= 0 && !sphgi_is_before(grid->blocks[next].key, key))
        return sphgi_same_key(grid->blocks[next].key, key) ? next : -1;
    return sphgi_find_block(grid, at);
}

/* Place by place: most blocks stand behind the one that was found before. */
static bool look_at_places(const struct sphgi_walk *walk, const struct sphgi_blocks *box,
                           struct sphgi_nearby *nearby)
{
    int32_t known = -1;
    bool room = true;
    for (int64_t z = box->low[2]; z <= box->high[2]; ++z)
        for (int64_t y = box->low[1]; y <= box->high[1]; ++y)
            for (int64_t x = box->low[0]; x <= box->high[0]; ++x) {
                const int64_t at[3] = {x, y, z};
                int64_t raised[3] = {x, y, z};
                sphgi_raise_octave(walk->octave, raised);
                const int32_t block = block_behind(walk->sources, known, raised);
                known = block >= 0 ? block : known;
                room = room && (block < 0 || note_block(walk, block, at, nearby));
            }
    return room;
}

static bool look_through_tree(struct sphgi_walk *walk, struct sphgi_nearby *nearby)
{
    for (walk->from = walk->sources->tree.first[walk->octave]; next_of_part(walk);)
        for (; walk->inside; walk->inside &= walk->inside - 1) {
            const int32_t block = walk->leaf * SPHGI_TREE_WIDTH + __builtin_ctz(walk->inside);
            int64_t at[3];
            place_of(walk, block, at);
            if (is_in_part(walk, at) && !note_block(walk, block, at, nearby))
                return false;
        }
    return true;
}

/* Are these so few places that to ask for each costs less than the way through the tree? */
static bool are_few(const struct sphgi_blocks *box)
{
    enum { FEW = 128, FAR = 1 << 29 }; /* places far out may be several to the tree */
    double places = 1;
    bool near = true;
    for (int32_t a = 0; a < 3; ++a) {
        places *= (double)box->high[a] - box->low[a] + 1;
        near &= box->low[a] > -FAR && box->high[a] < FAR;
    }
    return near && places <= FEW;
}

static bool look_into_part(struct sphgi_walk *walk, struct sphgi_nearby *nearby)
{
    const struct sphgi_blocks *all = &walk->sources->tree.octave[walk->octave];
    struct sphgi_blocks box;
    if (!box_of_part(walk, &box) || !sphgi_blocks_meet(&box, all))
        return true;
    struct sphgi_blocks inside = box;
    for (int32_t a = 0; a < 3; ++a) {
        inside.low[a] = sphgi_max32(box.low[a], all->low[a]);
        inside.high[a] = sphgi_min32(box.high[a], all->high[a]);
    }
    return are_few(&inside) ? look_at_places(walk, &inside, nearby)
                            : look_through_tree(walk, nearby);
}

bool sphgi_look_nearby(struct sphgi_walk *walk, struct sphgi_nearby *nearby)
{
    nearby->count = 0;
    while (enter_next_octave(walk))
        for (; walk->part < PARTS; ++walk->part)
            if (!look_into_part(walk, nearby)) {
                nearby->count = -1;
                return false;
            }
    return true;
}

/* Is a bar farther from the targets than they, whose reach this is, and those in it reach? */
static bool is_beyond(const struct sphgi_walk *walk, double reach, const struct sphgi_near *near)
{
    double square = 0;
    for (int32_t a = 0; a < 2; ++a) {
        const double below = near->low[a] - walk->high[a + 1];
        const double above = walk->low[a + 1] - near->high[a];
        const double gap = below > above ? below : above;
        square += gap > 0 ? gap * gap : 0;
    }
    const double most = near->reach > reach ? near->reach : reach;
    return square > most * most;
}

bool sphgi_walk_nearby(struct sphgi_walk *walk, const struct sphgi_nearby *nearby,
                       struct sphgi_runs *runs)
{
    const double own = with_margin(walk->reach, walk->sources->raster.slack);
    bool some = false;
    runs->count = runs->candidates = 0;
    walk->octave = -1;
    for (int32_t n = 0; n < nearby->count; ++n) {
        const struct sphgi_near *near = &nearby->near[n];
        if (near->octave != walk->octave) {
            walk->octave = near->octave;
            some = look_along_bars(walk, reach_in(walk, near->octave));
        }
        if (!some || is_beyond(walk, own, near))
            continue;
        if (runs->count + 2 > SPHGI_RUNS_MOST)
            return true;
        for (int32_t k = 0; k < walk->span[0].count; ++k)
            add_block(walk, near->block, near->x, k, runs);
    }
    return false;
}
