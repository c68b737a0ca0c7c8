/* SPDX-License-Identifier: MIT */
/* A line of a table, cut into cells, and the numbers in them. */
#ifndef SHARED_TABLES_CELLS_H
#define SHARED_TABLES_CELLS_H
#include "text_file.h"

/* In the order in which they are tried: a comma may also be decimal, a blank stand in a name. */
extern const char cell_separators[]; /* ended by '\0'; ' ': blanks and tabs, any number */

struct cells {
    struct span *at; /* without quotes, and blanks around them */
    int32_t count, room;
};

bool cells_split(struct cells *cells, struct span line, char separator); /* false: no memory */
bool cells_prepend(struct cells *cells, struct span cell);
void cells_destroy(struct cells *cells);

/* How many are left without empty ones at the end. */
int32_t cells_filled(const struct cells *cells);

/* Also with the exponents of Fortran and, unless commas separate, decimal commas. NaN and
 * infinity are numbers here. */
bool cell_number(struct span cell, char separator, double *value);
#endif
