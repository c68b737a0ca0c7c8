/* SPDX-License-Identifier: MIT */
/* A bundle of targets whose sums are done: results are written, or sums put away until those of the
 * other source sets have come in. */
#ifndef SPHGI_BUNDLE_H
#define SPHGI_BUNDLE_H
#include "worker.h"

/* Writes the results; the bundle is empty again. */
void sphgi_bundle_finish(struct sphgi_worker *worker);

/* The same for one whose sums stand in memory already. */
void sphgi_bundle_finish_from_sums(struct sphgi_worker *worker);

#endif
