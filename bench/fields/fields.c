/* SPDX-License-Identifier: MIT */
/* The command `fields`: errors of plain and corrected derivatives on a square, Figs. 2 and 4 of
 * Westhofen, Jeske, Bender 2023, doi:10.1145/3606933. */
#include "commands.h"
#include "field_study.h"
#include "report/plot.h"
#include "report/table.h"
#include "settings.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { METHODS = 6, SIZES = 3 /* N, 2 N, 4 N */, KINDS = 2 /* of fields */ };

static const sphg_method order[METHODS] = {SPHG_PLAIN, SPHG_KGC,  SPHG_MLS,
                                           SPHG_RKPM,  SPHG_CMLS, SPHG_CRKPM};

/* Everything measured on one lattice. */
struct lattice_results {
    const char *name;                                  /* "square" or "jittered" */
    struct study_setting setting;                      /* with the smallest N */
    struct study_errors errors[KINDS][METHODS][SIZES]; /* methods in the order above */
};

/* ---- Measuring ------------------------------------------------------------------------------- */

/* One row a particle: where, which velocity, all errors of the method in the order above. */
static void write_particles(const char *folder, const char *name, const struct study *study,
                            enum study_field field, const double *errors)
{
    struct column columns[5 + 2 * METHODS] = {{NULL, "x", NULL, NULL},
                                              {NULL, "y", NULL, NULL},
                                              {NULL, "vx", NULL, NULL},
                                              {NULL, "vy", NULL, NULL}};
    for (int k = 0; k < 2 * METHODS; ++k)
        columns[4 + k].key = table_text("%s_error_%s", k < METHODS ? "gradient" : "curl",
                                        method_names[order[k % METHODS]]);
    struct table *table = table_create("", columns);
    for (int32_t i = 0; i < study->count; ++i) {
        struct cell cells[4 + 2 * METHODS];
        double velocity[2];
        study_velocity(study, field, i, velocity);
        for (int axis = 0; axis < 2; ++axis) {
            cells[axis] = cell_number(numbers_get(&study->positions, i, axis));
            cells[2 + axis] = cell_number(velocity[axis]);
        }
        for (int k = 0; k < 2 * METHODS; ++k)
            cells[4 + k] = cell_number(errors[(ptrdiff_t)k * study->count + i]);
        table_add(table, cells, 4 + 2 * METHODS);
    }
    table_write_csv(table, folder, name);
}

/* The smallest lattice leaves a file of its particles. */
static void measure_field(const char *folder, const struct study *study, enum study_field field,
                          struct lattice_results *results, int size)
{
    const size_t count = (size_t)study->count;
    double *errors = allocate_or_exit(2 * METHODS * count, sizeof *errors);
    for (int k = 0; k < METHODS; ++k)
        results->errors[field][k][size] =
            study_measure(study, field, order[k], errors + (size_t)k * count,
                          errors + (size_t)(METHODS + k) * count);
    if (size == 0)
        write_particles(folder,
                        table_text("fields_%s_%s.csv", study_field_name(field), results->name),
                        study, field, errors);
    free(errors);
}

static void measure(const char *folder, struct lattice_results *results)
{
    for (int size = 0; size < SIZES; ++size) {
        struct study_setting setting = results->setting;
        setting.side <<= size;
        struct study study = study_open(&setting);
        for (int field = 0; field < KINDS; ++field)
            measure_field(folder, &study, (enum study_field)field, results, size);
        study_close(&study);
    }
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static struct table *table_of_errors(const struct lattice_results *results)
{
    static const struct column columns[] = {{"", NULL, NULL, NULL},
                                            {"boundary max", NULL, "%.3e", NULL},
                                            {"mean", NULL, "%.3e", NULL},
                                            {"inside max", NULL, "%.3e", NULL},
                                            {"mean", NULL, "%.3e", NULL},
                                            {"curl max", NULL, "%.3e", NULL},
                                            {0}};
    struct table *table = table_create("", columns);
    for (int field = 0; field < KINDS; ++field) {
        table_section(table, study_field_formula((enum study_field)field));
        for (int k = 0; k < METHODS; ++k) {
            const struct study_errors *e = &results->errors[field][k][0];
            TABLE_ROW(table, cell_text(method_names[order[k]]), cell_number(e->boundary_max),
                      cell_number(e->boundary_mean), cell_number(e->inside_max),
                      cell_number(e->inside_mean), cell_number(e->curl_max));
        }
    }
    return table;
}

/* The error falls as d^order between the two finest lattices. */
static struct cell cell_order(double coarse, double fine)
{
    return cell_number(log2(coarse / fine));
}

static struct table *table_of_convergence(const struct lattice_results *results)
{
    static struct column columns[10];
    const char *const halves[] = {"boundary", "inside"};
    const int32_t side = results->setting.side;
    columns[0] = (struct column){"convergence, trigonometric, max", NULL, NULL, NULL};
    for (int half = 0; half < 2; ++half) {
        columns[4 * half + 1].head = table_text("%s N = %d", halves[half], (int)side);
        columns[4 * half + 2].head = table_text("%d", 2 * (int)side);
        columns[4 * half + 3].head = table_text("%d", 4 * (int)side);
        columns[4 * half + 4] = (struct column){"order", NULL, "%.2f", NULL};
        for (int size = 0; size < SIZES; ++size)
            columns[4 * half + 1 + size].format = "%.3e";
    }
    struct table *table = table_create("", columns);
    for (int k = 0; k < METHODS; ++k) {
        const struct study_errors *e = results->errors[FIELD_TRIGONOMETRIC][k];
        TABLE_ROW(table, cell_text(method_names[order[k]]), cell_number(e[0].boundary_max),
                  cell_number(e[1].boundary_max), cell_number(e[2].boundary_max),
                  cell_order(e[1].boundary_max, e[2].boundary_max), cell_number(e[0].inside_max),
                  cell_number(e[1].inside_max), cell_number(e[2].inside_max),
                  cell_order(e[1].inside_max, e[2].inside_max));
    }
    return table;
}

static void print_lattice(const struct lattice_results *results)
{
    const int32_t side = results->setting.side;
    printf("\n%s lattice", results->name);
    if (results->setting.jitter > 0)
        printf(", each coordinate moved by up to %g d", results->setting.jitter);
    printf(": N = %d, %d particles, %d of them on the boundary; error |J_i - J|_F\n", side,
           side * side, side * side - (side - 4) * (side - 4));
    table_print(table_of_errors(results));
    table_print(table_of_convergence(results));
}

static void write_convergence(const char *folder, const struct lattice_results results[2])
{
    static const struct column columns[] = {{NULL, "lattice", NULL, NULL},
                                            {NULL, "field", NULL, NULL},
                                            {NULL, "method", NULL, NULL},
                                            {NULL, "N", NULL, NULL},
                                            {NULL, "spacing", NULL, NULL},
                                            {NULL, "boundary_max", NULL, NULL},
                                            {NULL, "boundary_mean", NULL, NULL},
                                            {NULL, "inside_max", NULL, NULL},
                                            {NULL, "inside_mean", NULL, NULL},
                                            {NULL, "curl_max", NULL, NULL},
                                            {0}};
    struct table *table = table_create("", columns);
    for (int n = 0; n < 2 * KINDS * METHODS * SIZES; ++n) {
        const int size = n % SIZES, k = n / SIZES % METHODS, field = n / SIZES / METHODS % KINDS;
        const struct lattice_results *lattice = &results[n / SIZES / METHODS / KINDS];
        const struct study_errors *e = &lattice->errors[field][k][size];
        const int32_t side = lattice->setting.side << size;
        TABLE_ROW(
            table, cell_text(lattice->name), cell_text(study_field_name((enum study_field)field)),
            cell_text(method_names[order[k]]), cell_count(side), cell_number(2.0 / side),
            cell_number(e->boundary_max), cell_number(e->boundary_mean), cell_number(e->inside_max),
            cell_number(e->inside_mean), cell_number(e->curl_max));
    }
    table_write_csv(table, folder, "fields_convergence.csv");
}

/* ---- Pictures -------------------------------------------------------------------------------- */

/* Three panels of a field, or, without a quantity, convergence. */
struct picture {
    const char *name, *quantity;
    enum study_field field;
};

static const struct picture pictures[] = {
    {"fields_rotation", "gradient", FIELD_ROTATION},
    {"fields_trigonometric", "gradient", FIELD_TRIGONOMETRIC},
    {"fields_curl", "curl", FIELD_ROTATION},
    {"fields_convergence", NULL, FIELD_TRIGONOMETRIC},
};

static bool draw(const char *folder, const struct lattice_results *results,
                 const struct picture *picture)
{
    const struct study_setting *setting = &results->setting;
    const char *ending = setting->jitter > 0 ? "_jittered" : "";
    const char *const parts[] = {
        "fields/fields_common.gp",
        picture->quantity ? "fields/fields_panels.gp" : "fields/fields_convergence.gp", NULL};
    const char *given =
        table_text("output = '%s%s.png'\nfield = '%s'\nformula = '%s'\nlattice = '%s'\n"
                   "support = '%g'\nkernel = '%s'\nprecision = '%s'\nside = %d\nquantity = '%s'\n",
                   picture->name, ending, study_field_name(picture->field),
                   study_field_formula(picture->field), results->name, setting->support,
                   kernel_title(setting->kernel), precision_names[setting->precision],
                   setting->side, picture->quantity ? picture->quantity : "");
    return plot_draw(folder, table_text("%s%s.gp", picture->name, ending), given, parts);
}

static bool draw_all(const char *folder, const struct lattice_results results[2])
{
    for (int lattice = 0; lattice < 2; ++lattice)
        for (size_t k = 0; k < sizeof pictures / sizeof pictures[0]; ++k)
            if (!draw(folder, &results[lattice], &pictures[k]))
                return false;
    return true;
}

int command_fields(int argc, char **argv)
{
    struct settings settings = {
        .support = 2, .jitter = 0.2, .precision = PRECISION_F64, .output = "fields"};
    int32_t side = 40;
    const struct command_option options[] = {
        {"size", 0, "N", "N x N particles; convergence over N, 2 N, 4 N (40)", OPTION_WHOLE, &side,
         5, 500, NULL, NULL},
        {"support", 0, "H", "support radius in spacings (2)", OPTION_REAL, &settings.support, 0.1,
         20, NULL, NULL},
        {"jitter", 0, "SHARE", "of the spacing, each way, on the jittered lattice (0.2)",
         OPTION_REAL, &settings.jitter, 0.001, 0.5, NULL, NULL},
        KERNEL_OPTION(settings),
        PRECISION_OPTION(settings, "f64"),
        OUTPUT_OPTION(settings, "CSV, scripts and pictures", "fields"),
        {0}};
    settings_read(&settings, options,
                  "Errors of plain and corrected derivatives of velocity fields on the square "
                  "[-1, 1]^2: tables here, every particle as CSV and pictures in a folder.",
                  argc, argv);
    const struct study_setting setting = {side, settings.support, settings.jitter, settings.kernel,
                                          settings.precision};
    struct lattice_results results[2] = {{.name = "square", .setting = setting},
                                         {.name = "jittered", .setting = setting}};
    results[0].setting.jitter = 0;
    printf("Velocity gradients on [-1, 1]^2, Figs. 2 and 4 of doi:10.1145/3606933\n"
           "difference form, %s, H = %g d, d = 2 / N, %s, V_j = 1 / sum_k W_jk (j included)\n"
           "boundary: the two outermost layers\n",
           kernel_title(settings.kernel), settings.support, precision_names[settings.precision]);
    for (int k = 0; k < 2; ++k) {
        measure(settings.output, &results[k]);
        print_lattice(&results[k]);
    }
    write_convergence(settings.output, results);
    printf("\nwritten to %s: fields_*.csv, fields_*.gp%s\n", settings.output,
           draw_all(settings.output, results) ? ", fields_*.png" : "");
    return EXIT_SUCCESS;
}
