/* SPDX-License-Identifier: MIT */
/* The command `frontier`: run time against error of every way to a velocity gradient. A round goes
 * once through all ways. frontier.py finds who is on a frontier. */
#include "commands.h"
#include "fields/fig2_trigonometric_measure.h"
#include "frontier_order.h"
#include "particles/errors.h"
#include "particles/particles.h"
#include "report/report.h"
#include <math.h>

enum path { PATH_KEPT, PATH_WEIGHTS, PATH_LIST_FREE, PATH_HOST_LISTS, PATHS };
static const char *const path_names[PATHS] = {"kept lists", "kept weights", "list-free",
                                              "host's lists"};

enum { WAVES, LINEAR, FIELDS };
static const enum study_field fields[FIELDS] = {FIELD_WAVES, FIELD_ROTATION};
enum {
    METHODS = 6,
    KERNELS = 7,
    PRECISIONS = 3,
    WAYS_MOST = METHODS * KERNELS * PRECISIONS * PATHS * 2
};

static const double wave_length = 20 * 1.0 / 128; /* 20 spacings */

struct way {
    sphg_method method;
    sphg_kernel kernel;
    enum precision precision;
    enum path path;
    bool by_table; /* matrices first, then the gradient by their table; else in one sweep */
    /* |J_i - J|_F over the root mean square of |J|_F, over all particles. */
    double mean[FIELDS], most[FIELDS];
};

struct frontier {
    struct settings settings;
    struct ground { /* what all ways of one precision share */
        struct scene scenes[PATHS];
        struct numbers fields[FIELDS];
        struct library_lists lists; /* the host's */
    } grounds[PRECISIONS];
    int way_count;
    struct way ways[WAYS_MOST];
    struct samples times[WAYS_MOST]; /* [ms] search or taking over lists, matrices, gradient */
};

/* Plain SPH has no matrices and so no table of them; weights are kept for the second of two sweeps,
 * and only where they are formed. */
static void list_ways(struct frontier *frontier)
{
    for (int k = 0; k < WAYS_MOST; ++k) {
        const struct way way = {.by_table = k % 2,
                                .path = (enum path)(k / 2 % PATHS),
                                .precision = (enum precision)(k / 2 / PATHS % PRECISIONS),
                                .kernel = (sphg_kernel)(k / 2 / PATHS / PRECISIONS % KERNELS),
                                .method = (sphg_method)(k / 2 / PATHS / PRECISIONS / KERNELS)};
        if ((way.method != SPHG_PLAIN || !way.by_table) &&
            (way.path != PATH_WEIGHTS || (way.by_table && keeps_weights(way.method))))
            frontier->ways[frontier->way_count++] = way;
    }
}

/* ---- Measuring ------------------------------------------------------------------------------- */

static struct ground open_ground(sphg_context *context, struct settings settings,
                                 enum precision precision)
{
    static const sphg_scheme widest = {.method = SPHG_CMLS, .support_radius = 1};
    settings.precision = precision;
    struct scene scene = scene_of_lattice(context, &settings, 3);
    struct ground ground = {
        .fields = {numbers_create(scene.field.type, scene.count, 3), scene.field}};
    study_fill_table(&scene, FIELD_WAVES, wave_length, &ground.fields[WAVES]);
    scene.corrections =
        numbers_create(scene.field.type, scene.count, sphg_correction_width(&widest));
    for (int path = 0; path < PATHS; ++path)
        ground.scenes[path] = scene_beside(&scene);
    ground.scenes[PATH_LIST_FREE].geometry.list_free = 1;
    ground.scenes[PATH_WEIGHTS].geometry.keep_weights = 1;
    ground.scenes[PATH_WEIGHTS].same_volumes = true;
    scene_run(&ground.scenes[PATH_KEPT], WORK_SEARCH);
    ground.lists =
        library_lists(context, &scene.scheme, ground.scenes[PATH_KEPT].neighbors, scene.count);
    return ground;
}

/* From positions to Jacobians. */
static struct scene take(const struct frontier *frontier, const struct way *way, int field)
{
    const struct ground *ground = &frontier->grounds[way->precision];
    const sphg_lists lists = {.offsets = ground->lists.offsets, .indices = ground->lists.indices};
    struct scene scene = ground->scenes[way->path];
    scene.field = ground->fields[field];
    scene.scheme.method = way->method;
    scene.scheme.kernel = way->kernel;
    if (way->path == PATH_HOST_LISTS)
        scene_use_lists(&scene, &lists);
    else
        scene_run(&scene, WORK_SEARCH);
    if (way->by_table)
        scene_run(&scene, WORK_MATRICES);
    scene_run(&scene, way->by_table ? WORK_GRADIENT : WORK_FUSED);
    return scene;
}

static double run(void *data, int32_t item)
{
    const struct frontier *frontier = data;
    take(frontier, &frontier->ways[item], WAVES);
    return 1;
}

static void measure_error(const struct frontier *frontier, struct way *way, int field)
{
    const struct scene scene = take(frontier, way, field);
    double v[3], expected[9], sum = 0, most = 0, squares = 0;
    for (int32_t i = 0; i < scene.count; ++i) {
        study_exact_at(&scene, fields[field], wave_length, i, v, expected);
        const double error = norm_of(&scene.jacobians, i, expected);
        sum += error;
        most = numbers_larger(most, error);
        for (int k = 0; k < 9; ++k)
            squares += expected[k] * expected[k];
    }
    const double size = sqrt(squares / scene.count);
    way->mean[field] = sum / scene.count / size;
    way->most[field] = most / size;
}

static void measure(struct frontier *frontier)
{
    const struct settings *settings = &frontier->settings;
    sphg_context *context = library_open(settings->threads);
    for (int precision = 0; precision < PRECISIONS; ++precision)
        frontier->grounds[precision] = open_ground(context, *settings, (enum precision)precision);
    for (int k = 0; k < frontier->way_count; ++k) {
        progress_show("errors: %d of %d", k + 1, frontier->way_count);
        for (int field = 0; field < FIELDS; ++field)
            measure_error(frontier, &frontier->ways[k], field);
    }
    rounds_measure(
        &(struct rounds){"ways", settings->repetitions, frontier->way_count, run, NULL, frontier},
        frontier->times);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void add_ways(const struct frontier *frontier)
{
    const int32_t count = frontier->grounds[0].scenes[0].count;
    report_lattice(&frontier->settings, count, (double)frontier->grounds[0].lists.count / count);
    table_begin("frontier");
    for (int k = 0; k < frontier->way_count; ++k) {
        const struct way *way = &frontier->ways[k];
        TABLE_ROW(cell_text("method", method_names[way->method]),
                  cell_text("kernel", kernel_names[way->kernel]),
                  cell_text("precision", precision_names[way->precision]),
                  cell_text("path", path_names[way->path]),
                  cell_text("option", way->method == SPHG_PLAIN ? "one sweep"
                                      : way->by_table           ? "table"
                                                                : "fused"),
                  cell_time("", &frontier->times[k], 1e6 / count, "ns_per_particle"),
                  cell_number("trigonometric_mean", way->mean[WAVES]),
                  cell_number("trigonometric_max", way->most[WAVES]),
                  cell_number("linear_mean", way->mean[LINEAR]),
                  cell_number("linear_max", way->most[LINEAR]));
    }
}

int command_frontier(int argc, char **argv)
{
    struct frontier *frontier = allocate_to_the_end(1, sizeof *frontier);
    struct settings *settings = &frontier->settings;
    *settings = settings_default(27000, 7, "frontier");
    bool order_alone = false;
    const struct command_option options[] = {
        {"output", 0, "FOLDER", "where CSV, script and picture go (frontier)",
         AS_FOLDER(settings->output)},
        {"order", 0, NULL, "order 2 beside order 1 alone", AS_FLAG(order_alone)},
        {0}};
    settings_read(settings, TAKES_LATTICE | TAKES_RUN, options,
                  "Times every way to a velocity gradient (method, kernel, precision, path, "
                  "option) from positions to result, and measures its error on a block with free "
                  "surfaces: which are worth their time.",
                  argc, argv);
    struct held *mark = held_so_far();
    list_ways(frontier);
    if (!order_alone)
        measure(frontier);
    report_open("frontier", settings);
    if (!order_alone)
        add_ways(frontier);
    release_held(mark);
    frontier_order(settings);
    return report_close();
}
