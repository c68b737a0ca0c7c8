/* SPDX-License-Identifier: MIT */
/* The library as the benchmark uses it: any failure ends the program with the library's words.
 * Contexts and neighbours are held (numbers.h). */
#ifndef SPHGRAD_BENCH_LIBRARY_H
#define SPHGRAD_BENCH_LIBRARY_H
#include "numbers.h"
#include <stdbool.h>

sphg_context *library_open(int32_t threads);                   /* 0: the library's default */
sphg_context *library_open_isa(int32_t threads, sphg_isa isa); /* NULL: it does not run here */
bool library_runs(sphg_isa isa);
void library_check(const sphg_context *context, sphg_result result);
const char *library_version(void);

/* The instruction set of contexts opened from here on; false: it does not run here. */
bool library_choose_isa(sphg_isa isa);
const char *library_isa(void); /* the one chosen, at first the best that runs here */

sphg_neighbors *library_neighbors(sphg_context *context); /* not searched for yet */
sphg_neighbors_info library_info(sphg_context *context, const sphg_neighbors *neighbors);

/* All pairs among the particles of neighbours, as lists of a host: indices ascend, and can be read
 * a vector beyond the last. */
struct library_lists {
    int64_t count, *offsets;
    int32_t *indices;
};
struct library_lists library_lists(sphg_context *context, const sphg_scheme *scheme,
                                   const sphg_neighbors *neighbors, int32_t particles);
#endif
