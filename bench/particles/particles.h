/* SPDX-License-Identifier: MIT */
/* Particles to measure on: a lattice, or a host's own from a file. */
#ifndef SPHGRAD_BENCH_PARTICLES_H
#define SPHGRAD_BENCH_PARTICLES_H
#include "scene.h"
#include "settings.h"
#include <stdbool.h>

enum particle_order { ORDER_AS_THEY_ARE, ORDER_SHUFFLED }; /* in memory */

struct particle_source {
    const char *input; /* text file; NULL: a lattice */
    double mass;       /* of each particle in a file with densities; 0: as the file says */
    int32_t dimension; /* of the lattice */
    int32_t side;      /* of the lattice, in particles */
    double jitter;     /* share of the spacing */
    enum particle_order order;
    enum precision precision;
};

struct particles {
    struct numbers positions;
    struct numbers velocities; /* of the file; count 0: it has none */
    struct numbers volumes;    /* count 0: not known yet */
    int32_t count, dimension;
    bool more;                 /* the file holds later moments, too, which are not read */
    const char *volume_origin; /* where the volumes are from, in words */
    const char *columns;       /* of the file that were read */
    const char *flat;          /* why it is in 2D; empty in 3D */
};

/* 1/128: a power of two, so that pairs at exactly r = H are exactly not neighbours. */
extern const double lattice_spacing;

/* Ends the program with one line where the file is not usable. */
struct particles particles_create(const struct particle_source *source);

/* The lattice of these settings, with KGC. */
struct scene scene_of_lattice(sphg_context *context, const struct settings *settings,
                              int32_t dimension);
#endif
