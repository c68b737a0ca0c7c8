/* SPDX-License-Identifier: MIT */
/* The walk through the cases of stability. Each case is measured by one thread, so that figures
 * do not depend on their number. */
#include "stability_trial.h"
#include <math.h>

enum { HALVINGS = 8 };

/* What the work on a case needs. */
struct bench {
    const struct stability *stability;
    struct stability_case *one;
    sphg_context *context;
    int32_t round;
};

static struct trial run_at(const struct bench *bench, double at, int exponent)
{
    struct stability_cloud cloud =
        stability_cloud_create(bench->stability, bench->one->sweep, at, bench->round);
    return trial_run(bench->context, bench->one, &cloud, exponent);
}

static void measure_scales(const struct bench *bench)
{
    struct stability_case *one = bench->one;
    struct trial base = run_at(bench, 0, 0);
    for (int32_t k = 0; k <= one->steps; ++k) {
        const int exponent = (int)lround(one->at + (one->end - one->at) * k / one->steps);
        struct trial trial = run_at(bench, 0, exponent);
        one->other_bits += trial_other_bits(&trial, &base, exponent);
        if (k == 0 || k == one->steps)
            reference_compare(&trial, bench->stability->compared, bench->one);
    }
}

/* Halves the step from `near` to `far` again and again and stays with the half that jumps more:
 * what is left of a jump that is none is as small as the step. */
static void bisect(const struct bench *bench, double near, double far)
{
    struct stability_case *one = bench->one;
    struct trial here = run_at(bench, near, 0), there = run_at(bench, far, 0);
    for (int k = 0; k < HALVINGS; ++k) {
        const double middle = (near + far) / 2;
        struct trial between = run_at(bench, middle, 0);
        const bool first = trial_jump(&here, &between) > trial_jump(&between, &there);
        *(first ? &there : &here) = between;
        *(first ? &far : &near) = middle;
    }
    one->jump_left = fmax(one->jump_left, trial_jump(&here, &there));
    one->correction_jump_left =
        fmax(one->correction_jump_left, trial_correction_jump(&here, &there));
}

static void measure_merging(const struct bench *bench)
{
    struct stability_case *one = bench->one;
    const double step = (one->end - one->at) / one->steps;
    struct trial trial = run_at(bench, one->at, 0);
    double largest = 0;
    int32_t largest_at = 1;
    reference_compare(&trial, bench->stability->compared, bench->one);
    for (int32_t k = 1; k <= one->steps; ++k) {
        struct trial next = run_at(bench, one->at + k * step, 0);
        const double jump = trial_jump(&trial, &next);
        if (jump > largest)
            largest = jump, largest_at = k;
        one->correction_jump = fmax(one->correction_jump, trial_correction_jump(&trial, &next));
        trial = next;
    }
    one->jump = fmax(one->jump, largest);
    bisect(bench, one->at + (largest_at - 1) * step, one->at + largest_at * step);
}

static void measure_case(const struct bench *bench)
{
    if (bench->one->sweep == SWEEP_SCALE) {
        measure_scales(bench);
    } else if (bench->one->sweep == SWEEP_MERGING) {
        measure_merging(bench);
    } else {
        const struct trial trial = run_at(bench, bench->one->at, 0);
        reference_compare(&trial, bench->stability->compared, bench->one);
    }
}

/* Whoever is free takes the next case. */
void stability_measure(struct stability *stability)
{
#pragma omp parallel for num_threads(stability->settings.threads) schedule(dynamic, 1)
    for (int index = 0; index < stability->case_count; ++index) {
        struct held *all = held_so_far();
        struct stability_case *one = &stability->cases[index];
        struct bench bench = {.stability = stability, .one = one, .context = library_open(1)};
#pragma omp critical
        progress_show("%s %s at %g: %d of %d", sweep_names[one->sweep],
                      method_names[one->scheme.method], one->at, index + 1, stability->case_count);
        for (bench.round = 0; bench.round < stability->settings.repetitions; ++bench.round) {
            struct held *of_round = held_so_far();
            measure_case(&bench);
            release_held(of_round);
        }
        release_held(all);
    }
    progress_clear();
}
