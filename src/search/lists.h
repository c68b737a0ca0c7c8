/* Finding all pairs of a searched object and keeping them. */
#ifndef SPHGI_LISTS_H
#define SPHGI_LISTS_H
#include "neighbors.h"

/* Fills neighbors->found from the grids. Gives OK or MEMORY. */
sphg_result sphgi_lists_build(sphg_context *context, sphg_neighbors *neighbors);

#endif
