/* SPDX-License-Identifier: MIT */
#include "elasticity.h"
#include <math.h>
#include <stdlib.h>

struct elasticity elasticity_new(const struct sph *sph, struct particles *body, double young,
                                 double poisson)
{
    const int32_t count = body->count;
    struct elasticity made = {.implicit = implicit_new(1e-4, count),
                              .rest = operators_new(sph, NULL, count),
                              .rotations = rotations_new(count)};
    made.shear = young / (2 * (1 + poisson));
    made.lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    made.deformation = array_new(count, sizeof *made.deformation);
    made.rotation = array_new(count, sizeof *made.rotation);
    made.rest_gradient = array_new(count, sizeof *made.rest_gradient);
    made.gradient = array_new(count, sizeof *made.gradient);
    made.stress = array_new(count, sizeof *made.stress);
    operators_update_density(&made.rest, body);
    operators_jacobian(&made.rest, body->x, made.rest_gradient);
    return made;
}

void elasticity_free(struct elasticity *elasticity)
{
    implicit_free(&elasticity->implicit);
    operators_free(&elasticity->rest);
    rotations_free(&elasticity->rotations);
    free(elasticity->deformation);
    free(elasticity->rotation);
    free(elasticity->rest_gradient);
    free(elasticity->gradient);
    free(elasticity->stress);
}

void elasticity_rotate(struct elasticity *elasticity, vector *x)
{
    const struct operators *rest = &elasticity->rest;
    operators_jacobian(rest, x, elasticity->deformation);
    rotations_find(rest->sph, &elasticity->rotations, rest->count, elasticity->deformation,
                   elasticity->rotation);
}

/* result = A B, or A B^T */
static void multiply(const double *a, const double *b, double *result)
{
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result[3 * row + column] = a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] +
                                       a[3 * row + 2] * b[6 + column];
}

static void multiply_transposed(const double *a, const double *b, double *result)
{
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result[3 * row + column] = dot(a + 3 * row, b + 3 * column);
}

/* P R from the displacement gradient D of Eq. (52) in the rest frame: P = mu (D R^T + R D^T) +
 * lambda tr(D R^T). */
static void corotated_stress(const struct elasticity *elasticity, const double *gradient,
                             const double *rotation, double *stress)
{
    tensor turned, piola;
    multiply_transposed(gradient, rotation, turned);
    const double pressure = elasticity->lame * (turned[0] + turned[4] + turned[8]);
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            piola[3 * a + b] = elasticity->shear * (turned[3 * a + b] + turned[3 * b + a]) +
                               (a == b ? pressure : 0);
    multiply(piola, rotation, stress);
}

static void force_of_stress(struct elasticity *elasticity, vector *force)
{
    operators_force(&elasticity->rest, SPHG_TENSOR, tensors(elasticity->stress), force);
}

void elasticity_force(struct elasticity *elasticity, vector *force)
{
    for (int32_t i = 0; i < elasticity->rest.count; ++i) {
        tensor gradient, unstrained;
        multiply(elasticity->rotation[i], elasticity->rest_gradient[i], unstrained);
        for (int k = 0; k < 9; ++k)
            gradient[k] = elasticity->deformation[i][k] - unstrained[k];
        corotated_stress(elasticity, gradient, elasticity->rotation[i], elasticity->stress[i]);
    }
    force_of_stress(elasticity, force);
}

void elasticity_rate(struct elasticity *elasticity, vector *u, vector *force)
{
    operators_jacobian(&elasticity->rest, u, elasticity->gradient);
    for (int32_t i = 0; i < elasticity->rest.count; ++i)
        corotated_stress(elasticity, elasticity->gradient[i], elasticity->rotation[i],
                         elasticity->stress[i]);
    force_of_stress(elasticity, force);
}

static void find_rate(void *data, vector *u, vector *force)
{
    elasticity_rate(data, u, force);
}

void elasticity_solve(struct elasticity *elasticity, struct particles *body, double dt)
{
    struct implicit *implicit = &elasticity->implicit;
    elasticity_rotate(elasticity, body->x);
    elasticity_force(elasticity, implicit->force);
    implicit_begin(implicit, body);
    for (int32_t i = 0; i < body->count; ++i)
        add_scaled(implicit->momentum[i], dt, implicit->force[i]);
    implicit_solve(implicit, body, dt * dt, find_rate, elasticity);
}

double elasticity_stretch_error(struct elasticity *elasticity, const struct particles *body,
                                double share)
{
    const int32_t count = elasticity->rest.count;
    vector *stretched = array_new(count, sizeof *stretched);
    vector *force = array_new(count, sizeof *force);
    double work = 0, volume = 0;
    for (int32_t i = 0; i < count; ++i) {
        add_scaled(stretched[i], 1, body->x[i]);
        stretched[i][2] += share * body->x[i][2];
    }
    elasticity_rotate(elasticity, stretched);
    elasticity_force(elasticity, force);
    for (int32_t i = 0; i < count; ++i) {
        work += body->x[i][2] * force[i][2];
        volume += elasticity->rest.volume[i];
    }
    free(stretched);
    free(force);
    return fabs(work / (-(2 * elasticity->shear + elasticity->lame) * share * volume) - 1);
}

double elasticity_least_volume(const struct elasticity *elasticity)
{
    double least = INFINITY;
    for (int32_t i = 0; i < elasticity->rest.count; ++i) {
        const double *sigma = elasticity->rotations.sigma[i];
        least = fmin(least, sigma[0] * sigma[1] * sigma[2]);
    }
    return least;
}
