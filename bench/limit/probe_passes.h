/* SPDX-License-Identifier: MIT */
/* The loops of the probe, compiled for the baseline and for AVX2. */
#ifndef SPHGRAD_BENCH_PROBE_PASSES_H
#define SPHGRAD_BENCH_PROBE_PASSES_H
#include <stdint.h>

enum { PROBE_LANES_MOST = 8 };

/* Rows of 16 bytes, sorted by cells: x y z and 6 sigma V / H^3; the field's a b c 0. Positions in
 * units of H. Results: C, 6 numbers a target, and J, 9, the targets of a vector interleaved. */
struct probe_arrays {
    const float (*positions)[4];
    const float (*fields)[4];
    const int64_t *offsets;
    const int32_t *indices; /* readable for one vector beyond the last */
    float *corrections, *jacobians;
};

/* begin is a multiple of PROBE_LANES_MOST; arrays have room for whole vectors of targets. */
typedef void probe_pass(const struct probe_arrays *arrays, int32_t begin, int32_t end,
                        int32_t count);

probe_pass probe_matrices_base, probe_gradient_base, probe_matrices_v3, probe_gradient_v3;
#endif
