/* SPDX-License-Identifier: MIT */
/* Pairs found up to H + skin serve until a particle has moved skin / 2. */
#ifndef SPHGI_SKIN_H
#define SPHGI_SKIN_H
#include "geometry.h"

/* The object holds pairs with a skin, found for the same question. */
bool sphgi_skin_asks_the_same(const sphg_neighbors *neighbors,
                              const struct sphgi_geometry *geometry, const sphg_geometry *given,
                              double radius);

/* [L] how far any particle may still move if they stand there now. The pairs cover everything
 * where it is >= 0, and do not where it is negative or NaN. */
double sphgi_skin_left(sphg_context *context, const sphg_neighbors *neighbors,
                       const struct sphgi_geometry *geometry);

/* The pairs stay, and the rows hold the new positions. radius: the largest there is now. */
void sphgi_skin_keep(sphg_context *context, sphg_neighbors *neighbors,
                     const struct sphgi_geometry *geometry, double radius, double left);

/* Keeps the positions that the pairs were found at, and says how far particles may move. False: out
 * of memory. */
bool sphgi_skin_remember(sphg_neighbors *neighbors, const struct sphgi_geometry *geometry);

#endif
