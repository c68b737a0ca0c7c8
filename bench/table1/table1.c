/* The command `table1`. */
#include "table1.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"
#include "settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    OPTION_PARTICLES = 256,
    OPTION_JITTER,
    OPTION_ORDER,
    OPTION_INPUT,
    OPTION_MASS,
    OPTION_SUPPORT,
    OPTION_KERNEL,
    OPTION_PRECISION,
    OPTION_THREADS,
    OPTION_ISA,
    OPTION_REPETITIONS,
    OPTION_JSON
};

static const struct argp_option option_list[] = {
    {"particles", OPTION_PARTICLES, "N", 0, "in the nearest cube (1000000)", 0},
    {"jitter", OPTION_JITTER, "SHARE", 0, "move each coordinate by up to this share of the spacing",
     0},
    {"order", OPTION_ORDER, "ORDER", 0,
     "particles in memory: lattice (or as in the input file), or shuffled", 0},
    {"input", OPTION_INPUT, "FILE", 0,
     "particles of your own instead of a lattice, from a text file with columns as solvers, "
     "ParaView and spreadsheets write it: positions (x, y, z; Points:0; Pos.x [m] ...; without z, "
     "or "
     "where one is constant, in 2D) and, if there, velocities, and volumes or densities and masses",
     0},
    {"mass", OPTION_MASS, "M", 0,
     "of each particle of an input file with densities, instead of its own masses", 0},
    {"support", OPTION_SUPPORT, "H", 0,
     "support radius, in spacings (2); with --input in the file's unit of length", 0},
    {"kernel", OPTION_KERNEL, "NAME", 0,
     "cubic, quintic, wendland-c2, wendland-c4, wendland-c6, poly6 or spiky (cubic)", 0},
    {"precision", OPTION_PRECISION, "TYPE", 0,
     "f32, f64, or mixed: positions f64, the rest f32 (f32)", 0},
    {"threads", OPTION_THREADS, "N", 0, "(OMP_NUM_THREADS, or one per processor)", 0},
    {"isa", OPTION_ISA, "NAME", 0, "baseline, x86-64-v3, x86-64-v4 or neon (the best)", 0},
    {"repetitions", OPTION_REPETITIONS, "N", 0, "of each measurement, after one warm-up (9)", 0},
    {"json", OPTION_JSON, "FILE", 0, "write all repetitions in Google Benchmark's format", 0},
    {0}};

/* What was given, to find combinations without meaning. */
struct command_line {
    struct table1_options *options;
    int particles_given, jitter_given;
};

static error_t parse_source_option(int key, char *text, struct command_line *line)
{
    static const char *const orders[] = {"lattice", "shuffled", NULL};
    struct table1_options *options = line->options;
    struct particle_source *source = &options->source;
    switch (key) {
    case OPTION_PARTICLES:
        options->wanted_particles = option_integer("particles", text, 1, 1000000000);
        line->particles_given = 1;
        return 0;
    case OPTION_JITTER:
        source->jitter = option_real("jitter", text, 0, 1);
        line->jitter_given = 1;
        return 0;
    case OPTION_ORDER:
        source->shuffled = option_choice("order", text, orders) == 1;
        return 0;
    case OPTION_INPUT:
        source->input = text;
        return 0;
    case OPTION_MASS:
        source->mass = option_positive("mass", text);
        return 0;
    case OPTION_PRECISION:
        source->precision = (enum precision)option_choice("precision", text, precision_names);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct command_line *line = state->input;
    struct table1_options *options = line->options;
    switch (key) {
    case OPTION_SUPPORT:
        options->support = option_positive("support", text);
        return 0;
    case OPTION_KERNEL:
        options->kernel = (sphg_kernel)option_choice("kernel", text, kernel_names);
        return 0;
    case OPTION_THREADS:
        options->threads = option_integer("threads", text, 1, 1024);
        return 0;
    case OPTION_ISA:
        settings_choose_isa(text);
        return 0;
    case OPTION_REPETITIONS:
        options->repetitions = option_integer("repetitions", text, 1, 10000);
        return 0;
    case OPTION_JSON:
        options->json = text;
        return 0;
    default:
        return parse_source_option(key, text, line);
    }
}

static void check_combination(const struct command_line *line)
{
    const struct table1_options *options = line->options;
    const int with_input = options->source.input != NULL;
    if (with_input && line->particles_given)
        options_refuse("--particles: --input brings its own");
    if (with_input && line->jitter_given)
        options_refuse("--jitter: only for the lattice, not with --input");
    if (with_input && options->support <= 0)
        options_refuse("--input: give the support radius in the file's unit with --support");
    if (!with_input && options->source.mass > 0)
        options_refuse("--mass: only with --input");
    if (!with_input && options->support > 50)
        options_refuse("--support: %.17g spacings are more than 50", options->support);
}

static void read_options(struct table1_options *options, int argc, char **argv)
{
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .doc = "Times the correction (T_mat), the gradient of a vector field with the correction "
               "given (T_grad), both in one call (fused) and the neighbour search (T_ns), and "
               "measures the error of each gradient on v = (-y, x, 2z)."};
    struct command_line line = {.options = options};
    options_parse(&argp, argc, argv, &line);
    check_combination(&line);
    if (!options->source.input && options->support <= 0)
        options->support = 2;
    options->source.side = (int32_t)lround(cbrt((double)options->wanted_particles));
    if (options->json)
        option_writable("json", options->json);
}

static const struct column paper_columns[TABLE1_COLUMNS] = {
    {.method = SPHG_PLAIN, .paper_gradient = 12.08},
    {.method = SPHG_KGC, .paper_matrix = 11.23, .paper_gradient = 13.00},
    {.method = SPHG_CMLS, .paper_matrix = 28.98, .paper_gradient = 41.95},
    {.method = SPHG_MLS, .paper_matrix = 11.29, .paper_gradient = 12.42},
    {.method = SPHG_CRKPM, .paper_matrix = 29.18, .paper_gradient = 44.80},
    {.method = SPHG_RKPM, .paper_matrix = 12.31, .paper_gradient = 13.94},
};

int table1_keeps_weights(const struct column *column)
{
    return column->method == SPHG_KGC || column->method == SPHG_MLS || column->method == SPHG_RKPM;
}

static void create_columns(struct table1 *table)
{
    const int32_t repetitions = table->options.repetitions;
    table->search = samples_create(repetitions);
    for (int work = 0; work < PROBE_WORKS; work++)
        table->probe[work] = samples_create(repetitions);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        struct column *column = &table->columns[k];
        *column = paper_columns[k];
        column->matrix = samples_create(repetitions);
        column->gradient = samples_create(repetitions);
        column->fused = samples_create(repetitions);
        column->matrix_kept = samples_create(repetitions);
        column->gradient_kept = samples_create(repetitions);
        column->fused_kept = samples_create(repetitions);
    }
}

static void destroy_columns(struct table1 *table)
{
    samples_destroy(&table->search);
    for (int work = 0; work < PROBE_WORKS; work++)
        samples_destroy(&table->probe[work]);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        samples_destroy(&table->columns[k].matrix);
        samples_destroy(&table->columns[k].gradient);
        samples_destroy(&table->columns[k].fused);
        samples_destroy(&table->columns[k].matrix_kept);
        samples_destroy(&table->columns[k].gradient_kept);
        samples_destroy(&table->columns[k].fused_kept);
    }
}

int command_table1(int argc, char **argv)
{
    struct table1 table = {
        .options = {.wanted_particles = 1000000, .threads = machine_threads(), .repetitions = 9}};
    read_options(&table.options, argc, argv);
    table.particles = particles_create(&table.options.source);
    table.support_radius = table.options.support;
    if (!table.options.source.input)
        table.support_radius *= lattice_spacing;
    create_columns(&table);
    table1_measure(&table);
    table1_print(&table);
    if (table.options.json)
        table1_write_json(&table, table.options.json, "sphgrad-bench");
    destroy_columns(&table);
    particles_destroy(&table.particles);
    return EXIT_SUCCESS;
}
