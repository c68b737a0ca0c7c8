/* SPDX-License-Identifier: MIT */
/* Who is whose neighbour, by brute force: r < H decided in the precision of the positions, without
 * FMA, as docs/theory.md says; and the rows that the library lists, to compare with. */
#ifndef TESTS_SUPPORT_BRUTE_FORCE_H
#define TESTS_SUPPORT_BRUTE_FORCE_H
#include "clouds.h"
#include "test.h"

/* Particles and how they are searched. Coordinates must be representable in the position type. */
typedef struct scene {
    int dimension, is_double; /* type of the positions */
    int source_count, target_count;
    double *sources;
    double *targets; /* NULL: the first target_count sources */
    double period[3];
    double skin;
    int list_free;
    sphg_type precision;              /* of the fields; 0: as the positions */
    double *support, *target_support; /* radii of their own; NULL: one for all */
    int mutual;
} scene;

/* So many particles at the origin, in the case's precision; and x as its positions hold it. */
scene scene_empty(const test_case *test, int count);
double scene_rounded(const scene *particles, double x);
scene scene_of_cloud(const test_case *test, const cloud *points);

/* Copies the positions into fresh arrays of the right type. */
sphg_geometry scene_geometry(const scene *particles);

typedef struct rows {
    int32_t count;
    int64_t *offsets;
    int32_t *indices;
} rows;

rows rows_by_brute_force(const scene *particles, double support_radius);
/* Through sphg_pair_gradients, in two calls: the count, then the indices. */
rows rows_listed(sphg_context *context, const sphg_neighbors *neighbors, const sphg_scheme *scheme,
                 const sphg_subset *subset);
void rows_require_equal(const rows *found, const rows *expected, const char *where);

/* Searches and compares with brute force; returns the pairs there are. */
int64_t rows_require_search_exact(sphg_context *context, sphg_neighbors *neighbors,
                                  const scene *particles, double support_radius, const char *where);

sphg_neighbors *brute_force_neighbors(sphg_context *context); /* empty, destroyed with the case */

#endif
