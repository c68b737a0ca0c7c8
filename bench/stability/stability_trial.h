/* SPDX-License-Identifier: MIT */
/* The library's answer for one cloud. */
#ifndef SPHGRAD_BENCH_STABILITY_TRIAL_H
#define SPHGRAD_BENCH_STABILITY_TRIAL_H
#include "numbers.h"
#include "stability_cloud.h"

enum trial_field {
    TRIAL_RANDOM, /* each component anywhere in [-1, 1] */
    TRIAL_LINEAR, /* (-y, x, 2z) of the unrounded positions, as a host's particles carry it */
    TRIAL_FIELDS
};

struct trial {
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    bool corrected;
    int32_t count, target_count;
    struct numbers positions, volumes, radii, fields[TRIAL_FIELDS];  /* radii: where they differ */
    struct numbers jacobians[TRIAL_FIELDS], corrections, lambda_min; /* results */
    uint8_t *ranks;
    sphg_stats stats;
};

/* Lengths times 2^exponent. Held. */
struct trial trial_create(sphg_context *context, const struct stability_case *one,
                          const struct stability_cloud *cloud, int exponent);

/* Search and evaluation, timed into the case, their results counted there. */
void trial_run(struct trial *trial, struct stability_case *one);

/* Largest |J_i - J_i'|_F H of the random field, and |C_i - C_i'|_F m_ref. */
double trial_jump(const struct trial *trial, const struct trial *other);
double trial_correction_jump(const struct trial *trial, const struct trial *other);

/* Targets whose results are not those of `base` times the power of two that lengths demand. */
int64_t trial_other_bits(const struct trial *trial, const struct trial *base, int exponent);
#endif
