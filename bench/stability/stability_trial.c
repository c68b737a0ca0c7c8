/* SPDX-License-Identifier: MIT */
#include "stability_trial.h"
#include "lattice.h"
#include "particles/errors.h"
#include <math.h>

static struct trial create(sphg_context *context, const struct stability_case *one,
                           const struct stability_cloud *cloud, int exponent)
{
    const sphg_type type = field_type(one->precision);
    const int32_t count = cloud->count;
    struct numbers positions = numbers_create(position_type(one->precision), count, 3),
                   volumes = numbers_create(type, count, 1);
    sphg_scheme scheme = one->scheme;
    scheme.support_radius = ldexp(cloud->support, exponent);
    struct trial trial = {.scene = scene_open(context, &scheme, positions, volumes),
                          .linear = numbers_create(type, count, 3),
                          .radii = numbers_create(positions.type, cloud->radius ? count : 0, 1),
                          .linear_jacobians = numbers_create(type, count, 9),
                          .lambda_min = numbers_create(type, count, 1),
                          .ranks = allocate_held((size_t)count, 1),
                          .target_count = cloud->target_count};
    trial.scene.geometry.target_count = cloud->target_count;
    if (cloud->radius)
        trial.scene.geometry.source_support = numbers_view(&trial.radii);
    for (int32_t i = 0; i < count; ++i) {
        const double *x = cloud->x[i], carried[3] = {-x[1], x[0], 2 * x[2]};
        numbers_set(&volumes, i, 0, ldexp(cloud->volume[i], 3 * exponent));
        if (cloud->radius)
            numbers_set(&trial.radii, i, 0, ldexp(cloud->radius[i], exponent));
        for (int axis = 0; axis < 3; ++axis) {
            numbers_set(&positions, i, axis, ldexp(x[axis] + cloud->shift[axis], exponent));
            numbers_set(&trial.linear, i, axis, ldexp(carried[axis], exponent));
            numbers_set(&trial.scene.field, i, axis,
                        2 * lattice_random(cloud->random + 3 * (int64_t)i + axis) - 1);
        }
    }
    return trial;
}

static void evaluate(struct trial *trial)
{
    const struct scene *scene = &trial->scene;
    const sphg_sources sources = scene_sources(scene);
    const sphg_view random = numbers_view(&scene->field), linear = numbers_view(&trial->linear);
    const sphg_field fields[] = {
        {.shape = SPHG_VECTOR, .at_sources = &random, .gradient = numbers_view(&scene->jacobians)},
        {.shape = SPHG_VECTOR,
         .at_sources = &linear,
         .gradient = numbers_view(&trial->linear_jacobians)}};
    sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = fields, .field_count = 2};
    if (scene->scheme.method != SPHG_PLAIN) {
        request.correction = scene_corrections(scene);
        request.lambda_min = numbers_view(&trial->lambda_min);
        request.rank = sphg_view_u8(trial->ranks, 1);
        request.stats = &trial->stats;
    }
    scene_evaluate(scene, &request);
}

static void tally(const struct trial *trial, struct stability_case *one)
{
    const struct scene *scene = &trial->scene;
    const bool corrected = scene->scheme.method != SPHG_PLAIN;
    one->targets += trial->target_count;
    one->not_finite += count_not_finite(&scene->jacobians) + count_not_finite(&scene->corrections) +
                       count_not_finite(&trial->linear_jacobians) +
                       count_not_finite(&trial->lambda_min);
    one->full += scene->scheme.order == 2 ? trial->stats.quadratic : trial->stats.rank[3];
    one->decomposed += trial->stats.decomposed;
    one->empty += trial->stats.empty;
    for (int32_t i = 0; i < trial->target_count; ++i) {
        const double error = linear_field_error(&trial->linear_jacobians, i);
        const double radius =
            trial->radii.count ? numbers_get(&trial->radii, i, 0) : scene->scheme.support_radius;
        one->rank_sum += trial->ranks[i];
        one->linear_sum += error;
        if (!corrected || trial->ranks[i] >= 3)
            one->linear_full = fmax(one->linear_full, error);
        one->noise = fmax(one->noise, norm_of(&scene->jacobians, i, NULL) * radius);
    }
}

struct trial trial_run(sphg_context *context, struct stability_case *one,
                       const struct stability_cloud *cloud, int exponent)
{
    struct trial trial = create(context, one, cloud, exponent);
    const struct moment start = now();
    scene_run(&trial.scene, WORK_SEARCH);
    evaluate(&trial);
    const struct moment time = since(start);
    one->time.wall += time.wall;
    one->time.cpu += time.cpu;
    tally(&trial, one);
    return trial;
}

/* ---- Two trials beside each other --------------------------------------------------------- */

/* Of symmetric tensors each entry off the diagonal counts twice. */
static double largest_change(const struct numbers *a, const struct numbers *b)
{
    static const double weights[6] = {1, 2, 2, 1, 2, 1};
    double largest = 0;
    for (int32_t i = 0; i < a->count; ++i) {
        double square = 0;
        for (int32_t k = 0; k < a->width; ++k) {
            const double change = numbers_get(a, i, k) - numbers_get(b, i, k);
            square += change * change * (a->width == 6 ? weights[k] : 1);
        }
        largest = fmax(largest, sqrt(square));
    }
    return largest;
}

double trial_jump(const struct trial *trial, const struct trial *other)
{
    return largest_change(&trial->scene.jacobians, &other->scene.jacobians) *
           trial->scene.scheme.support_radius;
}

/* C of a full neighbourhood is 1 / m_ref. */
static double reference_moment(const struct scene *scene)
{
    double mu2;
    sphg_kernel_constants(&scene->scheme, NULL, &mu2);
    const double second = mu2 * scene->scheme.support_radius * scene->scheme.support_radius;
    if (scene->scheme.method == SPHG_KGC)
        return 1;
    return scene->scheme.method == SPHG_RKPM ? second : second / numbers_get(&scene->volumes, 0, 0);
}

double trial_correction_jump(const struct trial *trial, const struct trial *other)
{
    if (trial->scene.corrections.width != 6)
        return 0;
    return largest_change(&trial->scene.corrections, &other->scene.corrections) *
           reference_moment(&trial->scene);
}

static bool is_scaled(const struct numbers *a, const struct numbers *b, int32_t i, int exponent)
{
    for (int32_t k = 0; k < a->width; ++k)
        if (ldexp(numbers_get(a, i, k), exponent) != numbers_get(b, i, k))
            return false;
    return true;
}

int64_t trial_other_bits(const struct trial *trial, const struct trial *base, int exponent)
{
    int64_t count = 0;
    for (int32_t i = 0; i < trial->target_count; ++i)
        count += !(is_scaled(&trial->scene.jacobians, &base->scene.jacobians, i, exponent) &&
                   is_scaled(&trial->linear_jacobians, &base->linear_jacobians, i, 0) &&
                   is_scaled(&trial->lambda_min, &base->lambda_min, i, 0) &&
                   trial->ranks[i] == base->ranks[i]);
    return count;
}
