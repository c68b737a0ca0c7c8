/* SPDX-License-Identifier: MIT */
/* Tiles of a batch that stay in the cache from round to round, so that their pairs are gathered and
 * weighed once. Longer lists are walked again, and only the first of their tiles stay. */
#ifndef SPHGI_HELD_H
#define SPHGI_HELD_H
#include "worker.h"

/* Sweeps of one round hold nothing. */
void sphgi_held_open(struct sphgi_worker *worker);

/* Where there is room: a place for the next tile of this round; once it is ready, it stays there.
 */
void sphgi_place_tile(struct sphgi_worker *worker);
void sphgi_hold_tile(struct sphgi_worker *worker);

/* All tiles of the round that just ended are there. */
static inline bool sphgi_are_held(const struct sphgi_worker *worker)
{
    return worker->batch.tiles <= worker->held.room;
}

/* Lists are walked again: the next tile is there. The last place was used more than once. */
static inline bool sphgi_is_held(const struct sphgi_worker *worker)
{
    return worker->batch.summing != SPHGI_SUM_MOMENTS &&
           worker->batch.tiles < worker->held.room - 1;
}

/* The tile becomes the k-th of them. */
void sphgi_take_tile(struct sphgi_worker *worker, int32_t k);

#endif
