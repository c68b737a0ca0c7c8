/* Vectors of REAL: GCC and Clang vector extensions, and the few operations that those lack.
 * Parameters: REAL_IS_F64. Gives real, vec, mask, LANES, U (unit roundoff). */
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifdef __AVX2__
#define VECTOR_BYTES 32
#else
#define VECTOR_BYTES 16
#endif

#define R(x) ((real)(x))
#if REAL_IS_F64
typedef double real;
typedef int64_t lane_int;
#define UNIT_ROUNDOFF 0x1p-53
#else
typedef float real;
typedef int32_t lane_int;
#define UNIT_ROUNDOFF 0x1p-24
#endif
#define LANES ((int)(VECTOR_BYTES / sizeof(real)))

typedef real vec __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef lane_int mask __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef real vec_anywhere
    __attribute__((vector_size(VECTOR_BYTES), aligned(__alignof__(real)), may_alias));

SPHGI_TEMPLATE vec load(const real *p)
{
    return *(const vec_anywhere *)p;
}

SPHGI_TEMPLATE void store(real *p, vec v)
{
    *(vec_anywhere *)p = v;
}

SPHGI_TEMPLATE vec splat(real x)
{
    return x - (vec){0};
}

SPHGI_TEMPLATE vec where(mask m, vec v) /* v where m, else +0 */
{
    return (vec)(m & (mask)v);
}

SPHGI_TEMPLATE vec select(mask m, vec a, vec b) /* whole lanes: a where m, else b */
{
#if defined(__AVX2__) && REAL_IS_F64
    return (vec)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m);
#elif defined(__AVX2__)
    return (vec)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m);
#else
    return (vec)((m & (mask)a) | (~m & (mask)b));
#endif
}

SPHGI_TEMPLATE vec vabs(vec v)
{
    return (vec)((mask)v & ~(mask)splat(R(-0.0)));
}

#if defined(__AVX2__) && REAL_IS_F64
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)_mm256_sqrt_pd((__m256d)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return (vec)_mm256_max_pd((__m256d)a, (__m256d)b);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    return (unsigned)_mm256_movemask_pd((__m256d)m);
}
#elif defined(__AVX2__)
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)_mm256_sqrt_ps((__m256)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return (vec)_mm256_max_ps((__m256)a, (__m256)b);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    return (unsigned)_mm256_movemask_ps((__m256)m);
}
#elif defined(__SSE2__) && REAL_IS_F64
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)_mm_sqrt_pd((__m128d)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return (vec)_mm_max_pd((__m128d)a, (__m128d)b);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    return (unsigned)_mm_movemask_pd((__m128d)m);
}
#elif defined(__SSE2__)
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)_mm_sqrt_ps((__m128)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return (vec)_mm_max_ps((__m128)a, (__m128)b);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    return (unsigned)_mm_movemask_ps((__m128)m);
}
#else
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    for (int k = 0; k < LANES; ++k)
        v[k] = REAL_IS_F64 ? R(__builtin_sqrt(v[k])) : R(__builtin_sqrtf((float)v[k]));
    return v;
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return select(a > b, a, b);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    unsigned bits = 0;
    for (int k = 0; k < LANES; ++k)
        bits |= (unsigned)(m[k] & 1) << k;
    return bits;
}
#endif

SPHGI_TEMPLATE vec vmin(vec a, vec b)
{
#if defined(__AVX2__) && REAL_IS_F64
    return (vec)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif defined(__AVX2__)
    return (vec)_mm256_min_ps((__m256)a, (__m256)b);
#elif defined(__SSE2__) && REAL_IS_F64
    return (vec)_mm_min_pd((__m128d)a, (__m128d)b);
#elif defined(__SSE2__)
    return (vec)_mm_min_ps((__m128)a, (__m128)b);
#else
    return -vmax(-a, -b);
#endif
}

SPHGI_TEMPLATE mask less(vec a, vec b)
{
    return (mask)(a < b);
}

SPHGI_TEMPLATE mask first_lanes(int32_t count) /* the lanes below count, which may be any number */
{
    mask numbers;
    for (int k = 0; k < LANES; ++k)
        numbers[k] = k;
    return (mask)(numbers < (mask){0} + (lane_int)count);
}

/* Keeps the compiler from fusing a product into a following sum: the neighbour predicate is
 * defined without FMA (docs/theory.md, section 1). */
SPHGI_TEMPLATE vec rounded(vec v)
{
#ifdef __FMA__
    __asm__("" : "+x"(v));
#elif defined(__aarch64__)
    __asm__("" : "+w"(v));
#endif
    return v;
}

/* sum over the lanes of a[k], for k = 0 .. LANES - 1, in lane k. */
SPHGI_TEMPLATE vec sum_across(const vec *a)
{
#if REAL_IS_F64 && VECTOR_BYTES == 16
    return __builtin_shufflevector(a[0], a[1], 0, 2) + __builtin_shufflevector(a[0], a[1], 1, 3);
#elif REAL_IS_F64
    const vec ab = __builtin_shufflevector(a[0], a[1], 0, 4, 2, 6) +
                   __builtin_shufflevector(a[0], a[1], 1, 5, 3, 7);
    const vec cd = __builtin_shufflevector(a[2], a[3], 0, 4, 2, 6) +
                   __builtin_shufflevector(a[2], a[3], 1, 5, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
           __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
#elif VECTOR_BYTES == 16
    const vec ab = __builtin_shufflevector(a[0], a[1], 0, 4, 1, 5) +
                   __builtin_shufflevector(a[0], a[1], 2, 6, 3, 7);
    const vec cd = __builtin_shufflevector(a[2], a[3], 0, 4, 1, 5) +
                   __builtin_shufflevector(a[2], a[3], 2, 6, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
           __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
#else
    vec pair[4], four[2];
    for (int k = 0; k < 4; ++k)
        pair[k] = __builtin_shufflevector(a[2 * k], a[2 * k + 1], 0, 8, 1, 9, 4, 12, 5, 13) +
                  __builtin_shufflevector(a[2 * k], a[2 * k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    for (int k = 0; k < 2; ++k)
        four[k] = __builtin_shufflevector(pair[2 * k], pair[2 * k + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
                  __builtin_shufflevector(pair[2 * k], pair[2 * k + 1], 2, 3, 10, 11, 6, 7, 14, 15);
    return __builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(four[0], four[1], 4, 5, 6, 7, 12, 13, 14, 15);
#endif
}

/* Four numbers each of LANES rows, as four vectors. at(k) is the k-th row. */
struct four {
    vec x, y, z, w;
};

typedef real quad
    __attribute__((vector_size(4 * sizeof(real)), aligned(__alignof__(real)), may_alias));

#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 == 8 /* eight lanes of f32 */
SPHGI_TEMPLATE vec two_rows(const real *low, const real *high)
{
    return __builtin_shufflevector(*(const quad *)low, *(const quad *)high, 0, 1, 2, 3, 4, 5, 6, 7);
}
/* [row][number] to [number][row] in each half, and back. */
SPHGI_TEMPLATE struct four turned(vec a, vec b, vec c, vec d)
{
    const vec ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const vec AB = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const vec cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const vec CD = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    return (struct four){__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
                         __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
                         __builtin_shufflevector(AB, CD, 0, 1, 8, 9, 4, 5, 12, 13),
                         __builtin_shufflevector(AB, CD, 2, 3, 10, 11, 6, 7, 14, 15)};
}
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    return turned(two_rows(row[0], row[4]), two_rows(row[1], row[5]), two_rows(row[2], row[6]),
                  two_rows(row[3], row[7]));
}
SPHGI_TEMPLATE quad half_of(vec v, int half)
{
    return half ? __builtin_shufflevector(v, v, 4, 5, 6, 7)
                : __builtin_shufflevector(v, v, 0, 1, 2, 3);
}
SPHGI_TEMPLATE void rows_of(struct four v, quad *rows)
{
    const struct four t = turned(v.x, v.y, v.z, v.w);
    for (int half = 0; half < 2; ++half) {
        rows[4 * half] = half_of(t.x, half);
        rows[4 * half + 1] = half_of(t.y, half);
        rows[4 * half + 2] = half_of(t.z, half);
        rows[4 * half + 3] = half_of(t.w, half);
    }
}
#elif REAL_IS_F64 && VECTOR_BYTES == 16
SPHGI_TEMPLATE struct four transpose(const real *const *row)
{
    const vec a = load(row[0]), A = load(row[0] + 2), b = load(row[1]), B = load(row[1] + 2);
    return (struct four){__builtin_shufflevector(a, b, 0, 2), __builtin_shufflevector(a, b, 1, 3),
                         __builtin_shufflevector(A, B, 0, 2), __builtin_shufflevector(A, B, 1, 3)};
}
SPHGI_TEMPLATE void rows_of(struct four v, quad *rows)
{
    for (int l = 0; l < 2; ++l)
        rows[l] = (quad){v.x[l], v.y[l], v.z[l], v.w[l]};
}
#else /* four lanes */
SPHGI_TEMPLATE struct four turned(vec a, vec b, vec c, vec d)
{
    const vec ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const vec AB = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const vec cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const vec CD = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return (struct four){
        __builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(AB, CD, 0, 1, 4, 5),
        __builtin_shufflevector(ab, cd, 2, 3, 6, 7), __builtin_shufflevector(AB, CD, 2, 3, 6, 7)};
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

/* The rows that ids[0 .. LANES) stand for. */
SPHGI_TEMPLATE struct four gather_rows(const real *rows, const void *ids, bool wide)
{
    const real *row[LANES];
    for (int k = 0; k < LANES; ++k) {
        const size_t id = wide ? ((const uint32_t *)ids)[k] : ((const uint16_t *)ids)[k];
        row[k] = rows + SPHGI_ROW / SPHGI_ID_STEP * id;
    }
    return transpose(row);
}
