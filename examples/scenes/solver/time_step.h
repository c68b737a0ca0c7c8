/* SPDX-License-Identifier: MIT */
/* Time steps. */
#ifndef SOLVER_TIME_STEP_H
#define SOLVER_TIME_STEP_H
#include "particles.h"

/* The longest step up to `most` in which no particle goes farther than 0.4 of a spacing (the
 * condition of Courant, Friedrichs and Lewy), but never below a hundredth of `most`. */
double time_step(const struct particles *particles, double spacing, double most);
#endif
