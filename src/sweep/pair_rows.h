/* SPDX-License-Identifier: MIT */
/* Pairs one by one, from a tile to the rows of the host. */
#ifndef SPHGI_PAIR_ROWS_H
#define SPHGI_PAIR_ROWS_H
#include "worker.h"

/* Appends the pairs of one lane to the row of lane `of`'s target; counts them in any case. */
void sphgi_write_lane(struct sphgi_worker *worker, int32_t lane, int32_t of);

#endif
