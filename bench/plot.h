/* Pictures by gnuplot: writing scripts and running them. */
#ifndef SPHGRAD_BENCH_PLOT_H
#define SPHGRAD_BENCH_PLOT_H
#include <stdbool.h>
#include <stdio.h>

/* Opens directory/name for writing, or ends the program with one line. */
FILE *plot_file(const char *directory, const char *name);
void plot_close(FILE *file, const char *name); /* the same where the disk is full */

/* Colour-blind-safe: viridis over colour-bar positions 0 to 1 (gnuplot: gray values). The lower
 * `share` of its colours is spread over positions 0 to knee, the rest over knee to 1. */
void plot_palette(FILE *script, double knee, double share);

/* Writes directory/script and runs it as plot_run does: the assignments, then bench/plots/common,
 * unless that is NULL, and bench/plots/script. These read the CSV by the names of its columns. */
bool plot_draw(const char *directory, const char *script, const char *common,
               const char *assignments);

/* Runs directory/script there. false: one line on stderr says why there is no picture. */
bool plot_run(const char *directory, const char *script);
#endif
