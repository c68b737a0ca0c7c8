/* SPDX-License-Identifier: MIT */
/* Clocks and rounds of measurements; and one line on a terminal that says how far they are. */
#ifndef SPHGRAD_BENCH_TIMING_H
#define SPHGRAD_BENCH_TIMING_H
#include <stdint.h>

struct moment {
    double wall, cpu; /* [ms]; cpu: of all threads of the process together */
};

struct samples {
    struct moment *values;
    int32_t count;
};

struct moment now(void);
struct moment since(struct moment start);

/* Items that are timed in turn, round by round, so that a slow second of the machine hits all. */
struct rounds {
    const char *name; /* on the terminal */
    int32_t count, items;
    /* Does the work of an item; returns how often, of which the time of once is taken. */
    double (*run)(void *data, int32_t item);
    double (*prepare)(void *data, int32_t item); /* untimed, before each run; or NULL */
    void *data;
};

/* Adds a sample to times[item] for each round. Items that run 0 times are left out. */
void rounds_measure(const struct rounds *rounds, struct samples *times);

double median_of(double *values, int32_t count); /* which are sorted then */

/* Nothing at all in a pipe. */
__attribute__((format(printf, 1, 2))) void progress_show(const char *format, ...);
void progress_clear(void);
#endif
