/* SPDX-License-Identifier: MIT */
/* The cases of stability: in each sweep one thing changes. */
#include "numbers.h"
#include "stability.h"
#include <float.h>
#include <math.h>

enum { CASES_MOST = 8192, PLACES_MOST = 32 };

const char *const sweep_names[] = {"slab",      "threshold", "offset",  "scale",  "neighbours",
                                   "volumes",   "jitter",    "merging", "crowds", "grading",
                                   "curvature", "thinning",  NULL};
const char *const policy_names[STABILITY_POLICIES] = {
    [SPHG_BLEND] = "blend",
    [SPHG_REPLACE] = "replace",
    [SPHG_TRUNCATE] = "truncate",
    [SPHG_IDENTITY] = "identity",
};

/* Places of a sweep: listed, or `count` of them, each 10^exponent times the one before or `step`
 * beside it. A walk goes from one to the next. */
struct places {
    double first, exponent, step;
    bool is_walk;
    int count;
    double at[PLACES_MOST];
};

static const struct places sweeps[] = {
    [SWEEP_SLAB] = {.first = 1, .exponent = 0.5, .count = 25},
    [SWEEP_THINNING] = {.first = 1, .exponent = 0.5, .count = 25},
    [SWEEP_THRESHOLD] = {.count = 12,
                         .at = {1e-6, 3.1622776601683795e-6, 1e-5, 3.1622776601683795e-5, 1e-4,
                                3.1622776601683795e-4, 1e-3, 3.1622776601683795e-3, 1e-2,
                                3.1622776601683795e-2, 1e-1, 0.3}},
    [SWEEP_CURVATURE] = {.first = 1e-7, .exponent = 0.5, .count = 11},
    [SWEEP_GRADING] = {.count = 7, .at = {1, 4, 16, 64, 256, 1024, 4096}},
    [SWEEP_OFFSET] = {.count = 10, .at = {0, 1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}},
    [SWEEP_SCALE] = {.is_walk = true, .count = 17},
    [SWEEP_NEIGHBOURS] = {.count = 24,
                          .at = {0,  1,  2,  3,  4,  5,  6,   8,   10,  12,  15,  20,
                                 25, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250, 300}},
    [SWEEP_VOLUMES] = {.first = 1, .exponent = 1, .count = 13},
    [SWEEP_JITTER] = {.step = 0.1, .count = 11},
    [SWEEP_CROWDS] = {.count = 8, .at = {1, 3, 10, 30, 100, 300, 1000, 4000}},
    [SWEEP_MERGING] = {.first = 1.1, .step = -0.05, .is_walk = true, .count = 23}};

/* From the smallest normal V = 2^(3 k) to the smallest normal 1 / H^3. */
static double scale_at(int k, double support, enum precision precision)
{
    const int range = (precision == PRECISION_F64 ? -DBL_MIN_EXP : -FLT_MIN_EXP) + 1;
    const double least = -floor(range / 3.0), most = floor(range / 3.0 - log2(support));
    return round(least + (most - least) / 16 * k);
}

static struct places places_of(const struct settings *settings, const struct stability_case *one)
{
    struct places places = sweeps[one->sweep];
    for (int k = 0; k < places.count; ++k)
        if (one->sweep == SWEEP_SCALE)
            places.at[k] = scale_at(k, settings->support, one->precision);
        else if (places.exponent > 0)
            places.at[k] = places.first * pow(10, k * places.exponent);
        else if (places.step != 0)
            places.at[k] = places.first + places.step * k;
    return places;
}

/* First, last, and a few between. */
static struct places thinned(const struct places *all, int keep)
{
    struct places places = {.is_walk = all->is_walk, .count = keep};
    for (int k = 0; k < keep; ++k)
        places.at[k] = all->at[k * (all->count - 1) / (keep - 1)];
    return places;
}

static void add_case(struct stability *stability, const struct stability_case *described)
{
    struct stability_case *one = &stability->cases[stability->case_count++];
    *one = *described;
    one->steps = 0;
    if (one->sweep == SWEEP_SCALE)
        one->steps = (int32_t)fmax(1, ceil((one->end - one->at) / (stability->quick ? 8 : 1)));
    if (one->sweep == SWEEP_MERGING)
        one->steps = (int32_t)lround((one->at - one->end) * (stability->quick ? 40 : 1000));
}

static void add_places(struct stability *stability, struct stability_case *one)
{
    struct places places = places_of(&stability->settings, one);
    if (stability->quick)
        places = thinned(&places, 4);
    const int last = places.is_walk ? places.count - 1 : places.count;
    for (int k = 0; k < last; ++k) {
        one->at = one->end = places.at[k];
        if (places.is_walk)
            one->end = places.at[k + 1];
        add_case(stability, one);
    }
}

/* Without a correction there is no threshold, and nothing that could jump. */
static bool makes_sense(const struct stability_case *one)
{
    const bool by_policy = one->sweep == SWEEP_THRESHOLD || one->sweep == SWEEP_MERGING;
    if (by_policy)
        return one->method != SPHG_PLAIN;
    if (stability_order(one) == 2 && one->method > SPHG_RKPM)
        return false;
    return one->policy == SPHG_BLEND;
}

void stability_create_cases(struct stability *stability)
{
    stability->cases = allocate_to_the_end(CASES_MOST, sizeof *stability->cases);
    for (int sweep = stability->first; sweep <= stability->last; ++sweep)
        for (int policy = 0; policy < STABILITY_POLICIES; ++policy)
            for (int method = 0; method < STABILITY_METHODS; ++method)
                for (int precision = 0; precision < STABILITY_PRECISIONS; ++precision) {
                    struct stability_case one = {.sweep = (enum stability_sweep)sweep,
                                                 .kernel = stability->settings.kernel,
                                                 .policy = (sphg_policy)policy,
                                                 .method = (sphg_method)method,
                                                 .precision = (enum precision)precision};
                    if (makes_sense(&one))
                        add_places(stability, &one);
                }
}

bool stability_is_corrected(const struct stability_case *one)
{
    return one->method != SPHG_PLAIN;
}

double stability_threshold(const struct stability_case *one)
{
    return one->sweep == SWEEP_THRESHOLD   ? one->at
           : one->sweep == SWEEP_CURVATURE ? 10 * one->at
                                           : 1e-2;
}

int32_t stability_order(const struct stability_case *one)
{
    return one->sweep == SWEEP_CURVATURE || one->sweep == SWEEP_THINNING ? 2 : 1;
}

double stability_rank(const struct stability_case *one)
{
    return (double)one->rank_sum / (double)one->targets;
}

double stability_fallback(const struct stability_case *one)
{
    return (double)(one->decomposed - one->empty) / (double)one->targets;
}

double stability_linear(const struct stability_case *one)
{
    return one->linear_sum / (double)one->targets;
}

double stability_ratio(const struct stability_case *one)
{
    return one->ratio_full > one->ratio_touched ? one->ratio_full : one->ratio_touched;
}
