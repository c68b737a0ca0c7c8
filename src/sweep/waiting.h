/* SPDX-License-Identifier: MIT */
/* Targets wait until the lanes of a batch are full, and batches until their bundle is. */
#ifndef SPHGI_WAITING_H
#define SPHGI_WAITING_H
#include "worker.h"

/* A lane for a target of that place in storage order; its number in the bundle. */
int32_t sphgi_add_target(struct sphgi_worker *worker, int32_t target, int32_t place);

/* The same with its list, which stays where it is until the batch is summed. */
void sphgi_add_list(struct sphgi_worker *worker, int32_t target, int32_t place, const uint32_t *ids,
                    int32_t count, int32_t stride);

/* The first `copied` ids of a list that does not stay: it waits as a copy. What is too long for
 * that is summed at once. */
void sphgi_add_copied(struct sphgi_worker *worker, int32_t target, int32_t place,
                      const uint32_t *ids, int32_t count, int32_t copied);

/* Sums the targets whose lists stand in worker->batch.lists, step by step. */
void sphgi_run_lists(struct sphgi_worker *worker);

/* Sums and writes what waits. */
void sphgi_run_rest(struct sphgi_worker *worker);

/* Writes the results of lanes whose sums are done. */
void sphgi_finish_lanes(struct sphgi_worker *worker);

#endif
