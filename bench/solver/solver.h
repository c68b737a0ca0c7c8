/* SPDX-License-Identifier: MIT */
/* Time a matrix of the library's batches: what is measured and reported. */
#ifndef SPHGRAD_BENCH_SOLVER_H
#define SPHGRAD_BENCH_SOLVER_H
#include "library.h"
#include "report/timing.h"
#include "settings.h"

enum solver_work { SOLVER_INVERSION, SOLVER_EIGEN, SOLVER_SVD };

enum solver_spectrum {
    SOLVER_COPIED,  /* no arithmetic: the numbers that go in and come out, moved */
    SOLVER_MOMENTS, /* eigenvalues of a particle inside a fluid, or, for a share of them, at its
                       surface */
    SOLVER_RANDOM,  /* entries in [-1, 1) */
    SOLVER_NEAR,    /* a thousandth away from the identity, SVD: from a rotation */
    SOLVER_GRADED   /* 1, 1e-3, 1e-6 */
};

struct solver_case {
    enum solver_work work;
    const char *what;
    enum solver_spectrum spectrum;
    double share; /* of moments that fall back to the decomposition */
};

enum { SOLVER_CASES = 13 };
extern const struct solver_case solver_cases[SOLVER_CASES];

struct solver_result {
    double deviation[LIBRARY_PATHS];  /* worst of C M - 1, A - Q L Q^T, A - U S V^T, over |A| */
    double decomposed[LIBRARY_PATHS]; /* share that the call says it sent there */
};

/* Measured in turn, round by round. */
struct solver_group {
    sphg_type type;
    int32_t dimension, count;
    struct solver_result results[SOLVER_CASES];
    struct samples times[SOLVER_CASES][LIBRARY_PATHS]; /* of one call; a copy: only of path 0 */
};

enum { SOLVER_GROUPS = 8, SOLVER_SMALL = 4096 /* matrices that stay in the second-level cache */ };

struct solver {
    struct settings settings;
    int32_t matrices;    /* of the large batches */
    int path, precision; /* the only one wanted, or -1 */
    bool available[LIBRARY_PATHS];
    int group_count;
    struct solver_group groups[SOLVER_GROUPS];
};

/* Numbers of an item: in, and of up to three results. */
struct solver_widths {
    int32_t in, out[3];
};
struct solver_widths solver_widths_of(enum solver_work work, int32_t dimension);
bool solver_has(const struct solver_group *group, int k); /* SVD is 3D only */

/* The matrices of a case. */
struct numbers solver_batch(const struct solver_case *one, sphg_type type, int32_t dimension,
                            int32_t count);

void solver_measure(struct solver *solver);
#endif
