/* SPDX-License-Identifier: MIT */
/* A group of targets whose sums are done: results are written, or sums put away until those of the
 * other source sets have come in. */
#ifndef SPHGI_GROUP_H
#define SPHGI_GROUP_H
#include "worker.h"

/* Writes the results; the group is empty again. */
void sphgi_group_finish(struct sphgi_worker *worker);

/* The same for a group whose sums stand in the arena already. */
void sphgi_group_finish_from_arena(struct sphgi_worker *worker);

#endif
