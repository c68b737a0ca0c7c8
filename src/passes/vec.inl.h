/* SPDX-License-Identifier: MIT */
/* Vectors of REAL: GCC and Clang vector extensions, and the few operations that those lack.
 * Parameters: REAL_IS_F64, FUSES. Gives real, vec, mask, LANES, UNIT_ROUNDOFF. */
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/* Whether plus and minus round once. The base path of x86 never does, whatever its compiler may
 * use: it has the same bits on every machine. */
#ifndef FUSES
#if defined(__aarch64__) || defined(__riscv) || defined(__powerpc64__) || defined(__s390x__)
#define FUSES 1
#else
#define FUSES 0
#endif
#endif

#if defined(__AVX512F__)
#define VECTOR_BYTES   64
#define VECTOR_TYPE(x) __m512##x
#define VECTOR_OP(x)   _mm512_##x
#elif defined(__AVX2__)
#define VECTOR_BYTES   32
#define VECTOR_TYPE(x) __m256##x
#define VECTOR_OP(x)   _mm256_##x
#elif defined(__aarch64__)
#define VECTOR_BYTES 16
#else
#define VECTOR_BYTES   16
#define VECTOR_TYPE(x) __m128##x
#define VECTOR_OP(x)   _mm_##x
#endif

#define R(x) ((real)(x))
#if REAL_IS_F64
typedef double real;
typedef int64_t lane_int;
#define UNIT_ROUNDOFF 0x1p-53
#ifdef __aarch64__
#define NATIVE   float64x2_t
#define OP(name) v##name##q_f64
#else
#define NATIVE        VECTOR_TYPE(d)
#define OP(name)      VECTOR_OP(name##_pd)
#define OP_MASK(name) VECTOR_OP(name##_pd_mask)
#endif
#else
typedef float real;
typedef int32_t lane_int;
#define UNIT_ROUNDOFF 0x1p-24
#ifdef __aarch64__
#define NATIVE   float32x4_t
#define OP(name) v##name##q_f32
#else
#define NATIVE        VECTOR_TYPE()
#define OP(name)      VECTOR_OP(name##_ps)
#define OP_MASK(name) VECTOR_OP(name##_ps_mask)
#endif
#endif
#define LANES ((int)(VECTOR_BYTES / sizeof(real)))
#define ALL   ((1u << LANES) - 1)

typedef real vec __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef lane_int bit_pattern __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef real vec_anywhere
    __attribute__((vector_size(VECTOR_BYTES), aligned(__alignof__(real)), may_alias));

/* Lanes of two vectors of one type by their numbers, those of b following those of a. GCC has the
 * function of Clang since 12; that of GCC 11 takes the numbers as a vector of integers as wide. */
#if defined(__clang__) || __GNUC__ >= 12
#define SHUFFLED_BY(integers, a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define SHUFFLED_BY(integers, a, b, ...) __builtin_shuffle(a, b, (integers){__VA_ARGS__})
#endif
#define SHUFFLED(a, b, ...) SHUFFLED_BY(bit_pattern, a, b, __VA_ARGS__)

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

SPHGI_TEMPLATE bit_pattern lane_numbers(void) /* 0, 1, 2, ... */
{
    bit_pattern numbers;
    for (int k = 0; k < LANES; ++k)
        numbers[k] = k;
    return numbers;
}

SPHGI_TEMPLATE vec vabs(vec v)
{
    return (vec)((bit_pattern)v & ~(bit_pattern)splat(R(-0.0)));
}

/* ---- Masks: which lanes. They are joined by & | ~ -------------------------------------------- */

#if defined(__AVX512F__)
typedef uint32_t mask; /* a bit a lane; those beyond the lanes mean nothing */

SPHGI_TEMPLATE mask less(vec a, vec b)
{
    return OP_MASK(cmp)((NATIVE)a, (NATIVE)b, _CMP_LT_OQ);
}
SPHGI_TEMPLATE mask at_most(vec a, vec b)
{
    return OP_MASK(cmp)((NATIVE)a, (NATIVE)b, _CMP_LE_OQ);
}
SPHGI_TEMPLATE mask differ(vec a, vec b)
{
    return OP_MASK(cmp)((NATIVE)a, (NATIVE)b, _CMP_NEQ_UQ);
}
SPHGI_TEMPLATE mask first_lanes(int32_t count) /* the lanes below count, which may be any number */
{
    return count >= LANES ? ALL : count > 0 ? (1u << count) - 1 : 0;
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
    return m & ALL;
}
#else
typedef bit_pattern mask; /* all bits of a lane */

SPHGI_TEMPLATE mask less(vec a, vec b)
{
    return (mask)(a < b);
}
SPHGI_TEMPLATE mask at_most(vec a, vec b)
{
    return (mask)(a <= b);
}
SPHGI_TEMPLATE mask differ(vec a, vec b)
{
    return (mask)(a != b);
}
SPHGI_TEMPLATE mask first_lanes(int32_t count) /* the lanes below count, which may be any number */
{
    return (mask)(lane_numbers() < (mask){0} + (lane_int)count);
}
SPHGI_TEMPLATE unsigned bits_of(mask m)
{
#if defined(__SSE2__)
    return (unsigned)OP(movemask)((NATIVE)m);
#elif defined(__aarch64__) && REAL_IS_F64
    return (unsigned)vaddvq_u64((uint64x2_t)(m & (mask){1, 2}));
#elif defined(__aarch64__)
    return vaddvq_u32((uint32x4_t)(m & (mask){1, 2, 4, 8}));
#else
    unsigned bits = 0;
    for (int k = 0; k < LANES; ++k)
        bits |= (unsigned)(m[k] & 1) << k;
    return bits;
#endif
}
#endif

SPHGI_TEMPLATE int32_t lanes_in(mask m) /* how many */
{
#if defined(__aarch64__) && REAL_IS_F64
    return -(int32_t)vaddvq_s64((int64x2_t)m);
#elif defined(__aarch64__)
    return -vaddvq_s32((int32x4_t)m);
#else
    return __builtin_popcount(bits_of(m));
#endif
}

SPHGI_TEMPLATE vec where(mask m, vec v) /* v where m, else +0 */
{
#if defined(__AVX512F__) && REAL_IS_F64
    return (vec)_mm512_maskz_mov_pd((__mmask8)m, (__m512d)v);
#elif defined(__AVX512F__)
    return (vec)_mm512_maskz_mov_ps((__mmask16)m, (__m512)v);
#else
    return (vec)(m & (bit_pattern)v);
#endif
}

SPHGI_TEMPLATE vec select(mask m, vec a, vec b) /* whole lanes: a where m, else b */
{
#if defined(__AVX512F__) && REAL_IS_F64
    return (vec)_mm512_mask_blend_pd((__mmask8)m, (__m512d)b, (__m512d)a);
#elif defined(__AVX512F__)
    return (vec)_mm512_mask_blend_ps((__mmask16)m, (__m512)b, (__m512)a);
#elif defined(__AVX2__)
    return (vec)OP(blendv)((NATIVE)b, (NATIVE)a, (NATIVE)m);
#else
    return (vec)((m & (bit_pattern)a) | (~m & (bit_pattern)b));
#endif
}

/* ---- Functions ------------------------------------------------------------------------------- */

#if defined(__SSE2__)
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)OP(sqrt)((NATIVE)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return (vec)OP(max)((NATIVE)a, (NATIVE)b);
}
SPHGI_TEMPLATE vec vmin(vec a, vec b)
{
    return (vec)OP(min)((NATIVE)a, (NATIVE)b);
}
#elif defined(__aarch64__)
SPHGI_TEMPLATE vec vsqrt(vec v)
{
    return (vec)OP(sqrt)((NATIVE)v);
}
SPHGI_TEMPLATE vec vmax(vec a, vec b) /* b if a is no number, which vmaxq would give */
{
    return (vec)OP(maxnm)((NATIVE)a, (NATIVE)b);
}
SPHGI_TEMPLATE vec vmin(vec a, vec b)
{
    return (vec)OP(minnm)((NATIVE)a, (NATIVE)b);
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
    return select(less(b, a), a, b);
}
SPHGI_TEMPLATE vec vmin(vec a, vec b)
{
    return -vmax(-a, -b);
}
#endif

/* ---- Products and sums -----------------------------------------------------------------------
 * Which product is fused to which sum, into one rounding, stands in the formulas and is left to no
 * compiler (-ffp-contract=off): what is written with + and * is rounded after each, and plus and
 * minus round once where the path fuses. Of a sum of products the first is rounded and the others
 * are fused to it in their order: a b + c d + e f is plus(plus(a * b, c, d), e, f). So all paths
 * that fuse give the same bits, on every machine and with every compiler. */

#if !FUSES
SPHGI_TEMPLATE vec plus(vec sum, vec a, vec b) /* sum + a b */
{
    return sum + a * b;
}
SPHGI_TEMPLATE vec minus(vec sum, vec a, vec b) /* sum - a b */
{
    return sum - a * b;
}
#elif defined(__FMA__)
SPHGI_TEMPLATE vec plus(vec sum, vec a, vec b)
{
    return (vec)OP(fmadd)((NATIVE)a, (NATIVE)b, (NATIVE)sum);
}
SPHGI_TEMPLATE vec minus(vec sum, vec a, vec b)
{
    return (vec)OP(fnmadd)((NATIVE)a, (NATIVE)b, (NATIVE)sum);
}
#elif defined(__aarch64__)
SPHGI_TEMPLATE vec plus(vec sum, vec a, vec b)
{
    return (vec)OP(fma)((NATIVE)sum, (NATIVE)a, (NATIVE)b);
}
SPHGI_TEMPLATE vec minus(vec sum, vec a, vec b)
{
    return (vec)OP(fms)((NATIVE)sum, (NATIVE)a, (NATIVE)b);
}
#else
SPHGI_TEMPLATE vec plus(vec sum, vec a, vec b)
{
#if REAL_IS_F64
#define FUSED(k) __builtin_fma(a[k], b[k], sum[k])
    return (vec){FUSED(0), FUSED(1)};
#else
#define FUSED(k) __builtin_fmaf(a[k], b[k], sum[k])
    return (vec){FUSED(0), FUSED(1), FUSED(2), FUSED(3)};
#endif
#undef FUSED
}
SPHGI_TEMPLATE vec minus(vec sum, vec a, vec b)
{
    return plus(sum, -a, b);
}
#endif
