/* SPDX-License-Identifier: MIT */
/* Neighbours of targets that have radii of their own. */
#ifndef SPHGI_FIND_OCTAVES_H
#define SPHGI_FIND_OCTAVES_H
#include "finder.h"

/* Lists of the next target and of those that are searched for together with it. */
void sphgi_find_in_octaves(struct sphgi_finder *finder);
/* One target, slice by slice of its runs. */
void sphgi_find_target_in_octaves(struct sphgi_finder *finder, int32_t target, sphgi_take *take,
                                  void *data);

#endif
