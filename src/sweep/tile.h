/* SPDX-License-Identifier: MIT */
/* A tile: some steps of the lists of a batch, gathered and summed. */
#ifndef SPHGI_TILE_H
#define SPHGI_TILE_H
#include "worker.h"

/* Steps [begin, begin + tile.steps) of the lists, a lane for each; pairs go to their sums. */
void sphgi_run_tile(struct sphgi_worker *worker, const struct sphgi_lane_lists *lists,
                    int32_t begin);

/* The pairs of the tile that is there to the sums of this round. */
void sphgi_sum_tile(struct sphgi_worker *worker);

#endif
