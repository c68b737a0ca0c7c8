/* SPDX-License-Identifier: MIT */
/* read_tables FILE...: reads tables of particles in one process, for builds that watch what it
 * does; prints how many rows each has, or what is wrong with it. */
#include "tables/csv.h"
#include <stdio.h>

int main(int argc, char **argv)
{
    for (int k = 1; k < argc; ++k) {
        struct csv csv;
        if (csv_open(&csv, argv[k]) && csv_read(&csv)) {
            printf("%s: %d rows\n", argv[k], (int)csv.row_count);
            csv_destroy(&csv);
        } else {
            puts(csv.message);
        }
    }
    return 0;
}
