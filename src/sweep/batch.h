/* SPDX-License-Identifier: MIT */
/* A batch: the targets of a bundle that are at work, from their lists to their sums. */
#ifndef SPHGI_BATCH_H
#define SPHGI_BATCH_H
#include "worker.h"

/* The lanes of the bundle from `first` on go to work. Those without a target repeat one: they are
 * read like the others, and never written. */
void sphgi_put_to_work(struct sphgi_worker *worker, int32_t first);

/* Sums the targets whose lists stand in worker->batch.lists, those of the bundle that are not
 * summed yet. */
void sphgi_batch_run(struct sphgi_worker *worker);

/* Of the lanes that were summed last, those with a bit in `kept` stay; the others' targets drop
 * out. */
void sphgi_batch_keep(struct sphgi_worker *worker, uint32_t kept);

/* What sphgi_batch_run() consists of, for lists that do not stand side by side:
 *   begin; do { run parts ... } while (again); end. */
void sphgi_batch_begin(struct sphgi_worker *worker);
bool sphgi_batch_again(struct sphgi_worker *worker);
void sphgi_batch_end(struct sphgi_worker *worker);

/* The rounding of long lists, which was carried along, comes in. */
void sphgi_batch_settle(struct sphgi_worker *worker);

/* All lanes for one target: a chunk each, of `count` pairs up to sphgi_spread_most(), which are
 * numbers `at` and so on of its list. */
void sphgi_run_spread(struct sphgi_worker *worker, const uint32_t *ids, int32_t count,
                      int32_t stride, int32_t at);

static inline int32_t sphgi_spread_most(const struct sphgi_worker *worker)
{
    return worker->passes->lanes * SPHGI_CHUNK;
}

#endif
