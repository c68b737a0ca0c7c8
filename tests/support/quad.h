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
    quad result = 1;
    for (int k = 0; k < exponent; ++k)
        result *= base;
    return result;
}

/* Newton from the double root; scaled by even powers of two so that the start neither overflows
 * nor underflows. */
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
        root = (root + a / root) / 2;
    return root * scale;
}

static inline quad quad_norm(const quad *a, int count)
{
    quad sum = 0;
    for (int k = 0; k < count; ++k)
        sum += a[k] * a[k];
    return quad_sqrt(sum);
}

#endif
