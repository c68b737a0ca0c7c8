/* SPDX-License-Identifier: MIT */
#include "viscosity.h"
#include <math.h>
#include <stdlib.h>

enum {
    WIDTH = 6 /* of a symmetric tensor, in 2D more than needed */
};

struct viscosity viscosity_new(const struct operators *operators, int32_t capacity)
{
    struct viscosity made = {.implicit = implicit_new(1e-3, capacity), .operators = operators};
    made.jacobian = array_new(capacity, sizeof *made.jacobian);
    made.stress = array_new(capacity, WIDTH * sizeof *made.stress);
    return made;
}

void viscosity_free(struct viscosity *viscosity)
{
    implicit_free(&viscosity->implicit);
    free(viscosity->jacobian);
    free(viscosity->stress);
}

/* S = 2 mu E, the numbers in the library's order: xx xy xz yy yz zz, in 2D xx xy yy. */
static void viscous_stress(int32_t dimension, double dynamic, const double *jacobian,
                           double *stress)
{
    for (int32_t a = 0; a < dimension; ++a)
        for (int32_t b = a; b < dimension; ++b)
            *stress++ = dynamic * (jacobian[3 * a + b] + jacobian[3 * b + a]);
}

void viscosity_force(struct viscosity *viscosity, vector *v, vector *force)
{
    const struct operators *operators = viscosity->operators;
    operators_jacobian(operators, v, viscosity->jacobian);
    for (int32_t i = 0; i < operators->count; ++i)
        viscous_stress(operators->sph->corrected.dimension, viscosity->dynamic,
                       viscosity->jacobian[i], viscosity->stress + (ptrdiff_t)WIDTH * i);
    operators_force(operators, SPHG_SYM_TENSOR,
                    sphg_view_f64(viscosity->stress, WIDTH * sizeof *viscosity->stress), force);
}

struct shear_errors viscosity_shear_errors(struct viscosity *viscosity,
                                           const struct particles *fluid)
{
    vector *flow = array_new(fluid->count, sizeof *flow);
    vector *force = array_new(fluid->count, sizeof *force);
    double power = 0, volume = 0, rate = 0;
    for (int32_t i = 0; i < fluid->count; ++i)
        flow[i][0] = fluid->x[i][1];
    viscosity_force(viscosity, flow, force);
    for (int32_t i = 0; i < fluid->count; ++i) {
        power += dot(flow[i], force[i]);
        volume += viscosity->operators->volume[i];
        rate = fmax(rate, fabs(viscosity->jacobian[i][1] - 1));
    }
    free(flow);
    free(force);
    return (struct shear_errors){fabs(power / (-viscosity->dynamic * volume) - 1), rate};
}

static void find_force(void *data, vector *v, vector *force)
{
    viscosity_force(data, v, force);
}

void viscosity_solve(struct viscosity *viscosity, struct particles *fluid, double dt)
{
    implicit_begin(&viscosity->implicit, fluid);
    if (viscosity->warm)
        particles_repeat_change(fluid);
    implicit_solve(&viscosity->implicit, fluid, dt, find_force, viscosity);
    particles_note_change(fluid, viscosity->implicit.momentum);
}
