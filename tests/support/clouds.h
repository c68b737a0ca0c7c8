/* SPDX-License-Identifier: MIT */
/* Particle clouds for tests: positions as doubles, which hold f32 positions exactly as well. */
#ifndef TESTS_SUPPORT_CLOUDS_H
#define TESTS_SUPPORT_CLOUDS_H
#include "random.h"

typedef struct cloud {
    int dimension; /* 2 or 3 */
    int count;
    double spacing; /* typical distance of neighbours; the usual support radius is twice that */
    double *x;      /* count * dimension numbers, released after the test case */
} cloud;

/* The same points in memory of their own. */
cloud cloud_copy(const cloud *points);
/* per_axis^d points, the first at the origin. */
cloud cloud_lattice(int dimension, int per_axis, double spacing);
/* The lattice with each coordinate moved by up to jitter * spacing. */
cloud cloud_jittered(int dimension, int per_axis, double spacing, double jitter,
                     random_state *random);
/* Independent uniform points in a cube; spacing is that of a lattice as dense. */
cloud cloud_random(int dimension, int count, double side, random_state *random);
/* A jittered block under a wavy free surface, with a few droplets above it. */
cloud cloud_free_surface(int dimension, int per_axis, double spacing, random_state *random);
/* A jittered block so small that every particle sees a corner. */
cloud cloud_corner(int dimension, double spacing, random_state *random);
/* A lattice in a plane of space (a line in 2D): exactly x_d = 0, or tilted at random, which
 * leaves the rounding of the coordinates as thickness. */
cloud cloud_plane(int dimension, int per_axis, double spacing);
cloud cloud_tilted_plane(int dimension, int per_axis, double spacing, random_state *random);
/* Points on the diagonal: exactly collinear when spacing is dyadic. */
cloud cloud_line(int dimension, int count, double spacing);
/* Two points at a distance along a direction that is no axis. */
cloud cloud_pair(int dimension, double distance);
cloud cloud_single(int dimension);
/* copies points at one place, and one more a spacing away where beside is not 0. */
cloud cloud_coincident(int dimension, int copies, int beside, double spacing);
/* Two lattice layers (lines in 2D) a gap apart. */
cloud cloud_sheets(int dimension, int per_axis, double spacing, double gap);

/* Rounds the coordinates to f32, or to multiples of a dyadic step. */
void cloud_round_to_single(cloud *points);
void cloud_snap(cloud *points, double step);
/* Adds the same vector to all points. */
void cloud_shift(cloud *points, const double *vector);
/* A rigid rotation about the origin by random angles. */
void cloud_rotate(cloud *points, random_state *random);

/* Rounded to the 24 bits of f32, whatever the exponent. */
double cloud_rounded(double number);
/* A number per point, uniform in [low, high) and rounded to 24 bits. */
double *cloud_numbers(const cloud *points, double low, double high, random_state *random);
/* Volumes around spacing^d, spread by the given share (0: all alike). */
double *cloud_volumes(const cloud *points, double spread, random_state *random);

/* The point nearest to the middle of the bounding box. */
int cloud_middle(const cloud *points);

#endif
