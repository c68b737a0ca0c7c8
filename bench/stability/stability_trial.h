/* SPDX-License-Identifier: MIT */
/* The library's answer for one cloud, and what it is held against. */
#ifndef SPHGRAD_BENCH_STABILITY_TRIAL_H
#define SPHGRAD_BENCH_STABILITY_TRIAL_H
#include "scene.h"
#include "stability_cloud.h"

struct trial {
    struct scene scene; /* its field: each component anywhere in [-1, 1] */
    struct numbers
        linear; /* (-y, x, 2z) of the unrounded positions, as a host's particles carry it */
    struct numbers radii;                        /* where they differ */
    struct numbers linear_jacobians, lambda_min; /* results, beside those of the scene */
    uint8_t *ranks;
    sphg_stats stats;
    int32_t target_count;
};

/* Lengths times 2^exponent. Held. Search and evaluation are timed into the case, their results
 * counted there. */
struct trial trial_run(sphg_context *context, struct stability_case *one,
                       const struct stability_cloud *cloud, int exponent);

/* Largest |J_i - J_i'|_F H of the random field, and |C_i - C_i'|_F m_ref. */
double trial_jump(const struct trial *trial, const struct trial *other);
double trial_correction_jump(const struct trial *trial, const struct trial *other);

/* Targets whose results are not those of `base` times the power of two that lengths demand. */
int64_t trial_other_bits(const struct trial *trial, const struct trial *base, int exponent);

/* So many of the targets beside the reference in quadruple precision: one half spread evenly, the
 * other those with the smallest moments. */
void reference_compare(const struct trial *trial, int32_t wanted, struct stability_case *one);
#endif
