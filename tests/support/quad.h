/* SPDX-License-Identifier: MIT */
/* Quadruple precision for the oracle: only the arithmetic that the compiler itself provides. */
#ifndef TESTS_SUPPORT_QUAD_H
#define TESTS_SUPPORT_QUAD_H
#include <math.h>

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 quad; /* 113 bits */
#else
typedef long double quad; /* 113 bits where there is no __float128, as on AArch64 */
#endif

/* Bounds say how far a result may be off: nobody needs their digits. What a processor computes in
 * by itself reaches as far, with 64 bits, where there is quad. */
typedef long double rough;

static inline quad quad_abs(quad a)
{
    return a < 0 ? -a : a;
}

static inline quad quad_max(quad a, quad b)
{
    return a > b ? a : b;
}

static inline quad quad_power(quad base, int exponent)
{
    if (exponent <= 0)
        return 1;
    const quad half = exponent > 1 ? quad_power(base, exponent / 2) : 1;
    return exponent % 2 ? half * half * base : half * half;
}

/* Newton from the double root, each step doubling the digits: what it adds is known well enough
 * from the remainder, which is formed in quad, in double. Scaled by even powers of two so that the
 * start neither overflows nor underflows. */
static inline quad quad_sqrt(quad a)
{
    quad scale = 1;
    if (!(a > 0))
        return 0;
    for (; a > 0x1p200; a *= 0x1p-200)
        scale *= 0x1p100;
    for (; a < 0x1p-200; a *= 0x1p200)
        scale *= 0x1p-100;
    quad root = sqrt((double)a);
    for (int step = 0; step < 2; ++step)
        root += (double)(a - root * root) / (2 * (double)root);
    return root * scale;
}

static inline quad quad_norm(const quad *a, int count)
{
    quad sum = 0;
    for (int k = 0; k < count; ++k)
        sum += a[k] * a[k];
    return quad_sqrt(sum);
}

static inline rough rough_abs(quad a)
{
    return fabsl((rough)a);
}

static inline rough rough_max(rough a, rough b)
{
    return a > b ? a : b;
}

static inline rough rough_norm(const quad *a, int count)
{
    rough sum = 0;
    for (int k = 0; k < count; ++k)
        sum += (rough)a[k] * (rough)a[k];
    return sqrtl(sum);
}

#endif
