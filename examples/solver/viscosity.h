/* Viscous forces. */
#ifndef SOLVER_VISCOSITY_H
#define SOLVER_VISCOSITY_H
#include "operators.h"
#include "pairs.h"

/* Implicit, of the strain rate E = (grad v + grad v^T) / 2 as in Takahashi et al. 2015
 * (doi:10.1111/cgf.12578), but with the force in adjoint form instead of the paper's Eq. (38): the
 * two agree where densities do, and only this one makes a symmetric system, loses no angular
 * momentum and never gains energy. */
struct viscosity {
    double dynamic;   /* mu [Pa s], in 2D [Pa s m] */
    double tolerance; /* of the linear system: 1e-3 for the eye, 1e-9 to measure */
    int64_t iterations;

    /* Private */
    const struct operators *operators;
    double dt, *mass;
    tensor *jacobian;
    double *stress, *right, *work;
    vector *force;
};

struct viscosity viscosity_new(const struct operators *operators, int32_t capacity);
void viscosity_free(struct viscosity *viscosity);

/* force = that of the velocities v */
void viscosity_force(struct viscosity *viscosity, vector *v, vector *force);

/* v = v + dt force(v) / mass, with the force of the new v. */
void viscosity_solve(struct viscosity *viscosity, struct particles *fluid, double dt);

/* Explicit, among the particles from `first` on, of the Laplacian of v in the form of Monaghan 2005
 * (doi:10.1088/0034-4885/68/8/R01), which Weiler et al. 2018 take for their implicit one: for
 * fluids that are hardly viscous. pairs: plain gradients with volumes at rest. */
void viscosity_add_laplacian(const struct sph *sph, const struct pairs *pairs,
                             const struct particles *fluid, int32_t first, double kinematic,
                             vector *acceleration);
#endif
