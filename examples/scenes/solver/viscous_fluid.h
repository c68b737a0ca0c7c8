/* SPDX-License-Identifier: MIT */
/* A viscous fluid and the walls beside it, with the solvers that take it from step to step. */
#ifndef SOLVER_VISCOUS_FLUID_H
#define SOLVER_VISCOUS_FLUID_H
#include "metrics.h"
#include "pressure.h"
#include "viscosity.h"

struct viscous_fluid {
    struct wall wall;
    struct contact contact;
    struct particles particles;
    struct pressure pressure;
    struct operators operators;
    struct viscosity viscosity;
};

/* Takes over wall and particles. The parts point at each other: it stays where it is. */
void viscous_fluid_init(struct viscous_fluid *fluid, const struct sph *sph, struct wall wall,
                        struct particles particles, double dynamic_viscosity);
void viscous_fluid_free(struct viscous_fluid *fluid);

/* Neighbours and matrices where the particles are now. */
void viscous_fluid_prepare(struct viscous_fluid *fluid);

/* Sets shear_error and shear_rate_error: what viscosity makes of a shear flow in the fluid as it
 * stands. */
void viscous_fluid_measure_shear(struct viscous_fluid *fluid, struct metrics *metrics);

/* A step of pressure, gravity, viscosity and friction at the wall (a share of XSPH; 0: none). */
void viscous_fluid_step(struct viscous_fluid *fluid, const double gravity[3], double friction,
                        double dt);
#endif
