/* SPDX-License-Identifier: MIT */
/* The host's numbers of sources become ids of rows that can be read. */
#ifndef SPHGI_CLEAN_H
#define SPHGI_CLEAN_H
#include "worker.h"

/* Ids of rows at out, padded to SPHGI_PAD: the target itself, and what is no source, becomes the
 * row behind the last source. What is no source is noted. */
void sphgi_clean_list(struct sphgi_worker *worker, int32_t target, const uint32_t *list,
                      int32_t count, uint32_t *ids);

/* The same for lists of the lanes at work, steps [begin, begin + tile.steps): the ids of the tile.
 */
void sphgi_clean_lists(struct sphgi_worker *worker, const struct sphgi_lane_lists *lists,
                       int32_t begin);

#endif
