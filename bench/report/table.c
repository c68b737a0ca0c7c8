/* SPDX-License-Identifier: MIT */
#include "table.h"
#include "machine.h"
#include "numbers.h"
#include "plot.h"
#include "text.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELL_SIZE = 96 };

struct section {
    int32_t row; /* that it begins with */
    const char *title;
};

struct table {
    const char *name;
    const struct column *columns;
    int32_t column_count, row_count, row_room, section_count, section_room;
    struct cell *cells;
    struct section *sections;
};

struct table *table_create(const char *name, const struct column *columns)
{
    struct table *table = allocate_to_the_end(1, sizeof *table);
    *table = (struct table){.name = name, .columns = columns};
    while (columns[table->column_count].head || columns[table->column_count].key)
        ++table->column_count;
    if (table->column_count > TABLE_COLUMNS_MOST)
        abort();
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
    if (count != (size_t)table->column_count)
        abort();
    const size_t size = (size_t)table->column_count * sizeof *cells;
    table->cells = grown(table->cells, table->row_count, &table->row_room, size);
    memcpy(table->cells + (size_t)table->row_count++ * (size_t)table->column_count, cells, size);
}

void table_section(struct table *table, const char *title)
{
    table->sections =
        grown(table->sections, table->section_count, &table->section_room, sizeof *table->sections);
    table->sections[table->section_count++] = (struct section){table->row_count, title};
}

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

int32_t table_rows(const struct table *table)
{
    return table->row_count;
}

const struct cell *table_row(const struct table *table, int32_t row)
{
    return table->cells + (ptrdiff_t)row * table->column_count;
}

const struct column *table_columns(const struct table *table)
{
    return table->columns;
}

const char *table_name(const struct table *table)
{
    return table->name;
}

/* ---- Cells as they are printed -------------------------------------------------------------- */

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
static void format_number(char text[CELL_SIZE], const char *format, double number)
{
    snprintf(text, CELL_SIZE, format ? format : "%.4g", number);
}

static void format_spread(char text[CELL_SIZE], const char *format, const struct spread *spread,
                          double scale)
{
    char median[TEXT_SIZE], least[TEXT_SIZE], most[TEXT_SIZE];
    if (format) {
        snprintf(text, CELL_SIZE, format, scale * spread->median, scale * spread->min,
                 scale * spread->max);
        return;
    }
    text_time(scale * spread->median, median);
    text_time(scale * spread->min, least);
    text_time(scale * spread->max, most);
    snprintf(text, CELL_SIZE, "%.16s (%.16s-%.16s)", median, least, most);
}
#pragma GCC diagnostic pop

static void format_cell(char text[CELL_SIZE], const struct column *column, const struct cell *cell)
{
    switch (cell->kind) {
    case CELL_TEXT:
        snprintf(text, CELL_SIZE, "%s", cell->text);
        break;
    case CELL_NUMBER:
        format_number(text, column->format, cell->number);
        break;
    case CELL_COUNT:
        text_grouped((int64_t)cell->number, text);
        break;
    case CELL_TIME: {
        const struct spread spread = samples_wall(cell->samples);
        format_spread(text, column->format, &spread, cell->number);
        break;
    }
    default:
        snprintf(text, CELL_SIZE, "-");
    }
}

/* ---- Rows as lines -------------------------------------------------------------------------- */

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Texts stand to the left, numbers to the right. */
static bool is_text(const struct table *table, int32_t c)
{
    for (int32_t r = 0; r < table->row_count; ++r)
        if (table_row(table, r)[c].kind != CELL_NONE)
            return table_row(table, r)[c].kind == CELL_TEXT;
    return true;
}

static int width_of(const struct table *table, int32_t c)
{
    char text[CELL_SIZE];
    int width = (int)strlen(table->columns[c].head);
    for (int32_t k = 0; c == 0 && k < table->section_count; ++k)
        if (table->sections[k].title)
            width = larger(width, (int)strlen(table->sections[k].title));
    for (int32_t r = 0; r < table->row_count; ++r) {
        format_cell(text, &table->columns[c], &table_row(table, r)[c]);
        width = larger(width, (int)strlen(text));
    }
    return width;
}

/* A line of which trailing blanks are left out. */
struct line {
    int wanted; /* blanks */
};

static void print_in(struct line *line, const char *text, int width, bool left)
{
    const int blanks = width - (int)strlen(text);
    line->wanted += 2 + (left ? 0 : larger(blanks, 0));
    if (*text) {
        printf("%*s%s", line->wanted, "", text);
        line->wanted = 0;
    }
    line->wanted += left ? larger(blanks, 0) : 0;
}

/* title: instead of the first head. */
static void print_heads(const struct table *table, const int *widths, const char *title)
{
    struct line line = {0};
    printf("\n");
    for (int32_t c = 0; c < table->column_count; ++c)
        if (table->columns[c].head) {
            print_in(&line, title ? title : table->columns[c].head, widths[c], is_text(table, c));
            title = NULL;
        }
    printf("\n");
}

void table_print(const struct table *table)
{
    int widths[TABLE_COLUMNS_MOST] = {0};
    int32_t next = 0;
    for (int32_t c = 0; c < table->column_count; ++c)
        if (table->columns[c].head)
            widths[c] = width_of(table, c);
    if (table->section_count == 0 || table->sections[0].row > 0)
        print_heads(table, widths, NULL);
    for (int32_t r = 0; r < table->row_count; ++r) {
        struct line line = {0};
        for (; next < table->section_count && table->sections[next].row == r; ++next)
            if (table->sections[next].title)
                print_heads(table, widths, table->sections[next].title);
            else
                printf("\n");
        for (int32_t c = 0; c < table->column_count; ++c) {
            char text[CELL_SIZE];
            if (!table->columns[c].head)
                continue;
            format_cell(text, &table->columns[c], &table_row(table, r)[c]);
            print_in(&line, text, widths[c], is_text(table, c));
        }
        printf("\n");
    }
}

/* ---- Rows as columns ------------------------------------------------------------------------ */

enum { TURNED_LABEL = 20, TURNED_WIDTH = 13 };

static bool has_values(const struct table *table, int32_t c)
{
    for (int32_t r = 0; r < table->row_count; ++r)
        if (table_row(table, r)[c].kind != CELL_NONE)
            return true;
    return false;
}

/* The number in front of the bracket, or what stands in it. */
static void split_spread(char text[CELL_SIZE], bool range)
{
    char *bracket = strchr(text, '(');
    if (!bracket)
        return;
    if (range) {
        memmove(text, bracket + 1, strlen(bracket));
        text[strcspn(text, ")")] = '\0';
    } else
        bracket[-1] = '\0';
}

static void print_turned_line(const struct table *table, int32_t c, bool range)
{
    printf("  %-*s", TURNED_LABEL, range ? "  min-max" : table->columns[c].head);
    for (int32_t r = 0; r < table->row_count; ++r) {
        char text[CELL_SIZE];
        format_cell(text, &table->columns[c], &table_row(table, r)[c]);
        split_spread(text, range);
        printf("%*s", TURNED_WIDTH, range && *text == '-' ? "" : text);
    }
    printf("\n");
}

void table_print_turned(const struct table *table)
{
    for (int32_t c = 0; c < table->column_count; ++c) {
        if (!table->columns[c].head)
            continue;
        if (!*table->columns[c].head && !table->columns[c].key) {
            printf("\n");
            continue;
        }
        if (!has_values(table, c))
            continue;
        print_turned_line(table, c, false);
        for (int32_t r = 0; r < table->row_count; ++r)
            if (table_row(table, r)[c].kind == CELL_TIME) {
                print_turned_line(table, c, true);
                break;
            }
    }
}

/* ---- CSV ------------------------------------------------------------------------------------ */

static bool is_time(const struct table *table, int32_t c)
{
    for (int32_t r = 0; r < table->row_count; ++r)
        if (table_row(table, r)[c].kind == CELL_TIME)
            return true;
    return false;
}

static void write_heads(FILE *file, const struct table *table)
{
    static const char *const ends[] = {"", "_least", "_most"};
    const char *comma = "";
    for (int32_t c = 0; c < table->column_count; ++c) {
        const struct column *column = &table->columns[c];
        if (!column->key)
            continue;
        const bool time = is_time(table, c);
        for (int k = 0; k < (time ? 3 : 1); ++k, comma = ",")
            fprintf(file, "%s%s%s%s%s", comma, column->key, time && *column->key ? "_" : "",
                    !time          ? ""
                    : column->unit ? column->unit
                                   : "ms",
                    ends[k]);
    }
    fputc('\n', file);
}

static void write_cell(FILE *file, const struct cell *cell, bool time)
{
    if (cell->kind == CELL_TEXT)
        fprintf(file, strchr(cell->text, ',') ? "\"%s\"" : "%s", cell->text);
    else if (cell->kind == CELL_TIME) {
        const struct spread spread = samples_wall(cell->samples);
        fprintf(file, "%.9g,%.9g,%.9g", cell->number * spread.median, cell->number * spread.min,
                cell->number * spread.max);
    } else if (cell->kind != CELL_NONE)
        fprintf(file, cell->kind == CELL_COUNT ? "%.0f" : "%.9g", cell->number);
    else if (time)
        fputs(",,", file);
}

void table_write_csv(const struct table *table, const char *folder, const char *name)
{
    FILE *file = plot_file(folder, name);
    fprintf(file, "# %s, %s\n", machine_cpu(), machine_date());
    write_heads(file, table);
    for (int32_t r = 0; r < table->row_count; ++r) {
        const char *comma = "";
        for (int32_t c = 0; c < table->column_count; ++c)
            if (table->columns[c].key) {
                fputs(comma, file);
                comma = ",";
                write_cell(file, &table_row(table, r)[c], is_time(table, c));
            }
        fputc('\n', file);
    }
    plot_close(file, name);
}
