/* SPDX-License-Identifier: MIT */
/* A cube in rigid rotation under viscosity alone (the paper's Fig. 6). What rotates it is the body
 * force omega x v, integrated exactly: a rigid rotation is then a solution, it keeps |v|, and
 * whatever slows or tears the cube comes from the viscous force, which should be zero. */
#include "solver/output.h"
#include "solver/viscosity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 0.05;
static const double support_radius = 0.1;
static const double density = 1000;
static const double turning = 6.283185307179586; /* omega [1/s]: a turn takes a second */
static const double step = 4e-3;
static const double gentle = 0.01, strong = 1; /* nu [m^2/s]: one tears plain SPH, one stops it */

struct state {
    double energy, momentum; /* kinetic energy, angular momentum around z */
};

static struct state state_of(const struct particles *cube)
{
    vector momentum;
    particles_angular_momentum(cube, momentum);
    return (struct state){particles_kinetic_energy(cube), momentum[2]};
}

static struct particles make_cube(const struct run *run)
{
    struct random random = {run->options->seed};
    const int32_t side = run->options->full ? 20 : 8, sides[3] = {side, side, side};
    struct particles cube = particles_block(sides, spacing, 0.1, density, &random);
    for (int32_t i = 0; i < cube.count; ++i) {
        cube.v[i][0] = -turning * cube.x[i][1];
        cube.v[i][1] = turning * cube.x[i][0];
    }
    return cube;
}

/* x and v where the body force alone acts for a step: v turns by an angle, x follows it. */
static void turn(struct particles *cube)
{
    const double angle = turning * step, c = cos(angle), s = sin(angle);
    for (int32_t i = 0; i < cube->count; ++i) {
        double *x = cube->x[i], *v = cube->v[i];
        const double vx = v[0], vy = v[1];
        x[0] += (s * vx - (1 - c) * vy) / turning;
        x[1] += ((1 - c) * vx + s * vy) / turning;
        x[2] += step * v[2];
        v[0] = c * vx - s * vy;
        v[1] = s * vx + c * vy;
    }
}

/* Largest viscous acceleration of the rotation, as a share of the centripetal one at the corner. */
static double ghost_acceleration(struct viscosity *viscosity, const struct particles *cube)
{
    vector *force = array_new(cube->count, sizeof *force);
    double largest = 0, outermost = 0;
    viscosity_force(viscosity, cube->v, force);
    for (int32_t i = 0; i < cube->count; ++i) {
        largest = fmax(largest, sqrt(dot(force[i], force[i])) / cube->mass[i]);
        outermost = fmax(outermost, hypot(cube->x[i][0], cube->x[i][1]));
    }
    free(force);
    return largest / (turning * turning * outermost);
}

/* What viscosity makes of a rotation, nothing, and of a shear flow. */
static void measure_forces(const struct run *run, struct viscosity *viscosity,
                           const struct particles *cube)
{
    metrics_set(run->metrics, "ghost_acceleration", ghost_acceleration(viscosity, cube));
    const struct shear_errors errors = viscosity_shear_errors(viscosity, cube);
    metrics_set(run->metrics, "shear_error", errors.power);
    metrics_set(run->metrics, "shear_rate_error", errors.rate);
}

/* Distances from the rigid cube, turned as far as fits best, in spacings. */
static void measure_shape(const struct run *run, const struct particles *cube, vector *start)
{
    double along = 0, across = 0, squares = 0, largest = 0;
    for (int32_t i = 0; i < cube->count; ++i) {
        along += cube->x[i][0] * start[i][0] + cube->x[i][1] * start[i][1];
        across += cube->x[i][1] * start[i][0] - cube->x[i][0] * start[i][1];
    }
    const double angle = atan2(across, along), c = cos(angle), s = sin(angle);
    for (int32_t i = 0; i < cube->count; ++i) {
        const vector off = {c * start[i][0] - s * start[i][1] - cube->x[i][0],
                            s * start[i][0] + c * start[i][1] - cube->x[i][1],
                            start[i][2] - cube->x[i][2]};
        squares += dot(off, off);
        largest = fmax(largest, dot(off, off));
    }
    metrics_set(run->metrics, "shape_rms", sqrt(squares / cube->count) / spacing);
    metrics_set(run->metrics, "shape_max", sqrt(largest) / spacing);
}

static void measure_losses(const struct run *run, const struct state *before,
                           const struct particles *cube)
{
    const struct state after = state_of(cube);
    metrics_set(run->metrics, "energy_loss", 1 - after.energy / before->energy);
    metrics_set(run->metrics, "momentum_loss", 1 - after.momentum / before->momentum);
}

static void write_cube(const struct run *run, const struct particles *cube, int32_t frame,
                       double time)
{
    static const double eye[3] = {1, -1.6, 2.2};
    output_speeds(run, "cube", eye, cube);
    output_state(run, frame, time, cube);
}

/* Turns the cube and measures what is left. */
static void spin(const struct run *run, const struct sph *sph, double turns)
{
    struct particles cube = make_cube(run);
    struct operators operators = operators_new(sph, NULL, cube.count);
    struct viscosity viscosity = viscosity_new(&operators, cube.count);
    vector *start = array_new(cube.count, sizeof *start);
    const struct state before = state_of(&cube);
    const int32_t steps = run->options->brief ? 1 : (int32_t)(turns / step + 0.5);
    memcpy(start, cube.x, (size_t)cube.count * sizeof *start);
    viscosity.dynamic = gentle * density;
    viscosity.implicit.tolerance = 1e-9;
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        operators_update_density(&operators, &cube);
        if (k == 0)
            measure_forces(run, &viscosity, &cube);
        viscosity_solve(&viscosity, &cube, step);
        turn(&cube);
        if (k % 25 == 0 || k == steps - 1)
            write_cube(run, &cube, (k + 24) / 25, step * (k + 1));
    }
    if (!run->options->brief) {
        measure_losses(run, &before, &cube);
        measure_shape(run, &cube, start);
        metrics_set(run->metrics, "iterations", (double)viscosity.implicit.iterations / steps);
    }
    viscosity_free(&viscosity);
    operators_free(&operators);
    particles_free(&cube);
    free(start);
}

/* Kinetic energy of what is not the rotation. */
static double noise_energy(const struct particles *cube)
{
    double sum = 0;
    for (int32_t i = 0; i < cube->count; ++i) {
        const vector off = {cube->v[i][0] + turning * cube->x[i][1],
                            cube->v[i][1] - turning * cube->x[i][0], cube->v[i][2]};
        sum += 0.5 * cube->mass[i] * dot(off, off);
    }
    return sum;
}

/* Strong viscosity, and one percent of noise in the velocities for it to smooth: energy may only
 * fall, and angular momentum must stay, though every step ends short of the exact solution. */
static void calm(const struct run *run, const struct sph *sph)
{
    struct particles cube = make_cube(run);
    struct operators operators = operators_new(sph, NULL, cube.count);
    struct viscosity viscosity = viscosity_new(&operators, cube.count);
    struct random random = {run->options->seed + 1};
    double gained = 0, lost = 0;
    for (int32_t i = 0; i < cube.count; ++i)
        for (int k = 0; k < 3; ++k)
            cube.v[i][k] += 0.01 * random_between(&random, -1, 1);
    viscosity.dynamic = strong * density;
    viscosity.implicit.tolerance = 1e-9;
    const double noise = noise_energy(&cube);
    for (int32_t k = 0; k < 50; ++k) {
        const struct state before = state_of(&cube);
        operators_update_density(&operators, &cube);
        viscosity_solve(&viscosity, &cube, step);
        const struct state after = state_of(&cube);
        gained = fmax(gained, after.energy / before.energy - 1);
        lost += 1 - after.momentum / before.momentum;
        turn(&cube);
    }
    metrics_set(run->metrics, "noisy_energy_gain", gained);
    metrics_set(run->metrics, "noisy_momentum_loss", fabs(lost));
    metrics_set(run->metrics, "noise_left", noise_energy(&cube) / noise);
    viscosity_free(&viscosity);
    operators_free(&operators);
    particles_free(&cube);
}

static void simulate(const struct run *run)
{
    struct sph sph = run_open(run, 3, support_radius, run->options->full ? 8000 : 512);
    spin(run, &sph, run->options->full ? 10 : 2);
    if (!run->options->brief)
        calm(run, &sph);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    picture_begin(picture, 900, 460);
    picture_bar(picture, 0.9, "speed [m/s]");
    fprintf(picture->script, "set cbrange [0:2.2]\n");
    picture_views(picture, "cube", 0.5 * spacing,
                  picture->full ? "the cube after ten turns" : "the cube after two turns", 0.44);
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"momentum_loss", ONLY_SPH, AT_LEAST, 0.05},
                                        {"shape_rms", ONLY_SPH, AT_LEAST, 0.3},
                                        {"ghost_acceleration", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"shear_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"shear_rate_error", EACH_CORRECTED, AT_MOST, 1e-11},
                                        {"energy_loss", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"momentum_loss", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"shape_max", EACH_CORRECTED, AT_MOST, 1e-9},
                                        {"noisy_energy_gain", EACH_CORRECTED, AT_MOST, 0},
                                        {"noisy_momentum_loss", EACH_CORRECTED, AT_MOST, 1e-8},
                                        {"noise_left", EACH_CORRECTED, AT_MOST, 0.05},
                                        {0}};
    static const struct scene scene = {
        "cube", "A rotating cube under viscosity alone.", simulate, draw, gates, true, false};
    return scene_main(&scene, argc, argv);
}
