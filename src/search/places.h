/* SPDX-License-Identifier: MIT */
/* Where the targets stand: do two objects mean the same ones? */
#ifndef SPHGI_PLACES_H
#define SPHGI_PLACES_H
#include "neighbors.h"

/* The first target that stands elsewhere in b than in a, -1: none does. Both have as many; types of
 * positions and periods are the same. Cost: the first question about an object reads all its
 * targets once, later ones compare a number. */
int32_t sphgi_first_elsewhere(sphg_context *context, const sphg_neighbors *a,
                              const sphg_neighbors *b);

#endif
