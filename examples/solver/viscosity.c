#include "viscosity.h"
#include "conjugate_gradient.h"

#include <stdlib.h>

enum {
    WIDTH = 6, /* of a symmetric tensor, in 2D more than needed */
    MOST_ITERATIONS = 500
};

struct viscosity viscosity_new(const struct operators *operators, int32_t capacity)
{
    struct viscosity made = {.tolerance = 1e-3, .operators = operators};
    made.jacobian = array_new(capacity, sizeof *made.jacobian);
    made.stress = array_new(capacity, WIDTH * sizeof *made.stress);
    made.force = array_new(capacity, sizeof *made.force);
    made.right = array_new(capacity, 3 * sizeof *made.right);
    made.work = array_new(capacity, 9 * sizeof *made.work);
    return made;
}

void viscosity_free(struct viscosity *viscosity)
{
    free(viscosity->jacobian);
    free(viscosity->stress);
    free(viscosity->force);
    free(viscosity->right);
    free(viscosity->work);
}

/* S = 2 mu E, the numbers in the library's order: xx xy xz yy yz zz, in 2D xx xy yy. */
static void viscous_stress(int32_t dimension, double dynamic, const double *jacobian,
                           double *stress)
{
    for (int32_t a = 0; a < dimension; a++)
        for (int32_t b = a; b < dimension; b++)
            *stress++ = dynamic * (jacobian[3 * a + b] + jacobian[3 * b + a]);
}

void viscosity_force(struct viscosity *viscosity, vector *v, vector *force)
{
    const struct operators *operators = viscosity->operators;
    operators_jacobian(operators, v, viscosity->jacobian);
    for (int32_t i = 0; i < operators->count; i++)
        viscous_stress(operators->sph->corrected.dimension, viscosity->dynamic,
                       viscosity->jacobian[i], viscosity->stress + (ptrdiff_t)WIDTH * i);
    operators_force(operators, SPHG_SYM_TENSOR,
                    sphg_view_f64(viscosity->stress, WIDTH * sizeof *viscosity->stress), force);
}

/* (mass - dt K) v */
static void apply(void *data, double *v, double *result)
{
    struct viscosity *viscosity = data;
    viscosity_force(viscosity, (vector *)v, viscosity->force);
    for (int32_t i = 0; i < viscosity->operators->count; i++)
        for (int32_t k = 0; k < 3; k++)
            result[3 * i + k] =
                viscosity->mass[i] * v[3 * i + k] - viscosity->dt * viscosity->force[i][k];
}

void viscosity_solve(struct viscosity *viscosity, struct particles *fluid, double dt)
{
    const struct conjugate_gradient system = {.apply = apply,
                                              .data = viscosity,
                                              .count = 3 * fluid->count,
                                              .tolerance = viscosity->tolerance,
                                              .most_iterations = MOST_ITERATIONS,
                                              .work = viscosity->work};
    viscosity->dt = dt;
    viscosity->mass = fluid->mass;
    for (int32_t i = 0; i < fluid->count; i++)
        for (int32_t k = 0; k < 3; k++)
            viscosity->right[3 * i + k] = fluid->mass[i] * fluid->v[i][k];
    if (viscosity->warm)
        particles_repeat_change(fluid);
    viscosity->iterations += conjugate_gradient(&system, viscosity->right, fluid->v[0]);
    particles_note_change(fluid, viscosity->right);
}
