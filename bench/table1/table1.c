/* SPDX-License-Identifier: MIT */
/* The command `table1`. */
#include "table1.h"
#include "commands.h"
#include <stdlib.h>

static const struct table1_method paper[TABLE1_METHODS] = {
    {.method = SPHG_PLAIN, .paper_gradient = 12.08},
    {.method = SPHG_KGC, .paper_matrix = 11.23, .paper_gradient = 13.00},
    {.method = SPHG_CMLS, .paper_matrix = 28.98, .paper_gradient = 41.95},
    {.method = SPHG_MLS, .paper_matrix = 11.29, .paper_gradient = 12.42},
    {.method = SPHG_CRKPM, .paper_matrix = 29.18, .paper_gradient = 44.80},
    {.method = SPHG_RKPM, .paper_matrix = 12.31, .paper_gradient = 13.94},
};

bool table1_keeps_weights(const struct table1_method *one)
{
    return one->method == SPHG_KGC || one->method == SPHG_MLS || one->method == SPHG_RKPM;
}

static void check_combination(const struct table1 *table, bool particles_given, bool jitter_given)
{
    const bool with_input = table->source.input != NULL;
    const double support = table->settings.support;
    if (with_input && particles_given)
        command_line_refuse("--particles: --input brings its own");
    if (with_input && jitter_given)
        command_line_refuse("--jitter: only for the lattice, not with --input");
    if (with_input && support <= 0)
        command_line_refuse("--input: give the support radius in the file's unit with --support");
    if (with_input && table->settings.output)
        command_line_refuse("--output: the picture is of the lattice, not of --input");
    if (!with_input && table->source.mass > 0)
        command_line_refuse("--mass: only with --input");
    if (!with_input && support > 50)
        command_line_refuse("--support: %.17g spacings are more than 50", support);
}

static void read_options(struct table1 *table, int argc, char **argv)
{
    static const char *const orders[] = {"lattice", "shuffled", NULL};
    struct settings *settings = &table->settings;
    struct particle_source *source = &table->source;
    bool particles_given = false, jitter_given = false;
    int order = 0;
    const struct command_option options[] = {
        {"particles", 0, "N", "in the nearest cube (1000000)", OPTION_WHOLE, &settings->particles,
         1, 1e9, NULL, &particles_given},
        {"jitter", 0, "SHARE", "move each coordinate by up to this share of the spacing",
         OPTION_REAL, &settings->jitter, 0, 1, NULL, &jitter_given},
        {"order", 0, "ORDER", "particles in memory: lattice (or as in the input file), or shuffled",
         OPTION_CHOICE, &order, 0, 0, orders, NULL},
        {"input", 0, "FILE",
         "particles of your own instead of a lattice, from a text file with columns as solvers, "
         "ParaView and spreadsheets write it: positions (x, y, z; Points:0; Pos.x [m] ...; "
         "without z, or where one is constant, in 2D) and, if there, velocities, and volumes or "
         "densities and masses",
         OPTION_TEXT, &source->input, 0, 0, NULL, NULL},
        {"mass", 0, "M",
         "of each particle of an input file with densities, instead of its own masses",
         OPTION_POSITIVE, &source->mass, 0, 0, NULL, NULL},
        {"support", 0, "H",
         "support radius, in spacings (2); with --input in the file's unit of length",
         OPTION_POSITIVE, &settings->support, 0, 0, NULL, NULL},
        KERNEL_OPTION(*settings),
        PRECISION_OPTION(*settings, "f32"),
        ISA_OPTION(*settings),
        THREADS_OPTION(*settings),
        {"repetitions", 0, "N", "of each measurement, after one warm-up (9)", OPTION_WHOLE,
         &settings->repetitions, 1, 10000, NULL, NULL},
        OUTPUT_OPTION(*settings, "Table 1 as CSV and as a picture", "nowhere"),
        JSON_OPTION(*settings),
        {0}};
    settings_read(settings, options,
                  "Times the correction (T_mat), the gradient of a vector field with the "
                  "correction given (T_grad), both in one call (fused) and the neighbour search "
                  "(T_ns), and measures the error of each gradient on v = (-y, x, 2z).",
                  argc, argv);
    check_combination(table, particles_given, jitter_given);
    if (!source->input && settings->support <= 0)
        settings->support = 2;
    source->dimension = 3;
    source->side = settings_side(settings->particles, 3);
    source->jitter = settings->jitter;
    source->shuffled = order == 1;
    source->precision = settings->precision;
}

int command_table1(int argc, char **argv)
{
    struct table1 table = {.settings = settings_default(1000000, 9, NULL)};
    table.settings.support = table.settings.jitter = 0; /* of a lattice 2, of a file as it says */
    for (int k = 0; k < TABLE1_METHODS; ++k)
        table.methods[k] = paper[k];
    read_options(&table, argc, argv);
    table.particles = particles_create(&table.source);
    table.support_radius = table.settings.support * (table.source.input ? 1 : lattice_spacing);
    table1_measure(&table);
    table1_report(&table);
    return EXIT_SUCCESS;
}
