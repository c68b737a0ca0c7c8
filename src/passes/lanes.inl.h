/* SPDX-License-Identifier: MIT */
/* What crosses the lanes of vectors: rows of four numbers turned into vectors and back. */

/* Four numbers each of LANES rows, as four vectors. */
struct four {
    vec x, y, z, w;
};

typedef real quad
    __attribute__((vector_size(4 * sizeof(real)), aligned(__alignof__(real)), may_alias));

#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 == 8 /* eight lanes, of AVX-512 or of AVX2 */
#if REAL_IS_F64
SPHGI_TEMPLATE vec joined(quad low, quad high)
{
    return (vec)_mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)low), (__m256d)high, 1);
}
SPHGI_TEMPLATE quad lower(vec v)
{
    return (quad)_mm512_castpd512_pd256((__m512d)v);
}
SPHGI_TEMPLATE quad upper(vec v)
{
    return (quad)_mm512_extractf64x4_pd((__m512d)v, 1);
}
#else
SPHGI_TEMPLATE vec joined(quad low, quad high)
{
    return (vec)_mm256_insertf128_ps(_mm256_castps128_ps256((__m128)low), (__m128)high, 1);
}
SPHGI_TEMPLATE quad lower(vec v)
{
    return (quad)_mm256_castps256_ps128((__m256)v);
}
SPHGI_TEMPLATE quad upper(vec v)
{
    return (quad)_mm256_extractf128_ps((__m256)v, 1);
}
#endif
SPHGI_TEMPLATE vec two_rows(const real *low, const real *high)
{
    return joined(*(const quad *)low, *(const quad *)high);
}
/* [row][number] to [number][row] in each half, and back. */
SPHGI_TEMPLATE struct four turned(vec a, vec b, vec c, vec d)
{
    const vec ab = SHUFFLED(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const vec AB = SHUFFLED(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const vec cd = SHUFFLED(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const vec CD = SHUFFLED(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    return (struct four){
        SHUFFLED(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13), SHUFFLED(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
        SHUFFLED(AB, CD, 0, 1, 8, 9, 4, 5, 12, 13), SHUFFLED(AB, CD, 2, 3, 10, 11, 6, 7, 14, 15)};
}
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    return turned(two_rows(row[0], row[4]), two_rows(row[1], row[5]), two_rows(row[2], row[6]),
                  two_rows(row[3], row[7]));
}
SPHGI_TEMPLATE void put_parts(vec v, quad *to)
{
    to[0] = lower(v);
    to[4] = upper(v);
}
#elif VECTOR_BYTES == 64
SPHGI_TEMPLATE __m256 two_rows(const real *low, const real *high)
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
}
/* By halves: three insertions one after the other would wait for each other. */
SPHGI_TEMPLATE vec four_rows(const real *const *row)
{
    const __m512d low = _mm512_castpd256_pd512(_mm256_castps_pd(two_rows(row[0], row[4])));
    return (vec)_mm512_insertf64x4(low, _mm256_castps_pd(two_rows(row[8], row[12])), 1);
}
/* [row][number] to [number][row] in each quarter, and back. */
SPHGI_TEMPLATE struct four turned(vec a, vec b, vec c, vec d)
{
    const __m512 ab = _mm512_unpacklo_ps((__m512)a, (__m512)b);
    const __m512 AB = _mm512_unpackhi_ps((__m512)a, (__m512)b);
    const __m512 cd = _mm512_unpacklo_ps((__m512)c, (__m512)d);
    const __m512 CD = _mm512_unpackhi_ps((__m512)c, (__m512)d);
    return (struct four){(vec)_mm512_shuffle_ps(ab, cd, 0x44), (vec)_mm512_shuffle_ps(ab, cd, 0xee),
                         (vec)_mm512_shuffle_ps(AB, CD, 0x44),
                         (vec)_mm512_shuffle_ps(AB, CD, 0xee)};
}
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    return turned(four_rows(row), four_rows(row + 1), four_rows(row + 2), four_rows(row + 3));
}
SPHGI_TEMPLATE void put_parts(vec v, quad *to)
{
    to[0] = (quad)_mm512_extractf32x4_ps((__m512)v, 0);
    to[4] = (quad)_mm512_extractf32x4_ps((__m512)v, 1);
    to[8] = (quad)_mm512_extractf32x4_ps((__m512)v, 2);
    to[12] = (quad)_mm512_extractf32x4_ps((__m512)v, 3);
}
#elif REAL_IS_F64 && VECTOR_BYTES == 16
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    const vec a = load(row[0]), A = load(row[0] + 2), b = load(row[1]), B = load(row[1] + 2);
    return (struct four){SHUFFLED(a, b, 0, 2), SHUFFLED(a, b, 1, 3), SHUFFLED(A, B, 0, 2),
                         SHUFFLED(A, B, 1, 3)};
}
SPHGI_TEMPLATE void rows_of(struct four v, quad *rows)
{
    for (int l = 0; l < 2; ++l)
        rows[l] = (quad){v.x[l], v.y[l], v.z[l], v.w[l]};
}
#else /* four lanes */
SPHGI_TEMPLATE struct four turned(vec a, vec b, vec c, vec d)
{
    const vec ab = SHUFFLED(a, b, 0, 4, 2, 6);
    const vec AB = SHUFFLED(a, b, 1, 5, 3, 7);
    const vec cd = SHUFFLED(c, d, 0, 4, 2, 6);
    const vec CD = SHUFFLED(c, d, 1, 5, 3, 7);
    return (struct four){SHUFFLED(ab, cd, 0, 1, 4, 5), SHUFFLED(AB, CD, 0, 1, 4, 5),
                         SHUFFLED(ab, cd, 2, 3, 6, 7), SHUFFLED(AB, CD, 2, 3, 6, 7)};
}
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    return turned(load(row[0]), load(row[1]), load(row[2]), load(row[3]));
}
SPHGI_TEMPLATE void rows_of(struct four v, quad *rows)
{
    const struct four t = turned(v.x, v.y, v.z, v.w);
    rows[0] = (quad)t.x;
    rows[1] = (quad)t.y;
    rows[2] = (quad)t.z;
    rows[3] = (quad)t.w;
}
#endif

#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 >= 8
SPHGI_TEMPLATE void rows_of(struct four v, quad *rows)
{
    const struct four t = turned(v.x, v.y, v.z, v.w);
    put_parts(t.x, rows);
    put_parts(t.y, rows + 1);
    put_parts(t.z, rows + 2);
    put_parts(t.w, rows + 3);
}
#endif

/* The rows that the first LANES ids stand for. */
SPHGI_TEMPLATE struct four gather_rows(const real *rows, const uint32_t *ids)
{
    const real *row[LANES];
    for (int l = 0; l < LANES; ++l)
        row[l] = rows + SPHGI_ROW / SPHGI_ID_STEP * (size_t)ids[l];
    return transpose(row);
}
