/* SPDX-License-Identifier: MIT */
/* What a command has measured: rows of cells, each with a name and a unit. The same table is
 * printed, written as CSV, and added to the report in JSON (report.h). */
#ifndef SPHGRAD_BENCH_TABLE_H
#define SPHGRAD_BENCH_TABLE_H
#include "timing.h"
#include <stdbool.h>
#include <stddef.h>

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
    return (struct cell){.head = head, .key = key, .kind = CELL_TEXT, .text = text};
}
static inline struct cell cell_number(const char *head, const char *key, const char *format,
                                      double number)
{
    return (struct cell){
        .head = head, .key = key, .kind = CELL_NUMBER, .format = format, .number = number};
}
static inline struct cell cell_count(const char *head, const char *key, int64_t count)
{
    return (struct cell){.head = head, .key = key, .kind = CELL_COUNT, .number = (double)count};
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

/* Columns from the first row on; sections begin with a row. */
struct table {
    const char *name; /* what the names of its benchmarks begin with */
    int32_t column_count, row_count, row_room, section_count, section_room;
    struct cell *cells;
    struct section {
        int32_t row;
        const char *title;
    } * sections;
};

/* The table and the texts below last to the end of the program, names and samples must, too. */
struct table *table_create(const char *name);

/* As many cells in each row: anything else ends the program. */
void table_add(struct table *table, const struct cell *cells, size_t count);
#define TABLE_ROW(table, ...)                                                                      \
    table_add(table, (const struct cell[]){__VA_ARGS__},                                           \
              sizeof((const struct cell[]){__VA_ARGS__}) / sizeof(struct cell))
const struct cell *table_row(const struct table *table, int32_t row);

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

__attribute__((format(printf, 1, 2))) const char *table_text(const char *format, ...);
const char *text_grouped(int64_t value);    /* 1234567 as "1 234 567" */
const char *text_time(double milliseconds); /* four digits are more than two runs agree on */
#endif
