/* SPDX-License-Identifier: MIT */
/* The question that a build answers. */
#ifndef SPHGI_GEOMETRY_H
#define SPHGI_GEOMETRY_H
#include "neighbors.h"

/* What a build is about; becomes the object's only when it succeeds. */
struct sphgi_geometry {
    int32_t source_count, target_count, dimension;
    sphg_type position_type, type;
    bool part_of, periodic;
    bool radii, graded; /* of their own; and not all the same */
    double least;       /* radius, if they have */
    struct sphgi_periods periods;
    double largest[3]; /* |coordinate|, of a periodic or graded geometry */
    struct sphgi_raster raster;
    const sphg_neighbors *targets_of;
    bool shares; /* the grid of targets is that of targets_of: there are no target_rows */
    size_t row_size;
    char *source_rows, *target_rows; /* in the order of the host, in context->input */
};

#endif
