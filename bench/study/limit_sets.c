/* SPDX-License-Identifier: MIT */
/* Which sets of passes there are, and which of them this processor can run. */
#include "limit_passes.h"
#include "report/processor.h"

struct limit_arrangement limit_arrangement(int index)
{
    return (struct limit_arrangement){index & 1, index & 2, index & 4};
}

int limit_sets(const struct limit_set *sets[], int room)
{
    const struct limit_set *const known[] = {&limit_set_base,
#ifdef BENCH_HAVE_X86
                                             &limit_set_v3, &limit_set_v4_narrow, &limit_set_v4
#endif
    };
    const int runs = processor_has_v4() ? 4 : processor_has_v3() ? 2 : 1;
    int count = 0;
    while (count < runs && count < room) {
        sets[count] = known[count];
        ++count;
    }
    return count;
}
