/* SPDX-License-Identifier: MIT */
/* probe_passes.inl.h for AVX2 and FMA. */
#define VECTOR_BYTES        32
#define PROBE_MATRICES_PASS probe_matrices_v3
#define PROBE_GRADIENT_PASS probe_gradient_v3
#include "probe_passes.inl.h"
