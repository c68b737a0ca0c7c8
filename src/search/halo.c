/* SPDX-License-Identifier: MIT */
/* What lies around a block of the grid. */
#include "halo.h"

/* ---- Bars ----------------------------------------------------------------------------------- */

/* The particles of cell `cell` of block `block`, which may be -1: none. */
static void range_of_cell(const struct sphgi_grid *grid, int32_t block, int32_t cell,
                          int32_t *range)
{
    range[0] = range[1] = 0;
    if (block < 0 || !(grid->blocks[block].occupied >> cell & 1))
        return;
    const struct sphgi_block *own = &grid->blocks[block];
    const int32_t *start = (const int32_t *)grid->cell_start.data + own->first +
                           sphgi_bits_in(own->occupied & (((uint32_t)1 << cell) - 1));
    range[0] = start[0];
    range[1] = start[1];
}

static bool is_block_at(const struct sphgi_grid *grid, int32_t block, struct sphgi_key key)
{
    return block >= 0 && block < grid->block_count && sphgi_same_key(grid->blocks[block].key, key);
}

/* The neighbour of a block along x; if the block itself is there, it stands next to it. */
static int32_t neighbour_of(const struct sphgi_grid *grid, const int64_t *at, int32_t block,
                            int32_t step)
{
    const int64_t beside[3] = {at[0] + step, at[1], at[2]};
    if (block < 0)
        return sphgi_find_block(grid, beside);
    return is_block_at(grid, block + step, sphgi_key_of(beside)) ? block + step : -1;
}

/* The block at `at`; it often stands behind the one that was there when the bar was looked up for
 * the block before. */
static int32_t block_of_bar(const struct sphgi_grid *grid, const int64_t *at,
                            const struct sphgi_bar *bar)
{
    const int32_t next = bar->block + 1;
    return is_block_at(grid, next, sphgi_key_of(at)) ? next : sphgi_find_block(grid, at);
}

/* The bar at `at`, and what lies before and behind it in storage, too. */
static void bar_at(const struct sphgi_grid *grid, const int64_t *at, struct sphgi_bar *bar)
{
    const struct sphgi_block *blocks = grid->blocks;
    const int32_t own = block_of_bar(grid, at, bar);
    const int32_t low = neighbour_of(grid, at, own, -1), high = neighbour_of(grid, at, own, 1);
    const int32_t begin = own >= 0    ? blocks[own].first
                          : low >= 0  ? blocks[low + 1].first
                          : high >= 0 ? blocks[high].first
                                      : 0;
    int32_t *first = bar->first + 1, range[2];
    bar->block = own;
    if (own >= 0)
        sphgi_cell_starts(grid, own, first);
    for (int32_t c = 0; own < 0 && c <= SPHGI_BLOCK_CELLS; ++c)
        first[c] = begin;
    range_of_cell(grid, low, SPHGI_BLOCK_CELLS - 1, range);
    bar->first[0] = range[1] > range[0] ? range[0] : begin;
    range_of_cell(grid, high, 0, range);
    first[SPHGI_BLOCK_CELLS + 1] = range[1] > range[0] ? range[1] : first[SPHGI_BLOCK_CELLS];
}

/* What a period puts before the first cell of the axis and behind its last. */
static void wrap_bar(const struct sphgi_grid *grid, const int64_t *at, struct sphgi_bar *bar)
{
    const int64_t last = grid->raster.axis[0].cells - 1;
    const int64_t begin[3] = {0, at[1], at[2]};
    const int64_t end[3] = {last >> SPHGI_BLOCK_SHIFT, at[1], at[2]};
    bar->before[0] = bar->before[1] = bar->behind[0] = bar->behind[1] = 0;
    if (at[0] == 0)
        range_of_cell(grid, sphgi_find_block(grid, end), (int32_t)(last & (SPHGI_BLOCK_CELLS - 1)),
                      bar->before);
    if (at[0] == end[0])
        range_of_cell(grid, sphgi_find_block(grid, begin), 0, bar->behind);
}

static int64_t wrapped(const struct sphgi_axis *axis, int64_t cell)
{
    return axis->cells ? (cell % axis->cells + axis->cells) % axis->cells : cell;
}

/* Cells of the block along x that the period has. */
static int32_t cells_along(const struct sphgi_axis *axis, int64_t block)
{
    const int64_t left = axis->cells - block * SPHGI_BLOCK_CELLS;
    return axis->cells && left < SPHGI_BLOCK_CELLS ? (int32_t)left : SPHGI_BLOCK_CELLS;
}

void sphgi_halo_of(const struct sphgi_grid *sources, struct sphgi_key block,
                   struct sphgi_halo *around)
{
    const struct sphgi_axis *axis = sources->raster.axis;
    int64_t own[3];
    sphgi_key_open(block, own);
    around->cells = cells_along(&axis[0], own[0]);
    around->bars = 1;
    for (int32_t z = axis[2].low; z <= axis[2].high; ++z)
        for (int32_t y = axis[1].low; y <= axis[1].high; ++y) {
            const int64_t at[3] = {own[0], wrapped(&axis[1], own[1] + y),
                                   wrapped(&axis[2], own[2] + z)};
            struct sphgi_bar *bar = &around->bar[y || z ? around->bars++ : 0];
            bar_at(sources, at, bar);
            if (axis[0].cells)
                wrap_bar(sources, at, bar);
        }
}

/* ---- Candidates ----------------------------------------------------------------------------- */

void sphgi_candidate_runs(const struct sphgi_raster *raster, const struct sphgi_halo *around,
                          int32_t from, int32_t to, struct sphgi_runs *runs)
{
    const struct sphgi_axis *x = &raster->axis[0];
    const int32_t low = from + x->low, high = to - 1 + x->high, bars = around->bars;
    const int32_t each = x->cells ? 3 : 1; /* runs of a bar: it, and what a period puts around it */
    int32_t candidates = 0;
    for (int32_t b = 0; b < bars; ++b) {
        const struct sphgi_bar *bar = &around->bar[b];
        const int32_t length = bar->first[high + 2] - bar->first[low + 1];
        runs->begin[each * b] = bar->first[low + 1];
        runs->length[each * b] = length;
        candidates += length;
    }
    for (int32_t b = 0; x->cells && b < bars; ++b) {
        const struct sphgi_bar *bar = &around->bar[b];
        const int32_t before = low < 0 ? bar->before[1] - bar->before[0] : 0;
        const int32_t behind = high == around->cells ? bar->behind[1] - bar->behind[0] : 0;
        runs->begin[each * b + 1] = bar->before[0];
        runs->length[each * b + 1] = before;
        runs->begin[each * b + 2] = bar->behind[0];
        runs->length[each * b + 2] = behind;
        candidates += before + behind;
    }
    runs->count = each * bars;
    runs->candidates = candidates;
    runs->own = around->bar[0].first[from + 1];
}
