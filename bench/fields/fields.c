/* SPDX-License-Identifier: MIT */
/* The command `fields`: errors of plain and corrected derivatives on a square, Figs. 2 and 4 of
 * Westhofen, Jeske, Bender 2023, doi:10.1145/3606933. */
#include "commands.h"
#include "fields_measure.h"
#include "particles/particles.h"
#include "report/plot.h"
#include "report/table.h"
#include "settings.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WAYS = 8, SIZES = 3 /* N, 2 N, 4 N */, KINDS = 2 /* of fields */ };

static const struct study_way ways[WAYS] = {
    {.name = "SPH", .method = SPHG_PLAIN}, {.name = "KGC", .method = SPHG_KGC},
    {.name = "MLS", .method = SPHG_MLS},   {.name = "RKPM", .method = SPHG_RKPM},
    {.name = "CMLS", .method = SPHG_CMLS}, {.name = "CRKPM", .method = SPHG_CRKPM},
    {.name = "KGC order 2", .order = 2},   {.name = "KGC order 2 lent", .order = 2, .lent = true}};

/* Everything measured on one lattice. */
struct lattice_results {
    const char *name;                               /* "square" or "jittered" */
    struct study_setting setting;                   /* with the smallest N */
    struct study_errors errors[KINDS][WAYS][SIZES]; /* ways in the order above */
};

/* ---- Measuring ------------------------------------------------------------------------------- */

/* One row a particle: where, which velocity, all errors of the ways in the order above. */
static void write_particles(const char *folder, const char *name, const struct study *study,
                            const double *errors)
{
    const struct scene *scene = &study->scene;
    const char *keys[2 * WAYS];
    struct table *table = table_create("");
    for (int k = 0; k < 2 * WAYS; ++k)
        keys[k] = table_text("%s_error_%s", k < WAYS ? "gradient" : "curl", ways[k % WAYS].name);
    for (int32_t i = 0; i < scene->count; ++i) {
        struct cell cells[4 + 2 * WAYS] = {
            cell_number(NULL, "x", NULL, numbers_get(&scene->positions, i, 0)),
            cell_number(NULL, "y", NULL, numbers_get(&scene->positions, i, 1)),
            cell_number(NULL, "vx", NULL, numbers_get(&scene->field, i, 0)),
            cell_number(NULL, "vy", NULL, numbers_get(&scene->field, i, 1))};
        for (int k = 0; k < 2 * WAYS; ++k)
            cells[4 + k] =
                cell_number(NULL, keys[k], NULL, errors[(ptrdiff_t)k * scene->count + i]);
        table_add(table, cells, 4 + 2 * WAYS);
    }
    table_write_csv(table, folder, name);
}

/* The smallest lattice leaves a file of its particles. */
static void measure_field(const char *folder, struct study *study, enum study_field field,
                          struct lattice_results *results, int size)
{
    const size_t count = (size_t)study->scene.count;
    double *errors = allocate_or_exit(2 * WAYS * count, sizeof *errors);
    study_fill(study, field);
    for (int k = 0; k < WAYS; ++k) {
        study_derive(study, &ways[k]);
        results->errors[field][k][size] =
            study_compare(study, errors + (size_t)k * count, errors + (size_t)(WAYS + k) * count);
    }
    if (size == 0)
        write_particles(folder,
                        table_text("fields_%s_%s.csv", study_field_name(field), results->name),
                        study, errors);
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
    struct table *table = table_create("");
    for (int field = 0; field < KINDS; ++field) {
        table_section(table, study_field_formula((enum study_field)field));
        for (int k = 0; k < WAYS; ++k) {
            const struct study_errors *e = &results->errors[field][k][0];
            TABLE_ROW(table, cell_text("", NULL, ways[k].name),
                      cell_number("boundary max", NULL, "%.3e", e->most[STUDY_BOUNDARY]),
                      cell_number("mean", NULL, "%.3e", e->mean[STUDY_BOUNDARY]),
                      cell_number("inside max", NULL, "%.3e", e->most[STUDY_INSIDE]),
                      cell_number("mean", NULL, "%.3e", e->mean[STUDY_INSIDE]),
                      cell_number("curl max", NULL, "%.3e", e->curl_max));
        }
    }
    return table;
}

/* The error falls as d^order between the two finest lattices. */
static struct table *table_of_convergence(const struct lattice_results *results)
{
    static const char *const halves[] = {"boundary N = ", "inside N = "};
    struct table *table = table_create("");
    for (int k = 0; k < WAYS; ++k) {
        const struct study_errors *e = results->errors[FIELD_TRIGONOMETRIC][k];
        struct cell cells[9] = {cell_text("convergence, trigonometric, max", NULL, ways[k].name)};
        int count = 1;
        for (int half = STUDY_BOUNDARY; half <= STUDY_INSIDE; ++half) {
            for (int size = 0; size < SIZES; ++size)
                cells[count++] = cell_number(table_text("%s%d", size ? "" : halves[half],
                                                        (int)results->setting.side << size),
                                             NULL, "%.3e", e[size].most[half]);
            cells[count++] =
                cell_number("order", NULL, "%.2f", log2(e[1].most[half] / e[2].most[half]));
        }
        table_add(table, cells, 9);
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
    struct table *table = table_create("");
    for (int n = 0; n < 2 * KINDS * WAYS * SIZES; ++n) {
        const int size = n % SIZES, k = n / SIZES % WAYS, field = n / SIZES / WAYS % KINDS;
        const struct lattice_results *lattice = &results[n / SIZES / WAYS / KINDS];
        const struct study_errors *e = &lattice->errors[field][k][size];
        const int32_t side = lattice->setting.side << size;
        TABLE_ROW(table, cell_text(NULL, "lattice", lattice->name),
                  cell_text(NULL, "field", study_field_name((enum study_field)field)),
                  cell_text(NULL, "method", ways[k].name), cell_count(NULL, "N", side),
                  cell_number(NULL, "spacing", NULL, 2.0 / side),
                  cell_number(NULL, "boundary_max", NULL, e->most[STUDY_BOUNDARY]),
                  cell_number(NULL, "boundary_mean", NULL, e->mean[STUDY_BOUNDARY]),
                  cell_number(NULL, "inside_max", NULL, e->most[STUDY_INSIDE]),
                  cell_number(NULL, "inside_mean", NULL, e->mean[STUDY_INSIDE]),
                  cell_number(NULL, "curl_max", NULL, e->curl_max));
    }
    table_write_csv(table, folder, "fields_convergence.csv");
}

/* ---- A file's particles ---------------------------------------------------------------------- */

/* Relative errors of waves, for those who resolve curvature, slopes alone, or not all of these. */
static struct table *table_of_waves(struct study *study, struct study_errors *last)
{
    static const struct {
        const char *mean, *mean_key, *max_key;
    } groups[STUDY_GROUPS] = {{"curvature: mean", "curvature_mean", "curvature_max"},
                              {"slopes: mean", "slopes_mean", "slopes_max"},
                              {"neither: mean", "neither_mean", "neither_max"}};
    const double k = 2 * 3.14159265358979323846 / (10 * study->scene.scheme.support_radius);
    struct table *table = table_create("");
    study_fill(study, FIELD_WAVES);
    for (int way = 0; way < WAYS; ++way) {
        struct cell cells[1 + 2 * STUDY_GROUPS] = {cell_text("", "method", ways[way].name)};
        study_derive(study, &ways[way]);
        *last = study_compare(study, NULL, NULL);
        for (int n = 0; n < STUDY_GROUPS; ++n) {
            const int group = STUDY_CURVATURE - n;
            cells[1 + 2 * n] =
                cell_if(last->counts[group], cell_number(groups[n].mean, groups[n].mean_key, "%.3e",
                                                         last->mean[group] / k));
            cells[2 + 2 * n] =
                cell_if(last->counts[group],
                        cell_number("max", groups[n].max_key, "%.3e", last->most[group] / k));
        }
        table_add(table, cells, 1 + 2 * STUDY_GROUPS);
    }
    return table;
}

static void measure_input(const char *folder, const struct particle_source *source,
                          struct study_setting setting)
{
    struct particles particles = particles_create(source);
    setting.dimension = particles.dimension;
    struct study study = study_of_particles(&setting, particles.positions, particles.volumes);
    struct study_errors e;
    const struct table *table = table_of_waves(&study, &e);
    const double percent = 100.0 / study.scene.count;
    printf(
        "particles  %d of %s, %dD, H = %g, volume %s\n"
        "resolved   slopes and curvature by %.2f %%, slopes alone by %.2f %%, neither by %.2f %%\n"
        "errors     |J_i - J|_F / k of v_a = sin(k x_a) cos(k x_b), 10 H a wave\n",
        (int)study.scene.count, source->input, (int)setting.dimension, setting.support,
        particles.volume_origin, percent * e.counts[STUDY_CURVATURE],
        percent * e.counts[STUDY_SLOPES], percent * e.counts[STUDY_NEITHER]);
    table_print(table);
    table_write_csv(table, folder, "fields_input.csv");
    printf("\nwritten to %s: fields_input.csv\n", folder);
}

/* ---- Pictures -------------------------------------------------------------------------------- */

struct picture {
    const char *name, *script, *quantity;
    enum study_field field;
};

static const struct picture pictures[] = {
    {"fields_rotation", "fields/fields_panels.gp", "gradient", FIELD_ROTATION},
    {"fields_trigonometric", "fields/fields_panels.gp", "gradient", FIELD_TRIGONOMETRIC},
    {"fields_curl", "fields/fields_panels.gp", "curl", FIELD_ROTATION},
    {"fields_convergence", "fields/fields_convergence.gp", "", FIELD_TRIGONOMETRIC},
    {"fields_order", "fields/fields_order.gp", "", FIELD_TRIGONOMETRIC},
};

static bool draw(const char *folder, const struct lattice_results *results,
                 const struct picture *picture)
{
    const struct study_setting *setting = &results->setting;
    const char *ending = setting->jitter > 0 ? "_jittered" : "";
    const char *const parts[] = {"fields/fields_common.gp", picture->script, NULL};
    const char *given =
        table_text("output = '%s%s.png'\nfield = '%s'\nformula = '%s'\nlattice = '%s'\n"
                   "support = '%g'\nkernel = '%s'\nprecision = '%s'\nside = %d\nquantity = '%s'\n",
                   picture->name, ending, study_field_name(picture->field),
                   study_field_formula(picture->field), results->name, setting->support,
                   kernel_title(setting->kernel), precision_names[setting->precision],
                   setting->side, picture->quantity);
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
    struct settings settings = {.jitter = 0.2, .precision = PRECISION_F64, .output = "fields"};
    struct particle_source source = {0};
    int32_t side = 40;
    const struct command_option options[] = {
        {"size", 0, "N", "N x N particles; convergence over N, 2 N, 4 N (40)", OPTION_WHOLE, &side,
         5, 500, NULL, NULL},
        {"support", 0, "H", "support radius in spacings (2); with --input in the file's unit",
         OPTION_POSITIVE, &settings.support, 0, 0, NULL, NULL},
        {"jitter", 0, "SHARE", "of the spacing, each way, on the jittered lattice (0.2)",
         OPTION_REAL, &settings.jitter, 0.001, 0.5, NULL, NULL},
        {"input", 0, "FILE",
         "particles of your own instead, as table1 reads them: who of them resolves slopes and "
         "curvature, and the errors of waves on them",
         OPTION_TEXT, &source.input, 0, 0, NULL, NULL},
        {"mass", 0, "M", "of each particle of an input file with densities", OPTION_POSITIVE,
         &source.mass, 0, 0, NULL, NULL},
        KERNEL_OPTION(settings),
        PRECISION_OPTION(settings, "f64"),
        OUTPUT_OPTION(settings, "CSV, scripts and pictures", "fields"),
        {0}};
    settings_read(&settings, options,
                  "Errors of plain and corrected derivatives of velocity fields on the square "
                  "[-1, 1]^2: tables here, every particle as CSV and pictures in a folder.",
                  argc, argv);
    if (!source.input && source.mass > 0)
        command_line_refuse("--mass: only with --input");
    if (source.input ? settings.support <= 0 : settings.support > 20)
        command_line_refuse("--support: %s", source.input ? "--input wants it, in the file's unit"
                                                          : "more than 20 spacings");
    const struct study_setting setting = {.dimension = 2,
                                          .side = side,
                                          .support = settings.support > 0 ? settings.support : 2,
                                          .jitter = settings.jitter,
                                          .kernel = settings.kernel,
                                          .precision = settings.precision};
    source.precision = settings.precision;
    if (source.input) {
        measure_input(settings.output, &source, setting);
        return EXIT_SUCCESS;
    }
    struct lattice_results results[2] = {{.name = "square", .setting = setting},
                                         {.name = "jittered", .setting = setting}};
    results[0].setting.jitter = 0;
    printf("Velocity gradients on [-1, 1]^2, Figs. 2 and 4 of doi:10.1145/3606933\n"
           "difference form, %s, H = %g d, d = 2 / N, %s, V_j = 1 / sum_k W_jk (j included)\n"
           "boundary: the two outermost layers\n",
           kernel_title(settings.kernel), setting.support, precision_names[settings.precision]);
    for (int k = 0; k < 2; ++k) {
        measure(settings.output, &results[k]);
        print_lattice(&results[k]);
    }
    write_convergence(settings.output, results);
    printf("\nwritten to %s: fields_*.csv, fields_*.gp%s\n", settings.output,
           draw_all(settings.output, results) ? ", fields_*.png" : "");
    return EXIT_SUCCESS;
}
