/* SPDX-License-Identifier: MIT */
/* What operator tests stand on: a context, typed arrays, neighbours of a cloud. All of it is
 * released by the runner when the case ends. */
#ifndef TESTS_SUPPORT_SETUP_H
#define TESTS_SUPPORT_SETUP_H
#include "clouds.h"
#include "fake_host.h"
#include "numbers.h"
#include "test.h"

/* Fails the test with the library's message unless the call succeeded. */
#define SETUP_OK(context, call) setup_ok(context, call, #call)
void setup_ok(const sphg_context *context, sphg_result result, const char *call);

/* A context of two threads, or of as many as wanted. */
sphg_context *setup_context(void);
sphg_context *setup_context_of(int threads);
/* On one instruction set; NULL where the machine or the build lacks it. */
sphg_context *setup_context_on(sphg_isa isa);
/* The same, but under sanitizers, which watch the path that is asked for, NULL for any other. */
sphg_context *setup_watched_context_on(sphg_isa isa);
sphg_context *setup_context_with(const sphg_config *config);
/* A host to be named in such a config: opened, and closed after the context. */
fake_host *setup_hooks(void);

/* Typed arrays, in memory that ends with the case. */
typedef struct numbers setup_array;

/* The numbers rounded to the type; NULL: filled with a canary, for outputs. */
setup_array setup_numbers(sphg_type type, int count, int width, const double *numbers);
setup_array setup_output(sphg_type type, int count, int width);
static inline sphg_view setup_view(const setup_array *array)
{
    return numbers_view(array);
}
static inline double setup_get(const setup_array *array, int item, int component)
{
    return numbers_get(array, item, component);
}
/* All numbers as doubles. */
double *setup_doubles(const setup_array *array);
/* Equal to the bit, NaN included. */
int setup_same_bits(const setup_array *a, const setup_array *b);
/* Equal but for the order of summation: a few hundred roundings of the largest number. */
void setup_require_close(const setup_array *a, const setup_array *b, const char *where);
/* number: over all items and components. */
void setup_put(const setup_array *array, int number, double value);
int setup_is_canary(const setup_array *array, int item);

/* Scheme of the case: blend, eps 1e-2. */
sphg_scheme setup_scheme(const test_case *test, double support_radius);
/* The cloud as the case stores it: rounds points->x to f32 where positions are f32. */
setup_array setup_positions(const test_case *test, cloud *points);
/* Geometry of a cloud whose targets are all its particles; fields as the case has them. */
sphg_geometry setup_geometry(const test_case *test, const cloud *points,
                             const setup_array *positions);
/* Positions, geometry and search in one. */
sphg_neighbors *setup_neighbors(sphg_context *context, const test_case *test,
                                const sphg_scheme *scheme, cloud *points);
/* Neighbours of any geometry; and by lists. */
sphg_neighbors *setup_search(sphg_context *context, const sphg_scheme *scheme,
                             const sphg_geometry *geometry);
sphg_neighbors *setup_lists(sphg_context *context, const sphg_scheme *scheme,
                            const sphg_geometry *geometry, const sphg_lists *lists);

/* Numbers per item of a shape. */
int setup_width(sphg_shape shape, int dimension);

#endif
