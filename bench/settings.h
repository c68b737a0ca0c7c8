/* SPDX-License-Identifier: MIT */
/* Options that the commands share: a command's table of options begins with those it takes. */
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

#define THREADS_OPTION(s)                                                                          \
    {                                                                                              \
        "threads", 0, "N", "(OMP_NUM_THREADS, or one per processor)", OPTION_WHOLE, &(s).threads,  \
            1, 1024, NULL, NULL                                                                    \
    }
#define REPETITIONS_OPTION(s)                                                                      \
    {                                                                                              \
        "repetitions", 0, "N", "rounds through everything, after a warm-up", OPTION_WHOLE,         \
            &(s).repetitions, 1, 10000, NULL, NULL                                                 \
    }
#define JSON_OPTION(s)                                                                             \
    {                                                                                              \
        "json", 0, "FILE", "write all repetitions in Google Benchmark's format", OPTION_FILE,      \
            &(s).json, 0, 0, NULL, NULL                                                            \
    }
#define ISA_OPTION(s)                                                                              \
    {                                                                                              \
        "isa", 0, "NAME", "baseline, x86-64-v3, x86-64-v4 or neon (the best)", OPTION_CHOICE,      \
            &(s).isa, 0, 0, isa_names, NULL                                                        \
    }
#define PRECISION_OPTION(s, default_name)                                                          \
    {                                                                                              \
        "precision", 0, "TYPE",                                                                    \
            "f32, f64, or mixed: positions f64, the rest f32 (" default_name ")", OPTION_CHOICE,   \
            &(s).precision, 0, 0, precision_names, NULL                                            \
    }
#define KERNEL_OPTION(s)                                                                           \
    {                                                                                              \
        "kernel", 0, "NAME",                                                                       \
            "cubic, quintic, wendland-c2, wendland-c4, wendland-c6, poly6 or spiky (cubic)",       \
            OPTION_CHOICE, &(s).kernel, 0, 0, kernel_names, NULL                                   \
    }
#define OUTPUT_OPTION(s, what, default_name)                                                       \
    {                                                                                              \
        "output", 0, "FOLDER", "where " what " go (" default_name ")", OPTION_FOLDER, &(s).output, \
            0, 0, NULL, NULL                                                                       \
    }
/* Those of every command that times calls; and of those whose particles are a jittered lattice. */
#define RUN_OPTIONS(s) THREADS_OPTION(s), REPETITIONS_OPTION(s), JSON_OPTION(s)
#define LATTICE_OPTIONS(s)                                                                         \
    {"particles", 0,    "N", "in the nearest cube or square", OPTION_WHOLE, &(s).particles, 1,     \
     1e9,         NULL, NULL},                                                                     \
        {"support", 0,    "H", "support radius in spacings", OPTION_REAL, &(s).support, 1.25,      \
         8,         NULL, NULL},                                                                   \
        {"jitter",    0,                                                                           \
         "SHARE",     "move each coordinate by up to this share of the spacing",                   \
         OPTION_REAL, &(s).jitter,                                                                 \
         0,           1,                                                                           \
         NULL,        NULL},                                                                       \
        ISA_OPTION(s), RUN_OPTIONS(s)

/* What they are where nothing is said; output: a folder, or NULL. */
struct settings settings_default(int32_t particles, int32_t repetitions, const char *output);

/* Reads them, and refuses an instruction set that does not run here. */
void settings_read(const struct settings *settings, const struct command_option *options,
                   const char *about, int argc, char **argv);

/* The side of the square or cube nearest to so many particles. */
int32_t settings_side(int32_t particles, int32_t dimension);
#endif
