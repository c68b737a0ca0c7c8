/* SPDX-License-Identifier: MIT */
/* The measurements of table1. Each round goes once through everything: the search, then each
 * method's three calls. So a slow second of the machine hits all columns alike. */
#include "particles/linear_field.h"
#include "report/progress.h"
#include "table1.h"
#include <math.h>
#include <stdlib.h>

struct bench {
    struct table1 *table;
    struct scene scenes[2];    /* [1]: the same pairs, with room for weights */
    struct numbers velocities; /* of the file, or the linear field */
    uint8_t *ranks;
    struct probe *probe;
};

/* A work of one method, on that field. */
static void compute(const struct bench *bench, int kept, sphg_method method, enum work work,
                    const struct numbers *field)
{
    struct scene scene = bench->scenes[kept];
    scene.scheme.method = method;
    scene.field = *field;
    scene_run(&scene, work);
}

/* ---- Errors ---------------------------------------------------------------------------------- */

/* What is fused says which particles could be corrected. */
static void compute_ranks(const struct bench *bench, struct table1_method *one)
{
    struct scene scene = bench->scenes[0];
    const sphg_sources sources = scene_sources(&scene);
    const sphg_view at_sources = numbers_view(&scene.field);
    const sphg_field wanted = {.shape = SPHG_VECTOR,
                               .at_sources = &at_sources,
                               .gradient = numbers_view(&scene.jacobians)};
    const sphg_request request = {.sources = &sources,
                                  .fields = &wanted,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .rank = sphg_view_u8(bench->ranks, 1),
                                  .stats = &one->stats};
    scene.scheme.method = one->method;
    scene_evaluate(&scene, &request);
}

/* Plain SPH corrects nothing and has no rank: all particles count. */
static double take_error(const struct bench *bench, struct table1_method *one)
{
    const struct numbers *jacobians = &bench->scenes[0].jacobians;
    one->not_finite += linear_field_not_finite(jacobians);
    return linear_field_worst(jacobians, one->method == SPHG_PLAIN ? NULL : bench->ranks);
}

static void measure_errors(const struct bench *bench, struct table1_method *one)
{
    const struct numbers *linear = &bench->scenes[0].field;
    progress_show("warm-up: %s", method_names[one->method]);
    if (one->method == SPHG_PLAIN)
        compute(bench, 0, one->method, WORK_FUSED, linear);
    else
        compute_ranks(bench, one);
    one->fused_error = take_error(bench, one);
    for (int kept = 0; kept < 1 + table1_keeps_weights(one); ++kept) {
        if (one->method != SPHG_PLAIN)
            compute(bench, kept, one->method, WORK_MATRICES, linear); /* keeps weights, too */
        compute(bench, kept, one->method, WORK_GRADIENT, linear);
        *(kept ? &one->kept_error : &one->gradient_error) = take_error(bench, one);
    }
    compute(bench, 0, one->method, WORK_FUSED, &bench->velocities);
    take_error(bench, one);
}

/* ---- Times ----------------------------------------------------------------------------------- */

/* Plain SPH has no matrix, and nothing to be fused. */
static double run(void *data, int32_t item)
{
    const struct bench *bench = data;
    const int place = item - TABLE1_FIRST, kept = place / WORKS / TABLE1_METHODS;
    const enum work work = (enum work)(place % WORKS);
    if (item == TABLE1_SEARCH) {
        scene_run(&bench->scenes[0], WORK_SEARCH);
        return 1;
    }
    if (item >= TABLE1_PROBE) {
        probe_run(bench->probe, (enum probe_work)(item - TABLE1_PROBE),
                  bench->table->settings.threads);
        return 1;
    }
    const struct table1_method *one = &bench->table->methods[place / WORKS % TABLE1_METHODS];
    if (work == WORK_SEARCH || (one->method == SPHG_PLAIN && work != WORK_GRADIENT) ||
        (kept && !table1_keeps_weights(one)))
        return 0;
    compute(bench, kept, one->method, work, &bench->velocities);
    return 1;
}

/* Weights of one scheme are kept at a time: those of a method are formed before its first work. */
static double prepare(void *data, int32_t item)
{
    const bool first_work = item > TABLE1_FIRST && item < TABLE1_PROBE &&
                            (item - TABLE1_FIRST) % WORKS == WORK_MATRICES;
    return first_work && item >= table1_item(1, 0, WORK_SEARCH) ? run(data, item) : 0;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static double median_ratio(const struct numbers *given, const struct numbers *expected)
{
    double *ratios = allocate_or_exit((size_t)given->count, sizeof *ratios);
    for (int32_t i = 0; i < given->count; ++i)
        ratios[i] = numbers_get(given, i, 0) / numbers_get(expected, i, 0);
    const double median = median_of(ratios, given->count);
    free(ratios);
    return median;
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

static struct bench open_bench(struct table1 *table)
{
    const struct particles *particles = &table->particles;
    const sphg_scheme widest = {.dimension = particles->dimension,
                                .method = SPHG_CMLS,
                                .kernel = table->settings.kernel,
                                .support_radius = table->support_radius};
    const struct numbers volumes = particles->volumes.count
                                       ? particles->volumes
                                       : numbers_create(field_type(table->source.precision), 1, 1);
    struct bench bench = {.table = table,
                          .ranks = allocate_held((size_t)particles->count, 1),
                          .scenes = {scene_open(library_open(table->settings.threads), &widest,
                                                particles->positions, volumes)}};
    struct scene *scene = &bench.scenes[0];
    progress_show("warm-up: search");
    const double start = now().wall;
    scene_run(scene, WORK_SEARCH);
    table->first_search = now().wall - start;
    table->neighbors = library_info(scene->context, scene->neighbors);
    complete_volumes(table, scene);
    bench.scenes[1] = scene_beside(scene);
    bench.scenes[1].geometry.keep_weights = 1;
    bench.scenes[1].same_volumes = true;
    scene_run(&bench.scenes[1], WORK_SEARCH);
    bench.velocities = particles->velocities.count ? particles->velocities : scene->field;
    return bench;
}

/* A cube of as many particles, a million at most, whatever the table is about. */
static void open_probe(struct bench *bench)
{
    const int32_t most = 1000000, count = bench->table->particles.count;
    progress_show("warm-up: probe");
    bench->probe = probe_create(bench->scenes[0].context,
                                settings_side(count < most ? count : most, 3), 2, 0.2);
    bench->table->probe_count = probe_count(bench->probe);
    for (int work = 0; work < PROBE_WORKS; ++work)
        run(bench, TABLE1_PROBE + work);
}

void table1_measure(struct table1 *table)
{
    struct bench bench = open_bench(table);
    open_probe(&bench);
    for (int k = 0; k < TABLE1_METHODS; ++k)
        measure_errors(&bench, &table->methods[k]);
    rounds_measure(
        &(struct rounds){"table1", table->settings.repetitions, TABLE1_ITEMS, run, prepare, &bench},
        table->times);
}
