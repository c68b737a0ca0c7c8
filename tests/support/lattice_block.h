/* SPDX-License-Identifier: MIT */
/* A block of particles in [-1, 1]^d, of a lattice or moved a little, with V = 1 / sum W. */
#ifndef TESTS_SUPPORT_LATTICE_BLOCK_H
#define TESTS_SUPPORT_LATTICE_BLOCK_H
#include "second_order.h"

/* per_axis^d particles, H in spacings, moved by up to `jitter` spacings an axis; of order 2. */
comparison lattice_block_of(const test_case *test, int per_axis, double support, double jitter);
/* In the two outer layers. */
int lattice_block_is_boundary(const comparison *on, int i);

#endif
