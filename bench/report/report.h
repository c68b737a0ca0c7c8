/* SPDX-License-Identifier: MIT */
/* What a command has measured: texts, numbers and times, each with a name, go to report.py, which
 * writes JSON in Google Benchmark's format, and to COMMAND.py, which prints tables, writes CSV and
 * draws. */
#ifndef SPHGRAD_BENCH_REPORT_H
#define SPHGRAD_BENCH_REPORT_H
#include "settings.h"
#include "timing.h"
#include <stdbool.h>
#include <stddef.h>

/* command: a folder of bench. Names that begin with a dot are for COMMAND.py, and stand in no file.
 */
void report_open(const char *command, const struct settings *settings);
void report_text(const char *name, const char *value); /* of all that was measured */
void report_number(const char *name, double value);
void report_lattice(const struct settings *settings, int32_t count, double pairs_per_particle);
int report_close(void); /* shows it; the exit status */

enum cell_kind { CELL_NONE, CELL_TEXT, CELL_NUMBER, CELL_COUNT, CELL_TIME };

struct cell {
    const char *name; /* "": of a time that needs no other than those of its row */
    enum cell_kind kind;
    const char *text;
    double number;
    const struct samples *samples; /* [ms], times `number` in the unit */
    const char *unit;              /* of these; NULL: ms */
};

static inline struct cell cell_text(const char *name, const char *text)
{
    return (struct cell){name, CELL_TEXT, text, 0, NULL, NULL};
}
static inline struct cell cell_number(const char *name, double number)
{
    return (struct cell){name, CELL_NUMBER, NULL, number, NULL, NULL};
}
static inline struct cell cell_count(const char *name, int64_t count)
{
    return (struct cell){name, CELL_COUNT, NULL, (double)count, NULL, NULL};
}
static inline struct cell cell_time(const char *name, const struct samples *samples,
                                    double unit_of_ms, const char *unit)
{
    const enum cell_kind kind = samples->count ? CELL_TIME : CELL_NONE;
    return (struct cell){name, kind, NULL, unit_of_ms, samples, unit};
}
static inline struct cell cell_ms(const char *name, const struct samples *samples)
{
    return cell_time(name, samples, 1, NULL);
}
static inline struct cell cell_if(bool there, struct cell cell)
{
    cell.kind = there ? cell.kind : CELL_NONE;
    return cell;
}

/* Each time of a row is a benchmark: NAME OF THE TABLE/TEXTS OF THE ROW/NAME OF THE CELL, and has
 * the row's numbers as counters. */
void table_begin(const char *name);
void table_add(const struct cell *cells, size_t count);
#define TABLE_ROW(...)                                                                             \
    table_add((const struct cell[]){__VA_ARGS__},                                                  \
              sizeof((const struct cell[]){__VA_ARGS__}) / sizeof(struct cell))
#endif
