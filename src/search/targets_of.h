/* SPDX-License-Identifier: MIT */
/* Targets that are those of another object: they are not read and sorted again. */
#ifndef SPHGI_TARGETS_OF_H
#define SPHGI_TARGETS_OF_H
#include "geometry.h"

/* geometry becomes what it would be had the host handed over the targets, their radii and their
 * number, but that these stand in the other object's order of storage. */
void sphgi_put_targets_of(sphg_geometry *geometry);

/* What is known without looking at the targets: g->largest. True: it is enough. */
bool sphgi_knows_targets_of(const sphg_neighbors *other, const sphg_geometry *given,
                            struct sphgi_geometry *g);

/* Their grid serves a search on that raster, too. */
bool sphgi_may_share_targets(const sphg_neighbors *other, const struct sphgi_raster *raster);

/* g->target_rows, in the order of the host, with their radii; g->largest. */
void sphgi_copy_targets(sphg_context *context, const sphg_neighbors *other,
                        struct sphgi_geometry *g);

/* Their grid becomes that of n, and is given up again. */
void sphgi_share_targets(sphg_neighbors *n, const sphg_neighbors *other);
void sphgi_give_up_targets(sphg_neighbors *n);

#endif
