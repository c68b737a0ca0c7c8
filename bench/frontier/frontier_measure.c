/* SPDX-License-Identifier: MIT */
/* The measurements of frontier. A round goes once through all ways. */
#include "frontier.h"
#include "fields/field_study.h"
#include "lattice.h"
#include "library.h"
#include "particles/particles.h"
#include "report/progress.h"
#include <math.h>
#include <stdlib.h>

static const double wave_length = 20 * 1.0 / 128; /* 20 spacings */

/* What all ways of one precision share. */
struct scene {
    sphg_context *context;
    sphg_neighbors *neighbors[PATHS];
    struct particles particles;
    struct numbers fields[FRONTIER_FIELDS], corrections, jacobians;
    double support_radius;
    int64_t *offsets; /* the host's lists */
    int32_t *indices;
};

static void evaluate_field(enum frontier_field field, const double x[3], double v[3], double j[9])
{
    study_field_at(field == FRONTIER_LINEAR ? FIELD_ROTATION : FIELD_WAVES, 3, wave_length, x, v,
                   j);
}

static void position_of(const struct scene *scene, int32_t i, double x[3])
{
    for (int axis = 0; axis < 3; ++axis)
        x[axis] = numbers_get(&scene->particles.positions, i, axis);
}

static void fill_field(struct scene *scene, enum frontier_field field)
{
    double x[3], v[3], j[9];
    for (int32_t i = 0; i < scene->particles.count; ++i) {
        position_of(scene, i, x);
        evaluate_field(field, x, v, j);
        for (int axis = 0; axis < 3; ++axis)
            numbers_set(&scene->fields[field], i, axis, v[axis]);
    }
}

static sphg_scheme scheme_of(const struct scene *scene, const struct frontier_point *point)
{
    return (sphg_scheme){
        .method = point->method, .kernel = point->kernel, .support_radius = scene->support_radius};
}

static void build(const struct scene *scene, const sphg_scheme *scheme, enum frontier_path path)
{
    sphg_geometry geometry = library_geometry(&scene->particles.positions, scene->jacobians.type);
    const sphg_lists lists = {.offsets = scene->offsets, .indices = scene->indices};
    sphg_neighbors *neighbors = scene->neighbors[path];
    geometry.list_free = path == PATH_LIST_FREE;
    if (path != PATH_HOST_LISTS)
        library_search(scene->context, neighbors, scheme, &geometry);
    else
        library_check(scene->context, sphg_neighbors_use_lists(scene->context, neighbors, scheme,
                                                               &geometry, &lists));
}

static void run(const struct scene *scene, const struct frontier_point *point,
                enum frontier_field field)
{
    const sphg_scheme scheme = scheme_of(scene, point);
    sphg_sources sources = {.neighbors = scene->neighbors[point->path],
                            .volume = numbers_view(&scene->particles.volumes)};
    build(scene, &scheme, point->path);
    if (point->by_table) {
        struct numbers table = scene->corrections;
        table.width = sphg_correction_width(&scheme);
        library_correct(scene->context, &scheme, &sources, numbers_view(&table), NULL);
        sources.correction = numbers_view(&table);
    }
    library_jacobian(scene->context, &scheme, &sources, &scene->fields[field], &scene->jacobians);
}

static void measure_error(const struct scene *scene, struct frontier_point *point,
                          enum frontier_field field)
{
    double x[3], v[3], expected[9], sum = 0, most = 0, squares = 0;
    run(scene, point, field);
    for (int32_t i = 0; i < scene->particles.count; ++i) {
        double difference = 0;
        position_of(scene, i, x);
        evaluate_field(field, x, v, expected);
        for (int32_t k = 0; k < 9; ++k) {
            const double d = numbers_get(&scene->jacobians, i, k) - expected[k];
            difference += d * d;
            squares += expected[k] * expected[k];
        }
        sum += sqrt(difference);
        most = numbers_larger(most, sqrt(difference));
    }
    const double size = sqrt(squares / scene->particles.count);
    point->mean[field] = sum / scene->particles.count / size;
    point->most[field] = most / size;
}

static void export_lists(struct scene *scene)
{
    const sphg_scheme scheme = {.support_radius = scene->support_radius};
    build(scene, &scheme, PATH_KEPT);
    const sphg_sources sources = {.neighbors = scene->neighbors[PATH_KEPT]};
    scene->offsets = allocate_or_exit((size_t)scene->particles.count + 1, sizeof *scene->offsets);
    sphg_pairs pairs = {.offsets = scene->offsets};
    library_check(scene->context, sphg_pair_gradients(scene->context, &scheme, &sources, NULL,
                                                      sphg_absent(), &pairs));
    scene->indices = allocate_or_exit((size_t)pairs.count, sizeof *scene->indices);
    pairs.indices = scene->indices;
    pairs.capacity = pairs.count;
    library_check(scene->context, sphg_pair_gradients(scene->context, &scheme, &sources, NULL,
                                                      sphg_absent(), &pairs));
}

static struct scene open_scene(const struct settings *settings, sphg_context *context,
                               enum precision precision)
{
    const struct particle_source source = {.side = settings_side(settings->particles, 3),
                                           .jitter = settings->jitter,
                                           .precision = precision};
    const sphg_scheme widest = {.method = SPHG_CMLS, .support_radius = 1};
    const sphg_type type = field_type(precision);
    struct scene scene = {.context = context,
                          .particles = particles_create(&source),
                          .support_radius = settings->support * lattice_spacing};
    const int32_t count = scene.particles.count;
    scene.corrections = numbers_create(type, count, sphg_correction_width(&widest));
    scene.jacobians = numbers_create(type, count, 9);
    for (int field = 0; field < FRONTIER_FIELDS; ++field) {
        scene.fields[field] = numbers_create(type, count, 3);
        fill_field(&scene, (enum frontier_field)field);
    }
    for (int path = 0; path < PATHS; ++path)
        scene.neighbors[path] = library_neighbors(context);
    export_lists(&scene);
    return scene;
}

static void close_scene(struct scene *scene)
{
    for (int path = 0; path < PATHS; ++path)
        sphg_neighbors_destroy(scene->neighbors[path]);
    for (int field = 0; field < FRONTIER_FIELDS; ++field)
        numbers_destroy(&scene->fields[field]);
    numbers_destroy(&scene->corrections);
    numbers_destroy(&scene->jacobians);
    particles_destroy(&scene->particles);
    free(scene->offsets);
    free(scene->indices);
}

static void measure_errors(struct frontier *frontier, const struct scene *scenes)
{
    for (int k = 0; k < frontier->point_count; ++k) {
        struct frontier_point *point = &frontier->points[k];
        progress_show("errors: %d of %d", k + 1, frontier->point_count);
        for (int field = 0; field < FRONTIER_FIELDS; ++field)
            measure_error(&scenes[point->precision], point, (enum frontier_field)field);
    }
}

static void measure_times(struct frontier *frontier, const struct scene *scenes)
{
    for (int32_t round = 0; round < frontier->settings.repetitions; ++round)
        for (int k = 0; k < frontier->point_count; ++k) {
            struct frontier_point *point = &frontier->points[k];
            if (k % 16 == 0)
                progress_show("round %d of %d: %d of %d", round + 1, frontier->settings.repetitions,
                              k, frontier->point_count);
            const struct moment start = now();
            run(&scenes[point->precision], point, FRONTIER_TRIGONOMETRIC);
            samples_add(&point->time, since(start));
        }
}

/* ---- The frontiers --------------------------------------------------------------------------- */

double frontier_error(const struct frontier_point *point, enum frontier_field field)
{
    return field == FRONTIER_LINEAR ? point->most[field] : point->mean[field];
}

enum frontier_side frontier_side(const struct frontier_point *point)
{
    return point->path == PATH_HOST_LISTS ? SIDE_HOST : SIDE_SEARCH;
}

static int compare_times(const void *left, const void *right)
{
    const struct frontier_point *a = left, *b = right;
    const double time_a = samples_median(&a->time), time_b = samples_median(&b->time);
    return (time_a > time_b) - (time_a < time_b);
}

/* From the fastest on, those with a smaller error than all before. Errors that say the same do
 * not count as smaller: of the linear field, which is all rounding, within a factor of 2. */
static void find_frontier(struct frontier *frontier, enum frontier_field field,
                          enum frontier_side side)
{
    const double smaller = field == FRONTIER_LINEAR ? 0.5 : 0.97;
    double least = INFINITY;
    for (int k = 0; k < frontier->point_count; ++k) {
        struct frontier_point *point = &frontier->points[k];
        const double error = frontier_error(point, field);
        if (frontier_side(point) != side || !(error < smaller * least))
            continue;
        least = error;
        point->on_frontier[field] = true;
    }
}

void frontier_measure(struct frontier *frontier)
{
    struct scene scenes[FRONTIER_PRECISIONS];
    sphg_context *context = library_open(frontier->settings.threads);
    for (int precision = 0; precision < FRONTIER_PRECISIONS; ++precision)
        scenes[precision] = open_scene(&frontier->settings, context, (enum precision)precision);
    frontier->count = scenes[0].particles.count;
    frontier->pairs = (double)scenes[0].offsets[frontier->count] / frontier->count;
    measure_errors(frontier, scenes);
    measure_times(frontier, scenes);
    progress_clear();
    qsort(frontier->points, (size_t)frontier->point_count, sizeof *frontier->points, compare_times);
    for (int k = 0; k < FRONTIER_FIELDS * SIDES; ++k)
        find_frontier(frontier, (enum frontier_field)(k / SIDES), (enum frontier_side)(k % SIDES));
    for (int precision = 0; precision < FRONTIER_PRECISIONS; ++precision)
        close_scene(&scenes[precision]);
    sphg_context_destroy(context);
}
