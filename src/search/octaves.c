/* SPDX-License-Identifier: MIT */
#include "octaves.h"
#include <math.h>
#include <string.h>

enum { Z_SHIFT = 38 }; /* blocks of an octave have |z| below half of 2^Z_SHIFT */

/* Positive numbers rise as their bits do: the quotient's exponent, rounded down, or as many steps
 * as octaves have quarters. */
static int32_t steps_between(double large, double small, int32_t bits)
{
    int64_t a, b;
    memcpy(&a, &large, sizeof a);
    memcpy(&b, &small, sizeof b);
    return (int32_t)((a - b) >> (52 - bits));
}

static int32_t octaves_between(double large, double small)
{
    return steps_between(large, small, 0);
}

int32_t sphgi_octaves_for(const struct sphgi_raster *raster, double least, const double *largest_x)
{
    int32_t octaves = sphgi_min32(octaves_between(raster->top, least) + 1, SPHGI_OCTAVES_MOST);
    for (int32_t a = 0; a < raster->dimension; ++a) {
        const struct sphgi_axis *axis = &raster->axis[a];
        double cells = axis->cells ? (double)axis->cells
                                   : largest_x[sphgi_number_of_axis(raster, a)] * axis->inverse;
        cells *= (double)((int64_t)1 << (octaves - 1));
        while (octaves > 1 && !(cells < 0x1p36)) {
            cells /= 2;
            --octaves;
        }
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

/* ---- The axis of bars ------------------------------------------------------------------------ */

enum { LOOKED_AT = 1 << 14, CLASS_BITS = 2, CLASSES = SPHGI_OCTAVES_MOST << CLASS_BITS };

/* Sums over the particles of a class of radii, coordinates counted from its first. */
struct extent {
    double count, first[3], sum[3], square[3];
};

static double number_in(const struct sphgi_strewn *strewn, int32_t i, int32_t number)
{
    const size_t k = SPHGI_ROW * (size_t)i + (size_t)number;
    return strewn->type == SPHG_F64 ? ((const double *)strewn->rows)[k]
                                    : (double)((const float *)strewn->rows)[k];
}

static void add(struct extent *extent, const struct sphgi_strewn *strewn, int32_t i)
{
    for (int32_t a = 0; a < strewn->dimension; ++a) {
        const double x = number_in(strewn, i, a);
        if (extent->count == 0)
            extent->first[a] = x;
        extent->sum[a] += x - extent->first[a];
        extent->square[a] += (x - extent->first[a]) * (x - extent->first[a]);
    }
    ++extent->count;
}

/* How far the particles of a class are spread along an axis, times their number. */
static double spread_of(const struct extent *extent, int32_t a)
{
    const double mean = extent->sum[a] / extent->count;
    const double square = extent->square[a] / extent->count - mean * mean;
    return square > 0 ? extent->count * sqrt(square) : 0;
}

int32_t sphgi_longest_axis(const struct sphgi_strewn *strewn)
{
    const double worth = 1.5;
    struct extent extents[CLASSES] = {{0}};
    double cells[3] = {0};
    const int32_t step = sphgi_max32(1, strewn->count / LOOKED_AT);
    for (int64_t i = 0; i < strewn->count; i += step) {
        const double radius = number_in(strewn, (int32_t)i, SPHGI_ROW - 1);
        const int32_t class = steps_between(strewn->top, radius, CLASS_BITS);
        add(&extents[sphgi_min32(class, CLASSES - 1)], strewn, (int32_t)i);
    }
    for (int32_t k = 0; k < CLASSES; ++k)
        for (int32_t a = 0; a < strewn->dimension && extents[k].count > 0; ++a)
            cells[a] += spread_of(&extents[k], a) * (double)((int64_t)1 << (k >> CLASS_BITS));
    int32_t longest = 0;
    for (int32_t a = 1; a < 3; ++a)
        if (cells[a] > worth * cells[longest])
            longest = a;
    return longest;
}
