/* SPDX-License-Identifier: MIT */
/* A few targets of the probe and their pairs, packed for limit_passes.h. */
#ifndef SPHGRAD_BENCH_LIMIT_PACK_H
#define SPHGRAD_BENCH_LIMIT_PACK_H
#include "limit_passes.h"
#include "probe.h"

struct packed {
    struct limit_data data;
    int32_t lanes;
    double pairs;                                /* a target, on average */
    double kilobytes;                            /* read by the loops */
    double reference[LIMIT_TARGETS][LIMIT_SUMS]; /* C, then J, in double from the same floats */
};

/* From the middle on, those with at least the mean number of pairs, for which there is room,
 * rounded up to whole vectors. Held. */
struct packed packed_create(const struct limit_set *set, const struct probe *probe);

/* Largest relative difference between finished results and the reference, Frobenius norm. */
double packed_deviation(const struct packed *packed, enum limit_work work);
#endif
