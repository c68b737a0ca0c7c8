/* SPDX-License-Identifier: MIT */
/* The row that padding stands for, behind the last source. */
#ifndef SPHGI_DUMMY_H
#define SPHGI_DUMMY_H
#include "neighbors.h"

/* Puts it farther away from all targets than any kernel reaches, so that a pair with it weighs
 * exactly 0 in all sums. Where no such place is known, or `fixed` says that nobody promises it (of
 * lists that are borrowed), it is NaN, and pairs are tested one by one. */
void sphgi_place_dummy(sphg_neighbors *neighbors, bool fixed);

#endif
