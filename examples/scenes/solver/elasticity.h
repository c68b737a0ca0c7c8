/* SPDX-License-Identifier: MIT */
/* Corotated linear elasticity on a rest configuration (Peer et al. 2018, doi:10.1111/cgf.13317; the
 * paper's Eqs. (51) to (53), the last with the volumes that make it a force). */
#ifndef SOLVER_ELASTICITY_H
#define SOLVER_ELASTICITY_H
#include "implicit.h"
#include "operators.h"
#include "rotation.h"

struct elasticity {
    double shear, lame;       /* mu, lambda [Pa] */
    struct implicit implicit; /* tolerance: 1e-4 */
    struct operators rest;    /* never built again */
    tensor *deformation;      /* F */
    tensor *rotation;         /* R */
    struct rotations rotations;

    /* Private */
    tensor *rest_gradient, *gradient, *stress;
};

/* body: as it stands at rest; its densities are summed on the way. */
struct elasticity elasticity_new(const struct sph *sph, struct particles *body, double young,
                                 double poisson);
void elasticity_free(struct elasticity *elasticity);

/* Deformation and rotation of the places x. */
void elasticity_rotate(struct elasticity *elasticity, vector *x);

/* Force at the places and rotations of the last elasticity_rotate. */
void elasticity_force(struct elasticity *elasticity, vector *force);

/* How the force changes per velocity u, the rotations held. */
void elasticity_rate(struct elasticity *elasticity, vector *u, vector *force);

/* A step of v: implicit in the force, with rotations as they are at body->x. */
void elasticity_solve(struct elasticity *elasticity, struct particles *body, double dt);

/* The body as it stands at rest, stretched along z by a share: the work of its force beside what it
 * must be, -(2 mu + lambda) e V for e the stretch, per unit of stretch: |found / true - 1|. Exact
 * where the Jacobian is. */
double elasticity_stretch_error(struct elasticity *elasticity, const struct particles *body,
                                double share);

double elasticity_least_volume(const struct elasticity *elasticity); /* smallest det F */
#endif
