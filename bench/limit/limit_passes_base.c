/* SPDX-License-Identifier: MIT */
/* limit_passes.inl.h for any machine. */
#define VECTOR_BYTES   16
#define LIMIT_SET      limit_set_base
#define LIMIT_SET_NAME "baseline, 4 lanes"
#include "limit_passes.inl.h"
