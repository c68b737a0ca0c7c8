/* SPDX-License-Identifier: MIT */
/* The measurements of scaling. */
#include "particles/linear_field.h"
#include "scaling.h"
#include <math.h>
#include <string.h>

static struct scene open_scene(const struct scaling_case *one)
{
    const struct cloud cloud = cloud_create(&one->cloud);
    const sphg_scheme scheme = {.dimension = one->cloud.dimension,
                                .support_radius = cloud.support_radius};
    struct scene scene =
        scene_open(library_open(one->threads), &scheme, cloud.positions, cloud.volumes);
    if (cloud.radii.count)
        scene.geometry.source_support = numbers_view(&cloud.radii);
    return scene;
}

static double run(void *scenes, int32_t item)
{
    scene_run((struct scene *)scenes + item / WORKS, (enum work)(item % WORKS));
    return 1;
}

/* Warms up on the way. */
static void measure_error(struct scene *scene, struct scaling_case *one)
{
    uint8_t *ranks = allocate_held((size_t)scene->count, 1);
    int32_t deficient = 0;
    for (int work = 0; work < WORKS; ++work)
        scene_run(scene, (enum work)work);
    scene_correct(scene, ranks);
    const sphg_neighbors_info info = library_info(scene->context, scene->neighbors);
    one->count = scene->count;
    one->pairs = (double)info.pairs / one->count;
    one->bytes = (double)info.bytes / one->count;
    for (int32_t i = 0; i < one->count; ++i) {
        one->not_finite += !isfinite(linear_field_error(&scene->jacobians, i));
        deficient += ranks[i] < scene->positions.width;
    }
    one->error = deficient < one->count ? linear_field_worst(&scene->jacobians, ranks) : 0;
    one->deficient = (double)deficient / one->count;
}

/* The cases of one group: its memory is released before that of the next is taken. */
static void measure_group(const struct settings *settings, struct scaling_case *cases, int count)
{
    struct held *mark = held_so_far();
    struct scene *scenes = allocate_held((size_t)count, sizeof *scenes);
    struct samples *times = allocate_to_the_end((size_t)count * WORKS, sizeof *times);
    for (int k = 0; k < count; ++k) {
        scenes[k] = open_scene(&cases[k]);
        measure_error(&scenes[k], &cases[k]);
    }
    rounds_measure(
        &(struct rounds){cases[0].group, settings->repetitions, count * WORKS, run, NULL, scenes},
        times);
    for (int k = 0; k < count * WORKS; ++k)
        cases[k / WORKS].time[k % WORKS] = times[k];
    release_held(mark);
}

void scaling_measure(struct scaling *scaling)
{
    for (int begin = 0, end; begin < scaling->case_count; begin = end) {
        struct scaling_case *first = &scaling->cases[begin];
        end = begin + 1;
        while (end < scaling->case_count && strcmp(scaling->cases[end].group, first->group) == 0)
            ++end;
        measure_group(&scaling->settings, first, end - begin);
    }
}
