/* SPDX-License-Identifier: MIT */
#include "operators.h"
#include "stopwatch.h"
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 6 /* of a row of corrections, in 2D more than needed */
};

struct operators operators_new(const struct sph *sph, sphg_neighbors *shared, int32_t capacity)
{
    struct operators made = {.sph = sph, .shared = shared};
    if (!shared)
        made.neighbors = sph_neighbors(sph);
    made.volume = array_new(capacity, sizeof *made.volume);
    made.correction = array_new(capacity, WIDTH * sizeof *made.correction);
    made.sources.neighbors = shared ? shared : made.neighbors;
    made.sources.volume = scalars(made.volume);
    if (sph->corrected.method != SPHG_PLAIN)
        made.sources.correction = sphg_view_f64(made.correction, WIDTH * sizeof *made.correction);
    return made;
}

void operators_free(struct operators *operators)
{
    sphg_neighbors_destroy(operators->neighbors);
    free(operators->volume);
    free(operators->correction);
}

static void correct(struct operators *operators, const struct particles *particles)
{
    const struct sph *sph = operators->sph;
    operators->count = particles->count;
    memcpy(operators->volume, particles->volume,
           (size_t)particles->count * sizeof *operators->volume);
    if (sph->corrected.method == SPHG_PLAIN)
        return;
    const double start = stopwatch_now();
    sph_check(sph, sphg_correction(sph->context, &sph->corrected, &operators->sources, NULL,
                                   operators->sources.correction, sphg_absent()));
    sph->spent[FLUID_MATRICES] += stopwatch_now() - start;
}

static void search(struct operators *operators, const struct particles *particles)
{
    if (operators->neighbors)
        sph_search(operators->sph, operators->neighbors, particles->count, particles->x);
}

void operators_update(struct operators *operators, const struct particles *particles)
{
    search(operators, particles);
    correct(operators, particles);
}

/* rho_i = sum m_j W_ij */
static void sum_density(const struct operators *operators, struct particles *particles)
{
    const struct sph *sph = operators->sph;
    const double one = 1;
    const sphg_view mass = scalars(particles->mass);
    const sphg_sources sources = {.neighbors = operators->sources.neighbors,
                                  .volume = everywhere(&one)};
    sphg_field field = direct_field(SPHG_SCALAR, &mass);
    field.value = scalars(particles->density);
    sph_evaluate(sph, &sph->plain, &sources, sphg_absent(), 1, &field);
    for (int32_t i = 0; i < particles->count; ++i)
        particles->volume[i] = particles->mass[i] / particles->density[i];
}

void operators_update_density(struct operators *operators, struct particles *particles)
{
    search(operators, particles);
    sum_density(operators, particles);
    correct(operators, particles);
}

void operators_jacobian(const struct operators *operators, vector *v, tensor *jacobian)
{
    const struct sph *sph = operators->sph;
    sph_check(sph, sphg_jacobian(sph->context, &sph->corrected, &operators->sources, NULL,
                                 vectors(v), tensors(jacobian)));
}

void operators_force(const struct operators *operators, sphg_shape shape, sphg_view stress,
                     vector *force)
{
    const struct sph *sph = operators->sph;
    sph_check(sph, sphg_force(sph->context, &sph->corrected, &operators->sources, NULL, shape,
                              stress, vectors(force)));
}
