/* SPDX-License-Identifier: MIT */
/* From the moments of a bundle to its corrections. */
#ifndef SPHGI_CORRECTIONS_H
#define SPHGI_CORRECTIONS_H
#include "worker.h"

/* worker->coefficients from the sums; writes what is wanted of them. Those of classic methods come
 * in two halves: moments give what their slopes need, and whoever asks how sound they are is told.
 */
void sphgi_finish_moments(struct sphgi_worker *worker);
void sphgi_finish_slopes(struct sphgi_worker *worker);
/* What slopes need of moments, and nobody is told: some targets will drop out. */
void sphgi_solve_for_slopes(struct sphgi_worker *worker);

#endif
