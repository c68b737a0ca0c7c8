/* SPDX-License-Identifier: MIT */
/* A spinning top of elastic material, free of outer forces (the paper's Fig. 9): its angular
 * momentum is the measure, by implicit steps and by explicit ones. */
#include "solver/elasticity.h"
#include "solver/output.h"
#include "solver/pressure.h"
#include "solver/sampling.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double density = 1000;
static const double young = 1e6, poisson = 0.3; /* [Pa], none */
static const double turning = 10;               /* omega [1/s] */
static const double turns = 5;
static const double fast_turning = 40;   /* on the ground, where a slow top falls over [1/s] */
static const double standing_time = 1.5; /* [s] */
static const double gravity = 9.81;
static const double implicit_step = 1e-3;
static const double explicit_step = 8e-3; /* of a spacing [s/m]: sound takes 28 ms for a metre */

/* Profile of the top: a stem, a disc, and a cone under it. z [m] -> radius [m], below 0: outside.
 */
static double profile(double z)
{
    const double disc = 0.27, half_height = 0.06;
    if (z > half_height)
        return z < 0.22 ? 0.06 : -1;
    return z > -half_height ? disc : disc + 1.2 * (z + half_height);
}

static double spacing_of(bool full)
{
    return full ? 0.02 : 0.05;
}

/* A lattice within the profile. */
static struct particles make_top(const struct run *run, double jitter)
{
    struct random random = {run->options->seed};
    const double spacing = spacing_of(run->options->full);
    const int32_t side = 2 * (int32_t)(0.3 / spacing) + 1, sides[3] = {side, side, side};
    struct particles block = particles_block(sides, spacing, jitter, density, &random);
    int32_t count = 0;
    for (int32_t i = 0; i < block.count; ++i)
        if (hypot(block.x[i][0], block.x[i][1]) < profile(block.x[i][2]))
            memmove(block.x[count++], block.x[i], sizeof block.x[i]);
    block.count = count;
    return block;
}

static void set_spinning(struct particles *top, double omega)
{
    for (int32_t i = 0; i < top->count; ++i) {
        top->v[i][0] = -omega * top->x[i][1];
        top->v[i][1] = omega * top->x[i][0];
        top->v[i][2] = 0;
    }
}

static double largest_acceleration(const struct particles *top, vector *force)
{
    double largest = 0;
    for (int32_t i = 0; i < top->count; ++i)
        largest = fmax(largest, sqrt(dot(force[i], force[i])) / top->mass[i]);
    return largest;
}

static double rotation_error(const struct elasticity *elasticity, const double *exact)
{
    double worst = 0;
    for (int32_t i = 0; i < elasticity->rest.count; ++i)
        for (int k = 0; k < 9; ++k)
            worst = fmax(worst, fabs(elasticity->rotation[i][k] - exact[k]));
    return worst;
}

/* A rigid rotation by 0.7 rad: what is found of it, which force it meets, and what the implicit
 * operator makes of rotating on. */
static void rigid_rotation(const struct run *run, const struct sph *sph)
{
    struct particles top = make_top(run, 0.15);
    struct elasticity elasticity = elasticity_new(sph, &top, young, poisson);
    vector *onward = array_new(top.count, sizeof *onward);
    vector *force = array_new(top.count, sizeof *force);
    const double c = cos(0.7), s = sin(0.7);
    const tensor exact = {c, -s, 0, s, c, 0, 0, 0, 1};
    metrics_set(run->metrics, "stretch_error", elasticity_stretch_error(&elasticity, &top, 0.01));
    for (int32_t i = 0; i < top.count; ++i) {
        const double x = top.x[i][0], y = top.x[i][1];
        top.x[i][0] = c * x - s * y;
        top.x[i][1] = s * x + c * y;
        onward[i][0] = -top.x[i][1];
        onward[i][1] = top.x[i][0];
    }
    elasticity_rotate(&elasticity, top.x);
    metrics_set(run->metrics, "particles", top.count);
    metrics_set(run->metrics, "rotation_error", rotation_error(&elasticity, exact));
    elasticity_force(&elasticity, force);
    metrics_set(run->metrics, "ghost_acceleration", largest_acceleration(&top, force));
    elasticity_rate(&elasticity, onward, force);
    metrics_set(run->metrics, "implicit_ghost", largest_acceleration(&top, force));
    elasticity_free(&elasticity);
    particles_free(&top);
    free(onward);
    free(force);
}

static void write_top(const struct run *run, const struct particles *top, int32_t frame,
                      double time)
{
    static const double eye[3] = {1, -2, 1.2};
    output_speeds(run, "top", eye, top);
    output_state(run, frame, time, top);
}

static void step_explicitly(struct elasticity *elasticity, struct particles *top, vector *force,
                            double dt)
{
    elasticity_rotate(elasticity, top->x);
    elasticity_force(elasticity, force);
    for (int32_t i = 0; i < top->count; ++i)
        add_scaled(top->v[i], dt / top->mass[i], force[i]);
}

/* Spins the top and returns how much of the angular momentum around its axis is lost. */
static double spin(const struct run *run, const struct sph *sph, bool implicit)
{
    struct particles top = make_top(run, 0.15);
    struct elasticity elasticity = elasticity_new(sph, &top, young, poisson);
    vector *force = array_new(top.count, sizeof *force), before, now;
    const double dt = implicit ? implicit_step : explicit_step * spacing_of(run->options->full);
    const int32_t steps = (int32_t)(6.283185307179586 * turns / turning / dt);
    FILE *series = implicit ? output_open(run, "momentum") : NULL;
    set_spinning(&top, turning);
    particles_angular_momentum(&top, before);
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        if (implicit)
            elasticity_solve(&elasticity, &top, dt);
        else
            step_explicitly(&elasticity, &top, force, dt);
        for (int32_t i = 0; i < top.count; ++i)
            add_scaled(top.x[i], dt, top.v[i]);
        particles_angular_momentum(&top, now);
        if (series)
            fprintf(series, "%g %.9g\n", dt * (k + 1), now[2] / before[2]);
        if (implicit && (k % 100 == 0 || k == steps - 1))
            write_top(run, &top, (k + 99) / 100, dt * (k + 1));
    }
    if (implicit)
        metrics_set(run->metrics, "iterations", (double)elasticity.implicit.iterations / steps);
    output_close(series);
    elasticity_free(&elasticity);
    particles_free(&top);
    free(force);
    return 1 - now[2] / before[2];
}

/* ---- On the ground ---- */

/* A top on a smooth but irregularly sampled floor without friction. */
struct stand {
    struct particles top;
    struct wall wall;
    struct contact contact;
    struct pressure pressure;
    struct elasticity elasticity;
    vector *force;
};

static void stand_init(struct stand *stand, const struct run *run, const struct sph *sph)
{
    static const double low[2] = {-0.6, -0.6}, high[2] = {0.6, 0.6};
    const double spacing = spacing_of(run->options->full);
    struct random random = {run->options->seed};
    double lowest = INFINITY;
    vector *x;
    const int32_t count = sample_rectangle(&random, low, high, 0.5 * spacing, &x);
    stand->top = make_top(run, 1e-3);
    for (int32_t i = 0; i < stand->top.count; ++i)
        lowest = fmin(lowest, stand->top.x[i][2]);
    for (int32_t k = 0; k < count; ++k)
        x[k][2] = lowest - spacing;
    stand->wall = wall_new(sph, count, x);
    stand->elasticity = elasticity_new(sph, &stand->top, young, poisson);
    stand->contact = contact_new(sph, &stand->wall, stand->top.count);
    stand->pressure = pressure_new(sph, &stand->contact, stand->top.count);
    stand->force = array_new(stand->top.count, sizeof *stand->force);
}

static void stand_free(struct stand *stand)
{
    elasticity_free(&stand->elasticity);
    pressure_free(&stand->pressure);
    contact_free(&stand->contact);
    wall_free(&stand->wall);
    particles_free(&stand->top);
    free(stand->force);
}

/* Momentum and, around the centre of mass, angular momentum. */
static void stand_momenta(const struct particles *top, double *momentum, double *angular)
{
    const double mass = particles_mass(top);
    vector centre = {0}, carried;
    for (int32_t i = 0; i < top->count; ++i)
        add_scaled(centre, top->mass[i] / mass, top->x[i]);
    particles_momentum(top, momentum);
    particles_angular_momentum(top, angular);
    cross(centre, momentum, carried);
    add_scaled(angular, -1, carried);
}

static void stand_advance(struct stand *stand, double dt)
{
    struct particles *top = &stand->top;
    pressure_prepare(&stand->pressure, top);
    pressure_stop_compression(&stand->pressure, top, dt);
    step_explicitly(&stand->elasticity, top, stand->force, dt);
    for (int32_t i = 0; i < top->count; ++i)
        top->v[i][2] -= gravity * dt;
    pressure_keep_density(&stand->pressure, top, dt);
    for (int32_t i = 0; i < top->count; ++i)
        add_scaled(top->x[i], dt, top->v[i]);
}

/* Such a floor pushes straight up, and what it pushes it may neither turn nor move aside. */
static void stand(const struct run *run, const struct sph *sph)
{
    struct stand stand = {0};
    vector momentum, before, now;
    double turned = 0, lowest = INFINITY;
    const double dt = explicit_step * spacing_of(run->options->full);
    const int32_t steps = (int32_t)(standing_time / dt);
    stand_init(&stand, run, sph);
    set_spinning(&stand.top, fast_turning);
    stand_momenta(&stand.top, momentum, before);
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        stand_advance(&stand, dt);
        stand_momenta(&stand.top, momentum, now);
        turned = fmax(turned, fabs(now[2] / before[2] - 1));
    }
    for (int32_t i = 0; i < stand.top.count; ++i)
        lowest = fmin(lowest, stand.top.x[i][2] - stand.wall.x[0][2]);
    metrics_set(run->metrics, "ground_spin_change", turned);
    metrics_set(run->metrics, "ground_drift",
                hypot(momentum[0], momentum[1]) / particles_mass(&stand.top));
    metrics_set(run->metrics, "ground_tilt", acos(now[2] / sqrt(dot(now, now))));
    metrics_set(run->metrics, "ground_height", lowest / spacing_of(run->options->full));
    stand_free(&stand);
}

static void simulate(const struct run *run)
{
    struct sph sph =
        run_open(run, 3, 2 * spacing_of(run->options->full), run->options->full ? 6000 : 400);
    rigid_rotation(run, &sph);
    if (!run->options->brief) {
        metrics_set(run->metrics, "implicit_loss", spin(run, &sph, true));
        metrics_set(run->metrics, "explicit_loss", fabs(spin(run, &sph, false)));
        stand(run, &sph);
    }
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    picture_begin(picture, 1300, 420);
    picture_bar(picture, 0.59, "speed [m/s]");
    fprintf(picture->script, "set cbrange [0:2.8]\n");
    picture_views(picture, "top", 0.5 * spacing_of(picture->full), "after the time of five turns",
                  0.295);
    fprintf(picture->script, "set key bottom left\nset title 'implicit steps'\n"
                             "set ylabel 'angular momentum / initial'\nset yrange [0:1.05]\n");
    picture_series(picture, "momentum");
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"implicit_loss", ONLY_SPH, AT_LEAST, 0.3},
                                        {"implicit_ghost", ONLY_SPH, AT_LEAST, 100},
                                        {"stretch_error", EACH_CORRECTED, AT_MOST, 1e-11},
                                        {"rotation_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"ghost_acceleration", EACH_CORRECTED, AT_MOST, 1e-8},
                                        {"implicit_ghost", EACH_CORRECTED, AT_MOST, 1e-8},
                                        {"implicit_loss", EACH_CORRECTED, AT_MOST, 1e-3},
                                        {"explicit_loss", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"ground_drift", ONLY_SPH, AT_LEAST, 0.01},
                                        {"ground_drift", EACH_CORRECTED, AT_MOST, 1e-3},
                                        {"ground_spin_change", EACH_CORRECTED, AT_MOST, 1e-6},
                                        {"ground_tilt", EACH_CORRECTED, AT_MOST, 2e-3},
                                        {"ground_height", EACH_CORRECTED, AT_LEAST, 0.4},
                                        {"ground_height", EACH_CORRECTED, AT_MOST, 1.1},
                                        {0}};
    static const struct scene scene = {
        "top", "A spinning elastic top.", simulate, draw, gates, false, false};
    return scene_main(&scene, argc, argv);
}
