/* SPDX-License-Identifier: MIT */
/* Viscous forces of a fluid that is hardly viscous, from the Laplacian of v in the form of Monaghan
 * 2005 (doi:10.1088/0034-4885/68/8/R01), over pairs with plain gradients: explicit, and implicit as
 * in Weiler et al. 2018 (doi:10.1111/cgf.13349). With both volumes of a pair in it, the force keeps
 * linear and angular momentum, and the system is symmetric. */
#ifndef SOLVER_LAPLACIAN_H
#define SOLVER_LAPLACIAN_H
#include "implicit.h"
#include "pairs.h"

struct laplacian {
    double kinematic;         /* nu [m^2/s] */
    struct implicit implicit; /* tolerance: 1e-3 */

    /* Private */
    const struct sph *sph;
    const sphg_neighbors *neighbors;
    struct pairs pairs;
    const struct particles *all;
    int32_t first; /* the fluid is all particles from here on */
};

/* neighbors: of all particles. */
struct laplacian laplacian_new(const struct sph *sph, const sphg_neighbors *neighbors,
                               int32_t capacity);
void laplacian_free(struct laplacian *laplacian);

/* v += dt force(v) / mass for the particles of `all` from `first` on, which share a rest density.
 */
void laplacian_step(struct laplacian *laplacian, struct particles *all, int32_t first, double dt);

/* The same with the force of the new v. */
void laplacian_solve(struct laplacian *laplacian, struct particles *all, int32_t first, double dt);
#endif
