/* SPDX-License-Identifier: MIT */
/* Positions into rows, and rows into cells. */

/* x y z 0 of a view of `count` components; false: one is not finite. */
SPHGI_TEMPLATE bool read_as(const struct sphgi_columns *columns, int64_t begin, int64_t end,
                            real *row, int32_t count)
{
    real difference = R(0); /* of x - x: 0, or NaN */
    for (int64_t k = begin; k < end; ++k, row += SPHGI_ROW) {
        const ptrdiff_t offset = (ptrdiff_t)k * columns->stride;
        row[2] = row[3] = R(0);
        for (int32_t c = 0; c < count; ++c) {
            const real x = number_at(columns->at[c] + offset);
            difference += x - x;
            row[c] = x;
        }
    }
    return difference == R(0);
}

static bool read_positions(const struct sphgi_columns *columns, int64_t begin, int64_t end,
                           void *rows)
{
    return columns->count == 3 ? read_as(columns, begin, end, rows, 3)
                               : read_as(columns, begin, end, rows, 2);
}

SPHGI_TEMPLATE real size_of(real x)
{
    return R(__builtin_fabs(x));
}

/* Of one axis; gives the largest |coordinate| that is left. */
SPHGI_TEMPLATE real reduce_axis(real *x, int64_t count, real period, real limit)
{
    real largest = R(0);
    for (int64_t k = 0; k < count; ++k, x += SPHGI_ROW) {
        if (size_of(*x) > limit)
            *x = R(__builtin_fmod(*x, period));
        largest = size_of(*x) > largest ? size_of(*x) : largest;
    }
    return largest;
}

static void take_into_box(const struct sphgi_periods *periods, int64_t count, void *rows,
                          double *largest)
{
    real most[SPHGI_ROW] = {0};
    const real *row = rows;
    for (int64_t k = 0; k < count; ++k, row += SPHGI_ROW)
        for (int c = 0; c < SPHGI_ROW; ++c)
            most[c] = size_of(row[c]) > most[c] ? size_of(row[c]) : most[c];
    for (int a = 0; a < 3; ++a) {
        const real limit = R(periods->limit[a]);
        if (most[a] > limit)
            most[a] = reduce_axis((real *)rows + a, count, R(periods->length[a]), limit);
        largest[a] = most[a] > largest[a] ? most[a] : largest[a];
    }
}

typedef double four_doubles __attribute__((vector_size(32), may_alias));
typedef int64_t four_longs __attribute__((vector_size(32), may_alias));
typedef uint64_t four_bits __attribute__((vector_size(32), may_alias));
typedef int32_t four_ints __attribute__((vector_size(16), may_alias));
typedef real four_reals
    __attribute__((vector_size(4 * sizeof(real)), aligned(__alignof__(real)), may_alias));

/* A cutting, an axis a lane. Added to `magic`, a number has its whole part in its lowest bits;
 * those of larger ones differ further up. */
struct cutter {
    four_doubles scale, magic;
    four_bits nearest;
    four_ints shift, local_shift, inside;
};

SPHGI_TEMPLATE struct cutter cutter_of(const struct sphgi_cutting *cutting)
{
    const double *inverse = cutting->inverse;
    const int32_t *s = cutting->shift, *l = cutting->local_shift;
    struct cutter c = {.scale = {inverse[0], inverse[1], inverse[2], 0},
                       .shift = {s[0], s[1], s[2], 0},
                       .local_shift = {l[0], l[1], l[2], 0},
                       .inside = {(1 << s[0]) - 1, (1 << s[1]) - 1, (1 << s[2]) - 1, 0}};
    c.magic = (four_doubles){0} + 0x1.8p52;
    c.nearest = (four_bits)c.magic - SPHGI_CUT_MOST;
    return c;
}

SPHGI_TEMPLATE bool are_near(const four_bits *far)
{
    const four_bits f = *far;
    return (f[0] | f[1] | f[2] | f[3]) < 2 * (uint64_t)SPHGI_CUT_MOST;
}

/* Block and local cell of each row, all axes at once. Products are rounded on their own: the same
 * cell must come out wherever it is computed (raster.c). False: a row is too far away. */
static bool cut(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                int32_t (*block)[4], uint8_t *local)
{
    const struct cutter c = cutter_of(cutting);
    four_bits far = {0};
    for (int32_t k = 0; k < count; ++k) {
        const four_reals row = *(const four_reals *)((const real *)rows + SPHGI_ROW * k);
        const four_doubles t = __builtin_convertvector(row, four_doubles) * c.scale;
        const four_bits bits = (four_bits)(t - 0.5 + c.magic);
        far |= bits - c.nearest;
        const four_ints cell = __builtin_convertvector((four_longs)bits, four_ints);
        *(four_ints *)block[k] = cell >> c.shift;
        const four_ints parts = (cell & c.inside) << c.local_shift;
        local[k] = (uint8_t)(parts[0] | parts[1] | parts[2]);
    }
    return are_near(&far);
}
