/* Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933: what is measured and reported. */
#ifndef SPHGRAD_BENCH_TABLE1_H
#define SPHGRAD_BENCH_TABLE1_H
#include "particles/particles.h"
#include "study/probe.h"
#include "report/timing.h"

enum { TABLE1_COLUMNS = 6 };

struct table1_options {
    struct particle_source source;
    int32_t wanted_particles; /* what the lattice's cube comes nearest to */
    double support;           /* in spacings; with an input file in its units; 0: not given */
    sphg_kernel kernel;
    int32_t threads, repetitions;
    const char *json; /* file to write, or NULL */
};

struct column {
    sphg_method method;
    double paper_matrix, paper_gradient; /* [ms], 32 cores of a Threadripper PRO 5975WX */
    struct samples matrix, gradient, fused;
    /* The same with weights that a sweep before kept; linearised methods only. */
    struct samples matrix_kept, gradient_kept, fused_kept;
    /* Untimed: the field v = (-y, x, 2z), in 2D (-y, x), max |J_i - J|_F / |J|_F over particles of
     * full rank (plain SPH, which has no rank: over all); NaN if there are none. */
    double gradient_error, fused_error, kept_error;
    int64_t not_finite; /* numbers in any Jacobian, of v and of the timed field */
    sphg_stats stats;
};

struct table1 {
    struct table1_options options;
    struct particles particles;
    double support_radius;
    sphg_neighbors_info neighbors;
    double volume_ratio; /* median of the file's volumes over 1 / sum W */
    double first_search; /* [ms], with all allocations */
    struct samples search;
    struct samples probe[PROBE_WORKS]; /* for as many particles as its cube holds */
    int32_t probe_count;
    struct column columns[TABLE1_COLUMNS];
};

/* Whether a method forms weights that neighbours can keep. */
int table1_keeps_weights(const struct column *column);

/* Opens the library, warms up, measures, closes. */
void table1_measure(struct table1 *table);

void table1_print(const struct table1 *table);
void table1_write_json(const struct table1 *table, const char *path, const char *executable);
#endif
