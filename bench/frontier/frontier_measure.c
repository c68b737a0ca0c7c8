/* SPDX-License-Identifier: MIT */
/* The measurements of frontier. A round goes once through all ways. */
#include "frontier.h"
#include "fields/fields_measure.h"
#include "particles/particles.h"
#include "report/progress.h"
#include <math.h>
#include <stdlib.h>

static const double wave_length = 20 * 1.0 / 128; /* 20 spacings */

/* What all ways of one precision share. */
struct ground {
    struct scene scenes[PATHS];
    struct numbers fields[FRONTIER_FIELDS];
    struct library_lists lists; /* the host's */
};

struct bench {
    struct frontier *frontier;
    struct ground grounds[FRONTIER_PRECISIONS];
};

static void exact_at(const struct scene *scene, enum frontier_field field, int32_t i, double v[3],
                     double j[9])
{
    double x[3];
    for (int axis = 0; axis < 3; ++axis)
        x[axis] = numbers_get(&scene->positions, i, axis);
    study_field_at(field == FRONTIER_LINEAR ? FIELD_ROTATION : FIELD_WAVES, 3, wave_length, x, v,
                   j);
}

static struct ground open_ground(sphg_context *context, struct settings settings,
                                 enum precision precision)
{
    settings.precision = precision;
    struct scene scene = scene_of_lattice(context, &settings, 3);
    struct ground ground = {
        .fields = {numbers_create(scene.field.type, scene.count, 3), scene.field}};
    double v[3], j[9];
    for (int32_t i = 0; i < scene.count; ++i) {
        exact_at(&scene, FRONTIER_TRIGONOMETRIC, i, v, j);
        for (int axis = 0; axis < 3; ++axis)
            numbers_set(&ground.fields[FRONTIER_TRIGONOMETRIC], i, axis, v[axis]);
    }
    const sphg_scheme widest = {.method = SPHG_CMLS, .support_radius = 1};
    scene.corrections =
        numbers_create(scene.field.type, scene.count, sphg_correction_width(&widest));
    for (int path = 0; path < PATHS; ++path)
        ground.scenes[path] = scene_beside(&scene);
    ground.scenes[PATH_LIST_FREE].geometry.list_free = 1;
    scene_run(&ground.scenes[PATH_KEPT], WORK_SEARCH);
    ground.lists =
        library_lists(context, &scene.scheme, ground.scenes[PATH_KEPT].neighbors, scene.count);
    return ground;
}

/* From positions to Jacobians. */
static struct scene take(const struct bench *bench, const struct frontier_point *point,
                         enum frontier_field field)
{
    const struct ground *ground = &bench->grounds[point->precision];
    const sphg_lists lists = {.offsets = ground->lists.offsets, .indices = ground->lists.indices};
    struct scene scene = ground->scenes[point->path];
    scene.field = ground->fields[field];
    scene.scheme.method = point->method;
    scene.scheme.kernel = point->kernel;
    if (point->path == PATH_HOST_LISTS)
        library_check(scene.context,
                      sphg_neighbors_use_lists(scene.context, scene.neighbors, &scene.scheme,
                                               &scene.geometry, &lists));
    else
        scene_run(&scene, WORK_SEARCH);
    if (point->by_table)
        scene_run(&scene, WORK_MATRICES);
    scene_run(&scene, point->by_table ? WORK_GRADIENT : WORK_FUSED);
    return scene;
}

static double run(void *data, int32_t item)
{
    const struct bench *bench = data;
    take(bench, &bench->frontier->points[item], FRONTIER_TRIGONOMETRIC);
    return 1;
}

static void measure_error(const struct bench *bench, struct frontier_point *point,
                          enum frontier_field field)
{
    const struct scene scene = take(bench, point, field);
    double v[3], expected[9], sum = 0, most = 0, squares = 0;
    for (int32_t i = 0; i < scene.count; ++i) {
        double difference = 0;
        exact_at(&scene, field, i, v, expected);
        for (int32_t k = 0; k < 9; ++k) {
            const double d = numbers_get(&scene.jacobians, i, k) - expected[k];
            difference += d * d;
            squares += expected[k] * expected[k];
        }
        sum += sqrt(difference);
        most = numbers_larger(most, sqrt(difference));
    }
    const double size = sqrt(squares / scene.count);
    point->mean[field] = sum / scene.count / size;
    point->most[field] = most / size;
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
    struct held *mark = held_so_far();
    struct bench bench = {.frontier = frontier};
    sphg_context *context = library_open(frontier->settings.threads);
    struct samples *times = allocate_held((size_t)frontier->point_count, sizeof *times);
    for (int precision = 0; precision < FRONTIER_PRECISIONS; ++precision)
        bench.grounds[precision] =
            open_ground(context, frontier->settings, (enum precision)precision);
    frontier->count = bench.grounds[0].scenes[0].count;
    frontier->pairs = (double)bench.grounds[0].lists.count / frontier->count;
    for (int k = 0; k < frontier->point_count; ++k) {
        progress_show("errors: %d of %d", k + 1, frontier->point_count);
        for (int field = 0; field < FRONTIER_FIELDS; ++field)
            measure_error(&bench, &frontier->points[k], (enum frontier_field)field);
    }
    rounds_measure(&(struct rounds){"ways", frontier->settings.repetitions, frontier->point_count,
                                    run, NULL, &bench},
                   times);
    for (int k = 0; k < frontier->point_count; ++k)
        frontier->points[k].time = times[k];
    qsort(frontier->points, (size_t)frontier->point_count, sizeof *frontier->points, compare_times);
    for (int k = 0; k < FRONTIER_FIELDS * SIDES; ++k)
        find_frontier(frontier, (enum frontier_field)(k / SIDES), (enum frontier_side)(k % SIDES));
    release_held(mark);
}
