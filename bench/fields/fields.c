/* SPDX-License-Identifier: MIT */
/* The command `fields`: errors of plain and corrected derivatives on a square, Figs. 2 and 4 of
 * Westhofen, Jeske, Bender 2023, doi:10.1145/3606933; or on the particles of a file. */
#include "commands.h"
#include "fields_measure.h"
#include "particles/particles.h"
#include "report/report.h"
#include <stdio.h>

enum { WAYS = 8, SIZES = 3 /* N, 2 N, 4 N */, KINDS = 2 /* of fields */, LATTICES = 2 };

static const struct study_way ways[WAYS] = {
    {.name = "SPH", .method = SPHG_PLAIN}, {.name = "KGC", .method = SPHG_KGC},
    {.name = "MLS", .method = SPHG_MLS},   {.name = "RKPM", .method = SPHG_RKPM},
    {.name = "CMLS", .method = SPHG_CMLS}, {.name = "CRKPM", .method = SPHG_CRKPM},
    {.name = "KGC order 2", .order = 2},   {.name = "KGC order 2 lent", .order = 2, .lent = true}};
static const char *const lattices[LATTICES] = {"square", "jittered"};

/* ---- Lattices -------------------------------------------------------------------------------- */

/* One row a particle: where, which velocity, all errors of the ways in the order above. */
static void write_particles(const char *folder, const char *name, const struct study *study,
                            const double *errors)
{
    const struct scene *scene = &study->scene;
    const char *keys[2 * WAYS];
    for (int k = 0; k < 2 * WAYS; ++k)
        keys[k] = text_of("%s_error_%s", k < WAYS ? "gradient" : "curl", ways[k % WAYS].name);
    REPORT("table", "");
    for (int32_t i = 0; i < scene->count; ++i) {
        struct cell cells[4 + 2 * WAYS] = {
            cell_number(NULL, "x", NULL, numbers_get(&scene->positions, i, 0)),
            cell_number(NULL, "y", NULL, numbers_get(&scene->positions, i, 1)),
            cell_number(NULL, "vx", NULL, numbers_get(&scene->field, i, 0)),
            cell_number(NULL, "vy", NULL, numbers_get(&scene->field, i, 1))};
        for (int k = 0; k < 2 * WAYS; ++k)
            cells[4 + k] =
                cell_number(NULL, keys[k], NULL, errors[(ptrdiff_t)k * scene->count + i]);
        table_add(cells, 4 + 2 * WAYS);
    }
    REPORT("csv", folder, name);
}

/* The smallest lattice leaves a file of its particles. */
static void measure(const char *folder, const struct study_setting *smallest,
                    struct study_errors found[LATTICES][KINDS][WAYS][SIZES])
{
    for (int n = 0; n < LATTICES * SIZES * KINDS; ++n) {
        const int lattice = n / KINDS / SIZES, size = n / KINDS % SIZES, field = n % KINDS;
        struct study_setting setting = *smallest;
        setting.side <<= size;
        setting.jitter = lattice ? setting.jitter : 0;
        struct study study = study_open(&setting);
        const size_t count = (size_t)study.scene.count;
        double *errors = allocate_held(2 * WAYS * count, sizeof *errors);
        study_fill(&study, (enum study_field)field);
        for (int k = 0; k < WAYS; ++k) {
            study_derive(&study, &ways[k]);
            found[lattice][field][k][size] = study_compare(&study, errors + (size_t)k * count,
                                                           errors + (size_t)(WAYS + k) * count);
        }
        if (size == 0)
            write_particles(folder,
                            text_of("fields_%s_%s.csv", study_field_name((enum study_field)field),
                                    lattices[lattice]),
                            &study, errors);
        study_close(&study);
    }
}

static void add_errors(const struct study_setting *smallest,
                       struct study_errors found[LATTICES][KINDS][WAYS][SIZES])
{
    REPORT("table", "");
    for (int n = 0; n < LATTICES * KINDS * WAYS * SIZES; ++n) {
        const int size = n % SIZES, k = n / SIZES % WAYS, field = n / SIZES / WAYS % KINDS;
        const int lattice = n / SIZES / WAYS / KINDS;
        const struct study_errors *e = &found[lattice][field][k][size];
        const int32_t side = smallest->side << size;
        TABLE_ROW(cell_text(NULL, "lattice", lattices[lattice]),
                  cell_text(NULL, "field", study_field_name((enum study_field)field)),
                  cell_text(NULL, "method", ways[k].name), cell_count(NULL, "N", side),
                  cell_number(NULL, "spacing", NULL, 2.0 / side),
                  cell_number(NULL, "boundary_max", NULL, e->most[STUDY_BOUNDARY]),
                  cell_number(NULL, "boundary_mean", NULL, e->mean[STUDY_BOUNDARY]),
                  cell_number(NULL, "inside_max", NULL, e->most[STUDY_INSIDE]),
                  cell_number(NULL, "inside_mean", NULL, e->mean[STUDY_INSIDE]),
                  cell_number(NULL, "curl_max", NULL, e->curl_max));
    }
}

static void draw(const char *folder, const struct study_setting *setting)
{
    static const struct {
        const char *name, *script, *quantity;
        enum study_field field;
    } pictures[] = {{"fields_rotation", "panels", "gradient", FIELD_ROTATION},
                    {"fields_trigonometric", "panels", "gradient", FIELD_TRIGONOMETRIC},
                    {"fields_curl", "panels", "curl", FIELD_ROTATION},
                    {"fields_convergence", "convergence", "", FIELD_TRIGONOMETRIC},
                    {"fields_order", "order", "", FIELD_TRIGONOMETRIC}};
    enum { PICTURES = sizeof pictures / sizeof pictures[0] };
    for (int k = 0; k < LATTICES * PICTURES; ++k) {
        const int p = k % PICTURES, lattice = k / PICTURES;
        const char *name = text_of("%s%s", pictures[p].name, lattice ? "_jittered" : "");
        REPORT("draw", folder, text_of("%s.gp", name),
               text_of("fields/fields_common.gp fields/fields_%s.gp", pictures[p].script),
               text_of("output = '%s.png'", name),
               text_of("field = '%s'", study_field_name(pictures[p].field)),
               text_of("formula = '%s'", study_field_formula(pictures[p].field)),
               text_of("lattice = '%s'", lattices[lattice]),
               text_of("support = '%g'", setting->support),
               text_of("kernel = '%s'", kernel_title(setting->kernel)),
               text_of("precision = '%s'", precision_names[setting->precision]),
               text_of("side = %d", setting->side),
               text_of("quantity = '%s'", pictures[p].quantity));
    }
}

static void study_lattices(const char *folder, const struct study_setting *setting)
{
    struct study_errors found[LATTICES][KINDS][WAYS][SIZES];
    printf("Velocity gradients on [-1, 1]^2, Figs. 2 and 4 of doi:10.1145/3606933\n"
           "difference form, %s, H = %g d, d = 2 / N, %s, V_j = 1 / sum_k W_jk (j included)\n"
           "boundary: the two outermost layers\n",
           kernel_title(setting->kernel), setting->support, precision_names[setting->precision]);
    measure(folder, setting, found);
    add_errors(setting, found);
    REPORT("show", "lattices", text_of("%g", setting->jitter), study_field_formula(FIELD_ROTATION),
           study_field_formula(FIELD_TRIGONOMETRIC));
    REPORT("csv", folder, "fields_convergence.csv");
    draw(folder, setting);
    REPORT("drawn", folder, "fields_*.csv, fields_*.gp", ", fields_*.png");
}

/* ---- A file's particles ---------------------------------------------------------------------- */

/* Relative errors of waves, for those who resolve curvature, slopes alone, or not all of these. */
static void add_waves(struct study *study, const struct study_errors errors[WAYS])
{
    static const struct {
        const char *mean, *mean_key, *max_key;
    } groups[STUDY_GROUPS] = {{"curvature: mean", "curvature_mean", "curvature_max"},
                              {"slopes: mean", "slopes_mean", "slopes_max"},
                              {"neither: mean", "neither_mean", "neither_max"}};
    const double k = 2 * 3.14159265358979323846 / (10 * study->scene.scheme.support_radius);
    REPORT("table", "");
    for (int way = 0; way < WAYS; ++way) {
        struct cell cells[1 + 2 * STUDY_GROUPS] = {cell_text("", "method", ways[way].name)};
        for (int n = 0; n < STUDY_GROUPS; ++n) {
            const int group = STUDY_CURVATURE - n;
            const bool there = errors[way].counts[group] > 0;
            cells[1 + 2 * n] = cell_if(there, cell_number(groups[n].mean, groups[n].mean_key,
                                                          "%.3e", errors[way].mean[group] / k));
            cells[2 + 2 * n] = cell_if(
                there, cell_number("max", groups[n].max_key, "%.3e", errors[way].most[group] / k));
        }
        table_add(cells, 1 + 2 * STUDY_GROUPS);
    }
}

static void study_input(const char *folder, const struct particle_source *source,
                        struct study_setting setting)
{
    struct particles particles = particles_create(source);
    setting.dimension = particles.dimension;
    struct study study = study_of_particles(&setting, particles.positions, particles.volumes);
    struct study_errors errors[WAYS];
    study_fill(&study, FIELD_WAVES);
    for (int way = 0; way < WAYS; ++way) {
        study_derive(&study, &ways[way]);
        errors[way] = study_compare(&study, NULL, NULL);
    }
    const double percent = 100.0 / study.scene.count;
    printf(
        "particles  %d of %s, %dD, H = %g, volume %s\n"
        "resolved   slopes and curvature by %.2f %%, slopes alone by %.2f %%, neither by %.2f %%\n"
        "errors     |J_i - J|_F / k of v_a = sin(k x_a) cos(k x_b), 10 H a wave\n",
        (int)study.scene.count, source->input, (int)setting.dimension, setting.support,
        particles.volume_origin, percent * errors[0].counts[STUDY_CURVATURE],
        percent * errors[0].counts[STUDY_SLOPES], percent * errors[0].counts[STUDY_NEITHER]);
    add_waves(&study, errors);
    REPORT("print");
    REPORT("csv", folder, "fields_input.csv");
    REPORT("drawn", folder, "fields_input.csv");
}

int command_fields(int argc, char **argv)
{
    struct settings settings = {.jitter = 0.2, .precision = PRECISION_F64, .output = "fields"};
    struct particle_source source = {0};
    int32_t side = 40;
    const struct command_option options[] = {
        {"size", 0, "N", "N x N particles; convergence over N, 2 N, 4 N (40)",
         AS_WHOLE(side, 5, 500)},
        {"support", 0, "H", "support radius in spacings (2); with --input in the file's unit",
         AS_POSITIVE(settings.support)},
        {"jitter", 0, "SHARE", "of the spacing, each way, on the jittered lattice (0.2)",
         AS_REAL(settings.jitter, 0.001, 0.5)},
        {"input", 0, "FILE",
         "particles of your own instead, as table1 reads them: who of them resolves slopes and "
         "curvature, and the errors of waves on them",
         AS_TEXT(source.input)},
        {"mass", 0, "M", "of each particle of an input file with densities",
         AS_POSITIVE(source.mass)},
        {"precision", 0, "TYPE", "f32, f64, or mixed: positions f64, the rest f32 (f64)",
         AS_CHOICE(settings.precision, precision_names)},
        {"output", 0, "FOLDER", "where CSV, scripts and pictures go (fields)",
         AS_FOLDER(settings.output)},
        {0}};
    settings_read(&settings, TAKES_KERNEL, options,
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
    report_open("fields", &settings);
    if (source.input)
        study_input(settings.output, &source, setting);
    else
        study_lattices(settings.output, &setting);
    return report_close();
}
