/* SPDX-License-Identifier: MIT */
/* Trials beside the reference in quadruple precision. */
#ifndef SPHGRAD_BENCH_STABILITY_REFERENCE_H
#define SPHGRAD_BENCH_STABILITY_REFERENCE_H
#include "stability_trial.h"

/* So many of the targets: one half spread evenly, the other those with the smallest moments. */
void reference_compare(const struct trial *trial, int32_t wanted, struct stability_case *one);
#endif
