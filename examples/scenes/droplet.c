/* SPDX-License-Identifier: MIT */
/* A cube of water without gravity (the paper's Fig. 8): surface tension should make it a ball. How
 * round it is says its support function, the extent from the centre in 400 directions; moments of
 * inertia would not do, because those of a cube are already those of a ball. */
#include "solver/laplacian.h"
#include "solver/output.h"
#include "solver/pressure.h"
#include "solver/surface_tension.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 0.05;
static const double support_radius = 0.1;
static const double density = 1000;
static const double kinematic = 0.1; /* nu [m^2/s] */
static const double weak = 10;       /* kappa [N] */
static const double control = 50;    /* what plain SPH might be given to do better */
static const double step = 2e-3;

enum { DIRECTIONS = 400 };

struct drop {
    struct particles fluid;
    struct pressure pressure;
    struct operators operators;
    struct surface_tension tension;
    struct laplacian viscosity;
    vector *acceleration;
};

static struct drop drop_new(const struct run *run, const struct sph *sph)
{
    struct random random = {run->options->seed};
    const int32_t side = run->options->full ? 20 : 10, sides[3] = {side, side, side};
    struct drop drop = {.fluid = particles_block(sides, spacing, 0.025, density, &random)};
    drop.pressure = pressure_new(sph, NULL, drop.fluid.count);
    drop.operators = operators_new(sph, drop.pressure.neighbors, drop.fluid.count);
    drop.acceleration = array_new(drop.fluid.count, sizeof *drop.acceleration);
    return drop;
}

static void drop_free(struct drop *drop)
{
    surface_tension_free(&drop->tension);
    laplacian_free(&drop->viscosity);
    operators_free(&drop->operators);
    pressure_free(&drop->pressure);
    particles_free(&drop->fluid);
    free(drop->acceleration);
}

static void advance(struct drop *drop)
{
    struct particles *fluid = &drop->fluid;
    pressure_prepare(&drop->pressure, fluid);
    pressure_stop_compression(&drop->pressure, fluid, step);
    operators_update(&drop->operators, fluid);
    memset(drop->acceleration, 0, (size_t)fluid->count * sizeof *drop->acceleration);
    laplacian_step(&drop->viscosity, fluid, 0, step);
    surface_tension_add(&drop->tension, fluid, drop->acceleration);
    for (int32_t i = 0; i < fluid->count; ++i)
        add_scaled(fluid->v[i], step, drop->acceleration[i]);
    pressure_keep_density(&drop->pressure, fluid, step);
    for (int32_t i = 0; i < fluid->count; ++i)
        add_scaled(fluid->x[i], step, fluid->v[i]);
}

static void find_centre(const struct particles *fluid, double *place, double *velocity)
{
    memset(place, 0, sizeof(vector));
    memset(velocity, 0, sizeof(vector));
    for (int32_t i = 0; i < fluid->count; ++i) {
        add_scaled(place, 1.0 / fluid->count, fluid->x[i]);
        add_scaled(velocity, 1.0 / fluid->count, fluid->v[i]);
    }
}

/* Directions that cover the sphere evenly, on a spiral of the golden angle. */
static void direction(int32_t k, double *toward)
{
    const double height = 1 - 2 * (k + 0.5) / DIRECTIONS, across = sqrt(1 - height * height);
    const double angle = k * 2.399963229728653;
    toward[0] = across * cos(angle);
    toward[1] = across * sin(angle);
    toward[2] = height;
}

static double extent(const struct particles *fluid, const double *centre, const double *toward)
{
    double farthest = -INFINITY;
    for (int32_t i = 0; i < fluid->count; ++i)
        farthest = fmax(farthest, dot(fluid->x[i], toward) - dot(centre, toward));
    return farthest;
}

struct roundness {
    double variation; /* standard deviation of the extents over their mean */
    double ratio;     /* smallest over largest */
    double drift;     /* speed of the centre */
    double motion;    /* rms speed against the centre */
};

static struct roundness measure(const struct particles *fluid)
{
    vector centre, velocity, toward;
    double sum = 0, squares = 0, least = INFINITY, most = 0, motion = 0;
    find_centre(fluid, centre, velocity);
    for (int32_t k = 0; k < DIRECTIONS; ++k) {
        direction(k, toward);
        const double far = extent(fluid, centre, toward);
        sum += far;
        squares += far * far;
        least = fmin(least, far);
        most = fmax(most, far);
    }
    for (int32_t i = 0; i < fluid->count; ++i) {
        vector relative = {0};
        add_scaled(relative, 1, fluid->v[i]);
        add_scaled(relative, -1, velocity);
        motion += dot(relative, relative);
    }
    const double mean = sum / DIRECTIONS;
    return (struct roundness){sqrt(fmax(0, squares / DIRECTIONS - mean * mean)) / mean,
                              least / most, sqrt(dot(velocity, velocity)),
                              sqrt(motion / fluid->count)};
}

static void write_drop(const struct run *run, const struct particles *fluid)
{
    static const double eye[3] = {1, -1.6, 0.9};
    double *depth = array_new(fluid->count, sizeof *depth);
    const double radius = cbrt(fluid->count * fluid->rest_volume * 3 / (4 * 3.141592653589793));
    vector centre, velocity;
    find_centre(fluid, centre, velocity);
    for (int32_t i = 0; i < fluid->count; ++i) {
        vector relative = {0};
        add_scaled(relative, 1, fluid->x[i]);
        add_scaled(relative, -1, centre);
        depth[i] = sqrt(dot(relative, relative)) / radius;
    }
    output_view(run, "drop", eye, fluid->count, fluid->x, depth);
    free(depth);
}

enum kept { KEEPS_FILES, KEEPS_NOTHING };

static struct roundness form(const struct run *run, const struct sph *sph, double strength,
                             bool balanced, double duration, enum kept kept)
{
    struct drop drop = drop_new(run, sph);
    const int32_t steps = (int32_t)(duration / step + 0.5);
    FILE *series = kept == KEEPS_FILES ? output_open(run, "roundness") : NULL;
    drop.viscosity = laplacian_new(sph, drop.pressure.neighbors, drop.fluid.count);
    drop.viscosity.kinematic = kinematic;
    drop.tension = surface_tension_new(&drop.operators, drop.fluid.count);
    drop.tension.strength = strength;
    drop.tension.balanced = balanced;
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        advance(&drop);
        if (series && k % 10 == 0)
            fprintf(series, "%g %g\n", step * k, measure(&drop.fluid).variation);
        if (series && k % 50 == 0)
            output_state(run, k / 50, step * (k + 1), &drop.fluid);
    }
    const struct roundness found = measure(&drop.fluid);
    if (kept == KEEPS_FILES) {
        write_drop(run, &drop.fluid);
        metrics_set(run->metrics, "net_force_share", drop.tension.net_share);
        metrics_set(run->metrics, "pressure_iterations",
                    (double)(drop.pressure.rate_iterations + drop.pressure.density_iterations) /
                        steps);
    }
    output_close(series);
    drop_free(&drop);
    return found;
}

/* How the tension of the cube, as it stands, pulls inward: the mean of -m a . x [N m]. */
static double pull(const struct run *run, const struct sph *sph)
{
    struct drop drop = drop_new(run, sph);
    double sum = 0;
    drop.tension = surface_tension_new(&drop.operators, drop.fluid.count);
    drop.tension.strength = weak;
    drop.tension.balanced = run->method != SPH;
    pressure_prepare(&drop.pressure, &drop.fluid);
    operators_update(&drop.operators, &drop.fluid);
    surface_tension_add(&drop.tension, &drop.fluid, drop.acceleration);
    for (int32_t i = 0; i < drop.fluid.count; ++i)
        sum -= drop.fluid.mass[i] * dot(drop.acceleration[i], drop.fluid.x[i]);
    sum /= drop.fluid.count;
    drop_free(&drop);
    return sum;
}

static void simulate_drops(const struct run *run, const struct sph *sph)
{
    const double duration = run->options->full ? 4 : 2.4;
    const struct roundness found = form(run, sph, weak, run->method != SPH, duration, KEEPS_FILES);
    metrics_set(run->metrics, "variation", found.variation);
    metrics_set(run->metrics, "least_over_most", found.ratio);
    metrics_set(run->metrics, "drift", found.drift);
    metrics_set(run->metrics, "motion", found.motion);
    if (run->method == SPH)
        metrics_set(run->metrics, "control_variation",
                    form(run, sph, control, false, duration, KEEPS_NOTHING).variation);
    else
        metrics_set(run->metrics, "printed_drift",
                    form(run, sph, weak, false, 0.6, KEEPS_NOTHING).drift);
}

static void simulate(const struct run *run)
{
    struct sph sph = run_open(run, 3, support_radius, run->options->full ? 8000 : 1000);
    metrics_set(run->metrics, "pull", pull(run, &sph));
    if (!run->options->brief)
        simulate_drops(run, &sph);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    picture_begin(picture, 1300, 420);
    picture_bar(picture, 0.59, "distance from the centre [radii]");
    fprintf(picture->script, "set cbrange [0.8:1.15]\n");
    picture_views(picture, "drop", 0.5 * spacing, "what was a cube", 0.295);
    fprintf(picture->script, "set key top right\nset title 'how round'\n"
                             "set ylabel 'variation of the extent'\nset yrange [0:0.11]\n");
    picture_series(picture, "roundness");
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"pull", EACH_CORRECTED, AT_LEAST, 0.3},
                                        {"pull", EACH_CORRECTED, AT_MOST, 0.7},
                                        {"variation", EACH_CORRECTED, AT_LEAST, 1e-3},
                                        {"variation", EACH_CORRECTED, AT_MOST, 0.015},
                                        {"variation", EACH_CORRECTED, SHARE_OF_SPH, 1.0 / 3},
                                        {"least_over_most", EACH_CORRECTED, AT_LEAST, 0.9},
                                        {"drift", EACH_CORRECTED, AT_MOST, 2e-3},
                                        {"printed_drift", EACH_CORRECTED, AT_LEAST, 5e-3},
                                        {0}};
    static const struct scene scene = {
        "droplet", "A cube of water in zero gravity.", simulate, draw, gates, false, false};
    return scene_main(&scene, argc, argv);
}
