/* SPDX-License-Identifier: MIT */
#include "particles.h"
#include <math.h>
#include <stdlib.h>

struct particles particles_new(int32_t count, double rest_volume)
{
    struct particles made = {.count = count, .rest_volume = rest_volume};
    made.x = array_new(count, sizeof *made.x);
    made.v = array_new(count, sizeof *made.v);
    made.change = array_new(count, sizeof *made.change);
    made.potential = array_new(count, sizeof *made.potential);
    made.rest_density = array_new(count, sizeof *made.rest_density);
    made.mass = array_new(count, sizeof *made.mass);
    made.density = array_new(count, sizeof *made.density);
    made.volume = array_new(count, sizeof *made.volume);
    return made;
}

void particles_free(struct particles *particles)
{
    free(particles->x);
    free(particles->v);
    free(particles->change);
    free(particles->potential);
    free(particles->rest_density);
    free(particles->mass);
    free(particles->density);
    free(particles->volume);
}

struct particles particles_range(const struct particles *particles, int32_t begin, int32_t end)
{
    const struct particles range = {.count = end - begin,
                                    .rest_volume = particles->rest_volume,
                                    .x = particles->x + begin,
                                    .v = particles->v + begin,
                                    .change = particles->change + begin,
                                    .potential = particles->potential + begin,
                                    .rest_density = particles->rest_density + begin,
                                    .mass = particles->mass + begin,
                                    .density = particles->density + begin,
                                    .volume = particles->volume + begin};
    return range;
}

void particles_set_rest_density(struct particles *particles, int32_t i, double rest_density)
{
    particles->rest_density[i] = particles->density[i] = rest_density;
    particles->mass[i] = rest_density * particles->rest_volume;
    particles->volume[i] = particles->rest_volume;
}

struct particles particles_block(const int32_t sides[3], double spacing, double jitter,
                                 double rest_density, struct random *random)
{
    const int dimension = sides[2] > 1 ? 3 : 2;
    struct particles made = particles_new(sides[0] * sides[1] * sides[2], pow(spacing, dimension));
    for (int32_t i = 0; i < made.count; ++i) {
        const int32_t place[3] = {i % sides[0], i / sides[0] % sides[1], i / sides[0] / sides[1]};
        for (int k = 0; k < dimension; ++k)
            made.x[i][k] = spacing * (place[k] - 0.5 * (sides[k] - 1) +
                                      random_between(random, -jitter, jitter));
        particles_set_rest_density(&made, i, rest_density);
    }
    return made;
}

void particles_repeat_change(struct particles *particles)
{
    for (int32_t i = 0; i < particles->count; ++i)
        add_scaled(particles->v[i], 1, particles->change[i]);
}

void particles_note_change(struct particles *particles, vector *momentum)
{
    for (int32_t i = 0; i < particles->count; ++i)
        for (int k = 0; k < 3; ++k)
            particles->change[i][k] = particles->v[i][k] - momentum[i][k] / particles->mass[i];
}

double particles_mass(const struct particles *particles)
{
    double mass = 0;
    for (int32_t i = 0; i < particles->count; ++i)
        mass += particles->mass[i];
    return mass;
}

void particles_momentum(const struct particles *particles, double *momentum)
{
    momentum[0] = momentum[1] = momentum[2] = 0;
    for (int32_t i = 0; i < particles->count; ++i)
        add_scaled(momentum, particles->mass[i], particles->v[i]);
}

void particles_angular_momentum(const struct particles *particles, double *momentum)
{
    momentum[0] = momentum[1] = momentum[2] = 0;
    for (int32_t i = 0; i < particles->count; ++i) {
        vector moment;
        cross(particles->x[i], particles->v[i], moment);
        add_scaled(momentum, particles->mass[i], moment);
    }
}

double particles_kinetic_energy(const struct particles *particles)
{
    double energy = 0;
    for (int32_t i = 0; i < particles->count; ++i)
        energy += 0.5 * particles->mass[i] * dot(particles->v[i], particles->v[i]);
    return energy;
}

double particles_fastest(const struct particles *particles)
{
    double fastest = 0;
    for (int32_t i = 0; i < particles->count; ++i)
        fastest = fmax(fastest, dot(particles->v[i], particles->v[i]));
    return sqrt(fastest);
}
