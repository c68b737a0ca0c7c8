/* SPDX-License-Identifier: MIT */
/* An elastic bunny, viscous soap and water in a rotating drum, all coupled (the paper's Fig. 1),
 * with its Table 2: where the time of a step goes, and how little of it the correction matrices
 * take. */
#include "drum.h"
#include "drum_view.h"
#include "solver/elasticity.h"
#include "solver/laplacian.h"
#include "solver/output.h"
#include "solver/pressure.h"
#include "solver/stopwatch.h"
#include "solver/time_step.h"
#include "solver/viscosity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double young = 2e5, poisson = 0.33;
static const double soap_viscosity = 5 * 1100; /* mu [Pa s] */
static const double water_viscosity = 0.01;    /* nu [m^2/s] */
static const double friction = 0.1;
static const double rest_time = 0.3;  /* the drum stands still [s] ... */
static const double ramp_time = 0.3;  /* ... then gains speed ... */
static const double full_speed = 4;   /* ... up to this [1/s] */
static const double pour_speed = 0.5; /* of soap and water from the nozzles [m/s] */
static const double gravity[3] = {0, -9.81, 0};
static const double longest_step = 1e-3; /* [s] */
static const double whole_turn = 6.283185307179586;
enum { STEPS_BETWEEN_SORTS = 100, MOST_SHARES = 10000 };

/* The matrices' share of the time, of each group of steps with one weighing of the wall's. Their
 * median is what a step usually spends: a weighing counts for its whole group, so that a sum over
 * all of them is at the mercy of the few that something interrupted. */
struct shares {
    int32_t count;
    double matrices, seconds; /* so far */
    double values[MOST_SHARES];
};

struct machine {
    const struct sph *sph;
    double spacing, time, last_poured, angle;
    struct load load;
    struct wall wall;
    struct contact contact;
    struct pressure pressure;
    struct elasticity elasticity;
    struct operators soap_operators;
    struct viscosity soap;
    struct laplacian water;
    double worst_compression, least_volume, fastest;
    int32_t steps, frames; /* made, and written */
    enum bunny_part *parts;
};

/* Films are for the eye, which sees no bunny in the few particles of the quick size. */
static double spacing_of(const struct options *options)
{
    return options->full ? 0.0105 : options->frames ? 0.019 : 0.028;
}

/* Full: the drum turns twice. */
static double duration_of(const struct options *options)
{
    return options->full ? 3.7 : options->frames ? 1.8 : 1.2;
}

static void sort(struct machine *machine, bool with_body)
{
    const struct particles *all = &machine->load.all;
    sph_search(machine->sph, machine->pressure.neighbors, all->count, all->x);
    load_sort(machine->sph, &machine->load, machine->pressure.neighbors, with_body);
}

static void machine_init(struct machine *machine, const struct run *run, const struct sph *sph)
{
    memset(machine, 0, sizeof *machine);
    machine->sph = sph;
    machine->spacing = spacing_of(run->options);
    machine->load = load_new(machine->spacing, run->options->seed);
    machine->wall = drum_wall(sph, machine->spacing);
    const int32_t capacity = machine->load.capacity;
    struct particles body = particles_range(&machine->load.all, 0, machine->load.body);
    machine->contact = contact_new(sph, &machine->wall, capacity);
    machine->contact.threshold = 0.05; /* a curved wall: exact normals are not to be had */
    machine->contact.skin = 0;         /* all of it moves */
    machine->pressure = pressure_new(sph, &machine->contact, capacity);
    machine->pressure.kept = 0.8;
    sort(machine, true);
    machine->parts = array_new(machine->load.body, sizeof *machine->parts);
    bunny_paint(machine->load.body, machine->load.all.x, machine->parts);
    machine->elasticity = elasticity_new(sph, &body, young, poisson);
    machine->elasticity.implicit.tolerance = 1e-3;
    machine->soap_operators = operators_new(sph, NULL, capacity);
    machine->soap = viscosity_new(&machine->soap_operators, capacity);
    machine->soap.dynamic = soap_viscosity;
    machine->soap.warm = true;
    machine->soap.implicit.tolerance = 1e-2; /* a warm start: what is left follows in later steps */
    machine->water = laplacian_new(sph, machine->pressure.neighbors, capacity);
    machine->water.kinematic = water_viscosity;
    machine->least_volume = INFINITY;
}

static void machine_free(struct machine *machine)
{
    laplacian_free(&machine->water);
    viscosity_free(&machine->soap);
    operators_free(&machine->soap_operators);
    elasticity_free(&machine->elasticity);
    pressure_free(&machine->pressure);
    contact_free(&machine->contact);
    wall_free(&machine->wall);
    load_free(&machine->load);
    free(machine->parts);
}

static double drum_speed(double time)
{
    return full_speed * fmin(1, fmax(0, time - rest_time) / ramp_time);
}

/* All that is not pressure, phase by phase. */
static void apply_forces(struct machine *machine, double dt)
{
    struct load *load = &machine->load;
    struct particles body = particles_range(&load->all, 0, load->body);
    struct particles soap = particles_range(&load->all, load->body, load->soap);
    const double *spent = machine->sph->spent;
    const double elsewhere = spent[SEARCH] + spent[FLUID_MATRICES], start = stopwatch_now();
    for (int32_t i = 0; i < load->all.count; ++i)
        add_scaled(load->all.v[i], dt, gravity);
    operators_update(&machine->soap_operators, &soap);
    viscosity_solve(&machine->soap, &soap, dt);
    laplacian_solve(&machine->water, &load->all, load->soap, dt);
    elasticity_solve(&machine->elasticity, &body, dt);
    contact_friction(&machine->contact, friction, &load->all);
    machine->sph->spent[FORCES] +=
        stopwatch_now() - start - (spent[SEARCH] + spent[FLUID_MATRICES] - elsewhere);
}

static void observe(struct machine *machine)
{
    const struct particles *all = &machine->load.all;
    double over = 0;
    for (int32_t i = 0; i < all->count; ++i)
        over += fmax(0, machine->pressure.compression[i] - 1) / all->count;
    machine->worst_compression = fmax(machine->worst_compression, over);
    machine->least_volume =
        fmin(machine->least_volume, elasticity_least_volume(&machine->elasticity));
    if (machine->time > rest_time)
        machine->fastest = fmax(machine->fastest, particles_fastest(all));
}

static void advance(struct machine *machine)
{
    struct particles *all = &machine->load.all;
    const double dt = time_step(all, machine->spacing, longest_step);
    const double speed = drum_speed(machine->time);
    drum_turn(&machine->wall, speed * dt, speed);
    machine->angle += speed * dt;
    if (machine->steps++ % STEPS_BETWEEN_SORTS == 0)
        sort(machine, false);
    pressure_prepare(&machine->pressure, all);
    pressure_stop_compression(&machine->pressure, all, dt);
    apply_forces(machine, dt);
    pressure_keep_density(&machine->pressure, all, dt);
    observe(machine);
    for (int32_t i = 0; i < all->count; ++i)
        add_scaled(all->x[i], dt, all->v[i]);
    machine->time += dt;
    if (machine->time > rest_time &&
        machine->time - machine->last_poured > machine->spacing / pour_speed) {
        load_pour(&machine->load, machine->spacing, pour_speed);
        machine->last_poured = machine->time;
    }
}

/* Fluids, body and drum as the phases 0 (body), 1 (soap), 2 (water) and 3 (drum). */
static void write_particles(const struct run *run, const struct machine *machine, int32_t frame)
{
    const struct load *load = &machine->load;
    const struct wall *wall = &machine->wall;
    const int32_t inside = load->all.count, count = inside + wall->count;
    double *phase = array_new(count, sizeof *phase);
    vector *x = array_new(count, sizeof *x), *v = array_new(count, sizeof *v);
    for (int32_t i = 0; i < count; ++i)
        phase[i] = (i >= load->body) + (i >= load->soap) + (i >= inside);
    memcpy(x, load->all.x, (size_t)inside * sizeof *x);
    memcpy(v, load->all.v, (size_t)inside * sizeof *v);
    memcpy(x + inside, wall->x, (size_t)wall->count * sizeof *x);
    memcpy(v + inside, wall->v, (size_t)wall->count * sizeof *v);
    const struct output_field fields[] = {{"phase", phase, 1}, {"velocity", v[0], 3}, {0}};
    output_particles(run, frame, machine->time, count, x, fields);
    free(phase);
    free(x);
    free(v);
}

static void write_view(const struct machine *machine, FILE *table)
{
    const struct drum_view view = {&machine->load, &machine->wall, machine->parts, machine->spacing,
                                   machine->angle};
    drum_view_write(&view, table);
    output_close(table);
}

/* Frames of the film that are due. */
static void write_frames(const struct run *run, struct machine *machine, double share)
{
    for (; machine->frames < run_frames(run, fmin(1, share)); ++machine->frames)
        write_view(machine, output_open_frame(run, "drum", machine->frames));
}

static void note_share(struct shares *shares, const double *spent, double all_seconds)
{
    const double seconds = all_seconds - spent[MEASURING];
    const double matrices = spent[FLUID_MATRICES] + spent[WALL_MATRICES];
    if (shares->count < MOST_SHARES)
        shares->values[shares->count++] =
            (matrices - shares->matrices) / (seconds - shares->seconds);
    shares->matrices = matrices;
    shares->seconds = seconds;
}

static int ascending(const void *a, const void *b)
{
    const double *first = a, *second = b;
    return (*first > *second) - (*first < *second);
}

static double median_share(struct shares *shares)
{
    qsort(shares->values, (size_t)shares->count, sizeof *shares->values, ascending);
    return shares->values[shares->count / 2];
}

/* Milliseconds per step, as in the paper's Table 2 with wall matrices and remainder beside. */
static void set_costs(const struct run *run, const struct machine *machine, double all_seconds)
{
    const double *spent = machine->sph->spent, each = 1000.0 / machine->steps;
    const double seconds = all_seconds - spent[MEASURING];
    const double matrices = spent[FLUID_MATRICES] + spent[WALL_MATRICES];
    double named = 0;
    for (int k = 0; k < MEASURING; ++k)
        named += spent[k];
    metrics_set(run->metrics, "ms_search", each * spent[SEARCH]);
    metrics_set(run->metrics, "ms_forces", each * spent[FORCES]);
    metrics_set(run->metrics, "ms_pressure", each * spent[PRESSURE]);
    metrics_set(run->metrics, "ms_fluid_matrices", each * spent[FLUID_MATRICES]);
    metrics_set(run->metrics, "ms_wall_matrices", each * spent[WALL_MATRICES]);
    metrics_set(run->metrics, "ms_remainder", each * (seconds - named));
    metrics_set(run->metrics, "ms_total", each * seconds);
    metrics_set(run->metrics, "matrices_share", matrices / seconds);
    metrics_set(run->metrics, "matrices_of_pressure", matrices / spent[PRESSURE]);
}

static int32_t count_escaped(const struct load *load)
{
    int32_t escaped = 0;
    for (int32_t i = 0; i < load->all.count; ++i)
        escaped += !drum_holds(load->all.x[i]);
    return escaped;
}

static double each_step(const struct machine *machine, int64_t count)
{
    return (double)count / machine->steps;
}

static void set_outcome(const struct run *run, const struct machine *machine)
{
    const struct load *load = &machine->load;
    metrics_set(run->metrics, "body", load->body);
    metrics_set(run->metrics, "soap", load->soap - load->body);
    metrics_set(run->metrics, "water", load->all.count - load->soap);
    metrics_set(run->metrics, "wall", machine->wall.count);
    metrics_set(run->metrics, "steps", machine->steps);
    metrics_set(run->metrics, "turns", machine->angle / whole_turn);
    metrics_set(run->metrics, "escaped", count_escaped(load));
    metrics_set(run->metrics, "mean_compression", machine->worst_compression);
    metrics_set(run->metrics, "fastest", machine->fastest);
    metrics_set(run->metrics, "least_volume_of_body", machine->least_volume);
    metrics_set(run->metrics, "iterations_soap",
                each_step(machine, machine->soap.implicit.iterations));
    metrics_set(run->metrics, "iterations_water",
                each_step(machine, machine->water.implicit.iterations));
    metrics_set(run->metrics, "iterations_body",
                each_step(machine, machine->elasticity.implicit.iterations));
    metrics_set(run->metrics, "iterations_rate",
                each_step(machine, machine->pressure.rate_iterations));
    metrics_set(run->metrics, "iterations_density",
                each_step(machine, machine->pressure.density_iterations));
}

/* A full run takes long: what it came to so far. Time, turns, particles, escaped, compression, det
 * F, speed; iterations of soap, water, body, rate, density; then milliseconds as in enum account.
 */
static void write_state(FILE *series, const struct machine *machine)
{
    if (!series)
        return;
    fprintf(series, "%g %g %d %d %g %g %g", machine->time, machine->angle / whole_turn,
            (int)machine->load.all.count, (int)count_escaped(&machine->load),
            machine->worst_compression, machine->least_volume, machine->fastest);
    fprintf(series, "  %g %g %g %g %g ", each_step(machine, machine->soap.implicit.iterations),
            each_step(machine, machine->water.implicit.iterations),
            each_step(machine, machine->elasticity.implicit.iterations),
            each_step(machine, machine->pressure.rate_iterations),
            each_step(machine, machine->pressure.density_iterations));
    for (int k = 0; k < MEASURING; ++k)
        fprintf(series, " %g", 1000.0 / machine->steps * machine->sph->spent[k]);
    fprintf(series, "\n");
    fflush(series);
}

/* What elasticity makes of a stretched bunny, viscosity of a shear flow in the soap. */
static void measure_start(const struct run *run, struct machine *machine)
{
    struct load *load = &machine->load;
    const struct particles body = particles_range(&load->all, 0, load->body);
    const struct particles soap = particles_range(&load->all, load->body, load->soap);
    metrics_set(run->metrics, "stretch_error",
                elasticity_stretch_error(&machine->elasticity, &body, 0.01));
    operators_update(&machine->soap_operators, &soap);
    const struct shear_errors errors = viscosity_shear_errors(&machine->soap, &soap);
    metrics_set(run->metrics, "shear_error", errors.power);
    metrics_set(run->metrics, "shear_rate_error", errors.rate);
}

static void simulate(const struct run *run)
{
    const double duration = run->options->brief ? 0 : duration_of(run->options);
    const double apart = 0.05;
    struct sph sph =
        run_open(run, 3, 2 * spacing_of(run->options), run->options->full ? 70000 : 3000);
    struct machine machine;
    static struct shares shares;
    int32_t frame = 0;
    FILE *series = output_open(run, "series");
    machine_init(&machine, run, &sph);
    measure_start(run, &machine);
    memset(&shares, 0, sizeof shares);
    memset(sph.spent, 0, ACCOUNT_COUNT * sizeof *sph.spent);
    double seconds = 0;
    while (machine.time < duration) {
        const double start = stopwatch_now();
        advance(&machine);
        seconds += stopwatch_now() - start;
        if (machine.steps % UPDATES_PER_WEIGHING == 0)
            note_share(&shares, sph.spent, seconds);
        run_progress(run, machine.time, duration);
        if (run->options->output && machine.time >= apart * frame) {
            write_particles(run, &machine, frame++);
            write_state(series, &machine);
        }
        write_frames(run, &machine, machine.time / duration);
    }
    if (run->options->output)
        write_view(&machine, output_open(run, "drum"));
    output_close(series);
    if (!run->options->brief) {
        set_outcome(run, &machine);
        set_costs(run, &machine, seconds);
        metrics_set(run->metrics, "median_matrices_share", median_share(&shares));
    }
    machine_free(&machine);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    drum_view_draw(picture, picture->share * duration_of(picture->options));
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"stretch_error", EACH_CORRECTED, AT_MOST, 1e-5},
                                        {"shear_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"shear_rate_error", EACH_CORRECTED, AT_MOST, 1e-11},
                                        {"escaped", EACH_CORRECTED, AT_MOST, 0},
                                        {"mean_compression", EACH_CORRECTED, AT_MOST, 1e-3},
                                        {"fastest", EACH_CORRECTED, AT_LEAST, 1},
                                        {"fastest", EACH_CORRECTED, AT_MOST, 20},
                                        {"least_volume_of_body", EACH_CORRECTED, AT_LEAST, 0.2},
                                        {"least_volume_of_body", EACH_CORRECTED, AT_MOST, 1.01},
                                        {"median_matrices_share", EACH_CORRECTED, AT_MOST, 0.02},
                                        {0}};
    static const struct scene scene = {"washing_machine",
                                       "A bunny, soap and water in a rotating drum.",
                                       simulate,
                                       draw,
                                       gates,
                                       false,
                                       true};
    return scene_main(&scene, argc, argv);
}
