/* SPDX-License-Identifier: MIT */
/* What is near a block: the bars of cells beside it, and from these the candidates of a cell. */
#ifndef SPHGI_HALO_H
#define SPHGI_HALO_H
#include "grid.h"

enum { SPHGI_BARS_MOST = 9 /* a block and the bars beside it */ };

/* The sources of a bar and of the cells before and behind it: those of cell c begin with row
 * first[c + 1] and end before first[c + 2], for c from -1 to SPHGI_BLOCK_CELLS. What a period puts
 * before or behind it stands somewhere else in storage: from row before[0] up to, and without,
 * before[1]. */
struct sphgi_bar {
    int32_t block; /* of the bar, -1: none is there */
    int32_t first[SPHGI_BLOCK_CELLS + 3];
    int32_t before[2], behind[2];
};

/* The bars around a block, its own first. */
struct sphgi_halo {
    int32_t bars, cells; /* cells: along x, in a period what the block has of it */
    struct sphgi_bar bar[SPHGI_BARS_MOST];
};

/* around: what it was for the block before, or 0. */
void sphgi_halo_of(const struct sphgi_grid *sources, struct sphgi_key block,
                   struct sphgi_halo *around);

/* The rows of the candidates of the cells [from, to). For every such range of a block there are as
 * many runs, each of which holds those of the cells in it. */
void sphgi_candidate_runs(const struct sphgi_raster *raster, const struct sphgi_halo *around,
                          int32_t from, int32_t to, struct sphgi_runs *runs);

#endif
