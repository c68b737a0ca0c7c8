/* SPDX-License-Identifier: MIT */
#include "scene.h"
#include "particles/errors.h"

struct scene scene_open(sphg_context *context, const sphg_scheme *scheme, struct numbers positions,
                        struct numbers volumes)
{
    const int32_t d = positions.width, count = positions.count;
    struct scene scene = {.context = context,
                          .neighbors = library_neighbors(context),
                          .scheme = *scheme,
                          .geometry = sphg_all(numbers_view(&positions), count),
                          .positions = positions,
                          .volumes = volumes,
                          .field = numbers_create(volumes.type, count, d),
                          .corrections =
                              numbers_create(volumes.type, count, sphg_correction_width(scheme)),
                          .jacobians = numbers_create(volumes.type, count, d * d),
                          .count = count};
    scene.geometry.precision = volumes.type;
    linear_field_fill(&positions, &scene.field);
    return scene;
}

struct scene scene_beside(const struct scene *scene)
{
    struct scene other = *scene;
    other.neighbors = library_neighbors(scene->context);
    return other;
}

struct scene scene_keeping_weights(const struct scene *scene)
{
    struct scene other = scene_beside(scene);
    other.geometry.keep_weights = 1;
    other.same_volumes = true;
    scene_run(&other, WORK_SEARCH);
    return other;
}

bool keeps_weights(sphg_method method)
{
    return method == SPHG_KGC || method == SPHG_MLS || method == SPHG_RKPM;
}

sphg_sources scene_sources(const struct scene *scene)
{
    sphg_sources sources = {.neighbors = scene->neighbors,
                            .volume = numbers_view(&scene->volumes),
                            .same_volumes = scene->same_volumes};
    if (scene->volumes.count == 1)
        sources.volume.stride = 0;
    return sources;
}

sphg_view scene_corrections(const struct scene *scene)
{
    struct numbers corrections = scene->corrections;
    corrections.width = sphg_correction_width(&scene->scheme);
    return corrections.width > 0 ? numbers_view(&corrections) : sphg_absent();
}

double scene_pairs(const struct scene *scene)
{
    return (double)library_info(scene->context, scene->neighbors).pairs / scene->count;
}

void scene_correct(const struct scene *scene, uint8_t *ranks)
{
    const sphg_sources sources = scene_sources(scene);
    library_check(scene->context, sphg_correction(scene->context, &scene->scheme, &sources, NULL,
                                                  scene_corrections(scene),
                                                  ranks ? sphg_view_u8(ranks, 1) : sphg_absent()));
}

void scene_evaluate(const struct scene *scene, const sphg_request *request)
{
    library_check(scene->context, sphg_evaluate(scene->context, &scene->scheme, request));
}

void scene_use_lists(const struct scene *scene, const sphg_lists *lists)
{
    library_check(scene->context,
                  sphg_neighbors_use_lists(scene->context, scene->neighbors, &scene->scheme,
                                           &scene->geometry, lists));
}

void scene_run(const struct scene *scene, enum work work)
{
    sphg_context *context = scene->context;
    sphg_sources sources = scene_sources(scene);
    if (work == WORK_SEARCH) {
        library_check(context, sphg_neighbors_search(context, scene->neighbors, &scene->scheme,
                                                     &scene->geometry));
    } else if (work == WORK_MATRICES) {
        scene_correct(scene, NULL);
    } else {
        if (work == WORK_GRADIENT)
            sources.correction = scene_corrections(scene);
        library_check(context,
                      sphg_jacobian(context, &scene->scheme, &sources, NULL,
                                    numbers_view(&scene->field), numbers_view(&scene->jacobians)));
    }
}

struct numbers scene_volumes(const struct scene *scene)
{
    struct scene plain = *scene;
    struct numbers volumes = numbers_create(scene->jacobians.type, scene->count, 1);
    plain.scheme.method = SPHG_PLAIN;
    plain.volumes = numbers_create(volumes.type, 1, 1);
    numbers_set(&plain.volumes, 0, 0, 1);
    const sphg_sources sources = scene_sources(&plain);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_DIRECT,
                              .at_sources = &sources.volume,
                              .value = numbers_view(&volumes)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    scene_evaluate(&plain, &request);
    for (int32_t i = 0; i < volumes.count; ++i)
        numbers_set(&volumes, i, 0, 1 / numbers_get(&volumes, i, 0));
    return volumes;
}
