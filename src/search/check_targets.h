/* SPDX-License-Identifier: MIT */
/* Refuses targets of another object that do not fit the question. */
#ifndef SPHGI_CHECK_TARGETS_H
#define SPHGI_CHECK_TARGETS_H
#include "core/check.h"
#include "neighbors.h"

/* geometry->targets_of is set. */
sphg_result sphgi_check_targets_of(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                   const struct sphgi_scheme *scheme, bool searched,
                                   const sphg_geometry *geometry);

#endif
