/* SPDX-License-Identifier: MIT */
/* Time a pair where a host's own arrays meet the library: sums over lists that a host brings, and
 * pairs that the library writes out for loops of a host's own. */
#ifndef SPHGRAD_BENCH_LISTS_H
#define SPHGRAD_BENCH_LISTS_H
#include "report/timing.h"
#include "settings.h"

/* Who says which pairs there are. */
enum lists_supply {
    SUPPLY_KEPT,      /* the library's search, its lists kept */
    SUPPLY_LIST_FREE, /* the same search, pairs found anew by each sweep */
    SUPPLY_CSR,       /* the host's offsets and indices */
    SUPPLY_ROWS,      /* the host's pointer and length for each target */
    SUPPLY_FUNCTION,  /* a function of the host's, called for each target */
    SUPPLY_COPIED,    /* the host's offsets and indices, copied by the build */
    SUPPLIES
};

enum lists_work {
    WORK_BUILD, /* the search, or handing over the lists */
    WORK_MATRICES,
    WORK_GRADIENT, /* with these matrices */
    WORK_FUSED,
    LISTS_WORKS
};

/* What sphg_pair_gradients is asked for. */
struct lists_export {
    const char *name;
    bool indices, gradients, any_order;
    int32_t block; /* so many targets in one call; 0: all of them */
};

enum { EXPORTS = 7, NO_ERROR = -1 /* where no gradient comes out */ };
extern const struct lists_export lists_exports[EXPORTS];

/* Errors: the largest |J_i - J|_F / |J|_F of a linear field. */
struct lists {
    struct settings settings;
    int32_t count;
    int64_t pairs;
    struct samples supplied[SUPPLIES][LISTS_WORKS];
    double supplied_error[SUPPLIES];
    struct samples exported[EXPORTS];
    double exported_error[EXPORTS];
};

void lists_measure(struct lists *lists);
#endif
