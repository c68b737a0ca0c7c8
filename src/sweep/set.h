/* SPDX-License-Identifier: MIT */
/* One sweep: all pairs of one source set. */
#ifndef SPHGI_SET_H
#define SPHGI_SET_H
#include "traverse.h"

/* Over the set of task->sweep.set_number, in its steps. Gives OK or MEMORY. */
sphg_result sphgi_sweep_set(struct sphgi_task *task, struct sphgi_selection *selection,
                            struct sphgi_tally *tally);

bool sphgi_is_bad_volume(const struct sphgi_columns *volume, sphg_type type, int64_t item,
                         double *value);

#endif
