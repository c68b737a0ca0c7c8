/* SPDX-License-Identifier: MIT */
/* A fixed yardstick for machines: KGC matrices and the gradient of a vector field over int32 CSR
 * lists of sorted 16-byte rows, with code that never changes with the library. */
#ifndef SPHGRAD_BENCH_PROBE_H
#define SPHGRAD_BENCH_PROBE_H
#include "scene.h"

enum probe_work { PROBE_MATRICES, PROBE_GRADIENT, PROBE_WORKS };
enum { PROBE_LANES_MOST = 8 };

/* A pass over the targets [begin, end), compiled for the baseline and for AVX2. begin is a multiple
 * of PROBE_LANES_MOST; arrays have room for whole vectors of targets. */
struct probe;
typedef void probe_pass(const struct probe *probe, int32_t begin, int32_t end);
extern probe_pass *const probe_passes_base[PROBE_WORKS], *const probe_passes_v3[PROBE_WORKS];

/* Rows of 16 bytes, sorted by cells: x y z and 6 sigma V / H^3; the field's a b c 0. Positions in
 * units of H. Results: C, 6 numbers a target, and J, 9, the targets of a vector interleaved. */
struct probe {
    int32_t count, lanes;
    float (*positions)[4], (*fields)[4];
    struct library_lists lists; /* indices can be read for one vector beyond the last */
    float *corrections, *jacobians;
    probe_pass *const *passes;
    struct scene scene; /* the same for the library */
};

/* A cube of side^3 particles, jittered. The lists are found with the library, untimed. Held. */
struct probe *probe_create(sphg_context *context, int32_t side, double support, double jitter);
double probe_pairs(const struct probe *probe); /* a particle */
void probe_run(const struct probe *probe, enum probe_work work, int32_t threads);

/* After the matrices were run: largest |C_i - C|_F / |C|_F, C of the library, over particles that
 * it corrects fully. Exactness on linear fields alone would forgive wrong pairs. */
double probe_matrix_deviation(const struct probe *probe);

/* max |J_i - J|_F / |J|_F on v = (-y, x, 2z), after both works were run. */
double probe_error(const struct probe *probe);
#endif
