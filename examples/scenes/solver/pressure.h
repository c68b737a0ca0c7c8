/* SPDX-License-Identifier: MIT */
/* Divergence-free SPH (Bender, Koschier 2017, doi:10.1109/TVCG.2016.2578335) for fluids of several
 * rest densities that share one particle volume, beside walls of particles. Its Jacobi iterations
 * are accelerated (Nesterov 1983) and begin anew as O'Donoghue and Candes propose (2015,
 * doi:10.1007/s10208-013-9150-3).
 *
 * A step: pressure_prepare, pressure_stop_compression, forces of the scene on v,
 * pressure_keep_density, x += dt v. */
#ifndef SOLVER_PRESSURE_H
#define SOLVER_PRESSURE_H
#include "wall.h"

struct pressure {
    double relaxation;    /* of the Jacobi iteration: 0.5, or 1 if particles see walls only */
    double rate_error;    /* mean compression that a step may add: 1e-3 */
    double density_error; /* mean compression that may remain: 1e-4 */
    double kept; /* share of the last potential that the solve for density starts with: 0 */
    int32_t fewest_iterations, most_iterations;
    int64_t rate_iterations, density_iterations; /* in all steps */

    /* Of the last pressure_prepare, one per particle. */
    double *compression; /* density over rest density */

    /* Private */
    const struct sph *sph;
    struct contact *contact; /* NULL: no wall */
    sphg_neighbors *neighbors;
    int64_t *offsets; /* of the pairs among the fluid */
    vector *slope;    /* of the compression: what moving particle i alone does to it */
    double *inverse_diagonal, *potential, *reached, *stress, *source, *change;
    vector *displacement;
};

struct pressure pressure_new(const struct sph *sph, struct contact *contact, int32_t capacity);
void pressure_free(struct pressure *pressure);

/* Neighbours, densities and volumes where the particles are now. */
void pressure_prepare(struct pressure *pressure, struct particles *fluid);

/* Changes v so that compressed particles are not compressed further. */
void pressure_stop_compression(struct pressure *pressure, struct particles *fluid, double dt);

/* Changes v so that after dt no particle is denser than at rest. */
void pressure_keep_density(struct pressure *pressure, struct particles *fluid, double dt);
#endif
