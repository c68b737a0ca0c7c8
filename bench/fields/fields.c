/* The command `fields`: errors of plain and corrected derivatives on a square, Figs. 2 and 4 of
 * Westhofen, Jeske, Bender 2023, doi:10.1145/3606933. */
#include "fields.h"
#include "commands.h"
#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct options {
    struct study_setting setting;
    const char *output;
};

enum {
    OPTION_SIZE = 256,
    OPTION_SUPPORT,
    OPTION_JITTER,
    OPTION_KERNEL,
    OPTION_PRECISION,
    OPTION_OUTPUT
};

static const struct argp_option option_list[] = {
    {"size", OPTION_SIZE, "N", 0, "N x N particles; convergence over N, 2 N, 4 N (40)", 0},
    {"support", OPTION_SUPPORT, "H", 0, "support radius in spacings (2)", 0},
    {"jitter", OPTION_JITTER, "SHARE", 0, "of the spacing, each way, on the jittered lattice (0.2)",
     0},
    {"kernel", OPTION_KERNEL, "NAME", 0,
     "cubic, quintic, wendland-c2, wendland-c4, wendland-c6, poly6 or spiky (cubic)", 0},
    {"precision", OPTION_PRECISION, "TYPE", 0,
     "f32, f64, or mixed: positions f64, the rest f32 (f64)", 0},
    {"output", OPTION_OUTPUT, "FOLDER", 0, "where CSV, scripts and pictures go (fields)", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct options *options = state->input;
    struct study_setting *setting = &options->setting;
    switch (key) {
    case OPTION_SIZE:
        setting->side = option_integer("size", text, 5, 500);
        return 0;
    case OPTION_SUPPORT:
        setting->support = option_real("support", text, 0.1, 20);
        return 0;
    case OPTION_JITTER:
        setting->jitter = option_real("jitter", text, 0.001, 0.5);
        return 0;
    case OPTION_KERNEL:
        setting->kernel = (sphg_kernel)option_choice("kernel", text, kernel_names);
        return 0;
    case OPTION_PRECISION:
        setting->precision = (enum precision)option_choice("precision", text, precision_names);
        return 0;
    case OPTION_OUTPUT:
        options->output = text;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void measure(const char *directory, struct lattice_results *results)
{
    for (int size = 0; size < FIELDS_SIZES; size++) {
        struct study_setting setting = results->setting;
        setting.side <<= size;
        struct study study = study_open(&setting);
        for (int field = 0; field < FIELDS_KINDS; field++) {
            const enum study_field kind = (enum study_field)field;
            if (size == 0)
                fields_write_particles(directory, &study, kind, results);
            for (int k = 0; size > 0 && k < FIELDS_METHODS; k++)
                results->errors[field][fields_order[k]][size] =
                    study_measure(&study, kind, fields_order[k], NULL, NULL);
        }
        study_close(&study);
    }
}

static void print_field(const struct lattice_results *results, enum study_field field)
{
    printf("\n  %-34s %21s %21s %10s\n", study_field_formula(field), "boundary      ",
           "inside        ", "curl   ");
    printf("  %-34s %10s %10s %10s %10s %10s\n", "error |J_i - J|_F", "max", "mean", "max", "mean",
           "max");
    for (int k = 0; k < FIELDS_METHODS; k++) {
        const struct study_errors *errors = &results->errors[field][fields_order[k]][0];
        printf("  %-34s %10.3e %10.3e %10.3e %10.3e %10.3e\n", method_names[fields_order[k]],
               errors->boundary_max, errors->boundary_mean, errors->inside_max, errors->inside_mean,
               errors->curl_max);
    }
}

/* The error falls as d^order between the two finest lattices. */
static double order_of(double coarse, double fine)
{
    return log2(coarse / fine);
}

static void print_convergence(const struct lattice_results *results)
{
    const int32_t side = results->setting.side;
    printf("\n  %-12s %39s   %39s\n", "convergence", "boundary max          ",
           "inside max           ");
    printf("  %-12s", study_field_name(FIELD_TRIGONOMETRIC));
    for (int half = 0; half < 2; half++)
        printf(" %9s%-4d %6d %9d %7s  ", "N = ", side, 2 * side, 4 * side, "order");
    printf("\n");
    for (int k = 0; k < FIELDS_METHODS; k++) {
        const struct study_errors *e = results->errors[FIELD_TRIGONOMETRIC][fields_order[k]];
        printf("  %-12s   %9.3e %9.3e %9.3e %6.2f", method_names[fields_order[k]],
               e[0].boundary_max, e[1].boundary_max, e[2].boundary_max,
               order_of(e[1].boundary_max, e[2].boundary_max));
        printf("     %9.3e %9.3e %9.3e %6.2f\n", e[0].inside_max, e[1].inside_max, e[2].inside_max,
               order_of(e[1].inside_max, e[2].inside_max));
    }
}

static void print_lattice(const struct lattice_results *results)
{
    const int32_t side = results->setting.side;
    printf("\n%s lattice", results->name);
    if (results->setting.jitter > 0)
        printf(", each coordinate moved by up to %g d", results->setting.jitter);
    printf(": N = %d, %d particles, %d of them on the boundary\n", side, side * side,
           side * side - (side - 4) * (side - 4));
    for (int field = 0; field < FIELDS_KINDS; field++)
        print_field(results, (enum study_field)field);
    print_convergence(results);
}

int command_fields(int argc, char **argv)
{
    struct options options = {
        {40, 2, 0.2, SPHG_CUBIC_SPLINE, PRECISION_F64},
        "fields",
    };
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .doc = "Errors of plain and corrected derivatives of velocity fields on the square "
               "[-1, 1]^2: tables here, every particle as CSV and pictures in a folder."};
    options_parse(&argp, argc, argv, &options);
    option_folder("output", options.output);

    printf("Velocity gradients on [-1, 1]^2, Figs. 2 and 4 of doi:10.1145/3606933\n"
           "difference form, %s, H = %g d, d = 2 / N, %s, V_j = 1 / sum_k W_jk (j included)\n"
           "boundary: the two outermost layers\n",
           kernel_title(options.setting.kernel), options.setting.support,
           precision_names[options.setting.precision]);
    struct lattice_results results[2] = {{.name = "square", .setting = options.setting},
                                         {.name = "jittered", .setting = options.setting}};
    results[0].setting.jitter = 0;
    for (int k = 0; k < 2; k++) {
        measure(options.output, &results[k]);
        print_lattice(&results[k]);
    }
    fields_write_convergence(options.output, results, 2);
    const bool drawn = fields_draw(options.output, results);
    printf("\nwritten to %s: fields_*.csv, fields_*.gp%s\n", options.output,
           drawn ? ", fields_*.png" : "");
    return EXIT_SUCCESS;
}
