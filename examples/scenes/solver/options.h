/* SPDX-License-Identifier: MIT */
/* The command line that all scenes share. */
#ifndef SOLVER_OPTIONS_H
#define SOLVER_OPTIONS_H
#include <stdbool.h>
#include <stdint.h>

enum {
    METHOD_COUNT = 4 /* sph, kgc, mls, rkpm */
};
enum method { SPH, KGC, MLS, RKPM };
extern const char *const method_names[METHOD_COUNT + 1]; /* NULL-terminated */

struct options {
    const char *scene;
    const char *output; /* a directory that exists; NULL: nothing is written */
    int32_t threads;    /* 0: the library's default */
    uint64_t seed;
    enum method method; /* runs beside SPH; SPH: runs alone */
    bool method_given;
    bool alone;     /* without SPH beside it */
    int32_t frames; /* of a film; 0: none */
    bool full;
    bool check;
    bool brief; /* no simulation: what the scene finds at its beginning */
};

/* Ends the program on a bad option (status 2) and after --help. */
struct options options_read(const char *scene, const char *about, int argc, char **argv);
#endif
