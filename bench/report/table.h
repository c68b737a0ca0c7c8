/* SPDX-License-Identifier: MIT */
/* What a command has measured: rows of cells under columns, each with a name and a unit. The same
 * table is printed, written as CSV, and added to the report in JSON (report.h). */
#ifndef SPHGRAD_BENCH_TABLE_H
#define SPHGRAD_BENCH_TABLE_H
#include "timing.h"
#include <stddef.h>

/* Formats: of a number what printf takes for a double; of a time the same for three, median, least
 * and most. NULL: as few digits as two runs agree on. */
struct column {
    const char *head;   /* above what is printed; NULL: not printed */
    const char *key;    /* in files; NULL: not there. "": of a time, which needs no other name */
    const char *format; /* of numbers and times */
    const char *unit;   /* of times; NULL: ms */
};

enum cell_kind { CELL_NONE, CELL_TEXT, CELL_NUMBER, CELL_COUNT, CELL_TIME };

struct cell {
    enum cell_kind kind;
    const char *text;
    double number;
    const struct samples *samples; /* [ms], times `number` in the column's unit */
};

static inline struct cell cell_none(void) /* printed as "-" */
{
    return (struct cell){.kind = CELL_NONE};
}
static inline struct cell cell_text(const char *text)
{
    return (struct cell){.kind = CELL_TEXT, .text = text};
}
static inline struct cell cell_number(double number)
{
    return (struct cell){.kind = CELL_NUMBER, .number = number};
}
static inline struct cell cell_count(int64_t count) /* printed as "1 234 567" */
{
    return (struct cell){.kind = CELL_COUNT, .number = (double)count};
}
static inline struct cell cell_time(const struct samples *samples, double unit_of_ms)
{
    return (struct cell){
        .kind = samples->count ? CELL_TIME : CELL_NONE, .number = unit_of_ms, .samples = samples};
}

struct table;

enum { TABLE_COLUMNS_MOST = 32 };

/* The columns end with one that has neither head nor key. They, the texts of cells and the samples
 * last at least as long as the table, which lasts to the end of the program. name: what the names
 * of its benchmarks begin with. */
struct table *table_create(const char *name, const struct column *columns);

/* One cell a column: anything else ends the program. */
void table_add(struct table *table, const struct cell *cells, size_t count);
#define TABLE_ROW(table, ...)                                                                      \
    table_add(table, (const struct cell[]){__VA_ARGS__},                                           \
              sizeof((const struct cell[]){__VA_ARGS__}) / sizeof(struct cell))

/* A text that lasts as long as the table. */
__attribute__((format(printf, 1, 2))) const char *table_text(const char *format, ...);

/* What follows stands under the heads again, the first of which reads `title`; NULL: after a blank
 * line. */
void table_section(struct table *table, const char *title);

/* Rows as lines; or as columns: then the heads are the first words of lines, and the least and most
 * of times stand in a line beneath. A line without any value is left out. */
void table_print(const struct table *table);
void table_print_turned(const struct table *table);

/* Comma-separated in folder/name, after a line with machine and date. A time has three columns:
 * KEY_UNIT, and that with _least and _most. */
void table_write_csv(const struct table *table, const char *folder, const char *name);

/* What a report takes from it. */
int32_t table_rows(const struct table *table);
const struct cell *table_row(const struct table *table, int32_t row);
const struct column *table_columns(const struct table *table);
const char *table_name(const struct table *table);
#endif
