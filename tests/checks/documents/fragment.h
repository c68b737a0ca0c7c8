/* SPDX-License-Identifier: MIT */
/* What fragments of C in the documents take as given: the names that a reader knows by then. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

extern sphg_context *context;
extern sphg_neighbors *neighbors, *in_fluid, *in_wall;
extern sphg_scheme scheme;
extern sphg_sources sources;
extern sphg_geometry block;
extern sphg_field field;
extern sphg_request request;
extern sphg_view positions, fluid, wall, pressure, force, gradient;
extern sphg_view pressure_of_fluid, pressure_of_wall, masses;
extern double x[1000][3], v[1000][3], J[1000][3][3], C[1000][3][3], table[1000][6], *px, *py, *pz;
extern double volume;
extern double T[1000], k[1000], rate[1000];
extern int32_t count, own, ghosts, fluid_count, wall_count, inner_count, outer_count;
extern int32_t inner_targets[1000], outer_targets[1000];
