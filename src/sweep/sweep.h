/* SPDX-License-Identifier: MIT */
/* Carries out a plan: sweeps over the source sets, in parallel over blocks of targets. */
#ifndef SPHGI_SWEEP_H
#define SPHGI_SWEEP_H
#include "plan/plan.h"

struct sphgi_pair_sink;

/* Numbers of the selected targets in the order of the subset: row_of_target[target] = row. Returns
 * the number of rows. */
int32_t sphgi_selected_rows(const sphg_subset *subset, int32_t target_count,
                            int32_t *row_of_target);

/* subset: checked, or NULL. pairs: NULL, or where pairs are wanted one by one. Gives OK, MEMORY,
 * INDEX or VOLUME, the message set. */
sphg_result sphgi_sweep_run(struct sphgi_checker checker, const struct sphgi_plan *plan,
                            const sphg_subset *subset, const struct sphgi_pair_sink *pairs);

#endif
