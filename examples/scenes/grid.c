/* SPDX-License-Identifier: MIT */
/* A grid of particles slides down an inclined plane (the paper's Fig. 5). The particles are too far
 * apart to feel each other: each is held up by an irregularly sampled wall alone, so that the grid
 * stays a grid only where the pressure of the wall has the direction of its normal. */
#include "solver/output.h"
#include "solver/pressure.h"
#include "solver/sampling.h"
#include <math.h>
#include <stdlib.h>

enum { SIDE = 20 };
static const double radius = 0.02; /* of a particle, r [m] */
static const double support_radius = 0.08;
static const double start_height = 0.05; /* above the plane [m] */
static const double spacing = 0.125;     /* above the support radius */
static const double incline = 0.05;      /* [rad] */
static const double gravity = 6;         /* [m/s^2] */
static const double step = 2e-3;         /* [s] */
static const double settled = 1;         /* [s] afterwards heights are watched */

/* The plane's own axes: downhill, out of the plane, across. */
struct frame {
    vector axes[3];
};

static struct frame inclined_frame(void)
{
    const double c = cos(incline), s = sin(incline);
    const struct frame frame = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    return frame;
}

static void to_world(const struct frame *frame, const double *local, double *world)
{
    world[0] = world[1] = world[2] = 0;
    for (int k = 0; k < 3; ++k)
        add_scaled(world, local[k], frame->axes[k]);
}

static void to_local(const struct frame *frame, const double *world, double *local)
{
    for (int k = 0; k < 3; ++k)
        local[k] = dot(world, frame->axes[k]);
}

/* How far the grid slides in so many steps of symplectic Euler. */
static double exact_slide(int32_t steps)
{
    return 0.5 * gravity * sin(incline) * step * step * steps * (steps + 1.0);
}

static struct wall make_wall(const struct sph *sph, const struct frame *frame,
                             struct random *random, double slide)
{
    const double margin = 0.2, half = 0.5 * SIDE * spacing + margin;
    const double low[2] = {-half, -half}, high[2] = {half + slide, half};
    vector *x;
    const int32_t count = sample_rectangle(random, low, high, radius, &x);
    for (int32_t k = 0; k < count; ++k) {
        const vector local = {x[k][0], 0, x[k][1]};
        to_world(frame, local, x[k]);
    }
    return wall_new(sph, count, x);
}

static struct particles make_grid(const struct frame *frame)
{
    struct particles made = particles_new(SIDE * SIDE, 0.8 * pow(2 * radius, 3));
    for (int32_t i = 0; i < made.count; ++i) {
        const vector local = {spacing * (i % SIDE - 0.5 * (SIDE - 1)), start_height,
                              spacing * (i / SIDE - 0.5 * (SIDE - 1))};
        to_world(frame, local, made.x[i]);
        particles_set_rest_density(&made, i, 1000);
    }
    return made;
}

/* What happens normal to the plane once the grid has come down. */
struct heights {
    double lowest, highest, speed_squares;
    int64_t count;
};

static void watch_heights(const struct frame *frame, const struct particles *grid,
                          struct heights *heights)
{
    for (int32_t i = 0; i < grid->count; ++i) {
        const double height = dot(grid->x[i], frame->axes[1]);
        const double speed = dot(grid->v[i], frame->axes[1]);
        heights->lowest = fmin(heights->lowest, height);
        heights->highest = fmax(heights->highest, height);
        heights->speed_squares += speed * speed;
        ++heights->count;
    }
}

/* What the shape of the grid has become: places in the plane, less the mean slide, beside those at
 * the start. */
static void measure_shape(const struct run *run, const struct frame *frame,
                          const struct particles *grid, int32_t steps)
{
    struct particles start = make_grid(frame);
    vector mean = {0};
    double largest = 0, squares = 0;
    int32_t through = 0;
    FILE *table = output_open(run, "places");
    for (int32_t i = 0; i < grid->count; ++i) {
        add_scaled(mean, 1.0 / grid->count, grid->x[i]);
        add_scaled(mean, -1.0 / grid->count, start.x[i]);
    }
    for (int32_t i = 0; i < grid->count; ++i) {
        vector moved = {0}, local, place;
        add_scaled(moved, 1, grid->x[i]);
        add_scaled(moved, -1, start.x[i]);
        add_scaled(moved, -1, mean);
        to_local(frame, moved, local);
        to_local(frame, grid->x[i], place);
        const double off = hypot(local[0], local[2]);
        largest = fmax(largest, off);
        squares += off * off;
        through += place[1] <= 0;
        if (table)
            fprintf(table, "%g %g %g\n", place[0], place[2], off);
    }
    output_close(table);
    const double slide = dot(mean, frame->axes[0]), exact = exact_slide(steps);
    metrics_set(run->metrics, "in_plane_deviation", largest);
    metrics_set(run->metrics, "in_plane_deviation_rms", sqrt(squares / grid->count));
    metrics_set(run->metrics, "slide", slide);
    metrics_set(run->metrics, "slide_error", fabs(slide / exact - 1));
    metrics_set(run->metrics, "tunnelled", through);
    particles_free(&start);
}

static void measure_end(const struct run *run, const struct frame *frame,
                        const struct particles *grid, int32_t steps, const struct heights *heights)
{
    measure_shape(run, frame, grid, steps);
    metrics_set(run->metrics, "height_range_in_r", (heights->highest - heights->lowest) / radius);
    metrics_set(run->metrics, "normal_speed_rms",
                sqrt(heights->speed_squares / (double)heights->count));
}

/* At the start all particles stand at one height, and a corrected slope is the normal over that,
 * downwards. The largest error, beside 1 / height. */
static double slope_error(const struct sph *sph, const struct frame *frame, struct contact *contact,
                          struct particles *grid)
{
    double worst = 0;
    for (int again = 0; again < 2; ++again) { /* what was found at another height must not stay */
        for (int32_t i = 0; i < grid->count; ++i)
            add_scaled(grid->x[i], (again ? 0.5 : -0.5) * start_height, frame->axes[1]);
        contact_update(sph, contact, grid);
    }
    for (int32_t i = 0; i < grid->count; ++i) {
        vector off = {0};
        add_scaled(off, start_height, contact->slope[i]);
        add_scaled(off, 1, frame->axes[1]);
        worst = fmax(worst, sqrt(dot(off, off)));
    }
    return worst;
}

static void simulate(const struct run *run)
{
    const struct frame frame = inclined_frame();
    const int32_t steps = run->options->brief ? 0 : run->options->full ? 2500 : 1500;
    struct random random = {run->options->seed};
    struct sph sph = run_open(run, 3, support_radius, SIDE * SIDE);
    struct wall wall = make_wall(&sph, &frame, &random, exact_slide(steps));
    struct particles grid = make_grid(&frame);
    struct contact contact = contact_new(&sph, &wall, grid.count);
    struct pressure pressure = pressure_new(&sph, &contact, grid.count);
    struct heights heights = {.lowest = INFINITY, .highest = -INFINITY};
    metrics_set(run->metrics, "slope_error", slope_error(&sph, &frame, &contact, &grid));
    pressure.relaxation = 1; /* no particle waits for another: one iteration is the solution */
    pressure.fewest_iterations = 1;
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        pressure_prepare(&pressure, &grid);
        pressure_stop_compression(&pressure, &grid, step);
        for (int32_t i = 0; i < grid.count; ++i)
            grid.v[i][1] -= step * gravity;
        pressure_keep_density(&pressure, &grid, step);
        for (int32_t i = 0; i < grid.count; ++i)
            add_scaled(grid.x[i], step, grid.v[i]);
        if (step * k > settled)
            watch_heights(&frame, &grid, &heights);
        if (k % 100 == 0)
            output_state(run, k / 100, step * (k + 1), &grid);
    }
    metrics_set(run->metrics, "wall_particles", wall.count);
    if (!run->options->brief)
        measure_end(run, &frame, &grid, steps, &heights);
    pressure_free(&pressure);
    contact_free(&contact);
    particles_free(&grid);
    wall_free(&wall);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    FILE *script = picture->script;
    picture_begin(picture, 1100, 520);
    fprintf(script,
            "set size ratio -1\nset cbrange [0:0.5]\nset xrange [-0.5:3]\nset yrange [-1.75:1.75]\n"
            "set xlabel 'downhill [m]'\nset ylabel 'across [m]'\n");
    picture_bar(picture, 0.9, "distance from the place in the grid [m]");
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.07 + 0.42 * k, 0.46 + 0.42 * k);
        fprintf(script,
                "set title '%s: the grid at the end of its slide, from above'\n"
                "plot 'grid_%s_places.dat' using 1:2:3 with points pt 7 ps 1 lc palette\n"
                "unset ylabel\nset format y ''\n",
                picture->titles[k], picture->methods[k]);
    }
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"in_plane_deviation", ONLY_SPH, AT_LEAST, 0.05},
                                        {"slope_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"in_plane_deviation", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"slide_error", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {"tunnelled", EACH_CORRECTED, AT_MOST, 0},
                                        {"height_range_in_r", EACH_CORRECTED, AT_LEAST, 0.5},
                                        {"height_range_in_r", EACH_CORRECTED, AT_MOST, 1.5},
                                        {0}};
    static const struct scene scene = {
        "grid", "A grid of particles slides down an inclined plane.", simulate, draw, gates, true,
        false};
    return scene_main(&scene, argc, argv);
}
