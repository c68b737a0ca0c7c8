/* SPDX-License-Identifier: MIT */
#include "skip_stage.h"
#include "lattice.h"
#include "particles/particles.h"
#include <math.h>
#include <stdlib.h>

static const double shares[SKIP_PATTERNS / 2] = {0.75, 0.5, 0.1, 0.01};

/* Largest distance from the middle on any axis, over half the side. */
static double off_centre(const struct numbers *positions, int32_t i, double middle)
{
    double most = 0;
    for (int32_t axis = 0; axis < positions->width; ++axis)
        most = fmax(most, fabs(numbers_get(positions, i, axis) - middle));
    return most / (middle + 0.5 * lattice_spacing);
}

static struct pattern create_pattern(const struct numbers *positions, double middle, double share,
                                     int clustered)
{
    const size_t count = (size_t)positions->count;
    struct pattern pattern = {.share = share, .clustered = clustered};
    pattern.mask = allocate_or_exit(count, sizeof *pattern.mask);
    pattern.indices = allocate_or_exit(count, sizeof *pattern.indices);
    for (int32_t i = 0; i < positions->count; ++i) {
        pattern.mask[i] =
            clustered ? off_centre(positions, i, middle) < cbrt(share) : lattice_random(i) < share;
        if (pattern.mask[i])
            pattern.indices[pattern.count++] = i;
    }
    return pattern;
}

static void fill_fields(struct cloud *cloud, int32_t dimension)
{
    const double wave = 2 * 3.14159265358979323846 / (32 * lattice_spacing);
    for (int32_t f = 0; f < SKIP_FIELDS; ++f) {
        cloud->fields[f] = numbers_create(SPHG_F32, cloud->positions.count, dimension);
        for (int32_t i = 0; i < cloud->positions.count; ++i)
            for (int32_t axis = 0; axis < dimension; ++axis) {
                const double x = numbers_get(&cloud->positions, i, (axis + f) % dimension);
                numbers_set(&cloud->fields[f], i, axis, sin(wave * x + f));
            }
    }
}

static struct outputs create_outputs(const struct cloud *cloud, int32_t dimension)
{
    const int32_t count = cloud->positions.count;
    struct outputs outputs = {
        .corrections = numbers_create(SPHG_F32, count, sphg_correction_width(&cloud->scheme)),
        .divergence = numbers_create(SPHG_F32, count, 1),
        .curl = numbers_create(SPHG_F32, count, dimension == 3 ? 3 : 1)};
    for (int f = 0; f < SKIP_FIELDS; ++f)
        outputs.jacobians[f] = numbers_create(SPHG_F32, count, dimension * dimension);
    return outputs;
}

static void destroy_outputs(struct outputs *outputs)
{
    numbers_destroy(&outputs->corrections);
    numbers_destroy(&outputs->divergence);
    numbers_destroy(&outputs->curl);
    for (int f = 0; f < SKIP_FIELDS; ++f)
        numbers_destroy(&outputs->jacobians[f]);
}

/* Each coordinate by at most a quarter of the skin: less than half of it in any direction. */
static void move(struct cloud *cloud, double skin)
{
    for (int32_t i = 0; i < cloud->positions.count; ++i)
        for (int32_t axis = 0; axis < cloud->positions.width; ++axis) {
            const double shift = 0.25 * skin * (2 * lattice_random(3 * (int64_t)i + axis) - 1);
            numbers_set(&cloud->moved, i, axis, numbers_get(&cloud->positions, i, axis) + shift);
        }
}

static sphg_neighbors *find(const struct skip_stage *stage, const struct cloud *cloud,
                            int32_t list_free, double skin, int32_t keep_weights)
{
    sphg_neighbors *neighbors = library_neighbors(stage->context);
    sphg_geometry geometry = library_geometry(&cloud->positions, SPHG_F32);
    geometry.list_free = list_free;
    geometry.keep_weights = keep_weights;
    geometry.skin = skin;
    library_search(stage->context, neighbors, &cloud->scheme, &geometry);
    return neighbors;
}

static struct cloud create_cloud(const struct skip_stage *stage, const struct settings *settings,
                                 int32_t dimension, double support)
{
    const struct lattice lattice = {.dimension = dimension,
                                    .side = settings_side(settings->particles, dimension),
                                    .spacing = lattice_spacing,
                                    .jitter = settings->jitter};
    const int32_t count = lattice_count(&lattice);
    struct cloud cloud = {
        .scheme = {.dimension = dimension, .support_radius = support * lattice_spacing},
        .positions = numbers_create(SPHG_F32, count, dimension),
        .moved = numbers_create(SPHG_F32, count, dimension)};
    lattice_fill(&lattice, &cloud.positions);
    move(&cloud, stage->skin);
    fill_fields(&cloud, dimension);
    cloud.full = create_outputs(&cloud, dimension);
    cloud.part = create_outputs(&cloud, dimension);
    cloud.kept = find(stage, &cloud, 0, 0, 0);
    cloud.info = library_info(stage->context, cloud.kept);
    return cloud;
}

static void destroy_cloud(struct cloud *cloud)
{
    sphg_neighbors_destroy(cloud->kept);
    sphg_neighbors_destroy(cloud->list_free);
    sphg_neighbors_destroy(cloud->skinned);
    sphg_neighbors_destroy(cloud->weighted);
    sphg_neighbors_destroy(cloud->rebuilt);
    numbers_destroy(&cloud->positions);
    numbers_destroy(&cloud->moved);
    for (int f = 0; f < SKIP_FIELDS; ++f)
        numbers_destroy(&cloud->fields[f]);
    destroy_outputs(&cloud->full);
    destroy_outputs(&cloud->part);
}

/* The radius [spacings] at which a plane holds as many neighbours. */
static double support_in_plane(const struct cloud *solid)
{
    const double pairs = (double)solid->info.pairs / solid->positions.count;
    return sqrt((pairs + 1) / 3.14159265358979323846);
}

struct skip_stage skip_stage_create(const struct settings *settings)
{
    struct skip_stage stage = {.context = library_open(settings->threads),
                               .skin = 0.1 * settings->support * lattice_spacing};
    const int32_t side = settings_side(settings->particles, 3);
    stage.solid = create_cloud(&stage, settings, 3, settings->support);
    stage.plane = create_cloud(&stage, settings, 2, support_in_plane(&stage.solid));
    stage.solid.list_free = find(&stage, &stage.solid, 1, 0, 0);
    stage.solid.skinned = find(&stage, &stage.solid, 0, stage.skin, 0);
    stage.solid.weighted = find(&stage, &stage.solid, 0, 0, 1);
    stage.solid.rebuilt = find(&stage, &stage.solid, 0, 0, 0);
    const int32_t solid_count = stage.solid.positions.count,
                  plane_count = stage.plane.positions.count;
    stage.volumes =
        numbers_create(SPHG_F32, solid_count > plane_count ? solid_count : plane_count, 1);
    stage.volume = numbers_create(SPHG_F32, 1, 1);
    const double volume = lattice_spacing * lattice_spacing * lattice_spacing;
    for (int32_t i = 0; i < stage.volumes.count; ++i)
        numbers_set(&stage.volumes, i, 0, volume);
    numbers_set(&stage.volume, 0, 0, volume);
    stage.corrections = numbers_create(SPHG_F32, solid_count, 6);
    for (int k = 0; k < SKIP_PATTERNS; ++k)
        stage.patterns[k] = create_pattern(
            &stage.solid.positions, 0.5 * (side - 1) * lattice_spacing, shares[k / 2], k % 2);
    return stage;
}

void skip_stage_destroy(struct skip_stage *stage)
{
    for (int k = 0; k < SKIP_PATTERNS; ++k) {
        free(stage->patterns[k].mask);
        free(stage->patterns[k].indices);
    }
    destroy_cloud(&stage->solid);
    destroy_cloud(&stage->plane);
    numbers_destroy(&stage->volumes);
    numbers_destroy(&stage->volume);
    numbers_destroy(&stage->corrections);
    sphg_context_destroy(stage->context);
}
