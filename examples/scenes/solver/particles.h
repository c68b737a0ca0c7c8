/* SPDX-License-Identifier: MIT */
/* The particles of a scene, fluid or solid, all with the same volume at rest. */
#ifndef SOLVER_PARTICLES_H
#define SOLVER_PARTICLES_H
#include "arrays.h"
#include "random.h"

struct particles {
    int32_t count;
    double rest_volume; /* [L^d] */
    vector *x, *v;
    vector *change;    /* of v in the last implicit solve: where the next one starts */
    double *potential; /* of the pressure in the last solve for density, as above */
    double *rest_density;
    double *mass;    /* rest_density rest_volume */
    double *density; /* where it stands now ... */
    double *volume;  /* ... and mass / density */
};

struct particles particles_new(int32_t count, double rest_volume);
void particles_free(struct particles *particles);

/* Some of them, as a set that shares their memory: not to be freed. */
struct particles particles_range(const struct particles *particles, int32_t begin, int32_t end);

/* Also the mass, and density and volume at rest. */
void particles_set_rest_density(struct particles *particles, int32_t i, double rest_density);

/* A block of sides[0] x sides[1] x sides[2] particles around the origin, each moved by at most
 * jitter * spacing along an axis. In 2D sides[2] is 1. */
struct particles particles_block(const int32_t sides[3], double spacing, double jitter,
                                 double rest_density, struct random *random);

/* v += change, as a start for an implicit solve of which momentum was the right side ... */
void particles_repeat_change(struct particles *particles);

/* ... and after it. */
void particles_note_change(struct particles *particles, vector *momentum);

double particles_mass(const struct particles *particles);
void particles_momentum(const struct particles *particles, double *momentum);
void particles_angular_momentum(const struct particles *particles, double *momentum); /* of 0 */
double particles_kinetic_energy(const struct particles *particles);
double particles_fastest(const struct particles *particles); /* largest |v| */
#endif
