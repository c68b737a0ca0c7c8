/* SPDX-License-Identifier: MIT */
/* Clouds of particles that a solver may bring. */
#ifndef SPHGRAD_BENCH_SCALING_CLOUD_H
#define SPHGRAD_BENCH_SCALING_CLOUD_H
#include "numbers.h"
#include <stdbool.h>

enum cloud_shape {
    CLOUD_JITTERED,
    CLOUD_LATTICE,
    CLOUD_ROTATED, /* jittered, then turned against the axes */
    CLOUD_SHEETS,  /* jittered sheets of one layer, out of each other's reach */
    CLOUD_SPRAY,   /* some three neighbours each */
    CLOUD_FAR,     /* jittered, 100 000 H from the origin */
    CLOUD_GRADED   /* layers whose spacing grows along x, with a radius for each particle */
};

struct cloud_setting {
    enum cloud_shape shape;
    int32_t dimension, particles; /* the nearest cube or square is taken */
    double support, jitter;       /* in spacings */
    bool shuffled;
    double ratio; /* graded: of the largest spacing to the smallest */
};

/* In f32, the smallest spacing lattice_spacing. */
struct cloud {
    struct numbers positions;
    struct numbers volumes; /* one for all, but of graded clouds */
    struct numbers radii;   /* of graded clouds alone */
    double support_radius;  /* the largest */
};
struct cloud cloud_create(const struct cloud_setting *setting);
#endif
