/* SPDX-License-Identifier: MIT */
/* Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933: what is measured and reported. */
#ifndef SPHGRAD_BENCH_TABLE1_H
#define SPHGRAD_BENCH_TABLE1_H
#include "particles/particles.h"
#include "report/timing.h"
#include "settings.h"
#include "study/probe.h"

enum { TABLE1_METHODS = 6 };

enum table1_work { TABLE1_MATRIX, TABLE1_GRADIENT, TABLE1_FUSED, TABLE1_WORKS };

struct table1_method {
    sphg_method method;
    double paper_matrix, paper_gradient; /* [ms], 32 cores of a Threadripper PRO 5975WX */
    /* [kept]: with weights that a sweep before kept; linearised methods only. */
    struct samples times[2][TABLE1_WORKS];
    /* Untimed: the field v = (-y, x, 2z), in 2D (-y, x), max |J_i - J|_F / |J|_F over particles of
     * full rank (plain SPH, which has no rank: over all); NaN if there are none. */
    double gradient_error, fused_error, kept_error;
    int64_t not_finite; /* numbers in any Jacobian, of v and of the timed field */
    sphg_stats stats;
};

struct table1 {
    struct settings settings; /* support: in spacings; with an input file in its units */
    struct particle_source source;
    struct particles particles;
    double support_radius;
    sphg_neighbors_info neighbors;
    double volume_ratio; /* median of the file's volumes over 1 / sum W */
    double first_search; /* [ms], with all allocations */
    struct samples search;
    struct samples probe[PROBE_WORKS]; /* for as many particles as its cube holds */
    int32_t probe_count;
    struct table1_method methods[TABLE1_METHODS];
};

/* Whether a method forms weights that neighbours can keep. */
bool table1_keeps_weights(const struct table1_method *one);

/* Opens the library, warms up, measures, closes. */
void table1_measure(struct table1 *table);

void table1_report(const struct table1 *table);
#endif
