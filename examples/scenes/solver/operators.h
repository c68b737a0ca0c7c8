/* SPDX-License-Identifier: MIT */
/* Corrected derivatives of what particles carry, over the particles themselves. Built again in each
 * step they are those of a fluid; built once, of the rest configuration of a solid. */
#ifndef SOLVER_OPERATORS_H
#define SOLVER_OPERATORS_H
#include "library.h"
#include "particles.h"

struct operators {
    const struct sph *sph;
    sphg_neighbors *neighbors, *shared; /* one is NULL */
    double *volume, *correction;        /* copies: of a rest configuration they must not change */
    sphg_sources sources;
    int32_t count;
};

/* shared: neighbours that others search, or NULL. */
struct operators operators_new(const struct sph *sph, sphg_neighbors *shared, int32_t capacity);
void operators_free(struct operators *operators);

/* Neighbours and corrections as the particles stand now, with the volumes that they have ... */
void operators_update(struct operators *operators, const struct particles *particles);

/* ... or with densities, and so volumes, that are summed here, over these particles alone. */
void operators_update_density(struct operators *operators, struct particles *particles);

/* J[a][b] = d v_a / d x_b */
void operators_jacobian(const struct operators *operators, vector *v, tensor *jacobian);

/* The force of a stress, sum V_i S_i G_ij - V_j S_j G_ji: the negative adjoint of the Jacobian, so
 * that operators made of the two are symmetric, and momentum is kept. */
void operators_force(const struct operators *operators, sphg_shape shape, sphg_view stress,
                     vector *force);
#endif
