/* SPDX-License-Identifier: MIT */
/* Where in a text table the names stand, where the numbers begin, and what separates them. */
#ifndef SHARED_TABLES_CSV_LAYOUT_H
#define SHARED_TABLES_CSV_LAYOUT_H
#include "csv.h"

/* Fills names, columns, separator, first_line, most_rows and the numbers of cells of a file that
 * has been read. false: `reason` says why it cannot be a table of particles. */
bool csv_find_layout(struct csv *csv, char *reason, size_t reason_size);

/* Whether nothing but blanks or a comment stands there. */
bool csv_is_remark(struct span line);
#endif
