/* SPDX-License-Identifier: MIT */
/* Clocks, and the statistics of repeated measurements. */
#ifndef SPHGRAD_BENCH_TIMING_H
#define SPHGRAD_BENCH_TIMING_H
#include <stdint.h>

struct moment {
    double wall, cpu; /* [ms]; cpu: of all threads of the process together */
};

/* {0} has none; there is room for as many as come. */
struct samples {
    struct moment *values;
    int32_t count, capacity;
};

struct spread {
    double median, mean, min, max, deviation; /* deviation: standard, of the sample */
};

struct moment now(void);
struct moment since(struct moment start);

void samples_add(struct samples *samples, struct moment duration);
struct spread samples_wall(const struct samples *samples); /* NaN if there are none */
struct spread samples_cpu(const struct samples *samples);
double samples_median(const struct samples *samples); /* wall [ms] */

/* Sorts the values. */
double median_of(double *values, int32_t count);
#endif
