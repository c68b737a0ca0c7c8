/* Totals of one worker, added up when all are done. */
#ifndef SPHGI_TALLY_H
#define SPHGI_TALLY_H
#include "passes/passes.h"

#define SPHGI_BAD_LENGTH INT64_MIN

struct sphgi_tally {
    sphg_stats stats;
    int32_t bad_target; /* first target whose list is wrong, -1: none */
    int64_t bad_index;  /* SPHGI_BAD_LENGTH: not an index, the length or the pointer */
    bool bad_volume;
};

void sphgi_tally_clear(struct sphgi_tally *tally);
void sphgi_tally_add(struct sphgi_tally *total, const struct sphgi_tally *part);

/* Counts the first `lanes` targets of a group. */
void sphgi_tally_verdict(struct sphgi_tally *tally, const struct sphgi_verdict *verdict,
                         const void *lambda_min, sphg_type type, int32_t lanes);

#endif
