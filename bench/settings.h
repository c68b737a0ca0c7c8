/* Options that the measuring commands share. */
#ifndef SPHGRAD_BENCH_SETTINGS_H
#define SPHGRAD_BENCH_SETTINGS_H
#include <argp.h>
#include <stdint.h>

struct settings {
    int32_t particles, threads, repetitions;
    double support;   /* in spacings */
    double jitter;    /* share of the spacing */
    const char *json; /* file to write, or NULL */
};

/* A child of a command's own argp; its input is a struct settings that holds the defaults. */
extern const struct argp settings_argp;

/* Refuses what is no instruction set or does not run here. */
void settings_choose_isa(const char *name);

/* Of these the options that need no particles: threads, repetitions, json. */
extern const struct argp settings_run_argp;

/* The side of the square or cube nearest to so many particles. */
int32_t settings_side(int32_t particles, int32_t dimension);
#endif
