#define _POSIX_C_SOURCE 200809L /* getline, strndup */
#include "csv.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* One reading of one file. */
struct reader {
    const char *path;
    const char *const *required;
    struct csv_table *table;
    int64_t line;
    int32_t capacity; /* rows that fit */
    char *message;
    size_t message_size;
};

__attribute__((format(printf, 2, 3))) static bool refuse(struct reader *reader, const char *format,
                                                         ...)
{
    char reason[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    if (reader->line > 0)
        snprintf(reader->message, reader->message_size, "%s, line %lld: %s", reader->path,
                 (long long)reader->line, reason);
    else
        snprintf(reader->message, reader->message_size, "%s: %s", reader->path, reason);
    return false;
}

/* Ends the cell at its comma or line end, without the blanks and quotes around it; *next is where
 * the following cell starts, NULL after the last. */
static char *take_cell(char *cell, char **next)
{
    char *end = cell + strcspn(cell, ",\r\n");
    *next = *end == ',' ? end + 1 : NULL;
    while (end > cell && (isspace((unsigned char)end[-1]) || end[-1] == '"'))
        end--;
    *end = '\0';
    while (isspace((unsigned char)*cell) || *cell == '"')
        cell++;
    return cell;
}

static int32_t count_cells(const char *line)
{
    int32_t cells = 1;
    for (; *line; line++)
        cells += *line == ',';
    return cells;
}

static bool read_header(struct reader *reader, char *line)
{
    struct csv_table *table = reader->table;
    table->names = calloc((size_t)count_cells(line), sizeof *table->names);
    if (!table->names)
        return refuse(reader, "out of memory");
    for (char *cell = line, *next; cell; cell = next) {
        char *name = take_cell(cell, &next);
        if (csv_column(table, name) >= 0)
            return refuse(reader, "column '%.40s' appears twice", name);
        table->names[table->column_count] = strdup(name);
        if (!table->names[table->column_count])
            return refuse(reader, "out of memory");
        table->column_count++;
    }
    for (const char *const *name = reader->required; *name; name++)
        if (csv_column(table, *name) < 0)
            return refuse(reader, "there is no column '%s'", *name);
    return true;
}

static bool grow(struct reader *reader)
{
    struct csv_table *table = reader->table;
    if (table->row_count < reader->capacity)
        return true;
    if (reader->capacity > INT32_MAX / 2)
        return refuse(reader, "too many rows");
    const int32_t capacity = reader->capacity > 0 ? 2 * reader->capacity : 1024;
    const size_t row_size = (size_t)table->column_count * sizeof *table->values;
    double *values = realloc(table->values, (size_t)capacity * row_size);
    if (values)
        table->values = values;
    int64_t *lines = realloc(table->lines, (size_t)capacity * sizeof *lines);
    if (lines)
        table->lines = lines;
    if (!values || !lines)
        return refuse(reader, "out of memory");
    reader->capacity = capacity;
    return true;
}

static bool parse_cell(struct reader *reader, int32_t column, const char *cell, double *value)
{
    char *end;
    const char *name = reader->table->names[column];
    *value = strtod(cell, &end);
    if (*cell == '\0')
        return refuse(reader, "column '%.40s' is empty", name);
    if (*end != '\0')
        return refuse(reader, "column '%.40s': '%.40s' is not a number", name, cell);
    if (!isfinite(*value))
        return refuse(reader, "column '%.40s': '%.40s' is not finite", name, cell);
    return true;
}

static bool read_row(struct reader *reader, char *line)
{
    struct csv_table *table = reader->table;
    const int32_t cells = count_cells(line);
    if (cells != table->column_count)
        return refuse(reader, "%d cells, but the header has %d", cells, table->column_count);
    if (!grow(reader))
        return false;
    double *row = table->values + (ptrdiff_t)table->row_count * table->column_count;
    char *next = line;
    for (int32_t column = 0; column < table->column_count; column++)
        if (!parse_cell(reader, column, take_cell(next, &next), &row[column]))
            return false;
    table->lines[table->row_count++] = reader->line;
    return true;
}

static bool read_line(struct reader *reader, char *line)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    if (reader->line == 1 && strncmp(line, byte_order_mark, 3) == 0)
        line += 3;
    const char *first = line + strspn(line, " \t\r\n");
    if (*first == '\0' || *first == '#')
        return true;
    return reader->table->column_count == 0 ? read_header(reader, line) : read_row(reader, line);
}

static bool read_lines(struct reader *reader, FILE *file)
{
    char *line = NULL;
    size_t size = 0;
    bool good = true;
    errno = 0;
    while (good && getline(&line, &size, file) >= 0) {
        reader->line++;
        good = read_line(reader, line);
    }
    const int error = errno;
    free(line);
    if (!good)
        return false;
    reader->line = 0;
    if (ferror(file))
        return refuse(reader, "%s", strerror(error));
    if (reader->table->row_count == 0)
        return refuse(reader, "no particles in it");
    return true;
}

bool csv_read(const char *path, const char *const required[], struct csv_table *table,
              char *message, size_t message_size)
{
    *table = (struct csv_table){0};
    struct reader reader = {.path = path,
                            .required = required,
                            .table = table,
                            .message = message,
                            .message_size = message_size};
    FILE *file = fopen(path, "r");
    if (!file)
        return refuse(&reader, "%s", strerror(errno));
    const bool good = read_lines(&reader, file);
    fclose(file);
    if (!good)
        csv_destroy(table);
    return good;
}

void csv_destroy(struct csv_table *table)
{
    for (int32_t column = 0; column < table->column_count; column++)
        free(table->names[column]);
    free(table->names);
    free(table->values);
    free(table->lines);
    *table = (struct csv_table){0};
}

int32_t csv_column(const struct csv_table *table, const char *name)
{
    for (int32_t column = 0; column < table->column_count; column++)
        if (strcasecmp(table->names[column], name) == 0)
            return column;
    return -1;
}

double csv_value(const struct csv_table *table, int32_t row, int32_t column)
{
    return table->values[(ptrdiff_t)row * table->column_count + column];
}
