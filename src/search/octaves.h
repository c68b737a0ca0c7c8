/* SPDX-License-Identifier: MIT */
/* Particles whose radii differ: each stands in the cells of its octave. Those of octave k hold the
 * radii from 2^-(k + 1) up to 2^-k of the largest, and are 2^-k as wide as those of octave 0; all
 * of them are in one grid, one octave behind the other. */
#ifndef SPHGI_OCTAVES_H
#define SPHGI_OCTAVES_H
#include "raster.h"

enum { SPHGI_OCTAVES_MOST = 32 };

/* A cell is 1 to 2 radii wide along its bar. Across it is thinner, so that bars are as thick as
 * those of one radius, about, and its particles are sorted by quarters of cells: so those that
 * follow one another in storage are as close together as there. */
#define SPHGI_OCTAVE_ACROSS 0.8

/* Particles in the order of the host, radii being the fourth numbers of their rows. */
struct sphgi_strewn {
    const void *rows;
    sphg_type type;
    int32_t count, dimension;
    double top; /* the largest radius */
};

/* The axis along which particles of like radii, of a quarter of an octave, reach farthest, in cells
 * of theirs: bars along it are long runs of them. Other axes than x must be worth it. Looks at some
 * thousands of the particles. */
int32_t sphgi_longest_axis(const struct sphgi_strewn *strewn);

/* How many octaves radii of these sizes need: no more than keys of blocks have room for, where
 * coordinates go as far as that. */
int32_t sphgi_octaves_for(const struct sphgi_raster *raster, double least, const double *largest_x);
int32_t sphgi_octave_of(const struct sphgi_raster *raster, double radius);

/* Key of a block of that octave from its place there, and back. */
void sphgi_raise_octave(int32_t octave, int64_t *at);
int32_t sphgi_lower_octave(int64_t *at);

#endif
