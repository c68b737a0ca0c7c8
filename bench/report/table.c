/* SPDX-License-Identifier: MIT */
#include "table.h"
#include "machine.h"
#include "numbers.h"
#include "plot.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct table *table_create(const char *name)
{
    struct table *table = allocate_to_the_end(1, sizeof *table);
    table->name = name;
    return table;
}

/* Room for one more item. */
static void *grown(void *items, int32_t count, int32_t *room, size_t size)
{
    if (count < *room)
        return items;
    *room = 2 * *room + 16;
    void *larger = allocate_to_the_end((size_t)*room, size);
    return items ? memcpy(larger, items, (size_t)count * size) : larger;
}

void table_add(struct table *table, const struct cell *cells, size_t count)
{
    if (table->row_count > 0 && count != (size_t)table->column_count)
        abort();
    table->column_count = (int32_t)count;
    table->cells = grown(table->cells, table->row_count, &table->row_room, count * sizeof *cells);
    memcpy(table->cells + (size_t)table->row_count++ * count, cells, count * sizeof *cells);
}

void table_section(struct table *table, const char *title)
{
    table->sections =
        grown(table->sections, table->section_count, &table->section_room, sizeof *table->sections);
    table->sections[table->section_count++] = (struct section){table->row_count, title};
}

const struct cell *table_row(const struct table *table, int32_t row)
{
    return table->cells + (ptrdiff_t)row * table->column_count;
}

/* ---- Texts ---------------------------------------------------------------------------------- */

const char *table_text(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const size_t size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
    va_end(arguments);
    char *text = allocate_to_the_end(1, size);
    va_start(arguments, format);
    vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return text;
}

const char *text_grouped(int64_t value)
{
    return value < 1000 ? table_text("%d", (int)value)
                        : table_text("%s %03d", text_grouped(value / 1000), (int)(value % 1000));
}

const char *text_time(double milliseconds)
{
    const int decimals = milliseconds < 1 ? 3 : milliseconds < 100 ? 2 : milliseconds < 1000;
    return table_text("%.*f", decimals, milliseconds);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
static const char *text_of(const struct table *table, int32_t r, int32_t c)
{
    const struct cell *cell = &table_row(table, r)[c];
    const char *format = table_row(table, 0)[c].format;
    if (cell->kind == CELL_TEXT)
        return cell->text;
    if (cell->kind == CELL_NUMBER)
        return table_text(format ? format : "%.4g", cell->number);
    if (cell->kind == CELL_COUNT)
        return text_grouped((int64_t)cell->number);
    if (cell->kind == CELL_NONE)
        return "-";
    const struct spread spread = samples_wall(cell->samples);
    const double median = cell->number * spread.median, least = cell->number * spread.min,
                 most = cell->number * spread.max;
    return format ? table_text(format, median, least, most)
                  : table_text("%s (%s-%s)", text_time(median), text_time(least), text_time(most));
}
#pragma GCC diagnostic pop

/* ---- Rows as lines -------------------------------------------------------------------------- */

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Of the first cell that holds something. */
static enum cell_kind kind_of(const struct table *table, int32_t c)
{
    for (int32_t r = 0; r < table->row_count; ++r)
        if (table_row(table, r)[c].kind != CELL_NONE)
            return table_row(table, r)[c].kind;
    return CELL_NONE;
}

static int width_of(const struct table *table, int32_t c)
{
    int width = (int)strlen(table->cells[c].head);
    for (int32_t k = 0; c == 0 && k < table->section_count; ++k)
        if (table->sections[k].title)
            width = larger(width, (int)strlen(table->sections[k].title));
    for (int32_t r = 0; r < table->row_count; ++r)
        width = larger(width, (int)strlen(text_of(table, r, c)));
    return width;
}

/* Texts to the left, numbers to the right; r < 0: the heads, the first of which reads `title`.
 * Trailing blanks are left out. */
static void print_line(const struct table *table, const int *widths, int32_t r, const char *title)
{
    int wanted = 0;
    for (int32_t c = 0; c < table->column_count; ++c) {
        const char *head = table->cells[c].head;
        if (!head)
            continue;
        const char *text = r >= 0 ? text_of(table, r, c) : title ? title : head;
        const int blanks = larger(widths[c] - (int)strlen(text), 0);
        const enum cell_kind kind = kind_of(table, c);
        const bool left = kind == CELL_TEXT || kind == CELL_NONE;
        title = NULL;
        wanted += 2 + (left ? 0 : blanks);
        if (*text) {
            printf("%*s%s", wanted, "", text);
            wanted = 0;
        }
        wanted += left ? blanks : 0;
    }
    printf("\n");
}

void table_print(const struct table *table)
{
    if (table->row_count == 0)
        return;
    int *widths = allocate_to_the_end((size_t)table->column_count, sizeof *widths);
    int32_t next = 0;
    for (int32_t c = 0; c < table->column_count; ++c)
        if (table->cells[c].head)
            widths[c] = width_of(table, c);
    if (table->section_count == 0 || table->sections[0].row > 0) {
        printf("\n");
        print_line(table, widths, -1, NULL);
    }
    for (int32_t r = 0; r < table->row_count; ++r) {
        for (; next < table->section_count && table->sections[next].row == r; ++next) {
            printf("\n");
            if (table->sections[next].title)
                print_line(table, widths, -1, table->sections[next].title);
        }
        print_line(table, widths, r, NULL);
    }
}

/* ---- Rows as columns ------------------------------------------------------------------------ */

/* range: the least and most of times, else their medians. */
static void print_turned_line(const struct table *table, int32_t c, bool range)
{
    enum { LABEL = 20, WIDTH = 13 };
    printf("  %-*s", LABEL, range ? "  min-max" : table->cells[c].head);
    for (int32_t r = 0; r < table->row_count; ++r) {
        const struct cell *cell = &table_row(table, r)[c];
        const char *text = range ? "" : "-";
        if (cell->kind == CELL_TIME) {
            const struct spread spread = samples_wall(cell->samples);
            text = range ? table_text("%s-%s", text_time(spread.min), text_time(spread.max))
                         : text_time(spread.median);
        } else if (!range)
            text = text_of(table, r, c);
        printf("%*s", WIDTH, text);
    }
    printf("\n");
}

void table_print_turned(const struct table *table)
{
    for (int32_t c = 0; c < table->column_count; ++c) {
        const struct cell *column = &table->cells[c];
        const enum cell_kind kind = kind_of(table, c);
        if (column->head && !*column->head && !column->key)
            printf("\n");
        else if (column->head && kind != CELL_NONE)
            print_turned_line(table, c, false);
        if (column->head && kind == CELL_TIME)
            print_turned_line(table, c, true);
    }
}

/* ---- CSV ------------------------------------------------------------------------------------ */

static void write_head(FILE *file, const struct table *table, int32_t c)
{
    const struct cell *column = &table->cells[c];
    const char *unit = column->unit ? column->unit : "ms", *bar = *column->key ? "_" : "";
    if (kind_of(table, c) != CELL_TIME)
        fputs(column->key, file);
    else
        fprintf(file, "%s%s%s,%s%s%s_least,%s%s%s_most", column->key, bar, unit, column->key, bar,
                unit, column->key, bar, unit);
}

static void write_cell(FILE *file, const struct table *table, int32_t r, int32_t c)
{
    const struct cell *cell = &table_row(table, r)[c];
    if (cell->kind == CELL_TEXT)
        fprintf(file, strchr(cell->text, ',') ? "\"%s\"" : "%s", cell->text);
    else if (cell->kind == CELL_TIME) {
        const struct spread spread = samples_wall(cell->samples);
        fprintf(file, "%.9g,%.9g,%.9g", cell->number * spread.median, cell->number * spread.min,
                cell->number * spread.max);
    } else if (cell->kind != CELL_NONE)
        fprintf(file, cell->kind == CELL_COUNT ? "%.0f" : "%.9g", cell->number);
    else if (kind_of(table, c) == CELL_TIME)
        fputs(",,", file);
}

void table_write_csv(const struct table *table, const char *folder, const char *name)
{
    FILE *file = plot_file(folder, name);
    fprintf(file, "# %s, %s\n", machine_cpu(), machine_date());
    for (int32_t r = -1; r < table->row_count; ++r) {
        const char *comma = "";
        for (int32_t c = 0; c < table->column_count; ++c)
            if (table->cells[c].key) {
                fputs(comma, file);
                comma = ",";
                if (r < 0)
                    write_head(file, table, c);
                else
                    write_cell(file, table, r, c);
            }
        fputc('\n', file);
    }
    plot_close(file, name);
}
