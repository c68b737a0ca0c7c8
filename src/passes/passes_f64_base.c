/* SPDX-License-Identifier: MIT */
/* All passes for double, the compiler's baseline instruction set: SSE2, or NEON on AArch64. */
#define REAL_IS_F64 1
#define SUFFIX      f64_base
#include "passes.inl.h"
