/* SPDX-License-Identifier: MIT */
/* Are the outputs of a part those of the full evaluation? */
#ifndef SPHGRAD_BENCH_SKIP_COMPARE_H
#define SPHGRAD_BENCH_SKIP_COMPARE_H
#include "skip.h"

/* Adds to result->deviation and differences. */
void skip_compare(const struct skip_stage *stage, const struct skip_row *row,
                  struct skip_result *result);

/* So that what a run does not write cannot look like what the run before wrote. */
void skip_spoil(const struct skip_row *row, struct outputs *outputs);
#endif
