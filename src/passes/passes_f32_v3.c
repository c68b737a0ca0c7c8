/* SPDX-License-Identifier: MIT */
/* All passes for float, x86-64-v3 (AVX2, FMA). */
#define REAL_IS_F64 0
#define SUFFIX      f32_v3
#define FUSES       1
#include "passes.inl.h"
