/* SPDX-License-Identifier: MIT */
#include "kernel.h"
#include "float_environment.h"
#include "passes/kernel_list.h"
#include <math.h>

typedef double vec;
#define R(x) ((double)(x))

SPHGI_TEMPLATE vec splat(double x)
{
    return x;
}

SPHGI_TEMPLATE vec vmax(vec a, vec b)
{
    return a > b ? a : b;
}

SPHGI_TEMPLATE vec plus(vec sum, vec a, vec b)
{
    return sum + a * b;
}

SPHGI_TEMPLATE vec minus(vec sum, vec a, vec b)
{
    return sum - a * b;
}

SPHGI_TEMPLATE bool less(vec a, vec b)
{
    return a < b;
}

SPHGI_TEMPLATE vec select(bool choose, vec a, vec b)
{
    return choose ? a : b;
}

#include "passes/kernels.inl.h"

static const double constants[][4] = {
#define SPHGI_CONSTANTS(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                \
    [SPHG_##name] = {sigma2, sigma3, mu2_2, mu2_3},
    SPHGI_KERNELS(SPHGI_CONSTANTS)
#undef SPHGI_CONSTANTS
};

bool sphgi_kernel_exists(sphg_kernel kernel)
{
    return (int)kernel >= 0 && (size_t)kernel < sizeof constants / sizeof *constants;
}

double sphgi_kernel_sigma(sphg_kernel kernel, int32_t dimension)
{
    return constants[kernel][dimension == 3];
}

double sphgi_kernel_mu2(sphg_kernel kernel, int32_t dimension)
{
    return constants[kernel][2 + (dimension == 3)];
}

double sphgi_kernel_mu4(sphg_kernel kernel, int32_t dimension)
{
    static const double of[][2] = {
        [SPHG_CUBIC_SPLINE] = {635.0 / 112896, 17.0 / 3360},
        [SPHG_QUINTIC_SPLINE] = {27479.0 / 10221552, 64.0 / 25515},
        [SPHG_WENDLAND_C2] = {7.0 / 1584, 2.0 / 495},
        [SPHG_WENDLAND_C4] = {3.0 / 1144, 2.0 / 819},
        [SPHG_WENDLAND_C6] = {33.0 / 19040, 1.0 / 612},
        [SPHG_POLY6] = {1.0 / 120, 1.0 / 143},
        [SPHG_SPIKY] = {5.0 / 1008, 1.0 / 210},
    };
    return of[kernel][dimension == 3];
}

double sphgi_kernel_w(sphg_kernel kernel, double q)
{
    return kernel_w(kernel, ratio_of(q, 1));
}

double sphgi_power(double scale, int32_t power)
{
    double result = 1;
    for (int32_t k = 0; k < power; ++k)
        result *= scale;
    return result;
}

static bool scheme_has_kernel(const sphg_scheme *scheme)
{
    return scheme && (scheme->dimension == 0 || scheme->dimension == 2 || scheme->dimension == 3) &&
           sphgi_kernel_exists(scheme->kernel);
}

/* Not inlined: arithmetic must stay between the two changes of the environment. */
__attribute__((noinline)) static void kernel_value(const sphg_scheme *scheme, double r,
                                                   double *value, double *slope)
{
    const int32_t d = scheme->dimension == 2 ? 2 : 3;
    const double inverse_h = 1 / scheme->support_radius;
    const struct ratio at = ratio_of(r, inverse_h);
    const double sigma = sphgi_kernel_sigma(scheme->kernel, d);
    const double scale = sigma * sphgi_power(inverse_h, d);
    const bool inside = r < scheme->support_radius;
    *value = inside ? scale * kernel_w(scheme->kernel, at) : 0;
    *slope = inside ? scale * inverse_h * inverse_h * kernel_d(scheme->kernel, at) : 0;
}

static void checked_value(const sphg_scheme *scheme, double r, double *value, double *slope)
{
    if (scheme_has_kernel(scheme) && scheme->support_radius > 0 &&
        isfinite(scheme->support_radius) && r >= 0)
        kernel_value(scheme, r, value, slope);
}

void sphg_kernel_value(const sphg_scheme *scheme, double r, double *w, double *dw_over_r)
{
    double value = NAN, slope = NAN;
    const struct sphgi_floats before = sphgi_floats_enter();
    checked_value(scheme, r, &value, &slope);
    sphgi_floats_leave(before);
    if (w)
        *w = value;
    if (dw_over_r)
        *dw_over_r = slope;
}

void sphg_kernel_constants(const sphg_scheme *scheme, double *sigma, double *mu2)
{
    const bool valid = scheme_has_kernel(scheme);
    const int32_t d = valid && scheme->dimension == 2 ? 2 : 3;
    if (sigma)
        *sigma = valid ? sphgi_kernel_sigma(scheme->kernel, d) : (double)NAN;
    if (mu2)
        *mu2 = valid ? sphgi_kernel_mu2(scheme->kernel, d) : (double)NAN;
}
