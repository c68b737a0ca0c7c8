/* SPDX-License-Identifier: MIT */
/* Candidates among sources whose radii differ: a walk through the octaves and their tree. */
#ifndef SPHGI_WALK_H
#define SPHGI_WALK_H
#include "passes/passes.h"
#include <stdbool.h>

struct sphgi_grid;

/* The runs of candidates of a few targets, octave by octave. */
struct sphgi_span { /* of cells along an axis: two where a period parts them */
    int32_t count;
    int64_t low[2], high[2];
};
struct sphgi_walk {
    const struct sphgi_grid *sources;
    double low[3], high[3]; /* of the targets, by the axes of the raster */
    double reach, stretch;  /* of the targets; of the radii of others where these count, else 0 */
    int32_t octave, part;
    int32_t from, leaf; /* block, from which on; leaf of the tree where the walk is ... */
    unsigned inside;    /* ... and its blocks within reach that are yet to come */
    struct sphgi_span span[3];
};

/* low, high: of the four numbers of the targets' rows, the radius being the last */
void sphgi_walk_open(struct sphgi_walk *walk, const struct sphgi_grid *sources, const double *low,
                     const double *high, double stretch, bool mutual);
/* The next runs, as many as there is room for. False: there are no more. */
bool sphgi_walk_on(struct sphgi_walk *walk, struct sphgi_runs *runs);

/* Blocks within reach of many targets, in the order of the walk: some of these after the other look
 * there alone. */
enum { SPHGI_NEAR_MOST = 256 };
struct sphgi_near {
    int32_t block, octave;
    int64_t x;              /* its place along the bars */
    double low[2], high[2]; /* where it begins and ends across them; infinite: nobody can tell */
    double reach;           /* of the radii in it, where these count */
};
struct sphgi_nearby {
    int32_t count; /* -1: there are more */
    struct sphgi_near near[SPHGI_NEAR_MOST];
};
/* False: there are more. */
bool sphgi_look_nearby(struct sphgi_walk *walk, struct sphgi_nearby *nearby);
/* The runs of some of these targets. False: there are more. */
bool sphgi_walk_nearby(struct sphgi_walk *walk, const struct sphgi_nearby *nearby,
                       struct sphgi_runs *runs);

#endif
