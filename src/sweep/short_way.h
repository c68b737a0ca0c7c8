/* SPDX-License-Identifier: MIT */
/* The short way of what most sweeps do: groups whose lists stand side by side go from ids to sums
 * in one pass, instead of step by step. */
#ifndef SPHGI_SHORT_WAY_H
#define SPHGI_SHORT_WAY_H
#include "worker.h"

/* Once a worker, when its rows are known: can its whole groups go that way? */
void sphgi_short_way_open(struct sphgi_worker *worker);

/* The targets from `first` on that stand in the bundle: a vector of them whose lists stand side by
 * side, the longest of which has `steps` pairs. Their sums are those of sphgi_batch_run(). */
void sphgi_short_way_run(struct sphgi_worker *worker, const uint32_t *ids, int32_t steps);

#endif
