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

/* Places of a sweep; those of a walk are the ends of its legs. */
struct places {
    int count;
    double at[PLACES_MOST];
};

static struct places powers(double first, double factor, int count)
{
    struct places places = {.count = count};
    for (int k = 0; k < count; ++k)
        places.at[k] = first * pow(10, k * log10(factor));
    return places;
}

static struct places equal_steps(double first, double step, int count)
{
    struct places places = {.count = count};
    for (int k = 0; k < count; ++k)
        places.at[k] = first + step * k;
    return places;
}

static struct places thresholds(void)
{
    struct places places = powers(1e-6, sqrt(10), 11);
    places.at[places.count++] = 0.3;
    return places;
}

static struct places offsets(void)
{
    struct places places = powers(0.1, 10, 10);
    places.at[0] = 0;
    return places;
}

static struct places neighbour_counts(void)
{
    return (struct places){24, {0,  1,  2,  3,  4,  5,  6,   8,   10,  12,  15,  20,
                                25, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250, 300}};
}

/* From the smallest normal V = 2^(3 k) to the smallest normal 1 / H^3. */
static struct places scales(double support, enum precision precision)
{
    const int range = (precision == PRECISION_F64 ? -DBL_MIN_EXP : -FLT_MIN_EXP) + 1;
    const double least = -floor(range / 3.0), most = floor(range / 3.0 - log2(support));
    struct places places = equal_steps(least, (most - least) / 16, 17);
    for (int k = 0; k < places.count; ++k)
        places.at[k] = round(places.at[k]);
    return places;
}

static struct places places_of(const struct settings *settings, const struct stability_case *one)
{
    switch (one->sweep) {
    case SWEEP_SLAB:
    case SWEEP_THINNING:
        return powers(1, sqrt(10), 25);
    case SWEEP_THRESHOLD:
        return thresholds();
    case SWEEP_CURVATURE:
        return powers(1e-7, sqrt(10), 11);
    case SWEEP_GRADING:
        return powers(1, 4, 7);
    case SWEEP_OFFSET:
        return offsets();
    case SWEEP_SCALE:
        return scales(settings->support, one->precision);
    case SWEEP_NEIGHBOURS:
        return neighbour_counts();
    case SWEEP_VOLUMES:
        return powers(1, 10, 13);
    case SWEEP_JITTER:
        return equal_steps(0, 0.1, 11);
    case SWEEP_CROWDS:
        return (struct places){8, {1, 3, 10, 30, 100, 300, 1000, 4000}};
    default:
        return equal_steps(1.1, -0.05, 23);
    }
}

/* First, last, and a few between. */
static struct places thinned(const struct places *all, int keep)
{
    struct places places = {.count = keep};
    for (int k = 0; k < keep; ++k)
        places.at[k] = all->at[k * (all->count - 1) / (keep - 1)];
    return places;
}

static bool is_walk(enum stability_sweep sweep)
{
    return sweep == SWEEP_SCALE || sweep == SWEEP_MERGING;
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
    const int last = is_walk(one->sweep) ? places.count - 1 : places.count;
    for (int k = 0; k < last; ++k) {
        one->at = one->end = places.at[k];
        if (is_walk(one->sweep))
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
