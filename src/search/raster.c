/* SPDX-License-Identifier: MIT */
/* How space is cut into cells and blocks. */
#include "raster.h"
#include <math.h>
#include <string.h>

/* Particles closer than the reach must lie in the same or in adjacent cells, for every finite
 * coordinate. t is the coordinate in cells, with a relative error of 2^-52.
 *   |t| < 2^29   t - 1/2 rounded to a whole number, as the pass that cuts rows does it: cells are
 *                wider than the reach by 2^-9, and the error is far below that
 *   |t| < 2^40   floor(t), the same but for whole t: the error is below 2^-11 cells
 *   |t| < 2^54   2^14 times coarser beyond 2^40: monotone, slope at most 1, and the error stays
 * small beyond       neighbouring coordinates there are more than a reach apart, so that neighbours
 * have equal coordinates: any monotone map will do, the bits themselves serve. */
static double far_cell(double a)
{
    static const double first = 0x1p40, second = 0x1p54;
    if (a < second)
        return first + (a - first) * 0x1p-14;
    uint64_t bits, base;
    memcpy(&bits, &a, sizeof bits);
    memcpy(&base, &second, sizeof base);
    return 2 * first + (double)((bits - base) >> 22);
}

static int64_t floor_to_int(double t)
{
    const int64_t whole = (int64_t)t;
    return whole - (t < (double)whole);
}

static int64_t open_cell(double t)
{
    const double magic = 0x1.8p52, centred = t - 0.5;
    if (centred < SPHGI_CUT_MOST && centred > -SPHGI_CUT_MOST)
        return (int64_t)((centred + magic) - magic);
    /* cppcheck-suppress incorrectLogicOperator ; it reads 0x1p40 as 0 */
    if (t < 0x1p40 && t > -0x1p40)
        return floor_to_int(t);
    return t > 0 ? floor_to_int(far_cell(t)) : floor_to_int(-far_cell(-t));
}

/* ---- Periods -------------------------------------------------------------------------------- */

static double unit_of(sphg_type type)
{
    return type == SPHG_F64 ? 0x1p-53 : 0x1p-24;
}

/* Coordinates stay as they are while they lie within a period or are rounded to 2^-8 H or less:
 * what is farther out would make all cells wider, and at last no whole number of periods would be
 * exact any more. */
struct sphgi_periods sphgi_periods_of(int32_t dimension, double radius, const double *period,
                                      sphg_type type)
{
    struct sphgi_periods periods;
    const double coarse = radius * 0x1p-8 / unit_of(type);
    for (int32_t a = 0; a < 3; ++a) {
        const double given = a < dimension ? period[a] : 0;
        const double length = type == SPHG_F64 ? given : (double)(float)given;
        periods.length[a] = length;
        periods.limit[a] = length > 0 ? fmax(length, coarse) : INFINITY;
    }
    return periods;
}

/* With |x| <= m, the difference D of two coordinates is off by 2 u m, and k L, which is exact for
 * |k| <= 2 and else at most 4/3 |D|, by 8/3 u m. That is less than 5 u m; dividing by the period
 * when cells are numbered (f64) adds u m for each of the two. */
static double axis_slack(double largest, sphg_type type)
{
    return 8 * unit_of(type) * largest;
}

double sphgi_slack_of(const struct sphgi_periods *periods, const double *largest, sphg_type type)
{
    double most = 0;
    for (int32_t a = 0; a < 3; ++a)
        if (periods->length[a] > 0)
            most = fmax(most, axis_slack(largest[a], type));
    return most;
}

/* ---- Cells ---------------------------------------------------------------------------------- */

/* Gives the coordinate in cells, too. */
double sphgi_place_on_axis(const struct sphgi_axis *axis, int32_t octave, double x, int64_t *cell)
{
    if (!axis->cells) {
        const double place = x * axis->inverse * (double)((int64_t)1 << octave);
        *cell = open_cell(place);
        return place;
    }
    const int64_t cells = axis->cells << octave;
    double turns = x / axis->length;
    turns -= __builtin_floor(turns);
    const double place = turns * (double)cells;
    *cell = (int64_t)place < cells ? (int64_t)place : cells - 1;
    return place;
}

void sphgi_cell_of(const struct sphgi_raster *raster, const double *x, int64_t *cell)
{
    for (int32_t a = 0; a < 3; ++a)
        if (a < raster->dimension)
            sphgi_place_on_axis(&raster->axis[a], 0, x[a], &cell[a]);
        else
            cell[a] = 0;
}

struct sphgi_raster sphgi_raster_of(int32_t dimension, double reach, struct sphgi_bars bars,
                                    const struct sphgi_periods *periods, const double *largest,
                                    sphg_type type)
{
    struct sphgi_raster raster = {.dimension = dimension,
                                  .along = bars.along,
                                  .slack = sphgi_slack_of(periods, largest, type)};
    for (int32_t a = 0; a < 3; ++a) {
        const double width = reach * (1 + 0x1p-9) * (a ? bars.across : 1);
        const int32_t number = sphgi_number_of_axis(&raster, a);
        struct sphgi_axis *axis = &raster.axis[a];
        *axis = (struct sphgi_axis){.inverse = 1 / width, .low = -1, .high = 1};
        axis->shift = a ? 0 : SPHGI_BLOCK_SHIFT;
        if (a >= dimension)
            *axis = (struct sphgi_axis){.shift = 0};
        else if (periods->length[number] > 0) {
            const double cells =
                periods->length[number] / (width + axis_slack(largest[number], type));
            raster.periodic = true;
            axis->length = periods->length[number];
            axis->cells = cells < 1 ? 1 : cells < 0x1p40 ? (int64_t)cells : (int64_t)1 << 40;
            axis->low = axis->cells >= 3 ? -1 : 0;
            axis->high = axis->cells >= 2 ? 1 : 0;
        }
    }
    return raster;
}

static bool same_axis(const struct sphgi_axis *a, const struct sphgi_axis *b)
{
    return a->inverse == b->inverse && a->length == b->length && a->cells == b->cells &&
           a->shift == b->shift && a->low == b->low && a->high == b->high;
}

bool sphgi_same_raster(const struct sphgi_raster *a, const struct sphgi_raster *b)
{
    bool same = a->dimension == b->dimension && a->periodic == b->periodic &&
                a->octaves == b->octaves && a->top == b->top && a->along == b->along;
    for (int32_t k = 0; k < 3; ++k)
        same = same && same_axis(&a->axis[k], &b->axis[k]);
    return same;
}

struct sphgi_cutting sphgi_cutting_of(const struct sphgi_raster *raster)
{
    struct sphgi_cutting cutting = {
        .octaves = raster->octaves, .top = raster->top, .along = raster->along};
    int32_t local = 0;
    for (int32_t a = 0; a < 3; ++a) {
        const int32_t number = sphgi_number_of_axis(raster, a);
        cutting.inverse[number] = raster->axis[a].inverse;
        cutting.shift[number] = raster->axis[a].shift;
        cutting.local_shift[number] = local;
        local += raster->axis[a].shift;
    }
    return cutting;
}

int32_t sphgi_local_cell(const struct sphgi_raster *raster, const int64_t *cell)
{
    int32_t local = 0;
    for (int32_t a = 2; a >= 0; --a) {
        const int32_t shift = raster->axis[a].shift;
        local = local << shift | (int32_t)(cell[a] & ((1 << shift) - 1));
    }
    return local;
}
