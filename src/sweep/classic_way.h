/* SPDX-License-Identifier: MIT */
/* The short way of the classic methods: one pass takes a vector of targets from ids to a tile and
 * to moments. What needs these (corrections, slopes, fields) waits until it is done for several
 * vectors of a bundle, one kind after the other, over tiles that are still in the cache. */
#ifndef SPHGI_CLASSIC_WAY_H
#define SPHGI_CLASSIC_WAY_H
#include "worker.h"

/* Can this sweep's groups go that way? */
bool sphgi_is_classic_way(const struct sphgi_worker *worker);
/* Is there room for the tiles of such lists? */
bool sphgi_has_tiles_for(const struct sphgi_worker *worker, int32_t steps);

/* The targets that stand in the bundle, not summed yet: a vector of them. */
void sphgi_classic_begin(struct sphgi_worker *worker, const uint32_t *ids, int32_t steps);
/* What waits is done; else nothing happens. */
void sphgi_classic_complete(struct sphgi_worker *worker);

#endif
