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
SPHGI_TEMPLATE bool cut_one_by_one(const struct sphgi_cutting *cutting, const void *rows,
                                   int32_t begin, int32_t end, int32_t (*block)[4], uint8_t *local)
{
    const struct cutter c = cutter_of(cutting);
    four_bits far = {0};
    for (int32_t k = begin; k < end; ++k) {
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

#if VECTOR_BYTES == 64 && !REAL_IS_F64
/* The same of LANES rows, an axis after the other. */
SPHGI_TEMPLATE __m512i cells_along(vec x, double inverse, __m512i *far)
{
    const __m512d scale = _mm512_set1_pd(inverse), half = _mm512_set1_pd(0.5);
    const __m512d magic = _mm512_set1_pd(0x1.8p52);
    const __m512i nearest =
        _mm512_sub_epi64(_mm512_castpd_si512(magic), _mm512_set1_epi64(SPHGI_CUT_MOST));
    const __m256 parts[2] = {_mm512_castps512_ps256((__m512)x),
                             _mm512_extractf32x8_ps((__m512)x, 1)};
    __m256i cells[2];
    for (int k = 0; k < 2; ++k) {
        const __m512d t = _mm512_mul_pd(_mm512_cvtps_pd(parts[k]), scale);
        const __m512i bits = _mm512_castpd_si512(_mm512_add_pd(_mm512_sub_pd(t, half), magic));
        *far = _mm512_or_si512(*far, _mm512_sub_epi64(bits, nearest));
        cells[k] = _mm512_cvtepi64_epi32(bits);
    }
    return _mm512_inserti64x4(_mm512_castsi256_si512(cells[0]), cells[1], 1);
}

SPHGI_TEMPLATE int32_t cut_together(const struct sphgi_cutting *cutting, const real *rows,
                                    int32_t count, int32_t (*block)[4], uint8_t *local, bool *near)
{
    __m512i far = _mm512_setzero_si512();
    int32_t k = 0;
    for (; k + LANES <= count; k += LANES) {
        const struct three at = coordinates_of(rows + SPHGI_ROW * k);
        const vec x[3] = {at.x, at.y, at.z};
        __m512i blocks[3], inside = _mm512_setzero_si512();
        for (int a = 0; a < 3; ++a) {
            const __m512i cells = cells_along(x[a], cutting->inverse[a], &far);
            const __m512i own =
                _mm512_and_si512(cells, _mm512_set1_epi32((1 << cutting->shift[a]) - 1));
            blocks[a] = _mm512_sra_epi32(cells, _mm_cvtsi32_si128(cutting->shift[a]));
            inside = _mm512_or_si512(
                inside, _mm512_sll_epi32(own, _mm_cvtsi32_si128(cutting->local_shift[a])));
        }
        rows_of((struct four){(vec)blocks[0], (vec)blocks[1], (vec)blocks[2], (vec){0}},
                (quad *)(void *)block[k]);
        _mm_storeu_si128((__m128i *)(void *)(local + k), _mm512_cvtepi32_epi8(inside));
    }
    *near = _mm512_cmpge_epu64_mask(far, _mm512_set1_epi64(2 * (int64_t)SPHGI_CUT_MOST)) == 0;
    return k;
}
#else
SPHGI_TEMPLATE int32_t cut_together(const struct sphgi_cutting *cutting, const real *rows,
                                    int32_t count, int32_t (*block)[4], uint8_t *local, bool *near)
{
    (void)cutting, (void)rows, (void)count, (void)block, (void)local;
    *near = true;
    return 0;
}
#endif

static bool cut(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                int32_t (*block)[4], uint8_t *local)
{
    bool near;
    const int32_t done = cut_together(cutting, rows, count, block, local, &near);
    return cut_one_by_one(cutting, rows, done, count, block, local) && near;
}
