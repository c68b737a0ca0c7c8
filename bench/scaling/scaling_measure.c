/* SPDX-License-Identifier: MIT */
/* The measurements of scaling. */
#include "library.h"
#include "particles/linear_field.h"
#include "particles/particles.h"
#include "report/progress.h"
#include "scaling.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a case runs on. */
struct scene {
    struct scaling_case *one;
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    struct numbers positions, radii, field, corrections,
        jacobians;          /* radii: count 0, one for all */
    struct numbers volumes; /* count 1: one for all */
};

static void take_cloud(struct scene *scene)
{
    const struct cloud_setting *setting = &scene->one->cloud;
    if (setting->shape == CLOUD_GRADED) {
        const struct graded_cloud cloud = cloud_graded(setting);
        scene->positions = cloud.positions;
        scene->radii = cloud.radii;
        scene->volumes = cloud.volumes;
        scene->scheme.support_radius *= setting->ratio;
        return;
    }
    scene->positions = cloud_positions(setting);
    scene->volumes = numbers_create(SPHG_F32, 1, 1);
    numbers_set(&scene->volumes, 0, 0, pow(lattice_spacing, setting->dimension));
}

static sphg_view volumes_of(const struct scene *scene)
{
    return scene->volumes.count == 1 ? sphg_same_f32(scene->volumes.data)
                                     : numbers_view(&scene->volumes);
}

static struct scene open_scene(struct scaling_case *one)
{
    const int32_t d = one->cloud.dimension;
    struct scene scene = {
        .one = one,
        .context = library_open(one->threads),
        .scheme = {.dimension = d, .support_radius = one->cloud.support * lattice_spacing}};
    take_cloud(&scene);
    const int32_t count = one->count = scene.positions.count;
    scene.field = numbers_create(SPHG_F32, count, d);
    scene.corrections = numbers_create(SPHG_F32, count, sphg_correction_width(&scene.scheme));
    scene.jacobians = numbers_create(SPHG_F32, count, d * d);
    linear_field_fill(&scene.positions, &scene.field);
    scene.neighbors = library_neighbors(scene.context);
    return scene;
}

static void close_scene(struct scene *scene)
{
    sphg_neighbors_destroy(scene->neighbors);
    sphg_context_destroy(scene->context);
    numbers_destroy(&scene->positions);
    numbers_destroy(&scene->field);
    numbers_destroy(&scene->volumes);
    numbers_destroy(&scene->radii);
    numbers_destroy(&scene->corrections);
    numbers_destroy(&scene->jacobians);
}

/* ranks: where they go, of matrices; NULL: nowhere */
static void run(struct scene *scene, enum scaling_work work, uint8_t *ranks)
{
    sphg_geometry geometry = library_geometry(&scene->positions, SPHG_F32);
    sphg_sources sources = {.neighbors = scene->neighbors, .volume = volumes_of(scene)};
    const sphg_view corrections = numbers_view(&scene->corrections);
    if (scene->radii.count)
        geometry.source_support = numbers_view(&scene->radii);
    if (work == SCALING_GRADIENT)
        sources.correction = corrections;
    if (work == SCALING_SEARCH)
        library_search(scene->context, scene->neighbors, &scene->scheme, &geometry);
    else if (work == SCALING_MATRICES)
        library_correct(scene->context, &scene->scheme, &sources, corrections, ranks);
    else
        library_jacobian(scene->context, &scene->scheme, &sources, &scene->field,
                         &scene->jacobians);
}

/* Warms up on the way. */
static void measure_error(struct scene *scene)
{
    struct scaling_case *one = scene->one;
    uint8_t *ranks = allocate_or_exit((size_t)one->count, 1);
    int32_t deficient = 0;
    for (int work = 0; work < SCALING_WORKS; ++work)
        run(scene, (enum scaling_work)work, ranks);
    const sphg_neighbors_info info = library_info(scene->context, scene->neighbors);
    one->pairs = (double)info.pairs / one->count;
    one->bytes = (double)info.bytes / one->count;
    for (int32_t i = 0; i < one->count; ++i) {
        one->not_finite += !isfinite(linear_field_error(&scene->jacobians, i));
        deficient += ranks[i] < scene->positions.width;
    }
    one->error = deficient < one->count ? linear_field_worst(&scene->jacobians, ranks) : 0;
    one->deficient = (double)deficient / one->count;
    free(ranks);
}

/* begin up to the returned index: the cases of one group. */
static int end_of_group(const struct scaling *scaling, int begin)
{
    int end = begin;
    while (end < scaling->case_count &&
           strcmp(scaling->cases[end].group, scaling->cases[begin].group) == 0)
        ++end;
    return end;
}

static void measure_group(struct scaling *scaling, int begin, int end)
{
    struct scene *scenes = allocate_or_exit((size_t)(end - begin), sizeof *scenes);
    for (int k = begin; k < end; ++k) {
        progress_show("%s: preparing %s", scaling->cases[k].group, scaling->cases[k].label);
        scenes[k - begin] = open_scene(&scaling->cases[k]);
        measure_error(&scenes[k - begin]);
    }
    for (int32_t round = 0; round < scaling->settings.repetitions; ++round)
        for (int k = begin; k < end; ++k) {
            struct scaling_case *one = &scaling->cases[k];
            progress_show("%s: round %d of %d: %s", one->group, round + 1,
                          scaling->settings.repetitions, one->label);
            for (int work = 0; work < SCALING_WORKS; ++work) {
                const struct moment start = now();
                run(&scenes[k - begin], (enum scaling_work)work, NULL);
                samples_add(&one->time[work], since(start));
            }
        }
    for (int k = 0; k < end - begin; ++k)
        close_scene(&scenes[k]);
    free(scenes);
}

void scaling_measure(struct scaling *scaling)
{
    for (int begin = 0, end; begin < scaling->case_count; begin = end) {
        end = end_of_group(scaling, begin);
        measure_group(scaling, begin, end);
    }
    progress_clear();
}
