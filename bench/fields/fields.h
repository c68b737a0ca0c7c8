/* What the command `fields` measures, and the files that it writes. */
#ifndef SPHGRAD_BENCH_FIELDS_H
#define SPHGRAD_BENCH_FIELDS_H
#include "field_study.h"

enum {
    FIELDS_METHODS = 6, /* indexed by sphg_method */
    FIELDS_SIZES = 3,   /* N, 2 N, 4 N */
    FIELDS_KINDS = 2    /* indexed by study_field */
};

/* Everything measured on one lattice. */
struct lattice_results {
    const char *name;             /* "square" or "jittered" */
    struct study_setting setting; /* with the smallest N */
    struct study_errors errors[FIELDS_KINDS][FIELDS_METHODS][FIELDS_SIZES];
};

extern const sphg_method fields_order[FIELDS_METHODS]; /* rows of all tables */

/* One row per particle: where, which velocity, all errors. The numbers go into results too. */
void fields_write_particles(const char *directory, const struct study *study,
                            enum study_field field, struct lattice_results *results);
void fields_write_convergence(const char *directory, const struct lattice_results *results,
                              int count);

/* Writes the gnuplot scripts of the square and the jittered lattice and runs them. false: not all
 * pictures are there. */
bool fields_draw(const char *directory, const struct lattice_results results[2]);
#endif
