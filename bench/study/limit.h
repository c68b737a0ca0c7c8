/* SPDX-License-Identifier: MIT */
/* How near the library comes to the arithmetic limit: what is measured and reported. */
#ifndef SPHGRAD_BENCH_LIMIT_H
#define SPHGRAD_BENCH_LIMIT_H
#include "limit_pack.h"
#include "particles/particles.h"
#include "probe.h"
#include "settings.h"
#include "report/timing.h"

enum { LIMIT_SETS_MOST = 4 };

/* Of one set and one kind of work. */
struct limit_times {
    struct samples arrangements[2][LIMIT_ARRANGEMENTS]; /* [finished] */
    double deviation;                                   /* worst of the finished results */
};

struct limit {
    struct settings settings;
    int32_t count;
    sphg_neighbors_info neighbors;
    int set_count;
    const struct limit_set *sets[LIMIT_SETS_MOST];
    double packed_pairs[LIMIT_SETS_MOST], kilobytes[LIMIT_SETS_MOST];
    int32_t slots[LIMIT_SETS_MOST];
    struct limit_times times[LIMIT_SETS_MOST][LIMIT_WORKS];
    struct samples library[LIMIT_WORKS];
    struct samples probe[PROBE_WORKS];
    double probe_error, probe_deviation, probe_pairs;
    bool probe_only;
};

void limit_measure(struct limit *limit);
#endif
