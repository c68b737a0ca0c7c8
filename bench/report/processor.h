/* SPDX-License-Identifier: MIT */
/* Which of the benchmark's own loops this processor can run. */
#ifndef SPHGRAD_BENCH_PROCESSOR_H
#define SPHGRAD_BENCH_PROCESSOR_H
#include <stdbool.h>

bool processor_has_v3(void); /* x86-64-v3, as far as compilers make use of it: AVX2, FMA, BMI */
bool processor_has_v4(void); /* x86-64-v4: AVX-512 F, BW, CD, DQ, VL */
#endif
