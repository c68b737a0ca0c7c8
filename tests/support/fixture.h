/* What operator tests stand on: a context, typed arrays, neighbours of a cloud. All of it is
 * released by the runner when the case ends. */
#ifndef TESTS_SUPPORT_FIXTURE_H
#define TESTS_SUPPORT_FIXTURE_H
#include "clouds.h"
#include "hooks.h"
#include "numbers.h"
#include "test.h"

/* Fails the test with the library's message unless the call succeeded. */
#define FIXTURE_OK(context, call) fixture_ok(context, call, #call)
void fixture_ok(const sphg_context *context, sphg_result result, const char *call);

/* A context of two threads, or of as many as wanted. */
sphg_context *fixture_context(void);
sphg_context *fixture_context_of(int threads);
/* On one instruction set; NULL where the machine or the build lacks it. */
sphg_context *fixture_context_on(sphg_isa isa);
sphg_context *fixture_context_with(const sphg_config *config);
/* A host to be named in such a config: opened, and closed after the context. */
hooks *fixture_hooks(void);

/* Typed arrays, in memory that ends with the case. */
typedef struct numbers fixture_array;

/* The numbers rounded to the type; NULL: filled with a canary, for outputs. */
fixture_array fixture_numbers(sphg_type type, int count, int width, const double *numbers);
fixture_array fixture_output(sphg_type type, int count, int width);
static inline sphg_view fixture_view(const fixture_array *array)
{
    return numbers_view(array);
}
static inline double fixture_get(const fixture_array *array, int item, int component)
{
    return numbers_get(array, item, component);
}
/* All numbers as doubles. */
double *fixture_doubles(const fixture_array *array);
/* Equal to the bit, NaN included. */
int fixture_same_bits(const fixture_array *a, const fixture_array *b);
/* Equal but for the order of summation: a few hundred roundings of the largest number. */
void fixture_require_close(const fixture_array *a, const fixture_array *b, const char *where);
/* number: over all items and components. */
void fixture_put(const fixture_array *array, int number, double value);
int fixture_is_canary(const fixture_array *array, int item);

/* Scheme of the case: blend, eps 1e-2. */
sphg_scheme fixture_scheme(const test_case *test, double support_radius);
/* The cloud as the case stores it: rounds points->x to f32 where positions are f32. */
fixture_array fixture_positions(const test_case *test, cloud *points);
/* Geometry of a cloud whose targets are all its particles; fields as the case has them. */
sphg_geometry fixture_geometry(const test_case *test, const cloud *points,
                               const fixture_array *positions);
/* Positions, geometry and search in one. */
sphg_neighbors *fixture_neighbors(sphg_context *context, const test_case *test,
                                  const sphg_scheme *scheme, cloud *points);
/* Neighbours of any geometry; and by lists. */
sphg_neighbors *fixture_search(sphg_context *context, const sphg_scheme *scheme,
                               const sphg_geometry *geometry);
sphg_neighbors *fixture_lists(sphg_context *context, const sphg_scheme *scheme,
                              const sphg_geometry *geometry, const sphg_lists *lists);

/* Numbers per item of a shape. */
int fixture_width(sphg_shape shape, int dimension);

#endif
