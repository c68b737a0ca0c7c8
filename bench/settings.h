/* SPDX-License-Identifier: MIT */
/* What most commands can be told on the command line. */
#ifndef SPHGRAD_BENCH_SETTINGS_H
#define SPHGRAD_BENCH_SETTINGS_H
#include "command_line.h"
#include "particles/names.h"

struct settings {
    int32_t particles, threads, repetitions;
    double support;     /* in spacings */
    double jitter;      /* share of the spacing */
    const char *json;   /* file to write, or NULL */
    const char *output; /* folder of CSV, scripts and pictures, or NULL */
    sphg_isa isa;
    sphg_kernel kernel;
    enum precision precision;
};

int32_t settings_processors(void); /* that this process may run on */

/* What they are where nothing is said; output: a folder, or NULL. */
struct settings settings_default(int32_t particles, int32_t repetitions, const char *output);

/* Which of these a command has options for. */
enum {
    TAKES_RUN = 1,     /* threads, repetitions, json: all that time calls */
    TAKES_LATTICE = 2, /* particles, support, jitter, isa: all on a jittered lattice */
    TAKES_PRECISION = 4,
    TAKES_KERNEL = 8
};

/* Reads them and the command's own options, and refuses an instruction set that does not run here.
 */
void settings_read(struct settings *settings, int takes, const struct command_option *own,
                   const char *about, int argc, char **argv);

/* The side of the square or cube nearest to so many particles. */
int32_t settings_side(int32_t particles, int32_t dimension);
#endif
