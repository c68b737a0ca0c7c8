/* SPDX-License-Identifier: MIT */
#include "viscous_fluid.h"

void viscous_fluid_init(struct viscous_fluid *fluid, const struct sph *sph, struct wall wall,
                        struct particles particles, double dynamic_viscosity)
{
    fluid->wall = wall;
    fluid->particles = particles;
    fluid->contact = contact_new(sph, &fluid->wall, particles.count);
    fluid->pressure = pressure_new(sph, &fluid->contact, particles.count);
    fluid->operators = operators_new(sph, fluid->pressure.neighbors, particles.count);
    fluid->viscosity = viscosity_new(&fluid->operators, particles.count);
    fluid->viscosity.dynamic = dynamic_viscosity;
}

void viscous_fluid_free(struct viscous_fluid *fluid)
{
    viscosity_free(&fluid->viscosity);
    operators_free(&fluid->operators);
    pressure_free(&fluid->pressure);
    contact_free(&fluid->contact);
    particles_free(&fluid->particles);
    wall_free(&fluid->wall);
}

void viscous_fluid_prepare(struct viscous_fluid *fluid)
{
    pressure_prepare(&fluid->pressure, &fluid->particles);
    operators_update(&fluid->operators, &fluid->particles);
}

void viscous_fluid_measure_shear(struct viscous_fluid *fluid, struct metrics *metrics)
{
    viscous_fluid_prepare(fluid);
    const struct shear_errors errors = viscosity_shear_errors(&fluid->viscosity, &fluid->particles);
    metrics_set(metrics, "shear_error", errors.power);
    metrics_set(metrics, "shear_rate_error", errors.rate);
}

void viscous_fluid_step(struct viscous_fluid *fluid, const double gravity[3], double friction,
                        double dt)
{
    struct particles *particles = &fluid->particles;
    pressure_prepare(&fluid->pressure, particles);
    pressure_stop_compression(&fluid->pressure, particles, dt);
    operators_update(&fluid->operators, particles);
    for (int32_t i = 0; i < particles->count; ++i)
        add_scaled(particles->v[i], dt, gravity);
    viscosity_solve(&fluid->viscosity, particles, dt);
    if (friction > 0)
        contact_friction(&fluid->contact, friction, particles);
    pressure_keep_density(&fluid->pressure, particles, dt);
    for (int32_t i = 0; i < particles->count; ++i)
        add_scaled(particles->x[i], dt, particles->v[i]);
}
