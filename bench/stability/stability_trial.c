/* SPDX-License-Identifier: MIT */
#include "stability_trial.h"
#include "lattice.h"
#include "library.h"
#include "particles/linear_field.h"
#include <math.h>

static void fill(struct trial *trial, const struct stability_cloud *cloud, int exponent)
{
    for (int32_t i = 0; i < trial->count; ++i) {
        const double *x = cloud->x[i];
        const double carried[3] = {-x[1], x[0], 2 * x[2]};
        numbers_set(&trial->volumes, i, 0, ldexp(cloud->volume[i], 3 * exponent));
        if (cloud->radius)
            numbers_set(&trial->radii, i, 0, ldexp(cloud->radius[i], exponent));
        for (int axis = 0; axis < 3; ++axis) {
            const double place = cloud->x[i][axis] + cloud->shift[axis];
            numbers_set(&trial->positions, i, axis, ldexp(place, exponent));
            numbers_set(&trial->fields[TRIAL_LINEAR], i, axis, ldexp(carried[axis], exponent));
            numbers_set(&trial->fields[TRIAL_RANDOM], i, axis,
                        2 * lattice_random(cloud->random + 3 * (int64_t)i + axis) - 1);
        }
    }
}

struct trial trial_create(sphg_context *context, const struct stability_case *one,
                          const struct stability_cloud *cloud, int exponent)
{
    struct trial trial = {.context = context,
                          .corrected = stability_is_corrected(one),
                          .count = cloud->count,
                          .target_count = cloud->target_count,
                          .scheme = {.method = one->method,
                                     .kernel = one->kernel,
                                     .policy = one->policy,
                                     .dimension = 3,
                                     .support_radius = ldexp(cloud->support, exponent),
                                     .threshold = stability_threshold(one),
                                     .order = stability_order(one)}};
    const sphg_type type = field_type(one->precision);
    const int32_t width = sphg_correction_width(&trial.scheme), targets = trial.target_count;
    trial.positions = numbers_create(position_type(one->precision), trial.count, 3);
    trial.volumes = numbers_create(type, trial.count, 1);
    if (cloud->radius)
        trial.radii = numbers_create(trial.positions.type, trial.count, 1);
    trial.corrections = numbers_create(type, targets, width);
    trial.lambda_min = numbers_create(type, targets, 1);
    trial.ranks = allocate_held((size_t)targets, 1);
    for (int field = 0; field < TRIAL_FIELDS; ++field) {
        trial.fields[field] = numbers_create(type, trial.count, 3);
        trial.jacobians[field] = numbers_create(type, targets, 9);
    }
    fill(&trial, cloud, exponent);
    trial.neighbors = library_neighbors(context);
    return trial;
}

/* ---- The library's part ------------------------------------------------------------------- */

static void search(struct trial *trial)
{
    sphg_geometry geometry = sphg_all(numbers_view(&trial->positions), trial->count);
    geometry.target_count = trial->target_count;
    geometry.precision = trial->volumes.type;
    if (trial->radii.data)
        geometry.source_support = numbers_view(&trial->radii);
    library_check(trial->context, sphg_neighbors_search(trial->context, trial->neighbors,
                                                        &trial->scheme, &geometry));
}

static void evaluate(struct trial *trial)
{
    const sphg_sources sources = {.neighbors = trial->neighbors,
                                  .volume = numbers_view(&trial->volumes)};
    sphg_view at_sources[TRIAL_FIELDS];
    sphg_field fields[TRIAL_FIELDS];
    for (int field = 0; field < TRIAL_FIELDS; ++field) {
        at_sources[field] = numbers_view(&trial->fields[field]);
        fields[field] = (sphg_field){.shape = SPHG_VECTOR,
                                     .at_sources = &at_sources[field],
                                     .gradient = numbers_view(&trial->jacobians[field])};
    }
    sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = fields, .field_count = TRIAL_FIELDS};
    if (trial->corrected) {
        request.correction = numbers_view(&trial->corrections);
        request.lambda_min = numbers_view(&trial->lambda_min);
        request.rank = sphg_view_u8(trial->ranks, 1);
        request.stats = &trial->stats;
    }
    library_check(trial->context, sphg_evaluate(trial->context, &trial->scheme, &request));
}

/* ---- What it came to ---------------------------------------------------------------------- */

static double norm_of(const struct numbers *tensors, int32_t i)
{
    double square = 0;
    for (int32_t k = 0; k < tensors->width; ++k)
        square += numbers_get(tensors, i, k) * numbers_get(tensors, i, k);
    return sqrt(square);
}

static void tally_ranks(const struct trial *trial, struct stability_case *one)
{
    for (int32_t i = 0; i < trial->target_count; ++i)
        one->rank_sum += trial->ranks[i];
    one->full += trial->scheme.order == 2 ? trial->stats.quadratic : trial->stats.rank[3];
    one->decomposed += trial->stats.decomposed;
    one->empty += trial->stats.empty;
}

static void tally_results(const struct trial *trial, struct stability_case *one)
{
    for (int32_t i = 0; i < trial->target_count; ++i) {
        const double error = linear_field_error(&trial->jacobians[TRIAL_LINEAR], i);
        one->linear_sum += error;
        if (!trial->corrected || trial->ranks[i] >= 3)
            one->linear_full = fmax(one->linear_full, error);
        one->noise = fmax(one->noise, norm_of(&trial->jacobians[TRIAL_RANDOM], i) *
                                          (trial->radii.data ? numbers_get(&trial->radii, i, 0)
                                                             : trial->scheme.support_radius));
    }
}

static void tally(const struct trial *trial, struct stability_case *one)
{
    one->targets += trial->target_count;
    for (int field = 0; field < TRIAL_FIELDS; ++field)
        one->not_finite += linear_field_not_finite(&trial->jacobians[field]);
    one->not_finite += linear_field_not_finite(&trial->corrections);
    one->not_finite += linear_field_not_finite(&trial->lambda_min);
    if (trial->corrected)
        tally_ranks(trial, one);
    tally_results(trial, one);
}

void trial_run(struct trial *trial, struct stability_case *one)
{
    const struct moment start = now();
    search(trial);
    evaluate(trial);
    const struct moment time = since(start);
    one->time.wall += time.wall;
    one->time.cpu += time.cpu;
    tally(trial, one);
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
    return largest_change(&trial->jacobians[TRIAL_RANDOM], &other->jacobians[TRIAL_RANDOM]) *
           trial->scheme.support_radius;
}

/* C of a full neighbourhood is 1 / m_ref. */
static double reference_moment(const struct trial *trial)
{
    double mu2;
    sphg_kernel_constants(&trial->scheme, NULL, &mu2);
    const double second = mu2 * trial->scheme.support_radius * trial->scheme.support_radius;
    if (trial->scheme.method == SPHG_KGC)
        return 1;
    return trial->scheme.method == SPHG_RKPM ? second : second / numbers_get(&trial->volumes, 0, 0);
}

double trial_correction_jump(const struct trial *trial, const struct trial *other)
{
    if (trial->corrections.width != 6)
        return 0;
    return largest_change(&trial->corrections, &other->corrections) * reference_moment(trial);
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
        count +=
            !(is_scaled(&trial->jacobians[TRIAL_RANDOM], &base->jacobians[TRIAL_RANDOM], i,
                        exponent) &&
              is_scaled(&trial->jacobians[TRIAL_LINEAR], &base->jacobians[TRIAL_LINEAR], i, 0) &&
              is_scaled(&trial->lambda_min, &base->lambda_min, i, 0) &&
              trial->ranks[i] == base->ranks[i]);
    return count;
}
