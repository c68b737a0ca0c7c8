/* SPDX-License-Identifier: MIT */
/* Pictures by gnuplot: the CSV and the scripts that read it. */
#ifndef SPHGRAD_BENCH_PLOT_H
#define SPHGRAD_BENCH_PLOT_H
#include <stdbool.h>
#include <stdio.h>

/* Opens directory/name for writing, or ends the program with one line. */
FILE *plot_file(const char *directory, const char *name);
void plot_close(FILE *file, const char *name); /* the same where the disk is full */

/* Writes directory/script and runs it: assignments, then files of bench, up to NULL. These read the
 * CSV by the names of its columns. false: one line on stderr says why there is no picture. */
bool plot_draw(const char *directory, const char *script, const char *assignments,
               const char *const parts[]);

/* The same for bench/PATH.gp, a picture of its own; says what is written, `tables` in front. */
void plot_written(const char *directory, const char *path, const char *tables,
                  const char *assignments);
#endif
