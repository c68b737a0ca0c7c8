/* SPDX-License-Identifier: MIT */
/* Time a particle over sizes, threads, neighbours, orders and clouds: what is measured. */
#ifndef SPHGRAD_BENCH_SCALING_H
#define SPHGRAD_BENCH_SCALING_H
#include "report/timing.h"
#include "scaling_cloud.h"
#include "scene.h"
#include "settings.h"

struct scaling_case {
    const char *group, *label;
    struct cloud_setting cloud;
    int32_t threads;
    struct samples time[WORKS];
    int32_t count;
    double pairs, bytes; /* a particle */
    double deficient;    /* share of particles without full rank */
    double error;        /* largest |J_i - J|_F / |J|_F of a linear field where rank is full */
    int64_t not_finite;  /* numbers of Jacobians */
};

struct scaling {
    struct settings settings;
    bool full; /* up to 30 times the particles */
    int case_count;
    struct scaling_case *cases; /* those of a group stand together */
};

void scaling_create_cases(struct scaling *scaling);
void scaling_measure(struct scaling *scaling); /* the cases of a group in turn, round by round */
#endif
