/* SPDX-License-Identifier: MIT */
/* The command `table1`: Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933, of a lattice
 * or of a file's particles, on a terminal of 100 columns. Each round goes once through everything:
 * the search, then each method's works, so that a slow second of the machine hits all columns
 * alike. */
#include "commands.h"
#include "particles/errors.h"
#include "particles/particles.h"
#include "report/report.h"
#include "limit/probe.h"
#include <math.h>

enum { METHODS = 6 };

/* Untimed: the linear field, max |J_i - J|_F / |J|_F over particles of full rank (plain SPH, which
 * has no rank: over all); NaN if there are none. */
struct method {
    sphg_method method;
    double paper_matrix, paper_gradient; /* [ms], 32 cores of a Threadripper PRO 5975WX */
    double gradient_error, fused_error, kept_error;
    int64_t not_finite; /* numbers in any Jacobian, of v and of the timed field */
    sphg_stats stats;
};

/* Timed: the search; each method's works but the search, without and with weights that a sweep
 * before kept; the probe. */
enum { SEARCH, FIRST, PROBE = FIRST + 2 * METHODS * WORKS, ITEMS = PROBE + PROBE_WORKS };

struct table1 {
    struct settings settings; /* support: in spacings; with an input file in its units */
    struct particle_source source;
    struct particles particles;
    struct scene scenes[2];    /* [1]: the same pairs, with weights */
    struct numbers velocities; /* of the file, or the linear field */
    uint8_t *ranks;
    sphg_neighbors_info neighbors;
    double volume_ratio; /* median of the file's volumes over 1 / sum W */
    double first_search; /* [ms], with all allocations */
    struct probe *probe; /* a million particles at most, whatever the table is about */
    struct method methods[METHODS];
    struct samples times[ITEMS];
};

static int item_of(int kept, int method, enum work work)
{
    return FIRST + (kept * METHODS + method) * WORKS + (int)work;
}

/* ---- Options --------------------------------------------------------------------------------- */

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
    const struct command_option options[] = {
        {"particles", 0, "N", "in the nearest cube (1000000)", OPTION_WHOLE, &settings->particles,
         1, 1e9, NULL, &particles_given},
        {"jitter", 0, "SHARE", "move each coordinate by up to this share of the spacing",
         OPTION_REAL, &settings->jitter, 0, 1, NULL, &jitter_given},
        {"order", 0, "ORDER", "particles in memory: lattice (or as in the input file), or shuffled",
         AS_CHOICE(source->order, orders)},
        {"input", 0, "FILE",
         "particles of your own instead of a lattice, from a text file with columns as solvers, "
         "ParaView and spreadsheets write it: positions (x, y, z; Points:0; Pos.x [m] ...; "
         "without z, or where one is constant, in 2D) and, if there, velocities, and volumes or "
         "densities and masses",
         AS_TEXT(source->input)},
        {"mass", 0, "M",
         "of each particle of an input file with densities, instead of its own masses",
         AS_POSITIVE(source->mass)},
        {"support", 0, "H",
         "support radius, in spacings (2); with --input in the file's unit of length",
         AS_POSITIVE(settings->support)},
        {"repetitions", 0, "N", "of each measurement, after one warm-up (9)",
         AS_WHOLE(settings->repetitions, 1, 10000)},
        {"output", 0, "FOLDER", "where Table 1 as CSV and as a picture go (nowhere)",
         AS_FOLDER(settings->output)},
        {0}};
    settings_read(settings, TAKES_LATTICE | TAKES_RUN | TAKES_KERNEL | TAKES_PRECISION, options,
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
    source->precision = settings->precision;
}

/* ---- Errors ---------------------------------------------------------------------------------- */

/* A work of one method, on that field. */
static void compute(const struct table1 *table, int kept, sphg_method method, enum work work,
                    const struct numbers *field)
{
    struct scene scene = table->scenes[kept];
    scene.scheme.method = method;
    scene.field = *field;
    scene_run(&scene, work);
}

/* What is fused says which particles could be corrected. */
static void compute_ranks(const struct table1 *table, struct method *one)
{
    struct scene scene = table->scenes[0];
    const sphg_sources sources = scene_sources(&scene);
    const sphg_view at_sources = numbers_view(&scene.field);
    const sphg_field wanted = {.shape = SPHG_VECTOR,
                               .at_sources = &at_sources,
                               .gradient = numbers_view(&scene.jacobians)};
    const sphg_request request = {.sources = &sources,
                                  .fields = &wanted,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .rank = sphg_view_u8(table->ranks, 1),
                                  .stats = &one->stats};
    scene.scheme.method = one->method;
    scene_evaluate(&scene, &request);
}

/* Plain SPH corrects nothing and has no rank: all particles count. */
static double take_error(const struct table1 *table, struct method *one)
{
    const struct numbers *jacobians = &table->scenes[0].jacobians;
    one->not_finite += count_not_finite(jacobians);
    return linear_field_worst(jacobians, one->method == SPHG_PLAIN ? NULL : table->ranks);
}

static void measure_errors(const struct table1 *table, struct method *one)
{
    const struct numbers *linear = &table->scenes[0].field;
    progress_show("warm-up: %s", method_names[one->method]);
    if (one->method == SPHG_PLAIN)
        compute(table, 0, one->method, WORK_FUSED, linear);
    else
        compute_ranks(table, one);
    one->fused_error = take_error(table, one);
    for (int kept = 0; kept < 1 + keeps_weights(one->method); ++kept) {
        if (one->method != SPHG_PLAIN)
            compute(table, kept, one->method, WORK_MATRICES, linear); /* keeps weights, too */
        compute(table, kept, one->method, WORK_GRADIENT, linear);
        *(kept ? &one->kept_error : &one->gradient_error) = take_error(table, one);
    }
    compute(table, 0, one->method, WORK_FUSED, &table->velocities);
    take_error(table, one);
}

/* ---- Times ----------------------------------------------------------------------------------- */

/* Plain SPH has no matrix, and nothing to be fused. */
static double run(void *data, int32_t item)
{
    const struct table1 *table = data;
    const int place = item - FIRST, kept = place / WORKS / METHODS;
    const enum work work = (enum work)(place % WORKS);
    if (item == SEARCH) {
        scene_run(&table->scenes[0], WORK_SEARCH);
    } else if (item >= PROBE) {
        probe_run(table->probe, (enum probe_work)(item - PROBE), table->settings.threads);
    } else {
        const sphg_method method = table->methods[place / WORKS % METHODS].method;
        if (work == WORK_SEARCH || (method == SPHG_PLAIN && work != WORK_GRADIENT) ||
            (kept && !keeps_weights(method)))
            return 0;
        compute(table, kept, method, work, &table->velocities);
    }
    return 1;
}

/* Weights of one scheme are kept at a time: those of a method are formed before its first work. */
static double prepare(void *data, int32_t item)
{
    const bool first_work = item > FIRST && item < PROBE && (item - FIRST) % WORKS == WORK_MATRICES;
    return first_work && item >= item_of(1, 0, WORK_SEARCH) ? run(data, item) : 0;
}

static double median_ratio(const struct numbers *given, const struct numbers *expected)
{
    double *ratios = allocate_held((size_t)given->count, sizeof *ratios);
    for (int32_t i = 0; i < given->count; ++i)
        ratios[i] = numbers_get(given, i, 0) / numbers_get(expected, i, 0);
    return median_of(ratios, given->count);
}

/* Volumes that neither lattice nor file gave; those of a file are compared with what would have
 * been taken without them. */
static void complete_volumes(struct table1 *table, struct scene *scene)
{
    const bool given = table->particles.volumes.count > 0;
    table->volume_ratio = 1;
    if (given && !table->source.input)
        return;
    const struct numbers volumes = scene_volumes(scene);
    if (given)
        table->volume_ratio = median_ratio(&scene->volumes, &volumes);
    else
        scene->volumes = volumes;
}

static void open_scenes(struct table1 *table)
{
    const struct particles *particles = &table->particles;
    const double unit = table->source.input ? 1 : lattice_spacing;
    const sphg_scheme widest = {.dimension = particles->dimension,
                                .method = SPHG_CMLS,
                                .kernel = table->settings.kernel,
                                .support_radius = table->settings.support * unit};
    const struct numbers volumes = particles->volumes.count
                                       ? particles->volumes
                                       : numbers_create(field_type(table->source.precision), 1, 1);
    struct scene *scene = &table->scenes[0];
    *scene =
        scene_open(library_open(table->settings.threads), &widest, particles->positions, volumes);
    progress_show("warm-up: search");
    const double start = now().wall;
    scene_run(scene, WORK_SEARCH);
    table->first_search = now().wall - start;
    table->neighbors = library_info(scene->context, scene->neighbors);
    complete_volumes(table, scene);
    table->scenes[1] = scene_keeping_weights(scene);
    table->ranks = allocate_held((size_t)particles->count, 1);
    table->velocities = particles->velocities.count ? particles->velocities : scene->field;
}

static void measure(struct table1 *table)
{
    const int32_t most = 1000000, count = table->particles.count;
    open_scenes(table);
    progress_show("warm-up: probe");
    table->probe = probe_create(table->scenes[0].context,
                                settings_side(count < most ? count : most, 3), 2, 0.2);
    for (int work = 0; work < PROBE_WORKS; ++work)
        run(table, PROBE + work);
    for (int k = 0; k < METHODS; ++k)
        measure_errors(table, &table->methods[k]);
    rounds_measure(
        &(struct rounds){"table1", table->settings.repetitions, ITEMS, run, prepare, table},
        table->times);
}

/* ---- What was measured ----------------------------------------------------------------------- */

static void report_context(const struct table1 *table)
{
    const struct settings *settings = &table->settings;
    const struct particles *particles = &table->particles;
    const double count = particles->count;
    report_text("particles_from", table->source.input ? table->source.input : "lattice");
    report_lattice(settings, particles->count, (double)table->neighbors.pairs / count);
    report_number("dimension", particles->dimension);
    report_number("bytes_per_particle", (double)table->neighbors.bytes / count);
    report_text("kernel", kernel_names[settings->kernel]);
    report_text("precision", precision_names[settings->precision]);
    report_text("order", table->source.order == ORDER_SHUFFLED ? "shuffled" : "lattice");
    report_number("support_radius", table->scenes[0].scheme.support_radius);
    report_number("search_first_ms", table->first_search);
    report_text(".flat", particles->flat);
    report_text(".frames", particles->more ? "several" : "");
    report_text(".columns", particles->columns);
    report_text(".volume", particles->volume_origin);
    report_text(".velocities", particles->velocities.count ? "the file's" : "");
    report_number(".side", table->source.side);
    report_number(".volume_ratio", table->volume_ratio);
}

static struct cell cell_error(const char *key, bool there, double error)
{
    return cell_if(there && !isnan(error), cell_number(key, error));
}

static void add_method(const struct table1 *table, int method)
{
    const struct method *one = &table->methods[method];
    const struct samples *plain = &table->times[item_of(0, method, WORK_SEARCH)],
                         *kept = &table->times[item_of(1, method, WORK_SEARCH)];
    const bool corrected = one->method != SPHG_PLAIN;
    TABLE_ROW(cell_text("method", method_names[one->method]),
              cell_ms("matrix", &plain[WORK_MATRICES]), cell_ms("gradient", &plain[WORK_GRADIENT]),
              cell_ms("fused", &plain[WORK_FUSED]), cell_ms("matrix+weights", &kept[WORK_MATRICES]),
              cell_ms("gradient+weights", &kept[WORK_GRADIENT]),
              cell_ms("fused+weights", &kept[WORK_FUSED]),
              cell_error("gradient_error", true, one->gradient_error),
              cell_error("fused_error", corrected, one->fused_error),
              cell_error("kept_error", keeps_weights(one->method), one->kept_error),
              cell_if(one->paper_matrix > 0, cell_number("paper_matrix", one->paper_matrix)),
              cell_number("paper_gradient", one->paper_gradient),
              cell_count(".not_finite", one->not_finite),
              cell_count(".decomposed", one->stats.decomposed),
              cell_count(".rank0", one->stats.rank[0]), cell_count(".rank1", one->stats.rank[1]),
              cell_count(".rank2", one->stats.rank[2]), cell_count(".rank3", one->stats.rank[3]));
}

static int show(const struct table1 *table)
{
    report_open("table1", &table->settings);
    report_context(table);
    table_begin("table1");
    TABLE_ROW(cell_ms("search", &table->times[SEARCH]));
    table_begin("probe");
    TABLE_ROW(cell_ms("matrices", &table->times[PROBE + PROBE_MATRICES]),
              cell_ms("gradient", &table->times[PROBE + PROBE_GRADIENT]),
              cell_count("particles", table->probe->count));
    table_begin("table1");
    for (int k = 0; k < METHODS; ++k)
        add_method(table, k);
    return report_close();
}

int command_table1(int argc, char **argv)
{
    struct table1 table = {
        .settings = settings_default(1000000, 9, NULL),
        .methods = {{.method = SPHG_PLAIN, .paper_gradient = 12.08},
                    {.method = SPHG_KGC, .paper_matrix = 11.23, .paper_gradient = 13.00},
                    {.method = SPHG_CMLS, .paper_matrix = 28.98, .paper_gradient = 41.95},
                    {.method = SPHG_MLS, .paper_matrix = 11.29, .paper_gradient = 12.42},
                    {.method = SPHG_CRKPM, .paper_matrix = 29.18, .paper_gradient = 44.80},
                    {.method = SPHG_RKPM, .paper_matrix = 12.31, .paper_gradient = 13.94}}};
    table.settings.support = table.settings.jitter = 0; /* of a lattice 2, of a file as it says */
    read_options(&table, argc, argv);
    table.particles = particles_create(&table.source);
    measure(&table);
    return show(&table);
}
