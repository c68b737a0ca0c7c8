#include "laplacian.h"
#include "conjugate_gradient.h"

#include <stdlib.h>

enum { MOST_ITERATIONS = 100 };

struct laplacian laplacian_new(const struct sph *sph, const struct pairs *pairs, int32_t capacity)
{
    struct laplacian made = {.tolerance = 1e-3, .sph = sph, .pairs = pairs};
    made.force = array_new(capacity, sizeof *made.force);
    made.right = array_new(capacity, 3 * sizeof *made.right);
    made.work = array_new(capacity, 9 * sizeof *made.work);
    return made;
}

void laplacian_free(struct laplacian *laplacian)
{
    free(laplacian->force);
    free(laplacian->right);
    free(laplacian->work);
}

/* 2 (d + 2) mu V_i sum V_j (v_ij . x_ij) / (|x_ij|^2 + 0.01 H^2) grad W_ij, of the velocities v of
 * the fluid alone; the gradients of pairs are V_0 grad W. */
static void find_force(struct laplacian *laplacian, const vector *v)
{
    const struct pairs *pairs = laplacian->pairs;
    const struct particles *all = laplacian->all;
    const sphg_scheme *scheme = &laplacian->sph->plain;
    const int32_t first = laplacian->first;
    const double floor = 0.01 * scheme->support_radius * scheme->support_radius;
    const double factor = 2 * (scheme->dimension + 2) * laplacian->kinematic / all->rest_volume;
    for (int32_t i = first; i < all->count; i++) {
        double *force = laplacian->force[i - first];
        const double *at = all->x[i], *own = v[i - first];
        const double scale = factor * all->rest_density[i] * all->volume[i];
        force[0] = force[1] = force[2] = 0;
        for (int64_t k = pairs->offsets[i]; k < pairs->offsets[i + 1]; k++) {
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

static void begin(struct laplacian *laplacian, const struct particles *all, int32_t first,
                  double dt)
{
    laplacian->all = all;
    laplacian->first = first;
    laplacian->dt = dt;
}

void laplacian_step(struct laplacian *laplacian, struct particles *all, int32_t first, double dt)
{
    begin(laplacian, all, first, dt);
    find_force(laplacian, (const vector *)(all->v + first));
    for (int32_t i = first; i < all->count; i++)
        add_scaled(all->v[i], dt / all->mass[i], laplacian->force[i - first]);
}

/* (mass - dt K) v */
static void apply(void *data, double *v, double *result)
{
    struct laplacian *laplacian = data;
    const double *mass = laplacian->all->mass + laplacian->first;
    find_force(laplacian, (const vector *)(const void *)v);
    for (int32_t i = 0; i < laplacian->all->count - laplacian->first; i++)
        for (int32_t k = 0; k < 3; k++)
            result[3 * i + k] = mass[i] * v[3 * i + k] - laplacian->dt * laplacian->force[i][k];
}

void laplacian_solve(struct laplacian *laplacian, struct particles *all, int32_t first, double dt)
{
    struct particles fluid = particles_range(all, first, all->count);
    const struct conjugate_gradient system = {.apply = apply,
                                              .data = laplacian,
                                              .count = 3 * fluid.count,
                                              .tolerance = laplacian->tolerance,
                                              .most_iterations = MOST_ITERATIONS,
                                              .work = laplacian->work};
    begin(laplacian, all, first, dt);
    for (int32_t i = 0; i < fluid.count; i++)
        for (int32_t k = 0; k < 3; k++)
            laplacian->right[3 * i + k] = fluid.mass[i] * fluid.v[i][k];
    laplacian->iterations += conjugate_gradient(&system, laplacian->right, fluid.v[0]);
}
