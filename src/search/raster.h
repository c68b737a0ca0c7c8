/* SPDX-License-Identifier: MIT */
/* How space is cut into cells a little wider than the search radius, and these into blocks, bars of
 * cells along x: shared by the grids of sources and targets. */
#ifndef SPHGI_RASTER_H
#define SPHGI_RASTER_H
#include "passes/passes.h"

enum { SPHGI_BLOCK_SHIFT = 5, SPHGI_BLOCK_CELLS = 1 << SPHGI_BLOCK_SHIFT };

struct sphgi_axis {
    double inverse;    /* open: 1 / cell width */
    double length;     /* of the period; 0: open */
    int64_t cells;     /* of the period */
    int32_t shift;     /* a block is 2^shift cells long: SPHGI_BLOCK_SHIFT along bars, else 0 */
    int32_t low, high; /* neighbouring cells that are cells of their own: -1 .. 1, fewer where the
                          period holds less than three */
};

/* Bars of cells. */
struct sphgi_bars {
    int32_t along; /* the axis of the positions that they follow */
    double across; /* how wide cells are along the others, in widths along it; 1 where neighbours
                      must lie in adjacent cells */
};

struct sphgi_raster {
    struct sphgi_axis axis[3]; /* [0]: along the bars; x stands where their axis would */
    int32_t along;             /* of the positions' axes */
    int32_t dimension;
    bool periodic;
    double slack;    /* rounding of differences between periodic images [L] */
    int32_t octaves; /* of radii (octaves.h); 0: all particles have the same */
    double top;      /* the largest radius, if there are octaves */
};

/* The periodic axes of a search for that radius. */
struct sphgi_periods sphgi_periods_of(int32_t dimension, double radius, const double *period,
                                      sphg_type type);
/* Bounds how far rounding brings images apart or together along any periodic axis [L]. largest[a]:
 * the largest |coordinate|. */
double sphgi_slack_of(const struct sphgi_periods *periods, const double *largest, sphg_type type);
struct sphgi_raster sphgi_raster_of(int32_t dimension, double reach, struct sphgi_bars bars,
                                    const struct sphgi_periods *periods, const double *largest,
                                    sphg_type type);
/* The number of a position that an axis of the raster stands for. */
static inline int32_t sphgi_number_of_axis(const struct sphgi_raster *raster, int32_t axis)
{
    return axis == 0 ? raster->along : axis == raster->along ? 0 : axis;
}

/* Cells of both are the same, whatever images' distances are rounded by. */
bool sphgi_same_raster(const struct sphgi_raster *a, const struct sphgi_raster *b);
struct sphgi_cutting sphgi_cutting_of(const struct sphgi_raster *raster);
/* Cells of octave k are 2^-k as wide. */
double sphgi_place_on_axis(const struct sphgi_axis *axis, int32_t octave, double x, int64_t *cell);
void sphgi_cell_of(const struct sphgi_raster *raster, const double *x, int64_t *cell);
/* Its number in its block. */
int32_t sphgi_local_cell(const struct sphgi_raster *raster, const int64_t *cell);

#endif
