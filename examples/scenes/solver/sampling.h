/* SPDX-License-Identifier: MIT */
/* Irregular samples of surfaces, as scanned or imported walls have them. */
#ifndef SOLVER_SAMPLING_H
#define SOLVER_SAMPLING_H
#include "arrays.h"
#include "random.h"

/* Random points of [low[0], high[0]] x [low[1], high[1]] x {0}, none nearer to another than
 * `distance` (Poisson disk by dart throwing). The caller frees *points. */
int32_t sample_rectangle(struct random *random, const double low[2], const double high[2],
                         double distance, vector **points);

/* The same on a sphere around the origin. Time grows with the square of the number of points. */
int32_t sample_sphere(struct random *random, double radius, double distance, vector **points);
#endif
