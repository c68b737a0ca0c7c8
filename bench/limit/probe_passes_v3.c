/* SPDX-License-Identifier: MIT */
/* probe_passes.inl.h for AVX2 and FMA. */
#define VECTOR_BYTES 32
#define PROBE_PASSES probe_passes_v3
#include "probe_passes.inl.h"
