/* SPDX-License-Identifier: MIT */
/* What a command has measured: texts, numbers and times, each with a name and a unit, go to
 * report.py, which prints tables, writes CSV, and JSON in Google Benchmark's format, and draws.
 * What is printed between report_open and report_close goes the same way, so that all stays in
 * order. */
#ifndef SPHGRAD_BENCH_REPORT_H
#define SPHGRAD_BENCH_REPORT_H
#include "settings.h"
#include "timing.h"
#include <stdbool.h>
#include <stddef.h>

/* command: a folder of bench. The JSON's context holds date, host, processors, library, compiler
 * and instruction set already. */
void report_open(const char *command, const struct settings *settings);
void report_number(const char *name, double value); /* more of the context */
/* How many particles there are, in a lattice of the settings, and pairs a particle. */
void report_lattice(const struct settings *settings, int32_t count, double pairs);
int report_close(void); /* writes the JSON, if one is wanted; the exit status */

/* The usual beginning: opens, prints that lattice, with `more` behind it, and names the machine. */
void report_begin(const char *command, const struct settings *settings, int32_t count, double pairs,
                  const char *more);
/* Prints one line if others kept the processors from the program while these samples were taken. */
void report_if_busy(const struct settings *settings, const struct samples *samples);

/* What report.py shall do, a word and its arguments:
 *   text NAME VALUE         more of the context. Here and in rows names with a dot in front are for
 *                           COMMAND.py alone
 *   machine                 prints the lines that name the machine
 *   table NAME              begins a table; its benchmarks are NAME/TEXTS OF A ROW/COLUMN
 *   section [TITLE]         rows below stand under the heads again, the first of which reads TITLE;
 *                           without one after a blank line
 *   print, turned           the table so far, rows as lines or as columns
 *   times                   the table into the JSON: each time is a benchmark, and has the numbers
 *                           of its row as counters
 *   csv FOLDER NAME         the same as a file; a time becomes KEY_UNIT, and that with _least,
 * _most show FUNCTION WORD...   by a function of COMMAND/COMMAND.py draw FOLDER SCRIPT PARTS
 * ASSIGNMENT...   SCRIPT, made of files of bench, run by gnuplot drawn FOLDER TABLES PICTURES says
 * what was written */
#define REPORT(...) report_tell(__VA_ARGS__, NULL)
void report_tell(const char *word, ...);

/* ---- Rows ----------------------------------------------------------------------------------- */

enum cell_kind { CELL_NONE, CELL_TEXT, CELL_NUMBER, CELL_COUNT, CELL_TIME };

/* Names, format and unit of a column are those of its first cell. */
struct cell {
    const char *head; /* above what is printed; NULL: not printed */
    const char *key;  /* in files; NULL: not there. "": of a time, which needs no other name */
    enum cell_kind kind;
    const char *text;
    const char *format; /* of a number what printf takes; of a time the same for three, median,
                           least and most. NULL: as few digits as two runs agree on */
    double number;
    const struct samples *samples; /* [ms], times `number` in the unit */
    const char *unit;              /* of these; NULL: ms */
};

static inline struct cell cell_text(const char *head, const char *key, const char *text)
{
    return (struct cell){head, key, CELL_TEXT, text, NULL, 0, NULL, NULL};
}
static inline struct cell cell_number(const char *head, const char *key, const char *format,
                                      double number)
{
    return (struct cell){head, key, CELL_NUMBER, NULL, format, number, NULL, NULL};
}
static inline struct cell cell_count(const char *head, const char *key, int64_t count)
{
    return (struct cell){head, key, CELL_COUNT, NULL, NULL, (double)count, NULL, NULL};
}
static inline struct cell cell_time(const char *head, const char *key,
                                    const struct samples *samples, double unit_of_ms,
                                    const char *unit, const char *format)
{
    const enum cell_kind kind = samples->count ? CELL_TIME : CELL_NONE;
    return (struct cell){head, key, kind, NULL, format, unit_of_ms, samples, unit};
}
static inline struct cell cell_ms(const char *head, const char *key, const struct samples *samples)
{
    return cell_time(head, key, samples, 1, NULL, NULL);
}
static inline struct cell cell_if(bool there, struct cell cell) /* else it is printed as "-" */
{
    cell.kind = there ? cell.kind : CELL_NONE;
    return cell;
}

/* As many cells in each row of a table. */
void table_add(const struct cell *cells, size_t count);
#define TABLE_ROW(...)                                                                             \
    table_add((const struct cell[]){__VA_ARGS__},                                                  \
              sizeof((const struct cell[]){__VA_ARGS__}) / sizeof(struct cell))

/* These last to the end of the program. */
__attribute__((format(printf, 1, 2))) const char *text_of(const char *format, ...);
const char *text_grouped(int64_t value);    /* 1234567 as "1 234 567" */
const char *text_time(double milliseconds); /* four digits are more than two runs agree on */
#endif
