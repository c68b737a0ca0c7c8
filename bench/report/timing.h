/* Clocks, and the statistics of repeated measurements. */
#ifndef SPHGRAD_BENCH_TIMING_H
#define SPHGRAD_BENCH_TIMING_H
#include <stdint.h>

struct moment {
    double wall, cpu; /* [ms]; cpu: of all threads of the process together */
};

struct samples {
    struct moment *values;
    int32_t count, capacity;
};

struct spread {
    double median, mean, min, max, deviation; /* deviation: standard, of the sample */
};

struct moment now(void);

struct samples samples_create(int32_t capacity);
void samples_destroy(struct samples *samples);
void samples_add(struct samples *samples, struct moment duration);    /* at most capacity */
void samples_add_since(struct samples *samples, struct moment start); /* at most capacity */
struct spread samples_wall(const struct samples *samples);            /* NaN if there are none */
struct spread samples_cpu(const struct samples *samples);
#endif
