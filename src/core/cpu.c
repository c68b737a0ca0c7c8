/* SPDX-License-Identifier: MIT */
#include "cpu.h"

#if defined(SPHG_HAVE_V3) || defined(SPHG_HAVE_V4)
static bool has_v3(void)
{
    __builtin_cpu_init(); /* asks the operating system for the register state, too */
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}
#endif

#ifdef SPHG_HAVE_V4
static bool has_v4(void)
{
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#endif

bool sphgi_cpu_has(sphg_isa isa)
{
    switch (isa) {
    case SPHG_ISA_BASE:
        return true;
#ifdef SPHG_HAVE_V3
    case SPHG_ISA_X86_V3:
        return has_v3();
#endif
#ifdef SPHG_HAVE_V4
    case SPHG_ISA_X86_V4:
        return has_v4();
#endif
#ifdef __aarch64__
    case SPHG_ISA_NEON:
        return true;
#endif
    default:
        return false;
    }
}

sphg_isa sphgi_cpu_best(void)
{
    static const sphg_isa best_first[] = {SPHG_ISA_X86_V4, SPHG_ISA_X86_V3, SPHG_ISA_NEON,
                                          SPHG_ISA_BASE};
    int k = 0;
    while (!sphgi_cpu_has(best_first[k]))
        ++k;
    return best_first[k];
}
