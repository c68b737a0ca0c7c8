/* All passes for float, the compiler's baseline instruction set. */
#define REAL_IS_F64 0
#define SUFFIX      f32_base
#include "passes.inl.h"
