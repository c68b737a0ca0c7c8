/* SPDX-License-Identifier: MIT */
/* Which sets of passes there are, and which of them this processor can run. */
#include "limit_passes.h"
#include "library.h"

int limit_sets(const struct limit_set *sets[LIMIT_SETS_MOST])
{
    const struct limit_set *const known[] = {&limit_set_base,
#ifdef BENCH_HAVE_X86
                                             &limit_set_v3, &limit_set_v4_narrow, &limit_set_v4
#endif
    };
    const int runs = library_runs(SPHG_ISA_X86_V4) ? 4 : library_runs(SPHG_ISA_X86_V3) ? 2 : 1;
    int count = 0;
    for (; count < runs; ++count)
        sets[count] = known[count];
    return count;
}
