/* SPDX-License-Identifier: MIT */
/* All source sets of a request, step by step where later sums need what the earlier gave. */
#ifndef SPHGI_SETS_H
#define SPHGI_SETS_H
#include "traverse.h"

/* Gives OK or MEMORY. */
sphg_result sphgi_sweep_sets(struct sphgi_task *task, struct sphgi_selection *selection,
                             struct sphgi_tally *tally);

#endif
