/* SPDX-License-Identifier: MIT */
/* Square and cubic lattices of particles, jittered and shuffled on request. */
#ifndef SHARED_LATTICE_H
#define SHARED_LATTICE_H
#include "numbers.h"
#include <stdbool.h>

struct lattice {
    int32_t dimension; /* 2 or 3 */
    int32_t side;      /* particles along each axis */
    double origin;     /* coordinate of the first particle on each axis */
    double spacing;
    double jitter; /* each coordinate moves by up to this share of the spacing */
    bool shuffled; /* random order instead of x fastest */
};

int32_t lattice_count(const struct lattice *lattice);

/* One row of `dimension` coordinates per particle; the same numbers on every run and machine. */
void lattice_fill(const struct lattice *lattice, struct numbers *positions);

/* In [0, 1), the same for the same number: random without a state. */
double lattice_random(int64_t number);

/* Reorders the rows of a table at random, the same way for every table of as many rows. */
void shuffle_rows(struct numbers *table);
#endif
