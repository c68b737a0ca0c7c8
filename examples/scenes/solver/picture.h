/* SPDX-License-Identifier: MIT */
/* Pictures by gnuplot: SCENE.gp and SCENE.png beside the tables of the runs, plain SPH to the left
 * of the method that ran beside it. */
#ifndef SOLVER_PICTURE_H
#define SOLVER_PICTURE_H
#include "options.h"
#include <stdio.h>

struct picture {
    const char *directory, *name;
    const char *methods[2], *titles[2]; /* as files are named, and to be read */
    bool full;                          /* the runs had their full size */
    FILE *script;                       /* gnuplot commands go here */
};

struct picture picture_open(const struct options *options);

/* width x height [pixel], and panels side by side. */
void picture_begin(const struct picture *picture, int width, int height, int rows, int columns);

/* Two panels of particles as output_view wrote them, with axes that mean nothing left away. */
void picture_views(const struct picture *picture, const char *label, double radius,
                   const char *title);

/* A panel with a line for each method, from tables of time and value. */
void picture_series(const struct picture *picture, const char *label);

/* Runs gnuplot. If that is missing, says so and leaves the script. */
void picture_close(const struct picture *picture);

/* How a solid looks from `eye` (a direction, z up): columns right, up and a colour of each
 * particle, the nearest last, for gnuplot to draw one over the other. */
void picture_project(FILE *table, const double eye[3], int count, double (*x)[3],
                     const double *colour);
#endif
