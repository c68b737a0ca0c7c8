/* SPDX-License-Identifier: MIT */
/* A sheet of a very viscous fluid, standing on its edge, buckles as it sinks (the paper's Fig. 7).
 * Folding is mostly rotation, which uncorrected viscosity resists. In 2D; the full size adds the
 * same in 3D, and other viscosities. */
#include "solver/output.h"
#include "solver/viscous_fluid.h"
#include <math.h>
#include <stdlib.h>

static const double spacing = 0.05;
static const double support_radius = 0.1;
static const double density = 1000;
static const double kinematic = 20;               /* nu [m^2/s] */
static const double gravity[3] = {0.1, -9.81, 0}; /* leans a little, as the paper's scene does */
static const double friction = 0.1;               /* at the wall, a share of XSPH */
static const double step = 2e-3;
static const double early = 1.5, late = 2.1; /* [s] */

/* A floor at y = 0, twice as dense as the fluid. */
static struct wall make_floor(const struct sph *sph, double half_length, double half_width)
{
    const double apart = 0.5 * spacing;
    const int32_t columns = 2 * (int32_t)(half_length / apart) + 1;
    const int32_t rows = 2 * (int32_t)(half_width / apart) + 1;
    vector *x = array_new(columns * rows, sizeof *x);
    for (int32_t k = 0; k < columns * rows; ++k) {
        x[k][0] = apart * (k % columns - columns / 2);
        x[k][2] = apart * (k / columns - rows / 2);
    }
    return wall_new(sph, columns * rows, x);
}

/* sides: its form in particles; sides[2] above 1 is 3D. */
static void sheet_init(struct viscous_fluid *sheet, const struct run *run, const struct sph *sph,
                       const int32_t sides[3], double nu)
{
    struct random random = {run->options->seed};
    struct particles fluid = particles_block(sides, spacing, 1e-3, density, &random);
    for (int32_t i = 0; i < fluid.count; ++i)
        fluid.x[i][1] += spacing * (0.5 * (sides[1] - 1) + 1);
    viscous_fluid_init(sheet, sph, make_floor(sph, 4, sides[2] > 1 ? 1 : 0), fluid, nu * density);
}

/* Mean x of the particles with y in [low, high); 0 where there are none. */
static double centre_of_slice(const struct particles *fluid, double low, double high)
{
    double sum = 0;
    int32_t count = 0;
    for (int32_t i = 0; i < fluid->count; ++i)
        if (fluid->x[i][1] >= low && fluid->x[i][1] < high) {
            sum += fluid->x[i][0];
            ++count;
        }
    return count ? sum / count : 0;
}

/* How far the centre line of the sheet has left x = 0. */
static double centre_line(const struct particles *fluid)
{
    const double slice = 0.1;
    double farthest = 0;
    for (int32_t k = 0; k < 60; ++k)
        farthest = fmax(farthest, fabs(centre_of_slice(fluid, slice * k, slice * (k + 1))));
    return farthest;
}

static double highest(const struct particles *fluid)
{
    double top = 0;
    for (int32_t i = 0; i < fluid->count; ++i)
        top = fmax(top, fluid->x[i][1]);
    return top;
}

/* Turning points of the fold near the floor, counted when it has come back by 0.1 m. */
struct folds {
    double extreme, side;
    int32_t reversals;
};

static void folds_follow(struct folds *folds, double place)
{
    if (folds->side == 0) {
        folds->side = fabs(place) > 0.05 ? copysign(1, place) : 0;
        folds->extreme = place;
    } else if (folds->side * (place - folds->extreme) > 0) {
        folds->extreme = place;
    } else if (folds->side * (folds->extreme - place) > 0.1) {
        ++folds->reversals;
        folds->side = -folds->side;
        folds->extreme = place;
    }
}

static void write_sheet(const struct run *run, const struct particles *fluid, const char *label)
{
    FILE *table = output_open(run, label);
    for (int32_t i = 0; table && i < fluid->count; ++i)
        fprintf(table, "%g %g %g\n", fluid->x[i][0], fluid->x[i][1],
                sqrt(dot(fluid->v[i], fluid->v[i])));
    output_close(table);
}

struct outcome {
    double amplitude, early_top, late_top, iterations, pressure_iterations;
    int32_t reversals;
};

static struct outcome sink(const struct run *run, const struct sph *sph, const int32_t sides[3],
                           double nu, bool kept)
{
    struct viscous_fluid sheet;
    struct folds folds = {0};
    struct outcome outcome = {0};
    const int32_t middle = (int32_t)(early / step + 0.5), steps = (int32_t)(late / step + 0.5);
    sheet_init(&sheet, run, sph, sides, nu);
    for (int32_t k = 0; k < steps; ++k) {
        run_progress(run, k + 1, steps);
        viscous_fluid_step(&sheet, gravity, friction, step);
        folds_follow(&folds, centre_of_slice(&sheet.particles, 0.4, 0.6));
        if (k + 1 == middle) {
            outcome.amplitude = centre_line(&sheet.particles);
            outcome.early_top = highest(&sheet.particles);
            if (kept)
                write_sheet(run, &sheet.particles, "early");
        }
        if (kept && k % 25 == 0)
            output_state(run, k / 25, step * (k + 1), &sheet.particles);
    }
    if (kept)
        write_sheet(run, &sheet.particles, "late");
    outcome.late_top = highest(&sheet.particles);
    outcome.reversals = folds.reversals;
    outcome.iterations = (double)sheet.viscosity.implicit.iterations / steps;
    outcome.pressure_iterations = (double)sheet.pressure.density_iterations / steps;
    viscous_fluid_free(&sheet);
    return outcome;
}

static void set_outcome(const struct run *run, const struct outcome *outcome)
{
    metrics_set(run->metrics, "amplitude", outcome->amplitude);
    metrics_set(run->metrics, "reversals", outcome->reversals);
    metrics_set(run->metrics, "top_early", outcome->early_top);
    metrics_set(run->metrics, "top_late", outcome->late_top);
    metrics_set(run->metrics, "iterations", outcome->iterations);
    metrics_set(run->metrics, "pressure_iterations", outcome->pressure_iterations);
}

/* Other viscosities in 2D, and the sheet in 3D. */
static void more(const struct run *run, const struct sph *flat, const int32_t sides[3])
{
    static const char *const amplitudes[] = {"amplitude_5", "amplitude_10", "amplitude_40"};
    static const char *const reversals[] = {"reversals_5", "reversals_10", "reversals_40"};
    static const double others[] = {5, 10, 40};
    static const int32_t solid[3] = {3, 120, 12};
    struct sph sph = run_open(run, 3, support_radius, 4320);
    for (int k = 0; k < 3; ++k) {
        const struct outcome outcome = sink(run, flat, sides, others[k], false);
        metrics_set(run->metrics, amplitudes[k], outcome.amplitude);
        metrics_set(run->metrics, reversals[k], outcome.reversals);
    }
    const struct outcome outcome = sink(run, &sph, solid, kinematic, false);
    metrics_set(run->metrics, "amplitude_3d", outcome.amplitude);
    metrics_set(run->metrics, "reversals_3d", outcome.reversals);
    metrics_set(run->metrics, "top_late_3d", outcome.late_top);
    sph_close(&sph);
}

/* What viscosity makes of a shear flow in the sheet as it stands. */
static void measure_start(const struct run *run, const struct sph *sph, const int32_t sides[3])
{
    struct viscous_fluid sheet;
    sheet_init(&sheet, run, sph, sides, kinematic);
    viscous_fluid_measure_shear(&sheet, run->metrics);
    viscous_fluid_free(&sheet);
}

static void simulate_sheets(const struct run *run, const struct sph *sph, const int32_t sides[3])
{
    const struct outcome outcome = sink(run, sph, sides, kinematic, true);
    set_outcome(run, &outcome);
    if (run->options->full)
        more(run, sph, sides);
}

static void simulate(const struct run *run)
{
    static const int32_t sides[3] = {4, 80, 1};
    struct sph sph = run_open(run, 2, support_radius, 320);
    measure_start(run, &sph, sides);
    if (!run->options->brief)
        simulate_sheets(run, &sph, sides);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    static const char *const labels[] = {"early", "late"};
    const double times[] = {early, late};
    FILE *script = picture->script;
    picture_begin(picture, 1300, 480);
    fprintf(script, "set size ratio -1\nset cbrange [0:4]\nset xrange [-0.85:1.05]\n"
                    "set yrange [0:2.5]\nset xtics 0.5\nset xlabel 'x [m]'\nset ylabel 'y [m]'\n"
                    "set cbtics 1\n");
    picture_bar(picture, 0.94, "speed [m/s]");
    for (int t = 0; t < 2; ++t)
        for (int k = 0; k < 2; ++k) {
            const double left = 0.06 + 0.218 * (2 * t + k);
            picture_panel(picture, left, left + 0.21);
            fprintf(script,
                    "set title '%s, %g s'\n"
                    "plot 'buckling_%s_%s.dat' using 1:2:(0.025):3 with circles lc palette\n"
                    "unset ylabel\nset format y ''\n",
                    picture->titles[k], times[t], picture->methods[k], labels[t]);
        }
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"shear_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"shear_rate_error", EACH_CORRECTED, AT_MOST, 1e-11},
                                        {"amplitude", ONLY_KGC, TIMES_SPH, 1.5},
                                        {"amplitude", EACH_CORRECTED, AT_MOST, 0.6},
                                        {"reversals", ONLY_SPH, AT_MOST, 0},
                                        {"reversals", ONLY_KGC, MORE_THAN_SPH, 1},
                                        {"reversals", EACH_CORRECTED, AT_MOST, 4},
                                        {"top_early", EACH_CORRECTED, AT_LEAST, 1.8},
                                        {"top_early", EACH_CORRECTED, AT_MOST, 2.6},
                                        {"top_late", EACH_CORRECTED, AT_LEAST, 0.5},
                                        {"top_late", EACH_CORRECTED, AT_MOST, 1.2},
                                        {0}};
    static const struct scene scene = {
        "buckling", "A sinking sheet of viscous fluid.", simulate, draw, gates, false, false};
    return scene_main(&scene, argc, argv);
}
