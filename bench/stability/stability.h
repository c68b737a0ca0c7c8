/* SPDX-License-Identifier: MIT */
/* How the operators bear degenerate, distant and uneven particles: what is swept and measured. */
#ifndef SPHGRAD_BENCH_STABILITY_H
#define SPHGRAD_BENCH_STABILITY_H
#include "report/timing.h"
#include "settings.h"

enum stability_sweep {
    SWEEP_SLAB,       /* (spacing / thickness)^2, about the condition number of the moments */
    SWEEP_THRESHOLD,  /* eps */
    SWEEP_OFFSET,     /* distance from the origin / H */
    SWEEP_SCALE,      /* k: lengths times 2^k */
    SWEEP_NEIGHBOURS, /* of each target */
    SWEEP_VOLUMES,    /* largest over smallest volume */
    SWEEP_JITTER,     /* share of the spacing by which each coordinate moves */
    SWEEP_MERGING,    /* distance of two layers / H */
    SWEEP_CROWDS,     /* equal particles in each of five places; it and those below run alone */
    SWEEP_GRADING,    /* largest over smallest support radius */
    SWEEP_CURVATURE,  /* eps_q, a tenth of eps, of order 2 */
    SWEEP_THINNING,   /* the slab, by order 2 */
    SWEEPS = SWEEP_CROWDS
};

/* One place of a sweep for one method, precision and policy; the worst of all rounds. */
struct stability_case {
    enum stability_sweep sweep;
    enum precision precision;
    sphg_scheme scheme; /* H apart */
    double at, end; /* scale and merging walk from `at` to `end`, in `steps` steps; else the same */
    int32_t steps;
    struct moment time; /* of all calls of the library */

    int64_t targets;    /* seen by the library */
    int64_t not_finite; /* numbers among the results */
    int64_t rank_sum, full, decomposed, empty;
    double linear_sum;  /* of |J_i - J|_F / |J|_F of a linear field */
    double linear_full; /* the largest where rank is full; plain SPH: the largest */
    double noise;       /* largest |J_i|_F H of a random field in [-1, 1] */

    int64_t compared, undecided; /* targets beside the reference; left out: rounding decides */
    int64_t wrong_ranks;
    double ratio_full, ratio_touched; /* largest error over its bound */
    double condition;                 /* largest of the normalised moments compared */

    int64_t other_bits; /* scale: targets that are not the power of two times those of k = 0 */
    double jump;        /* merging: largest |J_i - J_i'|_F H between steps, random field */
    double jump_left;   /* the same when the step it happens in is halved eight times */
    double correction_jump,
        correction_jump_left; /* |C_i - C_i'|_F m_ref; not for classic methods */
};

struct stability {
    struct settings settings;
    bool quick, one_policy;
    sphg_policy policy; /* where there is one */
    int first, last;    /* sweeps */
    int32_t seed;       /* of all random numbers */
    int32_t compared;   /* targets of a case that stand beside the reference */
    int case_count;
    struct stability_case *cases; /* those of a sweep stand together */
};

extern const char *const sweep_names[]; /* NULL-terminated */
extern const char *const policy_names[];

void stability_measure(struct stability *stability);
#endif
