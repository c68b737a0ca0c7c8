/* SPDX-License-Identifier: MIT */
#include "metrics.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void metrics_set(struct metrics *metrics, const char *name, double value)
{
    if (metrics->count == METRICS_MOST) {
        fprintf(stderr, "more than %d metrics\n", METRICS_MOST);
        exit(EXIT_FAILURE);
    }
    metrics->items[metrics->count].name = name;
    metrics->items[metrics->count++].value = value;
}

static const double *find(const struct metrics *metrics, const char *name)
{
    for (int32_t k = 0; k < metrics->count; ++k)
        if (strcmp(metrics->items[k].name, name) == 0)
            return &metrics->items[k].value;
    return NULL;
}

double metrics_get(const struct metrics *metrics, const char *name)
{
    const double *value = find(metrics, name);
    if (value)
        return *value;
    fprintf(stderr, "no metric is called %s\n", name);
    exit(EXIT_FAILURE);
}

void metrics_print(const struct options *options, enum method method, const struct metrics *metrics)
{
    printf("{\"scene\": \"%s\", \"method\": \"%s\", \"size\": \"%s\", \"seed\": %llu",
           options->scene, method_names[method], options->full ? "full" : "quick",
           (unsigned long long)options->seed);
    for (int32_t k = 0; k < metrics->count; ++k) {
        const double value = metrics->items[k].value;
        if (isfinite(value))
            printf(", \"%s\": %.6g", metrics->items[k].name, value);
        else
            printf(", \"%s\": null", metrics->items[k].name); /* JSON has no word for it */
    }
    printf("}\n");
    fflush(stdout);
}

/* NaN holds nowhere. */
static bool holds(const struct gate *gate, double value, double bound)
{
    return gate->relation == AT_MOST || gate->relation == SHARE_OF_SPH ? value <= bound
                                                                       : value >= bound;
}

static double bound_of(const struct gate *gate, const struct metrics *sph)
{
    switch (gate->relation) {
    case SHARE_OF_SPH:
    case TIMES_SPH:
        return gate->bound * metrics_get(sph, gate->name);
    case MORE_THAN_SPH:
        return gate->bound + metrics_get(sph, gate->name);
    default:
        return gate->bound;
    }
}

static bool gate_holds(const struct options *options, const struct gate *gate, enum method method,
                       const struct metrics runs[METHOD_COUNT])
{
    const double value = metrics_get(&runs[method], gate->name);
    const double bound = bound_of(gate, &runs[SPH]);
    const bool good = holds(gate, value, bound);
    const char *sign = gate->relation == AT_MOST || gate->relation == SHARE_OF_SPH ? "<=" : ">=";
    printf("gate %-15s seed %-3llu %-4s %-28s %12.4g %s %-10.4g %s\n", options->scene,
           (unsigned long long)options->seed, method_names[method], gate->name, value, sign, bound,
           good ? "ok" : "FAILED");
    return good;
}

static bool concerns(enum who who, enum method method)
{
    switch (who) {
    case ONLY_SPH:
        return method == SPH;
    case ONLY_KGC:
        return method == KGC;
    default:
        return method != SPH;
    }
}

/* A brief run has not measured everything. */
static bool is_compared(const struct options *options, const struct gate *gate, enum method method,
                        const struct metrics *run)
{
    return run->count && concerns(gate->who, method) && (!options->brief || find(run, gate->name));
}

bool gates_hold(const struct options *options, const struct gate *gates,
                const struct metrics runs[METHOD_COUNT])
{
    bool all = true, any = false;
    for (const struct gate *gate = gates; gate->name; ++gate)
        for (int m = SPH; m < METHOD_COUNT; ++m)
            if (is_compared(options, gate, (enum method)m, &runs[m])) {
                all = gate_holds(options, gate, (enum method)m, runs) && all;
                any = true;
            }
    return all && any;
}
