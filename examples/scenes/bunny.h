/* SPDX-License-Identifier: MIT */
/* A bunny that sits and looks along z: a union of ellipsoids, none of them thinner than what
 * particles can show. */
#ifndef EXAMPLES_BUNNY_H
#define EXAMPLES_BUNNY_H
#include "solver/arrays.h"

/* Whether a place is inside a bunny of particles with this spacing. */
bool bunny_holds(const double *x, double spacing);

enum bunny_part { BUNNY_FUR, BUNNY_EAR, BUNNY_EYE, BUNNY_NOSE, BUNNY_PARTS };

/* What each of its particles, which sits at rest, is to be painted as. */
void bunny_paint(int32_t count, vector *x, enum bunny_part *part);
#endif
