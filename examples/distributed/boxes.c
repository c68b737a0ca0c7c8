/* SPDX-License-Identifier: MIT */
#include "boxes.h"
#include <math.h>

bool box_holds(const struct box *box, const double *x)
{
    for (int a = 0; a < 3; ++a)
        if (!(x[a] >= box->low[a] && x[a] < box->high[a]))
            return false;
    return true;
}

static bool is_empty(const struct box *box)
{
    return !(box->low[0] < box->high[0] && box->low[1] < box->high[1] &&
             box->low[2] < box->high[2]);
}

bool boxes_are_near(const struct box *box, const struct box *other, double reach)
{
    double square = 0;
    if (is_empty(box) || is_empty(other))
        return false;
    for (int a = 0; a < 3; ++a) {
        const double gap =
            fmax(fmax(box->low[a] - other->high[a], other->low[a] - box->high[a]), 0);
        square += gap * gap;
    }
    return square <= reach * reach;
}

bool box_is_near(const struct box *box, const double *x, double reach)
{
    double square = 0;
    if (is_empty(box))
        return false;
    for (int a = 0; a < 3; ++a) {
        const double gap = fmax(fmax(box->low[a] - x[a], x[a] - box->high[a]), 0);
        square += gap * gap;
    }
    return square <= reach * reach;
}

const double *place_of(const struct places *places, int k)
{
    return (const double *)(const void *)((const char *)places->x + (size_t)k * places->stride);
}

cutter *best_cut(void)
{
#ifdef WITH_ZOLTAN
    return cut_by_bisection;
#else
    return cut_into_slabs;
#endif
}
