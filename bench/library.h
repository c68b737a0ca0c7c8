/* SPDX-License-Identifier: MIT */
/* The library as the benchmark uses it: any failure ends the program with the library's words. */
#ifndef SPHGRAD_BENCH_LIBRARY_H
#define SPHGRAD_BENCH_LIBRARY_H
#include "numbers.h"
#include <stdbool.h>

sphg_context *library_open(int32_t threads); /* 0: the library's default */
void library_check(const sphg_context *context, sphg_result result);

/* Path p is the instruction set p + 1 of the header; not all of them run here. */
enum { LIBRARY_PATHS = SPHG_ISA_NEON };
const char *library_path_name(int path);
sphg_context *library_open_path(int32_t threads, int path); /* or NULL */

const char *library_version(void);
/* The instruction set of contexts opened from here on; false: it does not run here. */
bool library_choose_isa(sphg_isa isa);
const char *library_isa(void); /* the one chosen, at first the best that runs here */

/* Neighbours not searched for yet; and of all particles, for fields of this type. */
sphg_neighbors *library_neighbors(sphg_context *context);
sphg_geometry library_geometry(const struct numbers *positions, sphg_type field_type);
void library_search(sphg_context *context, sphg_neighbors *neighbors, const sphg_scheme *scheme,
                    const sphg_geometry *geometry);
sphg_neighbors_info library_info(sphg_context *context, const sphg_neighbors *neighbors);

/* All targets: their corrections, their ranks (or NULL), and the Jacobians of a vector field. */
void library_correct(sphg_context *context, const sphg_scheme *scheme, const sphg_sources *sources,
                     sphg_view corrections, uint8_t *ranks);
void library_jacobian(sphg_context *context, const sphg_scheme *scheme, const sphg_sources *sources,
                      const struct numbers *field, const struct numbers *jacobians);

/* V_j = 1 / sum_k W_jk, j itself included: volumes from the positions alone. */
void library_volumes(sphg_context *context, const sphg_scheme *scheme,
                     const sphg_neighbors *neighbors, struct numbers *volumes);
#endif
