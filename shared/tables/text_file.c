/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* strncasecmp */
#include "text_file.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What files that are no tables begin with. */
static const struct kind {
    const char *bytes;
    size_t size;
    const char *name;
} kinds[] = {
    {"\x89HDF\r\n\x1a\n", 8, "HDF5 (VTKHDF, GADGET, H5Part and others)"},
    {"# vtk DataFile", 14, "legacy VTK"},
    {"<?xml", 5, "XML (VTK's .vtu and .vtp among others)"},
    {"<VTKFile", 8, "VTK's XML (.vtu, .vtp)"},
    {"ply\n", 4, "PLY"},
    {"ply\r\n", 5, "PLY"},
    {"\x1f\x8b", 2, "compressed by gzip"},
    {"BZh", 3, "compressed by bzip2"},
    {"\xfd"
     "7zXZ",
     5, "compressed by xz"},
    {"\x28\xb5\x2f\xfd", 4, "compressed by zstd"},
    {"PK\x03\x04", 4, "a zip archive (an .xlsx or .npz file is one)"},
    {"\xd0\xcf\x11\xe0", 4, "an old Office document (.xls)"},
    {"\x93NUMPY", 6, "NumPy's .npy"},
    {"MATLAB 5.0", 10, "MATLAB's .mat"},
    {"PAR1", 4, "Parquet"},
    {"ARROW1", 6, "Arrow"},
    {"CDF\x01", 4, "NetCDF"},
    {"CDF\x02", 4, "NetCDF"},
    {"SIMPLE  =", 9, "FITS"},
    {"PARTIO", 6, "Partio's text format"},
    {"#!TDV", 5, "binary Tecplot"},
    {"{", 1, "JSON"},
    {"[{", 2, "JSON"},
    {"[[", 2, "JSON"},
    {"[\n", 2, "JSON"},
    {"[\r\n", 3, "JSON"},
};

static bool refuse_kind(const char *name, char *reason, size_t size)
{
    snprintf(reason, size, "this is %s; it must be a text file with columns, such as CSV", name);
    return false;
}

static bool known_kind(const struct text_file *file, char *reason, size_t size)
{
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k)
        if (file->size >= kinds[k].size && memcmp(file->data, kinds[k].bytes, kinds[k].size) == 0)
            return !refuse_kind(kinds[k].name, reason, size);
    return false;
}

/* UTF-16 to one byte a character, in place; what ASCII lacks becomes a question mark. */
static void decode_wide(struct text_file *file, int low)
{
    const unsigned char *bytes = (const unsigned char *)file->data;
    const bool marked = bytes[low] == 0xff && bytes[1 - low] == 0xfe;
    size_t written = 0;
    for (size_t k = marked ? 2 : 0; k + 1 < file->size; k += 2) {
        const unsigned char character = (unsigned char)file->data[k + (size_t)low];
        const bool ascii = file->data[k + (size_t)(1 - low)] == 0 && character < 128;
        file->data[written++] = ascii ? (char)character : '?';
    }
    file->size = written;
}

/* Where the low byte of a character of UTF-16 stands; -1: it is none. Without a mark it is known
 * by zeros in every other place. */
static int low_byte(const struct text_file *file)
{
    const unsigned char *bytes = (const unsigned char *)file->data;
    if (file->size < 4)
        return -1;
    if (bytes[0] == 0xff && bytes[1] == 0xfe)
        return bytes[2] == 0 && bytes[3] == 0 ? -1 : 0; /* that would be UTF-32 */
    if (bytes[0] == 0xfe && bytes[1] == 0xff)
        return 1;
    if (bytes[0] && !bytes[1] && bytes[2] && !bytes[3])
        return 0;
    return !bytes[0] && bytes[1] && !bytes[2] && bytes[3] ? 1 : -1;
}

static void drop_byte_order_mark(struct text_file *file)
{
    static const char mark[] = "\xef\xbb\xbf";
    if (file->size < 3 || memcmp(file->data, mark, 3) != 0)
        return;
    file->size -= 3;
    memmove(file->data, file->data + 3, file->size);
}

static bool make_text(struct text_file *file, char *reason, size_t size)
{
    const int low = low_byte(file);
    if (low >= 0)
        decode_wide(file, low);
    drop_byte_order_mark(file);
    while (file->size > 0 && file->data[file->size - 1] == '\x1a') /* where text ends in DOS */
        --file->size;
    if (known_kind(file, reason, size))
        return false;
    if (file->size > 0 && memchr(file->data, '\0', file->size))
        return refuse_kind("a binary file", reason, size);
    return true;
}

static bool read_all(struct text_file *file, FILE *stream)
{
    size_t room = 0, got = 1;
    while (got > 0) {
        if (file->size == room) {
            room = room > 0 ? 2 * room : 1 << 16;
            char *data = realloc(file->data, room);
            if (!data)
                return false;
            file->data = data;
        }
        got = fread(file->data + file->size, 1, room - file->size, stream);
        file->size += got;
    }
    return !ferror(stream);
}

bool text_file_read(struct text_file *file, const char *path, char *reason, size_t reason_size)
{
    *file = (struct text_file){0};
    FILE *stream = fopen(path, "rb");
    bool good = stream != NULL;
    errno = good ? 0 : errno;
    good = good && read_all(file, stream);
    if (!good)
        snprintf(reason, reason_size, "%s", errno ? strerror(errno) : "it cannot be read");
    if (stream)
        fclose(stream);
    good = good && make_text(file, reason, reason_size);
    if (!good)
        text_file_destroy(file);
    return good;
}

void text_file_destroy(struct text_file *file)
{
    free(file->data);
    *file = (struct text_file){0};
}

bool text_file_line(struct text_file *file, struct span *line)
{
    if (file->next >= file->size)
        return false;
    const char *end = file->data + file->size, *at = file->data + file->next;
    line->start = at;
    while (at < end && *at != '\n' && *at != '\r')
        ++at;
    line->end = at;
    if (at < end)
        at += *at == '\r' && at + 1 < end && at[1] == '\n' ? 2 : 1;
    file->next = (size_t)(at - file->data);
    ++file->line;
    return true;
}

void text_file_rewind(struct text_file *file)
{
    file->next = 0;
    file->line = 0;
}

struct span span_trim(struct span span)
{
    while (span.start < span.end && isspace((unsigned char)*span.start))
        ++span.start;
    while (span.start < span.end && isspace((unsigned char)span.end[-1]))
        --span.end;
    return span;
}

bool span_begins(struct span span, const char *word)
{
    const size_t size = strlen(word);
    return (size_t)(span.end - span.start) >= size && strncasecmp(span.start, word, size) == 0;
}
