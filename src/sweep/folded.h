/* SPDX-License-Identifier: MIT */
/* Sums of fields whose terms of the sources are multiplied out (fold.h). */
#ifndef SPHGI_FOLDED_H
#define SPHGI_FOLDED_H
#include "worker.h"

/* What one of them sums of the tile, with the vectors that it carries. */
void sphgi_sum_folded(struct sphgi_worker *worker, int32_t number);

/* All of them, where both ends of a pair have radii of their own: of the pairs in the tile, whose
 * arrays hold other offsets and factors then. */
void sphgi_sum_both_sides(struct sphgi_worker *worker);

#endif
