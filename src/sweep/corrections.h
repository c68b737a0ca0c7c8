/* SPDX-License-Identifier: MIT */
/* From the moments of a bundle to its corrections. */
#ifndef SPHGI_CORRECTIONS_H
#define SPHGI_CORRECTIONS_H
#include "worker.h"

/* worker->coefficients from the sums; writes what is wanted of them. */
void sphgi_finish_corrections(struct sphgi_worker *worker);

#endif
