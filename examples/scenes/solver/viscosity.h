/* SPDX-License-Identifier: MIT */
/* Viscous forces of a fluid that is very viscous. */
#ifndef SOLVER_VISCOSITY_H
#define SOLVER_VISCOSITY_H
#include "implicit.h"
#include "operators.h"

/* Implicit, of the strain rate E = (grad v + grad v^T) / 2 as in Takahashi et al. 2015
 * (doi:10.1111/cgf.12578), but with the force in adjoint form instead of the paper's Eq. (38): the
 * two agree where densities do, and only this one makes a symmetric system, loses no angular
 * momentum and never gains energy. */
struct viscosity {
    double dynamic;           /* mu [Pa s], in 2D [Pa s m] */
    struct implicit implicit; /* tolerance: 1e-3 for the eye, 1e-9 to measure */
    bool warm; /* starts with the last change of v: fewer iterations, but angular momentum is then
                  kept to the tolerance only */

    /* Private */
    const struct operators *operators;
    tensor *jacobian;
    double *stress;
};

struct viscosity viscosity_new(const struct operators *operators, int32_t capacity);
void viscosity_free(struct viscosity *viscosity);

/* force = that of the velocities v */
void viscosity_force(struct viscosity *viscosity, vector *v, vector *force);

/* What is found of a shear flow v = (y, 0, 0). The power of the force against it must be -mu V in
 * all: exact where the Jacobian is, because the force is its adjoint, but of a Jacobian and a force
 * that both have the wrong sign it is the same. */
struct shear_errors {
    double power; /* |found / true - 1| */
    double rate;  /* the largest |d v_x / d y - 1| */
};
struct shear_errors viscosity_shear_errors(struct viscosity *viscosity,
                                           const struct particles *fluid);

/* v = v + dt force(v) / mass, with the force of the new v. */
void viscosity_solve(struct viscosity *viscosity, struct particles *fluid, double dt);
#endif
