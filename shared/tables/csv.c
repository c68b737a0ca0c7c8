/* SPDX-License-Identifier: MIT */
#include "csv.h"
#include "csv_layout.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* line: 0 where none is at fault. */
__attribute__((format(printf, 3, 4))) static bool refuse(struct csv *csv, int64_t line,
                                                         const char *format, ...)
{
    char reason[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    if (line > 0)
        snprintf(csv->message, sizeof csv->message, "%.100s, line %lld: %s", csv->path,
                 (long long)line, reason);
    else
        snprintf(csv->message, sizeof csv->message, "%.100s: %s", csv->path, reason);
    csv_destroy(csv);
    return false;
}

bool csv_open(struct csv *csv, const char *path)
{
    char reason[400];
    *csv = (struct csv){.path = path};
    if (!text_file_read(&csv->text, path, reason, sizeof reason) ||
        !csv_find_layout(csv, reason, sizeof reason))
        return refuse(csv, 0, "%s", reason);
    return true;
}

static bool grow(struct csv *csv, int32_t *room)
{
    if (csv->row_count < *room)
        return true;
    if (*room > INT32_MAX / 2)
        return false;
    *room = *room > 0 ? 2 * *room : 1024;
    void *values = realloc(csv->values, (size_t)*room * sizeof *csv->values);
    if (values)
        csv->values = values;
    void *lines = realloc(csv->lines, (size_t)*room * sizeof *csv->lines);
    if (lines)
        csv->lines = lines;
    return values && lines;
}

static bool read_cell(struct csv *csv, struct span cell, enum quantity quantity, double *value)
{
    char column[48];
    const int64_t line = csv->text.line;
    const int shown = (int)(cell.end - cell.start < 40 ? cell.end - cell.start : 40);
    csv_name(csv, quantity, column, sizeof column);
    if (shown == 0)
        return refuse(csv, line, "column '%s' is empty", column);
    if (!cell_number(cell, csv->separator, value))
        return refuse(csv, line, "column '%s': '%.*s' is not a number", column, shown, cell.start);
    if (!isfinite(*value))
        return refuse(csv, line, "column '%s': '%.*s' is not finite", column, shown, cell.start);
    return true;
}

static bool read_row(struct csv *csv, const struct cells *cells)
{
    const int32_t filled = cells_filled(cells);
    const int64_t line = csv->text.line;
    if (cells->count < csv->least_cells || filled > csv->most_cells)
        return refuse(csv, line, "%d cells, but %s %d%s",
                      (int)(filled > csv->most_cells ? filled : cells->count),
                      csv->names.count ? "the header has" : "the first row has",
                      (int)csv->least_cells,
                      csv->text.next == csv->text.size ? "; the file may end too early" : "");
    double *row = csv->values[csv->row_count];
    for (int quantity = 0; quantity < QUANTITIES; ++quantity) {
        const int32_t column = csv->columns[quantity];
        row[quantity] = 0;
        if (column >= 0 &&
            !read_cell(csv, cells->at[column], (enum quantity)quantity, &row[quantity]))
            return false;
    }
    csv->lines[csv->row_count++] = line;
    return true;
}

static bool read_rows(struct csv *csv, struct cells *cells)
{
    int32_t room = 0;
    struct span line;
    text_file_rewind(&csv->text);
    while (csv->row_count != csv->most_rows && text_file_line(&csv->text, &line)) {
        if (csv->text.line < csv->first_line || csv_is_remark(line))
            continue;
        if (span_begins(line, "ITEM:")) { /* the next moment of a dump */
            csv->more = true;
            break;
        }
        if (!grow(csv, &room) || !cells_split(cells, line, csv->separator))
            return refuse(csv, 0, "too many rows, or out of memory");
        if (!read_row(csv, cells))
            return false;
    }
    while (csv->row_count == csv->most_rows && !csv->more && text_file_line(&csv->text, &line))
        csv->more = !csv_is_remark(line);
    if (csv->row_count == 0)
        return refuse(csv, 0, "no particles in it");
    return csv->most_rows <= csv->row_count ||
           refuse(csv, 0, "%d particles, but its first line says %lld", (int)csv->row_count,
                  (long long)csv->most_rows);
}

bool csv_read(struct csv *csv)
{
    struct cells cells = {0};
    const bool good = read_rows(csv, &cells);
    cells_destroy(&cells);
    return good;
}

void csv_destroy(struct csv *csv)
{
    text_file_destroy(&csv->text);
    cells_destroy(&csv->names);
    free(csv->lines);
    free(csv->values);
    csv->lines = NULL;
    csv->values = NULL;
    csv->row_count = 0;
}

const char *csv_name(const struct csv *csv, enum quantity quantity, char *name, size_t size)
{
    static const char *const plain[QUANTITIES] = {"x",  "y",       "z",    "vx",    "vy",
                                                  "vz", "density", "mass", "volume"};
    const int32_t column = csv->columns[quantity];
    if (column < 0 || column >= csv->names.count)
        snprintf(name, size, "%s", plain[quantity]);
    else
        snprintf(name, size, "%.*s", (int)(csv->names.at[column].end - csv->names.at[column].start),
                 csv->names.at[column].start);
    return name;
}
