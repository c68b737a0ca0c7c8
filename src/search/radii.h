/* SPDX-License-Identifier: MIT */
/* Radii of their own: read from the host's views, checked, and put beside the positions. */
#ifndef SPHGI_RADII_H
#define SPHGI_RADII_H
#include "core/check.h"

struct sphgi_radii {
    double least, largest;
};

bool sphgi_has_radii(const sphg_geometry *given);

/* Looks at all of them. Without any particle both numbers are 1. */
sphg_result sphgi_look_at_radii(struct sphgi_checker checker, const sphg_geometry *given,
                                struct sphgi_radii *radii);

/* The 4th numbers of count rows of positions of that type. */
void sphgi_put_radii(sphg_context *context, const sphg_view *radii, int32_t count, void *rows);

#endif
