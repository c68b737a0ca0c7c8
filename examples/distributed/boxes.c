#include "boxes.h"
#include <math.h>

int box_with(const struct box *boxes, int count, const double *x)
{
    for (int k = 0; k < count; k++) {
        const struct box *b = &boxes[k];
        if (x[0] >= b->low[0] && x[0] < b->high[0] && x[1] >= b->low[1] && x[1] < b->high[1] &&
            x[2] >= b->low[2] && x[2] < b->high[2])
            return k;
    }
    return -1;
}

bool box_is_near(const struct box *box, const double *x, double reach)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        if (!(box->low[a] < box->high[a]))
            return false;
        const double out = fmax(fmax(box->low[a] - x[a], x[a] - box->high[a]), 0);
        square += out * out;
    }
    return square <= reach * reach;
}

const double *place_of(const struct places *places, int k)
{
    return (const double *)(const void *)((const char *)places->x + (size_t)k * places->stride);
}
