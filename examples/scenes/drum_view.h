/* SPDX-License-Identifier: MIT */
/* The washing machine as pictures: seen from the front, where the front half of the drum and of the
 * fluids is cut away, or they would hide the bunny. */
#ifndef EXAMPLES_DRUM_VIEW_H
#define EXAMPLES_DRUM_VIEW_H
#include "bunny.h"
#include "drum.h"
#include "solver/picture.h"

struct drum_view {
    const struct load *load;
    const struct wall *wall;
    const enum bunny_part *parts; /* of the body's particles */
    double spacing, angle;        /* by which the drum has turned [rad] */
};

/* A line for each disc, the nearest last: right, up, radius, what it is, nearness. */
void drum_view_write(const struct drum_view *view, FILE *table);

/* Two panels of the tables washing_machine_METHOD_drum.dat, or of a frame's. */
void drum_view_draw(const struct picture *picture, double time);
#endif
