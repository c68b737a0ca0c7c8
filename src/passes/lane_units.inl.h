/* SPDX-License-Identifier: MIT */
/* Targets with radii of their own: what takes the place of 1 / H, of H^d and of the factor of s_ij,
 * a number per target. In double, as the numbers of one radius are, and rounded at the end. */

typedef double radius_vec __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef double radius_anywhere
    __attribute__((vector_size(VECTOR_BYTES), aligned(__alignof__(double)), may_alias));
typedef int64_t radius_bits __attribute__((vector_size(VECTOR_BYTES), may_alias));
enum { RADII = VECTOR_BYTES / sizeof(double) };
typedef real radius_rounded
    __attribute__((vector_size(RADII * sizeof(real)), aligned(__alignof__(real)), may_alias));

SPHGI_TEMPLATE void put_rounded(const radius_vec *v, void *to, int32_t l)
{
    *(radius_rounded *)((real *)to + l) = __builtin_convertvector(*v, radius_rounded);
}

/* Volumes stand in units of the largest radius. The factor of s_ij takes them to units of the
 * target's, at the same place whether s_ij is formed at once or later. */
static void lane_units(int32_t width, const struct sphgi_lane_units *units, const double *radius,
                       void *ratio, void *inverse, void *inverse_square, void *factor)
{
    for (int32_t l = 0; l < width; l += RADII) {
        const radius_vec h = *(const radius_anywhere *)(radius + l);
        const radius_vec one = units->largest / h, two = one * one;
        radius_vec all = two;
        if (units->dimension == 3)
            all *= one;
        const radius_vec reciprocal = 1.0 / h, square = reciprocal * reciprocal;
        radius_vec weight = units->factor_of_h / h;
        if (units->in_radii)
            weight = units->factor_of_h - 0 * h;
        if (units->with_volume)
            weight *= all;
        put_rounded(&all, ratio, l);
        put_rounded(&reciprocal, inverse, l);
        put_rounded(&square, inverse_square, l);
        put_rounded(&weight, factor, l);
    }
}

enum { MANTISSA_BITS = 52, BIAS = 1023 };

SPHGI_TEMPLATE void put_power(const radius_bits *exponent, void *to, int32_t l)
{
    const radius_bits bits = (*exponent + BIAS) << MANTISSA_BITS;
    const radius_vec power = (radius_vec)bits;
    put_rounded(&power, to, l);
}

/* frexp() and ldexp() of normal numbers. The exponent is halved towards 0. */
static void lane_table_units(int32_t width, const double *factor, void *mantissa, void *first,
                             void *second)
{
    const int64_t field = (int64_t)0x7ff << MANTISSA_BITS, one = (int64_t)1 << MANTISSA_BITS;
    for (int32_t l = 0; l < width; l += RADII) {
        const radius_bits bits = (radius_bits) * (const radius_anywhere *)(factor + l);
        radius_bits exponent = ((bits & field) >> MANTISSA_BITS) - (BIAS - 1);
        radius_bits low = (bits & ~field) | (BIAS - 1) * one;
        const radius_bits half = (radius_bits)((radius_vec)low == 0.5);
        low += half & one; /* a power of two: nothing is rounded */
        exponent += half;
        const radius_bits part = (exponent - (exponent >> 63)) >> 1, rest = exponent - part;
        const radius_vec rounded = (radius_vec)low;
        put_rounded(&rounded, mantissa, l);
        put_power(&part, first, l);
        put_power(&rest, second, l);
    }
}
