/* SPDX-License-Identifier: MIT */
/* What is read of sources that have radii of their own: these, and classic tables. */
#ifndef SPHGI_TABLES_BY_RADIUS_H
#define SPHGI_TABLES_BY_RADIUS_H
#include "job.h"

/* Rows of H / H_j, H being that of the plan, 1 / H_j and H_j; of order 2 a factor behind them, what
 * s_ji has besides the kernel and V_i, times what takes G_ji to units of H. */
void sphgi_fill_radii(const struct sphgi_sweep *sweep, const int32_t *order, int32_t begin,
                      int32_t end, char *rows);

/* Rows of coefficients, as the host has them, of the sources order[begin] to order[end - 1] of the
 * host; order NULL: of `begin` and so on themselves. They are taken to units of H_j and multiplied
 * with what G_ji has of j besides. rows: y of the first; those of each z_k `array` bytes behind. */
void sphgi_scale_tables(const struct sphgi_sweep *sweep, const int32_t *order, int32_t begin,
                        int32_t end, char *rows, size_t array);

#endif
