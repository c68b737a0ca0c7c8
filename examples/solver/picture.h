/* Pictures by gnuplot: SCENE.gp and SCENE.png beside the tables of the runs. */
#ifndef SOLVER_PICTURE_H
#define SOLVER_PICTURE_H
#include <stdbool.h>
#include <stdio.h>

struct picture {
    const char *directory, *name;
    bool full;    /* the runs had their full size */
    FILE *script; /* gnuplot commands go here */
};

struct picture picture_open(const char *directory, const char *name, bool full);

/* width x height [pixel], and panels side by side. */
void picture_begin(const struct picture *picture, int width, int height, int rows, int columns);

/* Runs gnuplot. If that is missing, says so and leaves the script. */
void picture_close(const struct picture *picture);

/* How a solid looks from `eye` (a direction, z up): columns right, up and a colour of each
 * particle, the nearest last, for gnuplot to draw one over the other. */
void picture_project(FILE *table, const double eye[3], int count, double (*x)[3],
                     const double *colour);
#endif
