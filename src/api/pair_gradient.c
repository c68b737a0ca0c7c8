/* SPDX-License-Identifier: MIT */
/* The gradient of one pair, from the formulas alone. */
#include "core/check.h"
#include "core/float_environment.h"
#include "core/kernel.h"
#include <math.h>

/* C_i s_ij x_ij with everything in the units of the host. */
static void linearised_gradient(const sphg_scheme *scheme, int32_t d, const double *x_ij,
                                double volume, const double *c, double *gradient)
{
    double r = 0, w, slope;
    for (int32_t a = 0; a < d; ++a)
        r += x_ij[a] * x_ij[a];
    sphg_kernel_value(scheme, sqrt(r), &w, &slope);
    const double s = scheme->method == SPHG_MLS    ? -w
                     : scheme->method == SPHG_RKPM ? -volume * w
                                                   : volume * slope;
    for (int32_t a = 0; a < d; ++a) {
        gradient[a] = s * x_ij[a];
        for (int32_t b = 0; c && b < d; ++b) {
            const int32_t low = a < b ? a : b, high = a < b ? b : a;
            const double entry = c[low * d - low * (low - 1) / 2 + high - low];
            gradient[a] = (b ? gradient[a] : 0) + entry * s * x_ij[b];
        }
    }
}

/* d_k w (p.y) + w (p.z_k), p = (1, -x_ij / H) */
static void classic_gradient(const sphg_scheme *scheme, int32_t d, const double *x_ij,
                             double volume, const double *c, double *gradient)
{
    double r = 0, w, slope, polynomial[4];
    for (int32_t a = 0; a < d; ++a)
        r += x_ij[a] * x_ij[a];
    sphg_kernel_value(scheme, sqrt(r), &w, &slope);
    if (scheme->method == SPHG_CRKPM) {
        w *= volume;
        slope *= volume;
    }
    for (int32_t m = 0; m <= d; ++m, c += d + 1) {
        polynomial[m] = c[0];
        for (int32_t a = 0; a < d; ++a)
            polynomial[m] -= c[1 + a] * x_ij[a] / scheme->support_radius;
    }
    for (int32_t a = 0; a < d; ++a)
        gradient[a] = slope * x_ij[a] * polynomial[0] + w * polynomial[1 + a];
}

/* -s [P Q] (x, x x^T / 2), x = -x_ij; c: P as a triangle, then Q row by row. */
static void quadratic_gradient(const sphg_scheme *scheme, int32_t d, const double *x_ij,
                               double volume, const double *c, double *gradient)
{
    const int32_t n = d * (d + 1) / 2;
    double plain[3]; /* s x_ij */
    linearised_gradient(scheme, d, x_ij, volume, NULL, plain);
    linearised_gradient(scheme, d, x_ij, volume, c, gradient);
    for (int32_t a = 0; a < d; ++a)
        for (int32_t p = 0, k = 0; p < d; ++p)
            for (int32_t q = p; q < d; ++q, ++k)
                gradient[a] -= c[n + a * n + k] * (p == q ? .5 : 1) * plain[p] * x_ij[q];
}

/* Not inlined: arithmetic must stay between the two changes of the environment. */
__attribute__((noinline)) static void pair_gradient(const sphg_scheme *scheme, const double *x_ij,
                                                    double volume, const double *correction,
                                                    double *gradient)
{
    const int32_t d = scheme->dimension == 2 ? 2 : 3;
    if (sphgi_is_classic(scheme->method) && correction)
        classic_gradient(scheme, d, x_ij, volume, correction, gradient);
    else if (scheme->order == 2 && scheme->method != SPHG_PLAIN && correction)
        quadratic_gradient(scheme, d, x_ij, volume, correction, gradient);
    else
        linearised_gradient(scheme, d, x_ij, volume,
                            scheme->method == SPHG_PLAIN ? NULL : correction, gradient);
}

void sphg_pair_gradient(const sphg_scheme *scheme, const double *x_ij, double volume,
                        const double *correction, double *gradient)
{
    if (!gradient)
        return;
    for (int32_t a = 0; (!scheme || !x_ij) && a < (scheme && scheme->dimension == 2 ? 2 : 3); ++a)
        gradient[a] = (double)NAN;
    if (!scheme || !x_ij)
        return;
    const struct sphgi_floats before = sphgi_floats_enter();
    pair_gradient(scheme, x_ij, volume, correction, gradient);
    sphgi_floats_leave(before);
}
