/* SPDX-License-Identifier: MIT */
#include "dummy.h"
#include <math.h>

struct extent {
    int64_t low[3], high[3]; /* cells, along x those of whole blocks */
};

static void widen(struct extent *extent, const struct sphgi_grid *grid)
{
    for (int32_t b = 0; b < grid->block_count; ++b) {
        int64_t at[3];
        sphgi_key_open(grid->blocks[b].key, at);
        for (int32_t a = 0; a < 3; ++a) {
            const int64_t cells = (int64_t)1 << grid->raster.axis[a].shift;
            const int64_t low = at[a] * cells, high = low + cells;
            extent->low[a] = low < extent->low[a] ? low : extent->low[a];
            extent->high[a] = high > extent->high[a] ? high : extent->high[a];
        }
    }
}

static double number_at(const sphg_neighbors *n, const struct sphgi_grid *grid, int32_t row,
                        int32_t axis)
{
    const size_t at = SPHGI_ROW * (size_t)row + (size_t)axis;
    return n->position_type == SPHG_F64 ? ((const double *)grid->rows.data)[at]
                                        : (double)((const float *)grid->rows.data)[at];
}

/* Of rows that were not sorted into blocks. */
static void widen_by_rows(struct extent *extent, const sphg_neighbors *n,
                          const struct sphgi_grid *grid)
{
    for (int32_t a = 0; a < n->dimension; ++a) {
        double low = 0, high = 0;
        for (int32_t k = 0; k < grid->count; ++k) {
            const double x = number_at(n, grid, k, a);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        const double inverse = n->sources.raster.axis[a].inverse, most = 2.0 * SPHGI_CUT_MOST;
        const int64_t from = (int64_t)fmax(floor(low * inverse), -most);
        const int64_t to = (int64_t)fmin(ceil(high * inverse), most);
        extent->low[a] = from < extent->low[a] ? from : extent->low[a];
        extent->high[a] = to > extent->high[a] ? to : extent->high[a];
    }
}

static void widen_by(struct extent *extent, const sphg_neighbors *n, const struct sphgi_grid *grid)
{
    if (grid->block_count)
        widen(extent, grid);
    else
        widen_by_rows(extent, n, grid);
}

/* The same where cells have many widths. */
static double far_from_octaves(const sphg_neighbors *n, double most)
{
    const double width = 1 / n->sources.raster.axis[0].inverse;
    const double far = fmax(n->largest[0], fmax(n->largest[1], n->largest[2]));
    const bool near = far * n->sources.raster.axis[0].inverse < SPHGI_CUT_MOST;
    return near && 0x1p32 * width < most ? -2 * far - 64 * width : (double)NAN;
}

/* Below the lowest x by 64 cells, and by as much as that x has digits for; NaN if cells do not tell
 * places, or if squares of differences could leave the range of the type. */
static double far_x(const sphg_neighbors *n)
{
    const struct sphgi_raster *raster = &n->sources.raster;
    const double most = n->type == SPHG_F64 ? 0x1p500 : 0x1p60;
    if (n->graded)
        return far_from_octaves(n, most);
    struct extent extent = {{0}, {0}};
    widen_by(&extent, n, &n->sources);
    if (!n->same)
        widen_by(&extent, n, &n->targets);
    const double width = 1 / raster->axis[0].inverse;
    for (int32_t a = 0; a < raster->dimension; ++a)
        if (extent.low[a] <= -SPHGI_CUT_MOST || extent.high[a] >= SPHGI_CUT_MOST)
            return NAN;
    return 0x1p32 * width < most ? 2 * (double)extent.low[0] * width - 64 * width : NAN;
}

void sphgi_place_dummy(sphg_neighbors *n, bool fixed)
{
    const size_t row = SPHGI_ROW * (size_t)n->source_count;
    const double far = fixed && !n->periodic && !(n->skin > 0) ? far_x(n) : NAN;
    const double x[SPHGI_ROW] = {far, isnan(far) ? far : 0, isnan(far) ? far : 0, 0};
    n->dummy_is_far = !isnan(far);
    for (size_t a = 0; a < SPHGI_ROW; ++a)
        if (n->position_type == SPHG_F64)
            ((double *)n->sources.rows.data)[row + a] = x[a];
        else
            ((float *)n->sources.rows.data)[row + a] = (float)x[a];
}
