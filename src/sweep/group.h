/* SPDX-License-Identifier: MIT */
/* Groups of targets whose lists stand side by side. */
#ifndef SPHGI_GROUP_H
#define SPHGI_GROUP_H
#include "worker.h"

/* A whole one, while no lists wait. All its targets are summed, and those that are not active
 * dropped: where there are few of these that costs less than laying the lists of the others side by
 * side anew. */
void sphgi_group_run(struct sphgi_worker *worker, const struct sphgi_group *group);

/* The same for a group that was found on the spot: its lists, SPHGI_FIND_PAD dummies behind each of
 * them, are laid side by side and wait, so that the rows of some groups are asked for ahead. False:
 * they are too long for that. */
bool sphgi_woven_add(struct sphgi_worker *worker, int32_t place, uint32_t active,
                     const uint32_t *const *lists, const int32_t *lengths);

/* Sums those that wait. Before other lists wait, or are summed, they must be gone. */
void sphgi_woven_run(struct sphgi_worker *worker);

#endif
