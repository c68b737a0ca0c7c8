/* SPDX-License-Identifier: MIT */
/* The particles at one place of a sweep. */
#ifndef SPHGRAD_BENCH_STABILITY_CLOUD_H
#define SPHGRAD_BENCH_STABILITY_CLOUD_H
#include "stability.h"

/* Spacing 1. The first target_count particles are the targets. */
struct stability_cloud {
    int32_t count, target_count;
    double support; /* H, rounded to f32 */
    double (*x)[3];
    double *volume;
    double *radius;  /* of each, rounded to f32; NULL: H */
    double shift[3]; /* of the whole cloud: linear fields are taken before it */
    int64_t random;  /* numbers drawn */
};

/* Held. round: other random numbers, the same for every method, precision and policy. */
struct stability_cloud stability_cloud_create(const struct stability *stability,
                                              enum stability_sweep sweep, double at, int32_t round);
#endif
