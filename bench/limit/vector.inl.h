/* SPDX-License-Identifier: MIT */
/* Vectors of float for loops of the benchmark's own, written apart from the library's so that a
 * weakness there is not repeated here. Parameter: VECTOR_BYTES (16, 32 or 64). */
#if defined(__SSE2__)
#include <immintrin.h>
#endif
#include <stdint.h>

#define LANES  (VECTOR_BYTES / 4)
#define INLINE static inline __attribute__((always_inline))

typedef float vec __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef int32_t mask __attribute__((vector_size(VECTOR_BYTES), may_alias));

/* Lanes of two vectors by their numbers, those of b following those of a: GCC has the function of
 * Clang since 12. */
#if defined(__clang__) || __GNUC__ >= 12
#define SHUFFLED(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define SHUFFLED(a, b, ...) __builtin_shuffle(a, b, (mask){__VA_ARGS__})
#endif

INLINE vec load(const float *p) /* aligned to a vector, as all arrays here */
{
    return *(const vec *)p;
}

INLINE void store(float *p, vec v)
{
    *(vec *)p = v;
}

INLINE vec splat(float x)
{
    return x - (vec){0};
}

/* What C has no operator for: roots, minima, and x < limit ? below : other. */
#if VECTOR_BYTES == 64 && defined(__AVX512F__)
#define ROOT(v)         ((vec)_mm512_sqrt_ps((__m512)(v)))
#define ROUGH(v)        ((vec)_mm512_rsqrt14_ps((__m512)(v)))
#define SMALLER(a, b)   ((vec)_mm512_min_ps((__m512)(a), (__m512)(b)))
#define BELOW(x, limit) _mm512_cmp_ps_mask((__m512)(x), (__m512)(limit), _CMP_LT_OQ)
#define CHOOSE(x, limit, below, other)                                                             \
    ((vec)_mm512_mask_blend_ps(BELOW(x, limit), (__m512)(other), (__m512)(below)))
#elif VECTOR_BYTES == 32 && defined(__AVX2__)
#define ROOT(v)         ((vec)_mm256_sqrt_ps((__m256)(v)))
#define ROUGH(v)        ((vec)_mm256_rsqrt_ps((__m256)(v)))
#define SMALLER(a, b)   ((vec)_mm256_min_ps((__m256)(a), (__m256)(b)))
#define BELOW(x, limit) _mm256_cmp_ps((__m256)(x), (__m256)(limit), _CMP_LT_OQ)
#define CHOOSE(x, limit, below, other)                                                             \
    ((vec)_mm256_blendv_ps((__m256)(other), (__m256)(below), BELOW(x, limit)))
#else
INLINE vec select(mask first, vec a, vec b)
{
    return (vec)((first & (mask)a) | (~first & (mask)b));
}
#define CHOOSE(x, limit, below, other) select((x) < (limit), below, other)
#if VECTOR_BYTES == 16 && defined(__SSE2__)
#define ROOT(v)       ((vec)_mm_sqrt_ps((__m128)(v)))
#define ROUGH(v)      ((vec)_mm_rsqrt_ps((__m128)(v)))
#define SMALLER(a, b) ((vec)_mm_min_ps((__m128)(a), (__m128)(b)))
#else
INLINE vec roots(vec v)
{
    for (int k = 0; k < LANES; ++k)
        v[k] = __builtin_sqrtf(v[k]);
    return v;
}
#define ROOT(v)       roots(v)
#define ROUGH(v)      (1 / roots(v))
#define SMALLER(a, b) select((a) < (b), a, b)
#endif
#endif

/* -W'(q)/q of the cubic spline over 6 sigma: 2 - 3 q up to 1/2, then (1 - q)^2 / q = 1/q + q - 2.
 * q2 > 0; beyond 1 the result is 0. */
INLINE vec spline_weight(vec q2, int by_newton)
{
    const vec inside = SMALLER(q2, splat(1));
    vec q, reciprocal;
    if (by_newton) { /* one step of Newton's doubles the bits of the rough root */
        const vec rough = ROUGH(inside), root = inside * rough;
        const vec correction = 0.5f - root * (0.5f * rough);
        q = root + root * correction;
        reciprocal = rough + rough * correction;
    } else {
        q = ROOT(inside);
        reciprocal = 1 / q;
    }
    return CHOOSE(inside, splat(0.25f), 2 - 3 * q, reciprocal + (q - 2));
}

/* C = A^-1 of symmetric matrices xx xy xz yy yz zz, by cofactors. */
INLINE void invert_symmetric(const vec a[6], vec c[6])
{
    c[0] = a[3] * a[5] - a[4] * a[4];
    c[1] = a[2] * a[4] - a[1] * a[5];
    c[2] = a[1] * a[4] - a[2] * a[3];
    c[3] = a[0] * a[5] - a[2] * a[2];
    c[4] = a[1] * a[2] - a[0] * a[4];
    c[5] = a[0] * a[3] - a[1] * a[1];
    const vec reciprocal = 1 / (a[0] * c[0] + a[1] * c[1] + a[2] * c[2]);
    for (int k = 0; k < 6; ++k)
        c[k] *= reciprocal;
}

/* J = B C, both 3 x 3, C symmetric. */
INLINE void apply_symmetric(const vec b[9], const vec c[6], vec jacobian[9])
{
    for (int row = 0; row < 9; row += 3) {
        jacobian[row] = b[row] * c[0] + b[row + 1] * c[1] + b[row + 2] * c[2];
        jacobian[row + 1] = b[row] * c[1] + b[row + 1] * c[3] + b[row + 2] * c[4];
        jacobian[row + 2] = b[row] * c[2] + b[row + 1] * c[4] + b[row + 2] * c[5];
    }
}
