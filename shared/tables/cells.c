/* SPDX-License-Identifier: MIT */
#include "cells.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

const char cell_separators[] = ";\t|, ";

static bool add(struct cells *cells, struct span cell)
{
    if (cells->count == cells->room) {
        const int32_t room = cells->room > 0 ? 2 * cells->room : 64;
        struct span *at = realloc(cells->at, (size_t)room * sizeof *at);
        if (!at)
            return false;
        cells->at = at;
        cells->room = room;
    }
    cells->at[cells->count++] = cell;
    return true;
}

bool cells_prepend(struct cells *cells, struct span cell)
{
    if (!add(cells, cell))
        return false;
    memmove(cells->at + 1, cells->at, (size_t)(cells->count - 1) * sizeof *cells->at);
    cells->at[0] = cell;
    return true;
}

static struct span without_quotes(struct span cell)
{
    cell = span_trim(cell);
    const bool quoted = cell.end - cell.start >= 2 && (*cell.start == '"' || *cell.start == '\'') &&
                        cell.end[-1] == *cell.start;
    return quoted ? span_trim((struct span){cell.start + 1, cell.end - 1}) : cell;
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && isspace((unsigned char)*at))
        ++at;
    return at;
}

/* Past the closing quote of what begins with one; two in a row stand for one that is meant. Where
 * nothing closes it, it is a plain sign. */
static const char *skip_quoted(const char *at, const char *end)
{
    const char *close = skip_blanks(at, end);
    if (close == end || *close != '"')
        return at;
    do {
        close = memchr(close + 1, '"', (size_t)(end - close - 1));
        if (!close)
            return at;
        ++close;
    } while (close < end && *close == '"');
    return close;
}

/* The end of brackets with blanks around them, as in "x [m] y [m]" or "[01  x] [02  y]"; or `at`.
 */
static const char *skip_unit(const char *at, const char *end)
{
    const char *open = skip_blanks(at, end);
    if (open == end || (*open != '[' && *open != '('))
        return at;
    const char *close = memchr(open, *open == '[' ? ']' : ')', (size_t)(end - open));
    return close && (close + 1 == end || isspace((unsigned char)close[1])) ? close + 1 : at;
}

static bool split_at_blanks(struct cells *cells, struct span line)
{
    const char *at = skip_blanks(line.start, line.end);
    while (at < line.end) {
        const char *start = at;
        at = skip_unit(skip_quoted(at, line.end), line.end);
        while (at < line.end && !isspace((unsigned char)*at))
            ++at;
        if (*start != '[' && *start != '(')
            at = skip_unit(at, line.end);
        if (!add(cells, without_quotes((struct span){start, at})))
            return false;
        at = skip_blanks(at, line.end);
    }
    return true;
}

bool cells_split(struct cells *cells, struct span line, char separator)
{
    cells->count = 0;
    if (separator == ' ')
        return split_at_blanks(cells, line);
    const char *at = line.start;
    for (;;) {
        const char *start = at;
        at = skip_quoted(at, line.end);
        while (at < line.end && *at != separator)
            ++at;
        if (!add(cells, without_quotes((struct span){start, at})))
            return false;
        if (at == line.end)
            return true;
        ++at;
    }
}

void cells_destroy(struct cells *cells)
{
    free(cells->at);
    *cells = (struct cells){0};
}

int32_t cells_filled(const struct cells *cells)
{
    int32_t count = cells->count;
    while (count > 0 && cells->at[count - 1].start == cells->at[count - 1].end)
        --count;
    return count;
}

static bool is_digit(char c)
{
    return isdigit((unsigned char)c);
}

/* As strtod wants it: a decimal point, an exponent after E, which Fortran writes as D or, where it
 * has three digits, leaves out. */
static void translate(const char *cell, size_t size, bool decimal_comma, char *text)
{
    for (size_t k = 0; k < size; ++k) {
        const char c = cell[k];
        const bool between = k > 0 && (is_digit(cell[k - 1]) || cell[k - 1] == '.');
        const bool before_digit = k + 1 < size && is_digit(cell[k + 1]);
        if (decimal_comma && c == ',' && before_digit)
            *text++ = '.';
        else if (between && (c == 'D' || c == 'd' || c == 'q' || c == 'Q'))
            *text++ = 'e';
        else {
            if (between && before_digit && (c == '+' || c == '-'))
                *text++ = 'e';
            *text++ = c;
        }
    }
    *text = '\0';
}

bool cell_number(struct span cell, char separator, double *value)
{
    char text[256], *end;
    const size_t size = (size_t)(cell.end - cell.start);
    if (size == 0 || 2 * size >= sizeof text)
        return false;
    translate(cell.start, size, separator != ',', text);
    *value = strtod(text, &end);
    return end != text && *end == '\0';
}
