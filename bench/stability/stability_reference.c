/* SPDX-License-Identifier: MIT */
#include "stability_trial.h"
#include "support/oracle_quadratic.h"
#include <math.h>

void *oracle_memory(size_t bytes)
{
    return allocate_held(bytes, 1);
}

/* ---- The same inputs ------------------------------------------------------------------------- */

static double *doubles_of(const struct numbers *numbers)
{
    double *doubles =
        oracle_memory((size_t)numbers->count * (size_t)numbers->width * sizeof *doubles);
    for (int32_t i = 0; i < numbers->count; ++i)
        for (int32_t k = 0; k < numbers->width; ++k)
            doubles[i * numbers->width + k] = numbers_get(numbers, i, k);
    return doubles;
}

static oracle_scene scene_of(const struct trial *trial)
{
    const struct scene *scene = &trial->scene;
    return (oracle_scene){.scheme = scene->scheme,
                          .unit = scene->volumes.type == SPHG_F64 ? 0x1p-53 : 0x1p-24,
                          .single_positions = scene->positions.type == SPHG_F32,
                          .source_count = scene->count,
                          .target_count = trial->target_count,
                          .sources = doubles_of(&scene->positions),
                          .volume = doubles_of(&scene->volumes),
                          .support = trial->radii.count ? doubles_of(&trial->radii) : NULL};
}

/* ---- Which targets --------------------------------------------------------------------------- */

static int32_t find_smallest(const struct trial *trial, const uint8_t *taken)
{
    int32_t smallest = -1;
    for (int32_t i = 0; i < trial->target_count; ++i)
        if (!taken[i] && (smallest < 0 || numbers_get(&trial->lambda_min, i, 0) <
                                              numbers_get(&trial->lambda_min, smallest, 0)))
            smallest = i;
    return smallest;
}

/* 1 for each that is taken. */
static uint8_t *choose_targets(const struct trial *trial, int32_t wanted)
{
    const int32_t count = trial->target_count, most = wanted < count ? wanted : count;
    uint8_t *taken = allocate_held((size_t)count, 1);
    const int32_t even = trial->scene.scheme.method != SPHG_PLAIN ? (most + 1) / 2 : most;
    for (int32_t k = 0; k < even; ++k)
        taken[(int64_t)k * count / even] = 1;
    for (int32_t k = even; k < most; ++k)
        taken[find_smallest(trial, taken)] = 1;
    return taken;
}

/* ---- Comparison ------------------------------------------------------------------------------ */

/* Where rounding decides which way a threshold goes, nothing is compared. */
static void note_ratio(const struct trial *trial, const quad *exact, quad bound, bool touched,
                       bool undecided, int32_t i, struct stability_case *one)
{
    double found[9];
    one->undecided += undecided;
    if (undecided)
        return;
    for (int k = 0; k < 9; ++k)
        found[k] = numbers_get(&trial->scene.jacobians, i, k);
    const double ratio = oracle_ratio(9, found, exact, bound);
    double *worst = touched ? &one->ratio_touched : &one->ratio_full;
    *worst = numbers_larger(*worst, ratio);
}

static void note_condition(const oracle_point *point, struct stability_case *one)
{
    quad least = point->filter.lambda[0], most = least;
    for (int k = 1; k < 3; ++k) {
        least = point->filter.lambda[k] < least ? point->filter.lambda[k] : least;
        most = quad_max(most, point->filter.lambda[k]);
    }
    const double condition = least > 0 ? (double)(most / least) : 0;
    if (isfinite(condition))
        one->condition = fmax(one->condition, condition);
}

static void compare_target(const struct trial *trial, const oracle_scene *scene, oracle *reference,
                           const oracle_field *field, int32_t i, struct stability_case *one)
{
    const oracle_point *point = oracle_at(reference, i);
    const int rank = trial->ranks[i];
    ++one->compared;
    if (scene->scheme.order == 2) {
        const oracle_curved exact = oracle_apply_second(reference, field, i);
        const oracle_second *second = oracle_second_at(reference, i);
        note_ratio(trial, exact.gradient, exact.gradient_bound, exact.touched, exact.undecided, i,
                   one);
        one->wrong_ranks +=
            rank != second->rank && !oracle_second_rank_is_open(scene, point, second);
    } else {
        const oracle_result exact = oracle_apply(reference, field, i);
        note_ratio(trial, exact.gradient, exact.bound, exact.touched, exact.undecided, i, one);
        one->wrong_ranks += scene->scheme.method != SPHG_PLAIN && rank != point->rank &&
                            !oracle_rank_is_open(scene, point);
    }
    if (scene->scheme.method != SPHG_PLAIN)
        note_condition(point, one);
}

void reference_compare(const struct trial *trial, int32_t wanted, struct stability_case *one)
{
    struct held *mark = held_so_far();
    const oracle_scene scene = scene_of(trial);
    oracle *reference = oracle_of(&scene);
    const oracle_field field = {.shape = SPHG_VECTOR,
                                .form = SPHG_DIFFERENCE,
                                .at_sources = doubles_of(&trial->scene.field)};
    uint8_t *taken = choose_targets(trial, wanted);
    for (int32_t i = 0; i < trial->target_count; ++i)
        if (taken[i])
            compare_target(trial, &scene, reference, &field, i, one);
    release_held(mark);
}
