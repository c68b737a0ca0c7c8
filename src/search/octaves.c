/* SPDX-License-Identifier: MIT */
#include "octaves.h"
#include <string.h>

enum { Z_SHIFT = 38 }; /* blocks of an octave have |z| below half of 2^Z_SHIFT */

/* Positive numbers rise as their bits do: the quotient's exponent, rounded down. */
static int32_t octaves_between(double large, double small)
{
    int64_t a, b;
    memcpy(&a, &large, sizeof a);
    memcpy(&b, &small, sizeof b);
    return (int32_t)((a - b) >> 52);
}

int32_t sphgi_octaves_for(const struct sphgi_raster *raster, double least, const double *largest_x)
{
    int32_t octaves = sphgi_min32(octaves_between(raster->top, least) + 1, SPHGI_OCTAVES_MOST);
    for (int32_t a = 0; a < raster->dimension; ++a) {
        const struct sphgi_axis *axis = &raster->axis[a];
        double cells = axis->cells ? (double)axis->cells : largest_x[a] * axis->inverse;
        cells *= (double)((int64_t)1 << (octaves - 1));
        for (; octaves > 1 && !(cells < 0x1p36); cells /= 2)
            --octaves;
    }
    return octaves;
}

int32_t sphgi_octave_of(const struct sphgi_raster *raster, double radius)
{
    return sphgi_min32(octaves_between(raster->top, radius), raster->octaves - 1);
}

/* An only octave may reach as far as keys do. */
void sphgi_raise_octave(int32_t octave, int64_t *at)
{
    at[2] += (int64_t)octave << Z_SHIFT;
}

int32_t sphgi_lower_octave(int64_t *at)
{
    const int64_t octave = (at[2] + ((int64_t)1 << (Z_SHIFT - 1))) >> Z_SHIFT;
    at[2] -= octave << Z_SHIFT;
    return (int32_t)octave;
}
