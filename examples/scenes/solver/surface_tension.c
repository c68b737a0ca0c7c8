/* SPDX-License-Identifier: MIT */
#include "surface_tension.h"
#include <math.h>
#include <stdlib.h>

struct surface_tension surface_tension_new(const struct operators *operators, int32_t capacity)
{
    struct surface_tension made = {.operators = operators};
    made.colour = array_new(capacity, sizeof *made.colour);
    made.squares = array_new(capacity, sizeof *made.squares);
    made.gradient = array_new(capacity, sizeof *made.gradient);
    made.surface = array_new(capacity, sizeof *made.surface);
    made.force = array_new(capacity, sizeof *made.force);
    return made;
}

void surface_tension_free(struct surface_tension *tension)
{
    free(tension->colour);
    free(tension->squares);
    free(tension->gradient);
    free(tension->surface);
    free(tension->force);
}

/* sum A_j G_ij of a field A that particles carry */
static void sum_gradient(const struct operators *operators, double *values, vector *result)
{
    const struct sph *sph = operators->sph;
    const sphg_view given = scalars(values);
    sphg_field field = direct_field(SPHG_SCALAR, &given);
    sphg_request request = {
        .sources = &operators->sources, .set_count = 1, .fields = &field, .field_count = 1};
    field.gradient = vectors(result);
    sph_check(sph, sphg_evaluate(sph->context, &sph->corrected, &request));
}

/* c_i = sum V_j W_ij, Eq. (41), and sum G_ij in the same sweep. */
static void find_colour(struct surface_tension *tension)
{
    const struct sph *sph = tension->operators->sph;
    const double one = 1;
    const sphg_view ones = everywhere(&one);
    sphg_field field = direct_field(SPHG_SCALAR, &ones);
    field.value = scalars(tension->colour);
    field.gradient = vectors(tension->surface);
    sph_evaluate(sph, &sph->corrected, &tension->operators->sources, sphg_absent(), 1, &field);
}

static void find_squares(struct surface_tension *tension, int32_t count)
{
    const bool renormalised =
        tension->operators->sph->corrected.method == SPHG_PLAIN; /* Eq. (42) */
    sum_gradient(tension->operators, tension->colour, tension->gradient);
    for (int32_t i = 0; i < count; ++i) {
        const double factor = renormalised ? 1 / tension->colour[i] : 1;
        tension->squares[i] = factor * factor * dot(tension->gradient[i], tension->gradient[i]);
    }
}

/* V_i kappa / 2 sum (|grad c_i|^2 + |grad c_j|^2) / 2 G_ij */
static void find_force(struct surface_tension *tension, const struct particles *fluid)
{
    sum_gradient(tension->operators, tension->squares, tension->force);
    for (int32_t i = 0; i < fluid->count; ++i) {
        add_scaled(tension->force[i], tension->squares[i], tension->surface[i]);
        for (int k = 0; k < 3; ++k)
            tension->force[i][k] *= 0.25 * tension->strength * fluid->volume[i];
    }
}

struct moments {
    vector centre, torque, inertia; /* of the drop, around the axes */
};

static struct moments find_moments(const struct surface_tension *tension,
                                   const struct particles *fluid)
{
    struct moments found = {0};
    const double mass = particles_mass(fluid);
    for (int32_t i = 0; i < fluid->count; ++i)
        add_scaled(found.centre, fluid->mass[i] / mass, fluid->x[i]);
    for (int32_t i = 0; i < fluid->count; ++i) {
        vector arm = {fluid->x[i][0], fluid->x[i][1], fluid->x[i][2]}, moment;
        add_scaled(arm, -1, found.centre);
        cross(arm, tension->force[i], moment);
        add_scaled(found.torque, 1, moment);
        for (int k = 0; k < 3; ++k)
            found.inertia[k] += fluid->mass[i] * (dot(arm, arm) - arm[k] * arm[k]);
    }
    return found;
}

/* Takes away the acceleration of a rigid body under the same net force and torque; the body's axes
 * are those of space, as a cube's are and a ball's. */
static void balance(const struct surface_tension *tension, const struct particles *fluid,
                    const double *net, vector *acceleration)
{
    const double mass = particles_mass(fluid);
    const struct moments moments = find_moments(tension, fluid);
    const vector spin = {moments.torque[0] / moments.inertia[0],
                         moments.torque[1] / moments.inertia[1],
                         moments.torque[2] / moments.inertia[2]};
    for (int32_t i = 0; i < fluid->count; ++i) {
        vector arm = {fluid->x[i][0], fluid->x[i][1], fluid->x[i][2]}, turning;
        add_scaled(arm, -1, moments.centre);
        cross(spin, arm, turning);
        add_scaled(acceleration[i], -1 / mass, net);
        add_scaled(acceleration[i], -1, turning);
    }
}

void surface_tension_add(struct surface_tension *tension, const struct particles *fluid,
                         vector *acceleration)
{
    vector net = {0};
    double sum = 0;
    find_colour(tension);
    find_squares(tension, fluid->count);
    find_force(tension, fluid);
    for (int32_t i = 0; i < fluid->count; ++i) {
        add_scaled(net, 1, tension->force[i]);
        sum += sqrt(dot(tension->force[i], tension->force[i]));
    }
    tension->net_share = sqrt(dot(net, net)) / sum;
    for (int32_t i = 0; i < fluid->count; ++i)
        add_scaled(acceleration[i], 1 / fluid->mass[i], tension->force[i]);
    if (tension->balanced)
        balance(tension, fluid, net, acceleration);
}
