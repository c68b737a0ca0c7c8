/* SPDX-License-Identifier: MIT */
/* Keeping all pairs: those of a search, and those of the host's lists. */
#ifndef SPHGI_LISTS_H
#define SPHGI_LISTS_H
#include "core/check.h"
#include "neighbors.h"

/* Fills neighbors->found from the grids. Gives OK or MEMORY. */
sphg_result sphgi_lists_build(sphg_context *context, sphg_neighbors *neighbors);

/* The same from lists, for rows in the order of the host. Gives OK, MEMORY, or INDEX with a
 * message.
 */
sphg_result sphgi_lists_copy(struct sphgi_checker checker, sphg_neighbors *neighbors,
                             const sphg_lists *lists);

#endif
