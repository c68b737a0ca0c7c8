/* SPDX-License-Identifier: MIT */
/* probe_passes.inl.h for any machine. */
#define VECTOR_BYTES 16
#define PROBE_PASSES probe_passes_base
#include "probe_passes.inl.h"
