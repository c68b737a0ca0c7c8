/* SPDX-License-Identifier: MIT */
/* From the sums of a bundle to the results of its fields. */
#ifndef SPHGI_FINISH_H
#define SPHGI_FINISH_H
#include "worker.h"

/* worker->coefficients hold the corrections, if there are any. */
void sphgi_finish_fields(struct sphgi_worker *worker);

#endif
