/* Comma-separated numbers with one header line; lines that start with # are comments. */
#ifndef SPHGRAD_BENCH_CSV_H
#define SPHGRAD_BENCH_CSV_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct csv_table {
    char **names;   /* column_count header cells */
    double *values; /* row_count x column_count, all finite */
    int64_t *lines; /* line of each row in the file, from 1 */
    int32_t column_count;
    int32_t row_count;
};

/* required: names of columns that must be there, NULL after the last. false: `message` says in one
 * line what is wrong and where; the table is empty then. */
bool csv_read(const char *path, const char *const required[], struct csv_table *table,
              char *message, size_t message_size);
void csv_destroy(struct csv_table *table);

int32_t csv_column(const struct csv_table *table, const char *name); /* -1: there is none */
double csv_value(const struct csv_table *table, int32_t row, int32_t column);
#endif
