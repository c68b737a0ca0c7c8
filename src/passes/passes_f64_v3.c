/* SPDX-License-Identifier: MIT */
/* All passes for double, x86-64-v3 (AVX2, FMA). */
#define REAL_IS_F64 1
#define SUFFIX      f64_v3
#define FUSES       1
#include "passes.inl.h"
