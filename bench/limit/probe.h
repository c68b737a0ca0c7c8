/* SPDX-License-Identifier: MIT */
/* A fixed yardstick for machines: KGC matrices and the gradient of a vector field over int32 CSR
 * lists of sorted 16-byte rows, with code that never changes with the library. */
#ifndef SPHGRAD_BENCH_PROBE_H
#define SPHGRAD_BENCH_PROBE_H
#include "library.h"
#include "probe_passes.h"

enum probe_work { PROBE_MATRICES, PROBE_GRADIENT, PROBE_WORKS };

struct probe;

/* A cube of side^3 particles, jittered. The lists are found with the library, untimed. Held. */
struct probe *probe_create(sphg_context *context, int32_t side, double support, double jitter);

int32_t probe_count(const struct probe *probe);
struct probe_arrays probe_arrays(const struct probe *probe);
double probe_pairs(const struct probe *probe); /* a particle */
void probe_run(struct probe *probe, enum probe_work work, int32_t threads);

/* After the matrices were run: largest |C_i - C|_F / |C|_F, C of the library, over particles that
 * it corrects fully. Exactness on linear fields alone would forgive wrong pairs. */
double probe_matrix_deviation(const struct probe *probe, sphg_context *context);

/* max |J_i - J|_F / |J|_F on v = (-y, x, 2z), after both works were run. */
double probe_error(const struct probe *probe);
#endif
