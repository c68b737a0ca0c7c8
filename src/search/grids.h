/* SPDX-License-Identifier: MIT */
/* The grids of an object, of its sources and, where these are others, of its targets. */
#ifndef SPHGI_GRIDS_H
#define SPHGI_GRIDS_H
#include "geometry.h"

/* Both, with the place of each target in its grid; n knows its counts, radius and skin. Their
 * tables stand at the beginning of n->shared. Gives OK or MEMORY. */
sphg_result sphgi_grids_build(sphg_context *context, sphg_neighbors *n,
                              const struct sphgi_geometry *g);

#endif
