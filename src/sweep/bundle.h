/* SPDX-License-Identifier: MIT */
/* A bundle of targets whose sums are done: they are put away, or those of other source sets come in
 * and results are written. */
#ifndef SPHGI_BUNDLE_H
#define SPHGI_BUNDLE_H
#include "worker.h"

/* The bundle is empty again. */
void sphgi_bundle_finish(struct sphgi_worker *worker);

#endif
