/* SPDX-License-Identifier: MIT */
/* limit_passes.inl.h for AVX2 and FMA. */
#define VECTOR_BYTES   32
#define LIMIT_SET      limit_set_v3
#define LIMIT_SET_NAME "x86-64-v3, 8 lanes"
#include "limit_passes.inl.h"
