/* SPDX-License-Identifier: MIT */
/* probe_passes.inl.h for any machine. */
#define VECTOR_BYTES        16
#define PROBE_MATRICES_PASS probe_matrices_base
#define PROBE_GRADIENT_PASS probe_gradient_base
#include "probe_passes.inl.h"
