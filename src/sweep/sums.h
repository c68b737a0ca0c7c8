/* SPDX-License-Identifier: MIT */
/* The pairs of a tile into the sums of a plan. */
#ifndef SPHGI_SUMS_H
#define SPHGI_SUMS_H
#include "worker.h"

/* Weighs the gathered pairs and adds them to the sums of this round, or hands them on one by one.
 */
void sphgi_evaluate_tile(struct sphgi_worker *worker);

#endif
