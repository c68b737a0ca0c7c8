#include "cpu.h"

bool sphgi_cpu_has(sphg_isa isa)
{
    if (isa == SPHG_ISA_BASE)
        return true;
#ifdef SPHG_HAVE_V3
    if (isa == SPHG_ISA_X86_V3) {
        __builtin_cpu_init(); /* asks the operating system for the register state, too */
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
               __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    }
#endif
    return false;
}

sphg_isa sphgi_cpu_best(void)
{
    return sphgi_cpu_has(SPHG_ISA_X86_V3) ? SPHG_ISA_X86_V3 : SPHG_ISA_BASE;
}
