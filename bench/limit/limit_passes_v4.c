/* SPDX-License-Identifier: MIT */
/* limit_passes.inl.h for AVX-512. */
#define VECTOR_BYTES   64
#define LIMIT_SET      limit_set_v4
#define LIMIT_SET_NAME "x86-64-v4, 16 lanes"
#include "limit_passes.inl.h"
