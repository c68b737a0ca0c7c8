/* SPDX-License-Identifier: MIT */
/* The command `fields`: errors of plain and corrected derivatives on a square, Figs. 2 and 4 of
 * Westhofen, Jeske, Bender 2023, doi:10.1145/3606933; or on the particles of a file. */
#include "commands.h"
#include "fig2_trigonometric_measure.h"
#include "particles/particles.h"
#include "report/report.h"

enum { WAYS = 8, SIZES = 3 /* N, 2 N, 4 N */, KINDS = 2 /* of fields */, LATTICES = 2 };

static const struct study_way ways[WAYS] = {
    {.name = "SPH", .method = SPHG_PLAIN}, {.name = "KGC", .method = SPHG_KGC},
    {.name = "MLS", .method = SPHG_MLS},   {.name = "RKPM", .method = SPHG_RKPM},
    {.name = "CMLS", .method = SPHG_CMLS}, {.name = "CRKPM", .method = SPHG_CRKPM},
    {.name = "KGC order 2", .order = 2},   {.name = "KGC order 2 lent", .order = 2, .lent = true}};
static const char *const lattices[LATTICES] = {"square", "jittered"};

/* ---- Lattices -------------------------------------------------------------------------------- */

/* One row a particle: where, which velocity, all errors of the ways in the order above. */
static void add_particles(const char *name, const struct study *study, const double *errors)
{
    const struct scene *scene = &study->scene;
    const char *keys[2 * WAYS];
    for (int k = 0; k < 2 * WAYS; ++k)
        keys[k] = text_of("%s_error_%s", k < WAYS ? "gradient" : "curl", ways[k % WAYS].name);
    table_begin(name);
    for (int32_t i = 0; i < scene->count; ++i) {
        struct cell cells[4 + 2 * WAYS] = {cell_number("x", numbers_get(&scene->positions, i, 0)),
                                           cell_number("y", numbers_get(&scene->positions, i, 1)),
                                           cell_number("vx", numbers_get(&scene->field, i, 0)),
                                           cell_number("vy", numbers_get(&scene->field, i, 1))};
        for (int k = 0; k < 2 * WAYS; ++k)
            cells[4 + k] = cell_number(keys[k], errors[(ptrdiff_t)k * scene->count + i]);
        table_add(cells, 4 + 2 * WAYS);
    }
}

/* The smallest lattice leaves a file of its particles. */
static void measure(const struct study_setting *smallest,
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
            add_particles(text_of("fields_%s_%s.csv", study_field_name((enum study_field)field),
                                  lattices[lattice]),
                          &study, errors);
        study_close(&study);
    }
}

static void add_errors(const struct study_setting *smallest,
                       struct study_errors found[LATTICES][KINDS][WAYS][SIZES])
{
    table_begin("errors");
    for (int n = 0; n < LATTICES * KINDS * WAYS * SIZES; ++n) {
        const int size = n % SIZES, k = n / SIZES % WAYS, field = n / SIZES / WAYS % KINDS;
        const int lattice = n / SIZES / WAYS / KINDS;
        const struct study_errors *e = &found[lattice][field][k][size];
        const int32_t side = smallest->side << size;
        TABLE_ROW(cell_text("lattice", lattices[lattice]),
                  cell_text("field", study_field_name((enum study_field)field)),
                  cell_text("method", ways[k].name), cell_count("N", side),
                  cell_number("spacing", 2.0 / side),
                  cell_number("boundary_max", e->most[STUDY_BOUNDARY]),
                  cell_number("boundary_mean", e->mean[STUDY_BOUNDARY]),
                  cell_number("inside_max", e->most[STUDY_INSIDE]),
                  cell_number("inside_mean", e->mean[STUDY_INSIDE]),
                  cell_number("curl_max", e->curl_max));
    }
}

static void study_lattices(const struct study_setting *setting)
{
    struct study_errors found[LATTICES][KINDS][WAYS][SIZES];
    report_number(".side", setting->side);
    report_number(".support", setting->support);
    report_text(".rotation", study_field_formula(FIELD_ROTATION));
    report_text(".trigonometric", study_field_formula(FIELD_TRIGONOMETRIC));
    measure(setting, found);
    add_errors(setting, found);
}

/* ---- A file's particles ---------------------------------------------------------------------- */

/* Relative errors of waves, for those who resolve curvature, slopes alone, or not all of these. */
static void study_input(const struct particle_source *source, struct study_setting setting)
{
    static const char *const groups[STUDY_GROUPS] = {"neither", "slopes", "curvature"};
    struct particles particles = particles_create(source);
    setting.dimension = particles.dimension;
    struct study study = study_of_particles(&setting, particles.positions, particles.volumes);
    const double k = 2 * 3.14159265358979323846 / (10 * study.scene.scheme.support_radius);
    report_text(".input", source->input);
    report_text(".volume", particles.volume_origin);
    report_number(".particles", study.scene.count);
    report_number(".dimension", setting.dimension);
    table_begin("waves");
    study_fill(&study, FIELD_WAVES);
    for (int way = 0; way < WAYS; ++way) {
        study_derive(&study, &ways[way]);
        const struct study_errors e = study_compare(&study, NULL, NULL);
        struct cell cells[1 + 3 * STUDY_GROUPS] = {cell_text("method", ways[way].name)},
                                  *next = cells;
        for (int group = STUDY_CURVATURE; group >= 0; --group) {
            const bool there = e.counts[group] > 0;
            *++next =
                cell_if(there, cell_number(text_of("%s_mean", groups[group]), e.mean[group] / k));
            *++next =
                cell_if(there, cell_number(text_of("%s_max", groups[group]), e.most[group] / k));
            *++next = cell_count(text_of(".%s", groups[group]), e.counts[group]);
        }
        table_add(cells, 1 + 3 * STUDY_GROUPS);
    }
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
        study_input(&source, setting);
    else
        study_lattices(&setting);
    return report_close();
}
