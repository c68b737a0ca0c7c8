/* SPDX-License-Identifier: MIT */
/* Particles in the form VTKHDF 1.0, UnstructuredGrid, a vertex per particle: what VTK 9.1
 * (ParaView 5.11) reads; and their time in the group Steps of version 2.0. Readers that take a
 * single step for none find times in the list of output.h. docs.vtk.org, "VTKHDF file format". */
#ifndef SOLVER_VTKHDF_H
#define SOLVER_VTKHDF_H
#include "output.h"

bool vtkhdf_is_there(void); /* false: built without HDF5 */

/* One moment, and when it is [s]. */
bool vtkhdf_write(const char *path, double time, int32_t count, vector *x,
                  const struct output_field *fields);
#endif
