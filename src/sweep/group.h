/* SPDX-License-Identifier: MIT */
/* Groups of targets whose lists stand side by side. */
#ifndef SPHGI_GROUP_H
#define SPHGI_GROUP_H
#include "worker.h"

/* A whole one, while no lists wait. All its targets are summed, and those that are not active
 * dropped: where there are few of these that costs less than laying the lists of the others side by
 * side anew. */
void sphgi_group_run(struct sphgi_worker *worker, int32_t place, const uint32_t *ids,
                     uint32_t active);

#endif
