/* SPDX-License-Identifier: MIT */
#include "laplacian.h"

struct laplacian laplacian_new(const struct sph *sph, const sphg_neighbors *neighbors,
                               int32_t capacity)
{
    const struct laplacian made = {.implicit = implicit_new(1e-3, capacity),
                                   .sph = sph,
                                   .neighbors = neighbors,
                                   .pairs = pairs_new(capacity)};
    return made;
}

void laplacian_free(struct laplacian *laplacian)
{
    implicit_free(&laplacian->implicit);
    pairs_free(&laplacian->pairs);
}

/* 2 (d + 2) mu V_i sum V_j (v_ij . x_ij) / (|x_ij|^2 + 0.01 H^2) grad W_ij, of the velocities v of
 * the fluid alone; the gradients of pairs are V_0 grad W. */
static void find_force(void *data, vector *v, vector *result)
{
    const struct laplacian *laplacian = data;
    const struct pairs *pairs = &laplacian->pairs;
    const struct particles *all = laplacian->all;
    const sphg_scheme *scheme = &laplacian->sph->plain;
    const int32_t first = laplacian->first;
    const double floor = 0.01 * scheme->support_radius * scheme->support_radius;
    const double factor = 2 * (scheme->dimension + 2) * laplacian->kinematic / all->rest_volume;
    for (int32_t i = first; i < all->count; ++i) {
        double *force = result[i - first];
        const double *at = all->x[i], *own = v[i - first];
        const double scale = factor * all->rest_density[i] * all->volume[i];
        force[0] = force[1] = force[2] = 0;
        for (int64_t k = pairs->offsets[i - first]; k < pairs->offsets[i - first + 1]; ++k) {
            const int32_t j = pairs->indices[k];
            if (j < first)
                continue;
            const double *there = all->x[j], *other = v[j - first];
            const vector apart = {at[0] - there[0], at[1] - there[1], at[2] - there[2]};
            const vector slip = {own[0] - other[0], own[1] - other[1], own[2] - other[2]};
            const double closing = dot(slip, apart) / (dot(apart, apart) + floor);
            add_scaled(force, scale * all->volume[j] * closing, pairs->gradient[k]);
        }
    }
}

static void prepare(struct laplacian *laplacian, const struct particles *all, int32_t first)
{
    const sphg_sources sources = {.neighbors = laplacian->neighbors,
                                  .volume = everywhere(&all->rest_volume)};
    laplacian->all = all;
    laplacian->first = first;
    pairs_update(laplacian->sph, &sources, first, all->count, &laplacian->pairs);
}

void laplacian_step(struct laplacian *laplacian, struct particles *all, int32_t first, double dt)
{
    vector *force = laplacian->implicit.force;
    prepare(laplacian, all, first);
    find_force(laplacian, all->v + first, force);
    for (int32_t i = first; i < all->count; ++i)
        add_scaled(all->v[i], dt / all->mass[i], force[i - first]);
}

void laplacian_solve(struct laplacian *laplacian, struct particles *all, int32_t first, double dt)
{
    struct particles fluid = particles_range(all, first, all->count);
    prepare(laplacian, all, first);
    implicit_begin(&laplacian->implicit, &fluid);
    implicit_solve(&laplacian->implicit, &fluid, dt, find_force, laplacian);
}
