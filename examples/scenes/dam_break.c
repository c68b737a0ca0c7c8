/* SPDX-License-Identifier: MIT */
/* A column of fluid breaks down and runs along a tank (2D) whose walls are particles at irregular
 * distances. All along it is asked what gradients are worth where a fluid has a surface, sheets and
 * drops: of the field of the places x, whose gradient is I everywhere. */
#include "numbers.h"
#include "solver/output.h"
#include "solver/time_step.h"
#include "solver/viscous_fluid.h"
#include <math.h>
#include <stdlib.h>

static const double density = 1000;
static const double gravity[3] = {0, -9.81, 0};
static const double tank[2] = {1.6, 1.2};     /* width and height [m] */
static const double column[2] = {0.48, 0.72}; /* that of the fluid */
static const double kinematic = 0.01;         /* nu [m^2/s] */
static const double longest_step = 2e-3;      /* [s] */
static const double passed = 1.2;             /* the front is timed here [m] */

enum { STEPS_BETWEEN_READINGS = 10 };
static const double good = 0.1; /* what an error may be at most */

/* Of the gradient of x at each particle, |J - I| / |I|; and over all readings. */
struct gradients {
    double *error;
    uint8_t *rank;
    tensor *jacobian;
    double sum, bad, worst; /* the last of particles that can be corrected in both directions */
    int64_t count;
};

struct dam {
    double spacing, time, arrival;
    int32_t steps, frames; /* made, and written */
    struct viscous_fluid fluid;
    struct gradients gradients;
};

static double spacing_of(bool full)
{
    return full ? 0.008 : 0.02;
}

/* Quick: until the fluid has run up the wall. */
static double duration_of(bool full)
{
    return full ? 1.2 : 0.8;
}

/* Down the left wall, along the floor and up the right one, at 0.3 to 0.7 of the spacing. */
static struct wall make_tank(const struct sph *sph, double spacing, struct random *random)
{
    const double length = 2 * tank[1] + tank[0];
    vector *x = array_new((int32_t)(length / (0.3 * spacing)) + 1, sizeof *x);
    int32_t count = 0;
    for (double s = 0; s < length; s += spacing * random_between(random, 0.3, 0.7)) {
        double *at = x[count++];
        at[0] = fmin(tank[0], fmax(0, s - tank[1]));
        at[1] = fmax(0, fmax(tank[1] - s, s - tank[1] - tank[0]));
    }
    return wall_new(sph, count, x);
}

static struct particles make_column(double spacing, struct random *random)
{
    const int32_t sides[3] = {(int32_t)(column[0] / spacing + 0.5),
                              (int32_t)(column[1] / spacing + 0.5), 1};
    struct particles fluid = particles_block(sides, spacing, 1e-3, density, random);
    for (int32_t i = 0; i < fluid.count; ++i)
        for (int k = 0; k < 2; ++k)
            fluid.x[i][k] += spacing * (0.5 * (sides[k] - 1) + 1.2);
    return fluid;
}

static void dam_init(struct dam *dam, const struct run *run, const struct sph *sph, double spacing)
{
    struct random random = {run->options->seed};
    *dam = (struct dam){.spacing = spacing, .arrival = INFINITY};
    const struct wall wall = make_tank(sph, spacing, &random);
    const struct particles fluid = make_column(spacing, &random);
    viscous_fluid_init(&dam->fluid, sph, wall, fluid, kinematic * density);
    dam->fluid.viscosity.warm = true;
    dam->gradients.error = array_new(fluid.count, sizeof *dam->gradients.error);
    dam->gradients.rank = array_new(fluid.count, sizeof *dam->gradients.rank);
    dam->gradients.jacobian = array_new(fluid.count, sizeof *dam->gradients.jacobian);
}

static void dam_free(struct dam *dam)
{
    free(dam->gradients.error);
    free(dam->gradients.rank);
    free(dam->gradients.jacobian);
    viscous_fluid_free(&dam->fluid);
}

static void advance(struct dam *dam)
{
    const double dt = time_step(&dam->fluid.particles, dam->spacing, longest_step);
    viscous_fluid_step(&dam->fluid, gravity, 0, dt);
    dam->time += dt;
    ++dam->steps;
}

static bool is_outside(const double *x)
{
    return x[0] <= 0 || x[0] >= tank[0] || x[1] <= 0;
}

/* Which particles have neighbours enough for an exact gradient; of plain SPH none is asked for. */
static void find_ranks(const struct sph *sph, struct dam *dam)
{
    const sphg_sources *sources = &dam->fluid.operators.sources;
    if (sph->corrected.method != SPHG_PLAIN)
        sph_check(sph, sphg_correction(sph->context, &sph->corrected, sources, NULL,
                                       sources->correction, sphg_view_u8(dam->gradients.rank, 1)));
}

/* As the particles stand: neighbours and matrices are found for that. */
static void read_gradients(const struct sph *sph, struct dam *dam)
{
    struct gradients *found = &dam->gradients;
    viscous_fluid_prepare(&dam->fluid);
    operators_jacobian(&dam->fluid.operators, dam->fluid.particles.x, found->jacobian);
    find_ranks(sph, dam);
    for (int32_t i = 0; i < dam->fluid.particles.count; ++i) {
        const double *j = found->jacobian[i];
        found->error[i] = sqrt(
            0.5 * ((j[0] - 1) * (j[0] - 1) + j[1] * j[1] + j[3] * j[3] + (j[4] - 1) * (j[4] - 1)));
        found->sum += found->error[i];
        found->bad += !(found->error[i] <= good);
        if (found->rank[i] == 2)
            found->worst = numbers_larger(found->worst, found->error[i]);
    }
    found->count += dam->fluid.particles.count;
}

static void note_arrival(struct dam *dam)
{
    for (int32_t i = 0; i < dam->fluid.particles.count; ++i)
        if (dam->fluid.particles.x[i][0] > passed && !is_outside(dam->fluid.particles.x[i]))
            dam->arrival = fmin(dam->arrival, dam->time);
}

static void write_fluid(const struct dam *dam, FILE *table)
{
    for (int32_t i = 0; table && i < dam->fluid.particles.count; ++i)
        fprintf(table, "%.4f %.4f %.3g\n", dam->fluid.particles.x[i][0],
                dam->fluid.particles.x[i][1], dam->gradients.error[i]);
    output_close(table);
}

static void write_wall(const struct run *run, const struct wall *wall)
{
    FILE *table = output_open(run, "wall");
    for (int32_t k = 0; table && k < wall->count; ++k)
        fprintf(table, "%.4f %.4f\n", wall->x[k][0], wall->x[k][1]);
    output_close(table);
}

static void write_moment(const struct run *run, const struct sph *sph, struct dam *dam)
{
    const int32_t due = run_frames(run, fmin(1, dam->time / duration_of(run->options->full)));
    if (dam->frames < due || dam->steps % STEPS_BETWEEN_READINGS == 0)
        read_gradients(sph, dam);
    if (dam->steps % (5 * STEPS_BETWEEN_READINGS) == 0) {
        const struct output_field fields[] = {{"velocity", dam->fluid.particles.v[0], 3},
                                              {"gradient_error", dam->gradients.error, 1},
                                              {0}};
        output_particles(run, dam->steps / (5 * STEPS_BETWEEN_READINGS), dam->time,
                         dam->fluid.particles.count, dam->fluid.particles.x, fields);
    }
    for (; dam->frames < due; ++dam->frames)
        write_fluid(dam, output_open_frame(run, "fluid", dam->frames));
}

static void set_outcome(const struct run *run, const struct dam *dam)
{
    int32_t outside = 0;
    for (int32_t i = 0; i < dam->fluid.particles.count; ++i)
        outside += is_outside(dam->fluid.particles.x[i]);
    metrics_set(run->metrics, "particles", dam->fluid.particles.count);
    metrics_set(run->metrics, "arrival", dam->arrival);
    metrics_set(run->metrics, "gradient_mean_error",
                dam->gradients.sum / (double)dam->gradients.count);
    metrics_set(run->metrics, "gradient_bad_share",
                dam->gradients.bad / (double)dam->gradients.count);
    metrics_set(run->metrics, "gradient_worst_error", dam->gradients.worst);
    metrics_set(run->metrics, "outside", outside);
    metrics_set(run->metrics, "steps", dam->steps);
    metrics_set(run->metrics, "iterations",
                (double)dam->fluid.viscosity.implicit.iterations / dam->steps);
    metrics_set(run->metrics, "pressure_iterations",
                (double)dam->fluid.pressure.density_iterations / dam->steps);
}

/* Above the floor, away from the corners, a corrected slope is the normal over the distance,
 * downwards. The largest error, beside 1 / distance. */
static double slope_error(const struct dam *dam, double support_radius)
{
    double worst = 0;
    for (int32_t i = 0; i < dam->fluid.particles.count; ++i) {
        const double *x = dam->fluid.particles.x[i];
        if (x[0] < support_radius || dam->fluid.contact.touching[i] < 2)
            continue;
        vector off = {0, 1, 0};
        add_scaled(off, x[1], dam->fluid.contact.slope[i]);
        worst = numbers_larger(worst, sqrt(dot(off, off)));
    }
    return worst;
}

static void measure_start(const struct run *run, struct dam *dam, double support_radius)
{
    viscous_fluid_measure_shear(&dam->fluid, run->metrics);
    metrics_set(run->metrics, "slope_error", slope_error(dam, support_radius));
}

static void simulate(const struct run *run)
{
    const double spacing = spacing_of(run->options->full), support_radius = 2 * spacing;
    const double duration = duration_of(run->options->full);
    struct sph sph = run_open(run, 2, support_radius, 864);
    struct dam dam;
    dam_init(&dam, run, &sph, spacing);
    measure_start(run, &dam, support_radius);
    write_wall(run, &dam.fluid.wall);
    while (!run->options->brief && dam.time < duration) {
        write_moment(run, &sph, &dam);
        advance(&dam);
        note_arrival(&dam);
        run_progress(run, dam.time, duration);
    }
    if (!run->options->brief) {
        write_moment(run, &sph, &dam);
        read_gradients(&sph, &dam);
        write_fluid(&dam, output_open(run, "fluid"));
        set_outcome(run, &dam);
    }
    dam_free(&dam);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    FILE *script = picture->script;
    picture_begin(picture, 1200, 460);
    fprintf(script, "set size ratio -1\nset xrange [-0.03:1.63]\nset yrange [-0.03:1.15]\n"
                    "set xtics 0.4\nset ytics 0.4\nset xlabel 'x [m]'\nset ylabel 'y [m]'\n"
                    "set cbrange [0:0.6]\n"
                    "set palette defined (0 '#0072b2', 0.15 '#56b4e9', 0.3 '#f0e442', "
                    "0.6 '#d55e00')\n");
    picture_bar(picture, 0.91, "relative error of a gradient");
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.065 + 0.42 * k, 0.47 + 0.42 * k);
        fprintf(script,
                "set title \"{/:Bold=15 %s}\\n%.*f %% of the gradients are off by 10 %% or more\"\n"
                "set label 1 '%.2f s' at graph 0.03, graph 0.93\n"
                "plot 'dam_break_%s_fluid%s.dat' using 1:2:(%g):3 with circles lc palette, "
                "'dam_break_%s_wall.dat' with points pt 7 ps 0.4 lc rgb '#777777'\n"
                "unset ylabel\nset format y ''\n",
                picture->titles[k], k, 100 * metrics_get(picture->metrics[k], "gradient_bad_share"),
                picture->share * duration_of(picture->full), picture->methods[k], picture->frame,
                0.55 * spacing_of(picture->full), picture->methods[k]);
    }
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"slope_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"shear_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"shear_rate_error", EACH_CORRECTED, AT_MOST, 1e-11},
                                        {"gradient_worst_error", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"gradient_bad_share", ONLY_SPH, AT_LEAST, 0.1},
                                        {"gradient_bad_share", EACH_CORRECTED, AT_MOST, 0.02},
                                        {"outside", EACH_CORRECTED, AT_MOST, 0},
                                        {"arrival", EACH_CORRECTED, AT_LEAST, 0.25},
                                        {"arrival", EACH_CORRECTED, AT_MOST, 0.4},
                                        {0}};
    static const struct scene scene = {
        "dam_break", "A column of fluid breaks down in a tank.", simulate, draw, gates, false,
        true};
    return scene_main(&scene, argc, argv);
}
