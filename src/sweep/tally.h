/* SPDX-License-Identifier: MIT */
/* Totals of one worker, added up when all are done. */
#ifndef SPHGI_TALLY_H
#define SPHGI_TALLY_H
#include "passes/passes.h"

struct sphgi_tally {
    sphg_stats stats;
    int32_t bad_target; /* first target whose list is wrong, -1: none */
    int64_t bad_index;  /* SPHGI_BAD_LENGTH: not an index, the length or the pointer */
    bool bad_volume;
    double largest_square; /* of |A^-1|_F, which bounds lambda_min from below */
};

void sphgi_tally_clear(struct sphgi_tally *tally);
void sphgi_tally_add(struct sphgi_tally *total, const struct sphgi_tally *part);

void sphgi_tally_verdict(struct sphgi_tally *tally, const struct sphgi_verdict *verdict,
                         int32_t dimension);

/* What was counted, in the form of the host; type: in which lambda_min was computed. */
sphg_stats sphgi_tally_stats(const struct sphgi_tally *tally, sphg_type type);

#endif
