/* SPDX-License-Identifier: MIT */
/* Pictures by gnuplot: SCENE.gp and SCENE.png beside the tables of the runs, plain SPH to the left
 * of the method that ran beside it. */
#ifndef SOLVER_PICTURE_H
#define SOLVER_PICTURE_H
#include "metrics.h"
#include <stdio.h>

struct picture {
    const struct options *options; /* of the runs */
    const char *directory, *name;
    const char *methods[2], *titles[2]; /* as files are named, and to be read */
    const struct metrics *metrics[2];   /* what the runs came to */
    bool full;                          /* the runs had their full size */
    char frame[8];                      /* of a film: "_0012", the end of names; or empty */
    double share;                       /* of the run that is over */
    FILE *script;                       /* gnuplot commands go here */
};

struct picture picture_open(const struct options *options, const struct metrics *runs);

/* The picture that is described next is this frame of so many. */
void picture_frame(struct picture *picture, int32_t frame, int32_t of);

/* width x height [pixel] */
void picture_begin(const struct picture *picture, int width, int height);
void picture_end(const struct picture *picture);

/* What is plotted next stands there, in shares of the width; all panels have one height. */
void picture_panel(const struct picture *picture, double left, double right);

/* One colour bar for all panels, of their height, at this share of the width. */
void picture_bar(const struct picture *picture, double left, const char *label);

/* Two panels of particles as output_view wrote them, each a share of the width, with axes that mean
 * nothing left away. */
void picture_views(const struct picture *picture, const char *label, double radius,
                   const char *title, double width);

/* A third panel with a line for each method, from tables of time and value. */
void picture_series(const struct picture *picture, const char *label);

/* Runs gnuplot. If that is missing, says so and leaves the script. */
void picture_close(const struct picture *picture);

/* How a solid looks from `eye` (a direction, z up): columns right, up and a colour of each
 * particle, the nearest last, for gnuplot to draw one over the other. */
void picture_project(FILE *table, const double eye[3], int count, double (*x)[3],
                     const double *colour);
#endif
