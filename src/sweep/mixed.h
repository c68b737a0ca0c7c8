/* SPDX-License-Identifier: MIT */
/* Mixed groups: active targets of several groups, whose lists are laid side by side anew. */
#ifndef SPHGI_MIXED_H
#define SPHGI_MIXED_H
#include "worker.h"

/* Some targets of a group whose lists are kept side by side: a bit for each of them. They wait
 * until sixteen are together. False: their lists are too long for that, or rows are copied and sums
 * go step by step: they must come one by one. */
bool sphgi_mixed_add(struct sphgi_worker *worker, int32_t group, uint32_t active);

/* Sums those that wait. Before other lists wait they must be gone. */
void sphgi_mixed_run(struct sphgi_worker *worker);

#endif
