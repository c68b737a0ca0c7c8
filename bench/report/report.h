/* SPDX-License-Identifier: MIT */
/* Measurements for programs, in Google Benchmark's JSON format, which bench/compare and its
 * compare.py read. */
#ifndef SPHGRAD_BENCH_REPORT_H
#define SPHGRAD_BENCH_REPORT_H
#include "settings.h"
#include "table.h"

struct report;

/* The context holds date, host, processors, library, compiler and instruction set already. */
struct report *report_create(int32_t threads);
void report_text(struct report *report, const char *name, const char *value);
void report_number(struct report *report, const char *name, double value);

/* Particles, support and jitter of these settings, and pairs a particle. */
void report_lattice(struct report *report, const struct settings *settings, int32_t count,
                    double pairs);

/* Each time of a row is a benchmark, named by the table, the texts of the row and the column, and
 * has the row's numbers as counters. All repetitions, then, if there are several, mean, median,
 * stddev, cv, min and max. */
void report_table(struct report *report, const struct table *table);

/* Writes the file, if one is wanted, and destroys the report; ends the program where that fails. */
void report_write(struct report *report, const char *path);
#endif
