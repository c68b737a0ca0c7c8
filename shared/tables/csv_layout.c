/* SPDX-License-Identifier: MIT */
#include "csv_layout.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LINES_BEFORE_NAMES = 200, /* at most */
    LINES_BETWEEN = 3         /* names and numbers: units, rulers */
};

bool csv_is_remark(struct span line)
{
    line = span_trim(line);
    return line.start == line.end || *line.start == '#' || *line.start == '%' ||
           *line.start == '!' || span_begins(line, "//");
}

/* Names may stand in a comment, or behind a word. */
static struct span bare_names(struct span line)
{
    static const char *const words[] = {"ITEM: ATOMS", "VARIABLES"};
    line = span_trim(line);
    while (line.start < line.end && strchr("#%!/", *line.start))
        ++line.start;
    line = span_trim(line);
    for (int k = 0; k < 2; ++k)
        if (span_begins(line, words[k]))
            line.start += strlen(words[k]);
    line = span_trim(line);
    if (line.start < line.end && *line.start == '=')
        ++line.start;
    return line;
}

static bool is_number(struct span cell, char separator)
{
    double value;
    return cell_number(cell, separator, &value);
}

static int32_t count_numbers(const struct cells *cells, char separator)
{
    int32_t count = 0;
    for (int32_t k = 0; k < cells->count; ++k)
        count += is_number(cells->at[k], separator);
    return count;
}

/* ---- Names ---------------------------------------------------------------------------------- */

/* Whether the line that was split may be the first row under these names. */
static bool fits(const struct csv *csv, const struct cells *row, char separator)
{
    if (row->count < csv->least_cells || cells_filled(row) > csv->most_cells)
        return false;
    for (int axis = 0; axis < 3; ++axis) {
        const int32_t column = csv->columns[QUANTITY_X + axis];
        if (column >= 0 && !is_number(row->at[column], separator))
            return false;
    }
    return true;
}

/* Rows that begin with a quoted name of their own, for which there is no name of a column. */
static bool name_rows(struct csv *csv, const struct cells *row, struct span line)
{
    int32_t twice;
    const struct span trimmed = span_trim(line);
    if (row->count != csv->names.count + 1 || trimmed.start == trimmed.end ||
        *trimmed.start != '"' || !cells_prepend(&csv->names, (struct span){line.start, line.start}))
        return false;
    csv->least_cells = csv->most_cells = row->count;
    return columns_find(&csv->names, csv->columns, &twice);
}

/* The separator of a first row; that of the names is tried first. '\0': there is none. */
static char separator_of(struct csv *csv, struct cells *row, struct span line, char of_names)
{
    const char order[] = {of_names, ';', '\t', '|', ',', ' ', '\0'};
    for (const char *separator = order; *separator; ++separator)
        if (cells_split(row, line, *separator) &&
            (fits(csv, row, *separator) ||
             (name_rows(csv, row, line) && fits(csv, row, *separator))))
            return *separator;
    return '\0';
}

static bool has_numbers(struct cells *row, struct span line)
{
    for (const char *separator = cell_separators; *separator; ++separator)
        if (cells_split(row, line, *separator) && count_numbers(row, *separator) > 0)
            return true;
    return false;
}

/* Looks for the first row from where the file stands, the line below the names. first_line is that
 * row, or what stands in its place. */
static bool find_first_row(struct csv *csv, char of_names)
{
    struct cells row = {0};
    struct span line;
    int between = 0;
    char separator = '\0';
    csv->separator = of_names;
    csv->first_line = csv->text.line + 1;
    while (!separator && between <= LINES_BETWEEN && text_file_line(&csv->text, &line)) {
        if (csv_is_remark(line))
            continue;
        csv->first_line = csv->text.line;
        separator = separator_of(csv, &row, line, of_names);
        between += has_numbers(&row, line) ? LINES_BETWEEN + 1 : 1;
    }
    cells_destroy(&row);
    if (separator)
        csv->separator = separator;
    return separator != '\0';
}

static bool are_names(struct csv *csv, struct span line, char separator, int32_t *twice)
{
    *twice = -1;
    if (!cells_split(&csv->names, bare_names(line), separator))
        return false;
    csv->most_cells = csv->names.count;
    csv->least_cells = cells_filled(&csv->names);
    return columns_find(&csv->names, csv->columns, twice);
}

/* Keeps what was refused first. */
static void refuse_twice(const struct csv *csv, int64_t line, int32_t twice, char *reason,
                         size_t size)
{
    const struct span name = csv->names.at[twice];
    const int shown = (int)(name.end - name.start < 40 ? name.end - name.start : 40);
    if (!*reason)
        snprintf(reason, size,
                 "line %lld: column '%.*s' appears twice, or another name means the same",
                 (long long)line, shown, name.start);
}

/* Goes on to the next line that can be one of names, and to the row below it. */
static bool find_names(struct csv *csv, int64_t *candidate, char *candidate_separator, char *reason,
                       size_t reason_size)
{
    struct span line;
    while (csv->text.line < LINES_BEFORE_NAMES && text_file_line(&csv->text, &line)) {
        const size_t next = csv->text.next;
        const int64_t number = csv->text.line;
        for (const char *separator = cell_separators; *separator; ++separator) {
            int32_t twice;
            const bool names = are_names(csv, line, *separator, &twice);
            if (names && find_first_row(csv, *separator))
                return true;
            if (twice >= 0)
                refuse_twice(csv, number, twice, reason, reason_size);
            else if (names && *candidate == 0) {
                *candidate = number;
                *candidate_separator = *separator;
            }
            csv->text.next = next;
            csv->text.line = number;
        }
    }
    return false;
}

/* Names that are right, above what is no row: reading it says what is wrong there. */
static bool take_candidate(struct csv *csv, int64_t candidate, char separator)
{
    struct span line = {NULL, NULL};
    int32_t twice;
    text_file_rewind(&csv->text);
    while (csv->text.line < candidate && text_file_line(&csv->text, &line))
        continue;
    if (candidate == 0 || !are_names(csv, line, separator, &twice))
        return false;
    find_first_row(csv, separator);
    return true;
}

/* ---- No names ------------------------------------------------------------------------------- */

static void forget_names(struct csv *csv)
{
    csv->names.count = 0;
    for (int k = 0; k < QUANTITIES; ++k)
        csv->columns[k] = -1;
}

static void take_positions(struct csv *csv, int32_t first, int32_t width)
{
    for (int axis = 0; axis < width; ++axis)
        csv->columns[QUANTITY_X + axis] = first + axis;
}

/* The next of `Properties=species:S:1:pos:R:3:...` in the second line of extended XYZ. */
static bool next_property(struct span *at, struct span *name, int32_t *width)
{
    struct span part[3];
    for (int k = 0; k < 3; ++k) {
        part[k] = (struct span){at->start, at->start};
        while (part[k].end < at->end && *part[k].end != ':')
            ++part[k].end;
        at->start = part[k].end + (part[k].end < at->end);
    }
    double count;
    if (!cell_number(part[2], ',', &count) || !(count >= 1 && count <= 1000))
        return false;
    *name = part[0];
    *width = (int32_t)count;
    return true;
}

/* What follows the word in a line, up to a blank or a quotation mark. */
static bool value_of(struct span line, const char *word, struct span *value)
{
    while (line.start < line.end && !span_begins(line, word))
        ++line.start;
    if (line.start == line.end)
        return false;
    value->start = line.start + strlen(word);
    value->start += value->start < line.end && *value->start == '"';
    value->end = value->start;
    while (value->end < line.end && !isspace((unsigned char)*value->end) && *value->end != '"')
        ++value->end;
    return true;
}

/* Where the position stands, 1 where nothing is said; -1: nowhere. */
static int32_t position_column(struct span words)
{
    struct span at = words, name;
    int32_t column = 0, width = 0;
    if (!value_of(words, "Properties=", &at))
        return 1;
    for (; at.start < at.end && next_property(&at, &name, &width); column += width)
        if (name.end - name.start == 3 && span_begins(name, "pos"))
            return width == 3 ? column : -1;
    return -1;
}

/* XYZ: the number of particles, a line of words, then a name and a position in each line, or the
 * columns that the words list. */
static bool is_xyz(struct csv *csv, char *reason, size_t size)
{
    struct span line[3], listed;
    struct cells row = {0};
    double count;
    text_file_rewind(&csv->text);
    bool good = true;
    for (int k = 0; k < 3; ++k)
        good = good && text_file_line(&csv->text, &line[k]);
    good = good && cell_number(span_trim(line[0]), ',', &count) && count >= 1 && count < 1e15 &&
           cells_split(&row, line[2], ' ');
    const bool extended = good && value_of(line[1], "Properties=", &listed);
    const int32_t first = good ? position_column(line[1]) : 0;
    if (extended && (first < 0 || row.count < first + 3))
        snprintf(reason, size, "extended XYZ whose Properties have no pos:R:3 that its rows show");
    good = good && first >= 0 && row.count >= first + 3 && (extended || !is_number(row.at[0], ' '));
    for (int32_t k = first; good && k < first + 3; ++k)
        good = extended || is_number(row.at[k], ' ');
    if (good) {
        forget_names(csv);
        take_positions(csv, first, 3);
        csv->separator = ' ';
        csv->first_line = 3;
        csv->most_rows = (int64_t)count;
        csv->least_cells = csv->most_cells = row.count;
    }
    cells_destroy(&row);
    return good;
}

/* Numbers all along, at least two. */
static char separator_of_numbers(struct cells *row, struct span line)
{
    for (const char *separator = cell_separators; *separator; ++separator)
        if (cells_split(row, line, *separator) && cells_filled(row) > 1 &&
            count_numbers(row, *separator) == cells_filled(row))
            return *separator;
    return '\0';
}

/* Words above the numbers, as many as these: names that say nothing to us. */
static bool are_unknown_names(struct csv *csv, struct span above, int32_t count)
{
    for (const char *separator = cell_separators; *separator; ++separator)
        if (cells_split(&csv->names, bare_names(above), *separator) &&
            (csv->names.count == count || cells_filled(&csv->names) == count) &&
            count_numbers(&csv->names, *separator) == 0)
            return true;
    return false;
}

static bool refuse_names(const struct csv *csv, char *reason, size_t size)
{
    size_t length =
        (size_t)snprintf(reason, size, "no columns for the positions (x, y, z); found:");
    for (int32_t k = 0; k < csv->names.count; ++k) {
        const struct span name = csv->names.at[k];
        const int shown = (int)(name.end - name.start < 30 ? name.end - name.start : 30);
        if (length + (size_t)shown + 30 > size) {
            snprintf(reason + length, size - length, " and %d more", (int)(csv->names.count - k));
            break;
        }
        length += (size_t)snprintf(reason + length, size - length, "%s %.*s", k ? "," : "", shown,
                                   name.start);
    }
    for (char *at = reason; *at; ++at)
        if (iscntrl((unsigned char)*at))
            *at = ' ';
    return false;
}

/* The cells of the line, by what cuts it into most. */
static bool refuse_line(struct csv *csv, struct span line, char *reason, size_t size)
{
    char best = ',';
    int32_t most = 0;
    for (const char *separator = cell_separators; *separator; ++separator)
        if (cells_split(&csv->names, bare_names(line), *separator) && csv->names.count > most) {
            most = csv->names.count;
            best = *separator;
        }
    cells_split(&csv->names, bare_names(line), best);
    return refuse_names(csv, reason, size);
}

static bool take_numbers(struct csv *csv, const struct cells *row, struct span above, char *reason,
                         size_t size)
{
    const int32_t count = cells_filled(row);
    if (are_unknown_names(csv, above, count))
        return refuse_names(csv, reason, size);
    forget_names(csv);
    if (count > 3) {
        snprintf(
            reason, size,
            "no line of names above the numbers, and %d columns: which are x, y, z? Write their "
            "names in a first line",
            (int)count);
        return false;
    }
    take_positions(csv, 0, count);
    csv->first_line = csv->text.line;
    csv->least_cells = csv->most_cells = count;
    return true;
}

static bool find_numbers(struct csv *csv, char *reason, size_t size)
{
    struct cells row = {0};
    struct span line, above = {"", ""}, first = {"", ""};
    bool good = false;
    text_file_rewind(&csv->text);
    csv->separator = '\0';
    while (!csv->separator && text_file_line(&csv->text, &line)) {
        const struct span trimmed = span_trim(line);
        if (trimmed.start == trimmed.end)
            continue;
        if (first.start == first.end)
            first = line;
        csv->separator = separator_of_numbers(&row, line);
        above = csv->separator ? above : line;
    }
    if (csv->separator)
        good = take_numbers(csv, &row, above, reason, size);
    else if (first.start == first.end)
        snprintf(reason, size, "no particles in it");
    else
        refuse_line(csv, first, reason, size);
    cells_destroy(&row);
    return good;
}

bool csv_find_layout(struct csv *csv, char *reason, size_t reason_size)
{
    int64_t candidate = 0;
    char separator = ',';
    csv->most_rows = -1;
    *reason = '\0';
    if (is_xyz(csv, reason, reason_size))
        return true;
    if (*reason)
        return false;
    text_file_rewind(&csv->text);
    if (find_names(csv, &candidate, &separator, reason, reason_size) ||
        (!*reason && take_candidate(csv, candidate, separator)))
        return true;
    return *reason ? false : find_numbers(csv, reason, reason_size);
}
