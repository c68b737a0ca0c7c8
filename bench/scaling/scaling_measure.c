/* The measurements of scaling. */
#include "library.h"
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

/* v = (-y, x, 2z), in 2D (-y, 2x): numbers that are stored exactly, whatever the positions. */
static const double linear[2][9] = {{0, -1, 2, 0}, {0, -1, 0, 1, 0, 0, 0, 0, 2}};

static void fill_field(struct scene *scene)
{
    const int32_t d = scene->positions.width;
    for (int32_t i = 0; i < scene->positions.count; i++)
        for (int32_t a = 0; a < d; a++) {
            double value = 0;
            for (int32_t b = 0; b < d; b++)
                value += linear[d - 2][a * d + b] * numbers_get(&scene->positions, i, b);
            numbers_set(&scene->field, i, a, value);
        }
}

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
    fill_field(&scene);
    library_check(scene.context, sphg_neighbors_create(scene.context, &scene.neighbors));
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

static void run(struct scene *scene, enum scaling_work work)
{
    sphg_geometry geometry = sphg_all(numbers_view(&scene->positions), scene->positions.count);
    sphg_sources sources = {.neighbors = scene->neighbors, .volume = volumes_of(scene)};
    const sphg_view corrections = numbers_view(&scene->corrections);
    sphg_result result = SPHG_OK;
    if (scene->radii.count)
        geometry.source_support = numbers_view(&scene->radii);
    if (work == SCALING_GRADIENT)
        sources.correction = corrections;
    if (work == SCALING_SEARCH)
        result = sphg_neighbors_search(scene->context, scene->neighbors, &scene->scheme, &geometry);
    else if (work == SCALING_MATRICES)
        result = sphg_correction(scene->context, &scene->scheme, &sources, NULL, corrections,
                                 sphg_absent());
    else
        result = sphg_jacobian(scene->context, &scene->scheme, &sources, NULL,
                               numbers_view(&scene->field), numbers_view(&scene->jacobians));
    library_check(scene->context, result);
}

static void compute_ranks(struct scene *scene, uint8_t *ranks)
{
    const sphg_sources sources = {.neighbors = scene->neighbors, .volume = volumes_of(scene)};
    library_check(scene->context,
                  sphg_correction(scene->context, &scene->scheme, &sources, NULL,
                                  numbers_view(&scene->corrections), sphg_view_u8(ranks, 1)));
}

static double error_of(const struct scene *scene, int32_t i)
{
    const int32_t d = scene->positions.width;
    double difference = 0, size = 0;
    for (int32_t k = 0; k < d * d; k++) {
        const double expected = linear[d - 2][k];
        const double off = numbers_get(&scene->jacobians, i, k) - expected;
        difference += off * off;
        size += expected * expected;
    }
    return sqrt(difference / size);
}

/* Warms up on the way. */
static void measure_error(struct scene *scene)
{
    struct scaling_case *one = scene->one;
    uint8_t *ranks = allocate_or_exit((size_t)one->count, 1);
    sphg_neighbors_info info;
    int32_t deficient = 0;
    run(scene, SCALING_SEARCH);
    compute_ranks(scene, ranks);
    run(scene, SCALING_GRADIENT);
    run(scene, SCALING_FUSED);
    library_check(scene->context, sphg_neighbors_get_info(scene->context, scene->neighbors, &info));
    one->pairs = (double)info.pairs / one->count;
    one->bytes = (double)info.bytes / one->count;
    for (int32_t i = 0; i < one->count; i++) {
        const double error = error_of(scene, i);
        one->not_finite += !isfinite(error);
        if (ranks[i] == scene->positions.width)
            one->error = numbers_larger(one->error, error);
        else
            deficient++;
    }
    one->deficient = (double)deficient / one->count;
    free(ranks);
}

/* begin up to the returned index: the cases of one group. */
static int end_of_group(const struct scaling *scaling, int begin)
{
    int end = begin;
    while (end < scaling->case_count &&
           strcmp(scaling->cases[end].group, scaling->cases[begin].group) == 0)
        end++;
    return end;
}

static void measure_group(struct scaling *scaling, int begin, int end)
{
    struct scene *scenes = allocate_or_exit((size_t)(end - begin), sizeof *scenes);
    for (int k = begin; k < end; k++) {
        progress_show("%s: preparing %s", scaling->cases[k].group, scaling->cases[k].label);
        scenes[k - begin] = open_scene(&scaling->cases[k]);
        measure_error(&scenes[k - begin]);
    }
    for (int32_t round = 0; round < scaling->settings.repetitions; round++)
        for (int k = begin; k < end; k++) {
            struct scaling_case *one = &scaling->cases[k];
            progress_show("%s: round %d of %d: %s", one->group, round + 1,
                          scaling->settings.repetitions, one->label);
            for (int work = 0; work < SCALING_WORKS; work++) {
                const struct moment start = now();
                run(&scenes[k - begin], (enum scaling_work)work);
                samples_add_since(&one->time[work], start);
            }
        }
    for (int k = 0; k < end - begin; k++)
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
