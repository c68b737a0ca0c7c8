/* SPDX-License-Identifier: MIT */
/* What is in the washing machine: a drum around the z axis, an elastic bunny, soap, water, nozzles.
 */
#ifndef EXAMPLES_DRUM_H
#define EXAMPLES_DRUM_H
#include "solver/wall.h"

static const double drum_radius = 0.4, drum_depth = 0.3; /* [m] */

/* Wall particles of a drum, closed at both ends. */
struct wall drum_wall(const struct sph *sph, double spacing);

/* Turns the wall by an angle; omega is the speed it has from now on. */
void drum_turn(struct wall *wall, double angle, double omega);

bool drum_holds(const double *x);

/* All particles, phase after phase: [0, body) [body, soap) [soap, count). */
struct load {
    struct particles all;
    int32_t body, soap; /* ends of these phases; the rest is water */
    int32_t capacity;
};

struct load load_new(double spacing, uint64_t seed);
void load_free(struct load *load);

/* Each phase in the library's order of the sources of neighbors, over all particles, in which
 * operators are fastest. The body first of all and then never again: its rest configuration counts
 * on the order. */
void load_sort(const struct sph *sph, struct load *load, const sphg_neighbors *neighbors,
               bool with_body);

/* Lets a nozzle for soap and one for water add a layer each, where there is room. */
void load_pour(struct load *load, double spacing, double speed);
#endif
