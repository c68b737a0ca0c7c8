/* SPDX-License-Identifier: MIT */
/* limit_passes.inl.h for AVX-512 in vectors of AVX2's length: twice the registers. */
#define VECTOR_BYTES   32
#define LIMIT_SET      limit_set_v4_narrow
#define LIMIT_SET_NAME "x86-64-v4, 8 lanes"
#include "limit_passes.inl.h"
