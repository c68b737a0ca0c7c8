/* SPDX-License-Identifier: MIT */
/* Diffusion: the Laplacian of the adjoint form, pair by pair (theory.md, section 11). */
#ifndef SPHGI_DIFFUSION_H
#define SPHGI_DIFFUSION_H
#include "worker.h"

/* L_ij of the tile: as a whole, or, where H_j is another radius than H_i, the share that has H_i.
 */
void sphgi_begin_diffusion(struct sphgi_worker *worker);

/* The rest of L_ij, once s_ij have H_j, and the sums of all fields over it. */
void sphgi_sum_diffusion(struct sphgi_worker *worker);

void sphgi_finish_diffusion(struct sphgi_worker *worker, const struct sphgi_field_plan *field);

#endif
