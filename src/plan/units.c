/* SPDX-License-Identifier: MIT */
#include "units.h"
#include "core/kernel.h"
#include <math.h>

/* Linearised (theory.md, section 3): KGC C; RKPM C / (mu2 H^2); MLS C H^(d - 2) / mu2, where ours
 * contains V_i / H^d. Classic: w is W H^d (CMLS) or V W (CRKPM). */
bool sphgi_has_units(const struct sphgi_scheme *scheme)
{
    return scheme->method != SPHG_KGC && scheme->method != SPHG_PLAIN;
}

/* A loop for each method, which compilers turn into vectors: divisions are what it costs. */
static void put_values(const struct sphgi_scheme *scheme, int32_t count,
                       const double *restrict radius, double *restrict value)
{
    const double mu2 = sphgi_kernel_mu2(scheme->kernel, scheme->dimension);
    const bool mls = scheme->method == SPHG_MLS, rkpm = scheme->method == SPHG_RKPM;
    const bool three = scheme->dimension == 3;
    for (int32_t k = 0; k < count; ++k)
        value[k] = three ? radius[k] * radius[k] * radius[k] : radius[k] * radius[k];
    for (int32_t k = 0; mls && k < count; ++k)
        value[k] = value[k] / (radius[k] * radius[k]) / mu2;
    for (int32_t k = 0; rkpm && k < count; ++k)
        value[k] = 1 / (mu2 * radius[k] * radius[k]);
    for (int32_t k = 0; !mls && !rkpm && scheme->method != SPHG_CMLS && k < count; ++k)
        value[k] = 1;
}

void sphgi_table_scales_at(const struct sphgi_scheme *scheme, int32_t count,
                           const double *restrict radius, double *restrict value,
                           double *restrict slope)
{
    const bool classic = sphgi_is_classic(scheme->method);
    put_values(scheme, count, radius, value);
    for (int32_t k = 0; k < count; ++k)
        slope[k] = classic ? value[k] / radius[k] : 0;
}

struct sphgi_scales sphgi_table_scales(const struct sphgi_scheme *scheme)
{
    struct sphgi_scales scales;
    sphgi_table_scales_at(scheme, 1, &scheme->radius, &scales.value, &scales.slope);
    return scales;
}

double sphgi_factor_of_h(const struct sphgi_scheme *scheme)
{
    const double sigma = sphgi_kernel_sigma(scheme->kernel, scheme->dimension);
    const bool by_value = scheme->method == SPHG_MLS || scheme->method == SPHG_RKPM;
    return by_value ? sigma / sphgi_kernel_mu2(scheme->kernel, scheme->dimension) : sigma;
}

static struct sphgi_table_unit table_unit_of(double factor, int32_t first, int32_t count)
{
    int exponent;
    struct sphgi_table_unit unit = {.first = first, .count = count};
    unit.mantissa = frexp(factor, &exponent);
    if (unit.mantissa == 0.5) { /* a power of two: nothing is rounded */
        unit.mantissa = 1;
        --exponent;
    }
    unit.power[0] = ldexp(1, exponent / 2);
    unit.power[1] = ldexp(1, exponent - exponent / 2);
    return unit;
}

void sphgi_table_units(const struct sphgi_plan *plan,
                       struct sphgi_table_unit units[SPHGI_TABLE_UNITS])
{
    const struct sphgi_scales scales = sphgi_table_scales(&plan->scheme);
    const int32_t width = sphgi_plan_width(plan), d = plan->dimension, pairs = d * (d + 1) / 2;
    const int32_t values = plan->classic ? d + 1 : plan->quadratic ? pairs : width;
    const double h = plan->scheme.radius;
    units[0] = table_unit_of(scales.value, 0, values);
    units[1] = units[2] = (struct sphgi_table_unit){.count = 0};
    if (plan->classic)
        units[1] = table_unit_of(scales.slope, values, width - values);
    if (plan->quadratic) {
        units[1] = table_unit_of(scales.value / h, pairs, d * pairs);
        units[2] =
            table_unit_of(scales.value / h / h, pairs + d * pairs, width - pairs - d * pairs);
    }
}

/* Products of the offsets have the moments m4 (2 I + 1 1^T) in a full neighbourhood, which
 * whitening turns into the unit matrix. */
struct sphgi_second sphgi_second_of(const struct sphgi_scheme *scheme)
{
    const int32_t d = scheme->dimension;
    const double mu2 = sphgi_kernel_mu2(scheme->kernel, d);
    const double m4 = scheme->method == SPHG_KGC ? mu2 : sphgi_kernel_mu4(scheme->kernel, d) / mu2;
    const double deviator = 1 / sqrt(2 * m4), whole = 1 / sqrt((d + 2) * m4);
    return (struct sphgi_second){.policy = scheme->policy,
                                 .eps = scheme->threshold / 10,
                                 .high = scheme->threshold,
                                 .off = 1 / sqrt(m4),
                                 .diagonal = deviator,
                                 .trace = (whole - deviator) / d};
}
