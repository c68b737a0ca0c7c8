/* Timings in Google Benchmark's JSON format, which its compare.py reads. */
#ifndef SPHGRAD_BENCH_REPORT_JSON_H
#define SPHGRAD_BENCH_REPORT_JSON_H
#include "timing.h"

struct report;

/* The context holds date, host, processors, library, compiler and instruction set already. */
struct report *report_create(const char *executable, int32_t threads);
void report_text(struct report *report, const char *name, const char *value);
void report_number(struct report *report, const char *name, double value);

/* A counter of a benchmark: name, value. */
struct counter {
    const char *name; /* NULL ends a list */
    double value;
};

/* All repetitions, then mean, median, stddev, cv, min and max. Nothing if there are none. */
void report_benchmark(struct report *report, const char *name, const struct samples *samples,
                      const struct counter *counters);

/* One entry for what is not timed again and again. */
void report_once(struct report *report, const char *name, struct moment time,
                 const struct counter *counters);

/* Writes the file and destroys the report; ends the program where that fails. */
void report_write(struct report *report, const char *path);
#endif
