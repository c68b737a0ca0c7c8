/* SPDX-License-Identifier: MIT */
/* Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933: what is measured and reported. */
#ifndef SPHGRAD_BENCH_TABLE1_H
#define SPHGRAD_BENCH_TABLE1_H
#include "particles/particles.h"
#include "report/timing.h"
#include "study/probe.h"

enum { TABLE1_METHODS = 6 };

/* Untimed: the field v = (-y, x, 2z), in 2D (-y, x), max |J_i - J|_F / |J|_F over particles of full
 * rank (plain SPH, which has no rank: over all); NaN if there are none. */
struct table1_method {
    sphg_method method;
    double paper_matrix, paper_gradient; /* [ms], 32 cores of a Threadripper PRO 5975WX */
    double gradient_error, fused_error, kept_error;
    int64_t not_finite; /* numbers in any Jacobian, of v and of the timed field */
    sphg_stats stats;
};

/* Timed: the search; each method's works but the search, without and with weights that a sweep
 * before kept (linearised methods only); the probe. */
enum {
    TABLE1_SEARCH,
    TABLE1_FIRST,
    TABLE1_PROBE = TABLE1_FIRST + 2 * TABLE1_METHODS * WORKS,
    TABLE1_ITEMS = TABLE1_PROBE + PROBE_WORKS
};

struct table1 {
    struct settings settings; /* support: in spacings; with an input file in its units */
    struct particle_source source;
    struct particles particles;
    double support_radius;
    sphg_neighbors_info neighbors;
    double volume_ratio; /* median of the file's volumes over 1 / sum W */
    double first_search; /* [ms], with all allocations */
    int32_t probe_count; /* particles that the probe's cube holds */
    struct table1_method methods[TABLE1_METHODS];
    struct samples times[TABLE1_ITEMS];
};

/* Which of the times. */
static inline int table1_item(int kept, int method, enum work work)
{
    return TABLE1_FIRST + (kept * TABLE1_METHODS + method) * WORKS + (int)work;
}

/* Whether a method forms weights that neighbours can keep. */
bool table1_keeps_weights(const struct table1_method *one);

/* Opens the library, warms up, measures. */
void table1_measure(struct table1 *table);

void table1_report(const struct table1 *table);
#endif
