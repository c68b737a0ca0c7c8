/* SPDX-License-Identifier: MIT */
/* Rows with radii of their own into the cells of their octaves (search/octaves.h). */

/* 2^k, k the whole number of times that a radius goes into the largest by halves, at most `most`:
 * bits of positive numbers rise as these do. */
SPHGI_TEMPLATE int32_t octave_of(int64_t top, double radius, int32_t most)
{
    int64_t bits;
    __builtin_memcpy(&bits, &radius, sizeof bits);
    const int64_t octave = (top - bits) >> 52;
    return octave < most ? (int32_t)octave : most;
}

SPHGI_TEMPLATE double two_to_the(int32_t exponent)
{
    const int64_t bits = (int64_t)(1023 + exponent) << 52;
    double power;
    __builtin_memcpy(&power, &bits, sizeof power);
    return power;
}

/* Block and octave, and quarter of one of its cells of each row; as `cut` does it, in cells that
 * are as many times smaller. */
SPHGI_TEMPLATE bool cut_octaves_one_by_one(const struct sphgi_cutting *cutting, const void *rows,
                                           int32_t begin, int32_t end, int32_t (*block)[4],
                                           uint8_t *local)
{
    const struct cutter c = cutter_of(cutting);
    int64_t top;
    __builtin_memcpy(&top, &cutting->top, sizeof top);
    four_bits far = {0};
    for (int32_t k = begin; k < end; ++k) {
        const four_reals row = *(const four_reals *)((const real *)rows + SPHGI_ROW * k);
        const int32_t octave = octave_of(top, (double)row[3], cutting->octaves - 1);
        const four_doubles t =
            __builtin_convertvector(row, four_doubles) * c.scale * two_to_the(octave);
        const four_doubles raised = t - 0.5 + c.magic, whole = raised - c.magic;
        const four_bits bits = (four_bits)raised;
        far |= bits - c.nearest;
        const four_ints cell = __builtin_convertvector((four_longs)bits, four_ints);
        const four_ints parts = (cell & c.inside) << c.local_shift;
        four_ints at = cell >> c.shift;
        const int32_t first = at[0];
        at[3] = octave;
        at[0] = at[cutting->along];
        at[cutting->along] = first;
        *(four_ints *)block[k] = at;
        local[k] = (uint8_t)((parts[0] | parts[1] | parts[2]) * SPHGI_QUARTERS +
                             sphgi_quarter_of(t[cutting->along] - whole[cutting->along]));
    }
    return are_near(&far);
}

#if VECTOR_BYTES == 64 && !REAL_IS_F64
/* Numbers of LANES rows as doubles, in two halves. */
struct halves {
    __m512d half[2];
};

SPHGI_TEMPLATE struct halves halves_of(vec x)
{
    return (struct halves){{_mm512_cvtps_pd(_mm512_castps512_ps256((__m512)x)),
                            _mm512_cvtps_pd(_mm512_extractf32x8_ps((__m512)x, 1))}};
}

SPHGI_TEMPLATE __m512i joined_ints(__m256i low, __m256i high)
{
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

/* Octaves of radii; these become what two to the power of them is. */
SPHGI_TEMPLATE __m512i octaves_of(const struct sphgi_cutting *cutting, struct halves *radii)
{
    const __m512d top = _mm512_set1_pd(cutting->top);
    const __m512i most = _mm512_set1_epi64(cutting->octaves - 1);
    __m256i octaves[2];
    for (int k = 0; k < 2; ++k) {
        const __m512i below =
            _mm512_sub_epi64(_mm512_castpd_si512(top), _mm512_castpd_si512(radii->half[k]));
        const __m512i octave = _mm512_min_epi64(_mm512_srai_epi64(below, 52), most);
        const __m512i exponent = _mm512_add_epi64(octave, _mm512_set1_epi64(1023));
        radii->half[k] = _mm512_castsi512_pd(_mm512_slli_epi64(exponent, 52));
        octaves[k] = _mm512_cvtepi64_epi32(octave);
    }
    return joined_ints(octaves[0], octaves[1]);
}

/* Cells along an axis, and the quarters of these. */
SPHGI_TEMPLATE __m512i cells_in_octaves(vec x, double inverse, const struct halves *powers,
                                        __m512i *far, __m512i *quarters)
{
    const __m512d scale = _mm512_set1_pd(inverse), half = _mm512_set1_pd(0.5);
    const __m512d magic = _mm512_set1_pd(0x1.8p52), parts = _mm512_set1_pd(SPHGI_QUARTERS);
    const __m512i nearest =
        _mm512_sub_epi64(_mm512_castpd_si512(magic), _mm512_set1_epi64(SPHGI_CUT_MOST));
    const struct halves at = halves_of(x);
    __m256i cells[2], quarter[2];
    for (int k = 0; k < 2; ++k) {
        const __m512d t = _mm512_mul_pd(_mm512_mul_pd(at.half[k], scale), powers->half[k]);
        const __m512d raised = _mm512_add_pd(_mm512_sub_pd(t, half), magic);
        const __m512d inside = _mm512_sub_pd(t, _mm512_sub_pd(raised, magic));
        const __m512i bits = _mm512_castpd_si512(raised);
        *far = _mm512_or_si512(*far, _mm512_sub_epi64(bits, nearest));
        cells[k] = _mm512_cvtepi64_epi32(bits);
        quarter[k] = _mm512_cvttpd_epi32(_mm512_mul_pd(inside, parts));
    }
    *quarters = joined_ints(quarter[0], quarter[1]);
    *quarters = _mm512_max_epi32(*quarters, _mm512_setzero_si512());
    *quarters = _mm512_min_epi32(*quarters, _mm512_set1_epi32(SPHGI_QUARTERS - 1));
    return joined_ints(cells[0], cells[1]);
}

/* The same of LANES rows, an axis after the other; returns how many rows are done. */
SPHGI_TEMPLATE int32_t cut_octaves_together(const struct sphgi_cutting *cutting, const real *rows,
                                            int32_t count, int32_t (*block)[4], uint8_t *local,
                                            bool *near)
{
    const __m512i most = _mm512_set1_epi64(2 * (int64_t)SPHGI_CUT_MOST);
    __m512i far = _mm512_setzero_si512();
    int32_t k = 0;
    for (; k + LANES <= count; k += LANES) {
        const real *row[LANES];
        for (int l = 0; l < LANES; ++l)
            row[l] = rows + SPHGI_ROW * (k + l);
        const struct four at = transpose(row);
        const vec x[3] = {at.x, at.y, at.z};
        struct halves powers = halves_of(at.w);
        const __m512i octaves = octaves_of(cutting, &powers);
        __m512i blocks[3], quarters[3], inside = _mm512_setzero_si512();
        for (int a = 0; a < 3; ++a) {
            const __m512i cells =
                cells_in_octaves(x[a], cutting->inverse[a], &powers, &far, &quarters[a]);
            const __m512i own =
                _mm512_and_si512(cells, _mm512_set1_epi32((1 << cutting->shift[a]) - 1));
            blocks[a] = _mm512_sra_epi32(cells, _mm_cvtsi32_si128(cutting->shift[a]));
            inside = _mm512_or_si512(
                inside, _mm512_sll_epi32(own, _mm_cvtsi32_si128(cutting->local_shift[a])));
        }
        const int along = cutting->along;
        const __m512i first = blocks[along];
        blocks[along] = blocks[0];
        rows_of((struct four){(vec)first, (vec)blocks[1], (vec)blocks[2], (vec)octaves},
                (quad *)(void *)block[k]);
        inside = _mm512_add_epi32(_mm512_mullo_epi32(inside, _mm512_set1_epi32(SPHGI_QUARTERS)),
                                  quarters[along]);
        _mm_storeu_si128((__m128i *)(void *)(local + k), _mm512_cvtepi32_epi8(inside));
    }
    *near = _mm512_cmpge_epu64_mask(far, most) == 0;
    return k;
}
#else
SPHGI_TEMPLATE int32_t cut_octaves_together(const struct sphgi_cutting *cutting, const real *rows,
                                            int32_t count, int32_t (*block)[4], uint8_t *local,
                                            bool *near)
{
    (void)cutting, (void)rows, (void)count, (void)block, (void)local;
    *near = true;
    return 0;
}
#endif

static bool cut_octaves(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                        int32_t (*block)[4], uint8_t *local)
{
    bool near;
    const int32_t done = cut_octaves_together(cutting, rows, count, block, local, &near);
    return cut_octaves_one_by_one(cutting, rows, done, count, block, local) && near;
}
