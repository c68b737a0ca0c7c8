/* SPDX-License-Identifier: MIT */
/* The library as the scenes use it: a failure ends the program with the library's words. */
#ifndef SOLVER_LIBRARY_H
#define SOLVER_LIBRARY_H
#include "arrays.h"

/* Where the time of a step goes. */
enum account {
    SEARCH,
    FLUID_MATRICES,
    WALL_MATRICES,
    PRESSURE,
    FORCES,
    MEASURING, /* what would not be done but for this account */
    ACCOUNT_COUNT
};

/* What every part of the solver is given. Densities and the pressure among fluid particles are
 * plain SPH throughout; `corrected` is the method that a run is about, which may be plain, too. */
struct sph {
    sphg_context *context;
    sphg_scheme plain, corrected;
    double *spent; /* [s], ACCOUNT_COUNT numbers */
};

/* threads 0: the library's default. */
struct sph sph_open(int32_t threads, int32_t dimension, double support_radius, sphg_method method);
void sph_close(struct sph *sph);

void sph_check(const struct sph *sph, sphg_result result);

/* An empty object. */
sphg_neighbors *sph_neighbors(const struct sph *sph);

/* All x are each other's neighbours. */
void sph_search(const struct sph *sph, sphg_neighbors *neighbors, int32_t count, vector *x);

/* Sums of the DIRECT form over one source set: the sphg_field that asks for them. */
sphg_field direct_field(sphg_shape shape, const sphg_view *at_sources);

/* Evaluates fields over the particles of sources; volumes of targets, where they are not part of
 * these, may be absent. */
void sph_evaluate(const struct sph *sph, const sphg_scheme *scheme, const sphg_sources *sources,
                  sphg_view target_volume, int32_t field_count, const sphg_field *fields);
#endif
