/* SPDX-License-Identifier: MIT */
/* All passes for float, x86-64-v4 (AVX-512 F, BW, DQ, VL). */
#define REAL_IS_F64 0
#define SUFFIX      f32_v4
#define FUSES       1
#include "passes.inl.h"
