/* SPDX-License-Identifier: MIT */
/* What a command has measured, on the terminal and for programs: in Google Benchmark's JSON format,
 * which bench/compare and its compare.py read. */
#ifndef SPHGRAD_BENCH_REPORT_H
#define SPHGRAD_BENCH_REPORT_H
#include "settings.h"
#include "table.h"

struct report;

/* The context holds date, host, processors, library, compiler and instruction set already. */
struct report *report_create(const struct settings *settings);
void report_text(struct report *report, const char *name, const char *value);
void report_number(struct report *report, const char *name, double value);

/* Prints how many particles there are, in a lattice of the settings, and pairs a particle; without
 * the end of the line. */
void report_lattice(struct report *report, int32_t count, double pairs);
void report_lattice_numbers(struct report *report, int32_t count, double pairs); /* not printed */
/* Prints the lines that name the machine. */
void report_machine(const struct report *report);
/* Prints one line if others kept the processors from the program while these samples were taken. */
void report_if_busy(const struct report *report, const struct samples *samples);

/* Each time of a row is a benchmark, named by the table, the texts of the row and the column, and
 * has the row's numbers as counters. All repetitions, then, if there are several, mean, median,
 * stddev, cv, min and max. */
void report_times(struct report *report, const struct table *table);
/* The same, and prints the table. */
void report_table(struct report *report, const struct table *table);

/* Writes the file, if one is wanted, and destroys the report; ends the program where that fails. */
void report_write(struct report *report);
#endif
