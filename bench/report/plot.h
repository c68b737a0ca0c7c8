/* Pictures by gnuplot: writing scripts and running them. */
#ifndef SPHGRAD_BENCH_PLOT_H
#define SPHGRAD_BENCH_PLOT_H
#include <stdbool.h>
#include <stdio.h>

/* Opens directory/name for writing, or ends the program with one line. */
FILE *plot_file(const char *directory, const char *name);
void plot_close(FILE *file, const char *name); /* the same where the disk is full */

/* Writes directory/script and runs it as plot_run does: assignments, then files of bench, up to
 * NULL. These read the CSV by the names of its columns. */
bool plot_draw(const char *directory, const char *script, const char *assignments,
               const char *const parts[]);

/* Runs directory/script there. false: one line on stderr says why there is no picture. */
bool plot_run(const char *directory, const char *script);
#endif
