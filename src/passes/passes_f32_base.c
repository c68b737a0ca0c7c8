/* SPDX-License-Identifier: MIT */
/* All passes for float, the compiler's baseline instruction set: SSE2, or NEON on AArch64. */
#define REAL_IS_F64 0
#define SUFFIX      f32_base
#include "passes.inl.h"
