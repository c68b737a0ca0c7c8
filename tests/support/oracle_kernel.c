/* SPDX-License-Identifier: MIT */
#include "oracle_kernel.h"

/* w(q) = sum of spline pieces c (b - a q)+^p, or (1 - q)^p times a polynomial in q. */
typedef struct kernel_text {
    int sigma[2][2]; /* numerator and denominator / pi, in 2D and 3D */
    int mu2[2][2];
    int power;
    struct {
        int c, a;
        quad b;
    } pieces[3];
    quad polynomial[4]; /* 1, q, q^2, q^3 */
} kernel_text;

static const kernel_text kernels[] = {
    [SPHG_CUBIC_SPLINE] = {.sigma = {{40, 7}, {8, 1}},
                           .mu2 = {{31, 392}, {3, 40}},
                           .power = 3,
                           .pieces = {{2, 1, 1}, {-8, 1, .5}}},
    [SPHG_QUINTIC_SPLINE] = {.sigma = {{63, 478}, {9, 40}},
                             .mu2 = {{2771, 51624}, {7, 135}},
                             .power = 5,
                             .pieces = {{1, 3, 3}, {-6, 3, 2}, {15, 3, 1}}},
    [SPHG_WENDLAND_C2] = {.sigma = {{7, 1}, {21, 2}},
                          .mu2 = {{5, 72}, {1, 15}},
                          .power = 4,
                          .polynomial = {1, 4}},
    [SPHG_WENDLAND_C4] = {.sigma = {{9, 1}, {495, 32}},
                          .mu2 = {{7, 132}, {2, 39}},
                          .power = 6,
                          .polynomial = {1, 6, (quad)35 / 3}},
    [SPHG_WENDLAND_C6] = {.sigma = {{78, 7}, {1365, 64}},
                          .mu2 = {{3, 70}, {1, 24}},
                          .power = 8,
                          .polynomial = {1, 8, 25, 32}},
    /* (1 - q^2)^3 = (1 - q)^3 (1 + q)^3 */
    [SPHG_POLY6] = {.sigma = {{4, 1}, {315, 64}},
                    .mu2 = {{1, 10}, {1, 11}},
                    .power = 3,
                    .polynomial = {1, 3, 3, 1}},
    [SPHG_SPIKY] = {.sigma = {{10, 1}, {15, 1}},
                    .mu2 = {{1, 14}, {1, 14}},
                    .power = 3,
                    .polynomial = {1}},
};

static quad arctangent_of_inverse(int n)
{
    quad sum = 0, term = (quad)1 / n;
    for (int k = 1; term != 0 && k < 200; k += 2, term /= -n * n)
        sum += term / k;
    return sum;
}

/* Machin's formula. */
quad oracle_pi(void)
{
    static quad pi;
    if (pi == 0)
        pi = 16 * arctangent_of_inverse(5) - 4 * arctangent_of_inverse(239);
    return pi;
}

quad oracle_sigma(sphg_kernel kernel, int dimension)
{
    static quad known[SPHG_SPIKY + 1][2];
    const int *ratio = kernels[kernel].sigma[dimension - 2];
    quad *value = &known[kernel][dimension - 2];
    if (*value == 0)
        *value = ratio[0] / (ratio[1] * oracle_pi());
    return *value;
}

quad oracle_mu2(sphg_kernel kernel, int dimension)
{
    const int *ratio = kernels[kernel].mu2[dimension - 2];
    return (quad)ratio[0] / ratio[1];
}

static void add_pieces(const kernel_text *text, quad q, quad shape[3])
{
    int p = text->power;
    for (int k = 0; k < 3; ++k) {
        const int c = text->pieces[k].c, a = text->pieces[k].a;
        const quad base = text->pieces[k].b - (a == 1 ? q : a * q);
        if (c == 0 || base <= 0)
            continue;
        const quad power = quad_power(base, p - 2), next = power * base;
        shape[0] += c * (next * base);
        shape[1] -= c * p * a * next;
        shape[2] += c * p * (p - 1) * a * a * power;
    }
}

static void add_product(const kernel_text *text, quad q, quad shape[3])
{
    const quad *c = text->polynomial;
    int p = text->power;
    if (c[0] == 0) /* a sum of pieces */
        return;
    quad value = c[0] + q * (c[1] + q * (c[2] + q * c[3]));
    quad first = c[1] + q * (2 * c[2] + q * 3 * c[3]);
    quad second = 2 * c[2] + 6 * q * c[3];
    quad t = 1 - q, power = quad_power(t, p - 2), next = power * t, slope = t * first;
    shape[0] += next * t * value;
    shape[1] += next * (slope - p * value);
    shape[2] += power * (t * t * second - 2 * p * slope + p * (p - 1) * value);
}

void oracle_shape_of(sphg_kernel kernel, quad q, quad shape[3])
{
    shape[0] = shape[1] = shape[2] = 0;
    if (q >= 1)
        return;
    add_pieces(&kernels[kernel], q, shape);
    add_product(&kernels[kernel], q, shape);
}

oracle_weights oracle_weights_at(sphg_kernel kernel, int dimension, quad support, quad r)
{
    oracle_weights at = {0, 0, 0};
    quad shape[3], q = r / support;
    oracle_shape_of(kernel, q, shape);
    quad scale = oracle_sigma(kernel, dimension) / quad_power(support, dimension);
    at.w = scale * shape[0];
    if (r > 0) {
        quad over = 1 / (support * r);
        at.slope = scale * shape[1] * over;
        at.slope_rate = scale * (shape[2] * r - shape[1] * support) * over * over;
    }
    return at;
}
