/* SPDX-License-Identifier: MIT */
/* Particles from a text table: one line of names, then one of numbers for each particle. Takes what
 * solvers, viewers and spreadsheets write: any usual separator, lines before the names, comments,
 * columns that nobody needs, no names at all (x, y, z), dumps of LAMMPS, XYZ. */
#ifndef SHARED_TABLES_CSV_H
#define SHARED_TABLES_CSV_H
#include "column_names.h"

struct csv {
    const char *path;
    struct text_file text;
    struct cells names; /* none: x, y, z */
    int32_t columns[QUANTITIES];
    char separator;                  /* of the rows */
    int64_t first_line;              /* that may be a row */
    int64_t most_rows;               /* where the file says how many; or -1 */
    int32_t least_cells, most_cells; /* of a row; cells at its end that are empty do not count */
    int32_t row_count;
    bool more;                    /* moments follow the first, which is read */
    int64_t *lines;               /* line of each row in the file, from 1 */
    double (*values)[QUANTITIES]; /* of each row, finite; 0 where there is no column */
    char message[600];
};

/* Reads the file and finds its columns. false: `message` says in one line what is wrong and where,
 * and nothing is left to destroy. */
bool csv_open(struct csv *csv, const char *path);
/* Reads the rows; set columns that are not needed to -1 before. As csv_open. */
bool csv_read(struct csv *csv);
void csv_destroy(struct csv *csv);

/* The name of a quantity's column, cut to what fits. */
const char *csv_name(const struct csv *csv, enum quantity quantity, char *name, size_t size);
#endif
