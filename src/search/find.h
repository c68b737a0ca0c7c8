/* SPDX-License-Identifier: MIT */
/* Neighbours of targets in the order of storage, found cell by cell. */
#ifndef SPHGI_FIND_H
#define SPHGI_FIND_H
#include "finder.h"

/* Bytes of scratch for a walk; it depends on the number of sources alone. */
size_t sphgi_finder_size(const sphg_neighbors *neighbors);
void sphgi_finder_open(struct sphgi_finder *finder, const sphg_context *context,
                       const sphg_neighbors *neighbors, void *memory);

/* The lists of a group, padded to SPHGI_PAD with the dummy, and their lengths; they stay until the
 * next call. SPHGI_GROUP entries, those behind the last target are empty. False: a target is
 * crowded, and there are none. Groups are best asked for in rising order. */
bool sphgi_find_group(struct sphgi_finder *finder, int32_t group, const uint32_t **lists,
                      int32_t *lengths);

/* The same for one target however crowded, slice by slice of its candidates. */
void sphgi_find_target(struct sphgi_finder *finder, int32_t target, sphgi_take *take, void *data);

#endif
