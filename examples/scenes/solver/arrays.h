/* SPDX-License-Identifier: MIT */
/* Arrays of the solver, and how the library is shown them. */
#ifndef SOLVER_ARRAYS_H
#define SOLVER_ARRAYS_H
#include <sphgrad/sphgrad.h>
#include <stdbool.h>

/* C11 cannot add a const to an array behind a pointer, so arrays that are only read are not const.
 */
typedef double vector[3]; /* in 2D the third number stays zero */
typedef double tensor[9]; /* row-major 3 x 3, in 2D with a row and a column of zeros */

/* count items of zeros, or the end of the program. */
void *array_new(int32_t count, size_t item_size);

static inline sphg_view scalars(const double *first)
{
    return sphg_view_f64(first, sizeof *first);
}
static inline sphg_view vectors(vector *first)
{
    return sphg_view_f64(*first, sizeof *first);
}
static inline sphg_view tensors(tensor *first) /* rows apart, so that 2D fits, too */
{
    return sphg_xyz_f64(*first, *first + 3, *first + 6, sizeof *first);
}
static inline sphg_view everywhere(const double *value) /* one item for all particles */
{
    return sphg_same_f64(value);
}

static inline double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void cross(const double *a, const double *b, double *result)
{
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}
/* v += factor a */
static inline void add_scaled(double *v, double factor, const double *a)
{
    for (int k = 0; k < 3; ++k)
        v[k] += factor * a[k];
}
#endif
