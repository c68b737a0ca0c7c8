/* SPDX-License-Identifier: MIT */
#include "check.h"
#include "digits.h"
#include "kernel.h"
#include "refuse.h"
#include <float.h>
#include <math.h>

bool sphgi_is_classic(sphg_method method)
{
    return method == SPHG_CMLS || method == SPHG_CRKPM;
}

int32_t sphgi_correction_width(sphg_method method, int32_t dimension, int32_t order)
{
    if (method == SPHG_PLAIN)
        return 0;
    const int32_t d = dimension, all = d * (d + 3) / 2;
    if (order == 2)
        return all * (all + 1) / 2;
    return sphgi_is_classic(method) ? (d + 1) * (d + 1) : d * (d + 1) / 2;
}

int32_t sphg_correction_width(const sphg_scheme *scheme)
{
    if (!scheme || scheme->method < SPHG_KGC || scheme->method > SPHG_PLAIN)
        return 0;
    const bool second = scheme->order == 2 && scheme->method <= SPHG_RKPM;
    return sphgi_correction_width(scheme->method, scheme->dimension == 2 ? 2 : 3, second ? 2 : 1);
}

sphg_result sphgi_check_pointer(struct sphgi_checker checker, const void *pointer, const char *name)
{
    if (!pointer)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s is NULL", checker.function, name);
    return SPHG_OK;
}

sphg_result sphgi_check_scheme_beside_radii(struct sphgi_checker checker, const sphg_scheme *scheme,
                                            struct sphgi_scheme *checked)
{
    const char *f = checker.function;
    const sphg_result missing = sphgi_check_pointer(checker, scheme, "scheme");
    if (missing)
        return missing;
    if (scheme->dimension != 0 && scheme->dimension != 2 && scheme->dimension != 3)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.dimension is %d, must be 2 or 3", f,
               (int)scheme->dimension);
    if (scheme->method < SPHG_KGC || scheme->method > SPHG_PLAIN)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.method is %d, not a method", f,
               (int)scheme->method);
    if (!sphgi_kernel_exists(scheme->kernel))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.kernel is %d, not a kernel", f,
               (int)scheme->kernel);
    if (scheme->policy < SPHG_BLEND || scheme->policy > SPHG_IDENTITY)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.policy is %d, not a policy", f,
               (int)scheme->policy);
    if (!(scheme->threshold >= 0 && scheme->threshold < 1))
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: scheme.threshold is %s, must be at least 0 (the default) and below 1", f,
               sphgi_digits(scheme->threshold).text);
    if (scheme->order < 0 || scheme->order > 2)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.order is %d, must be 1 (or 0) or 2", f,
               (int)scheme->order);
    if (scheme->order == 2 && scheme->method > SPHG_RKPM)
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: scheme.order is 2, which KGC, MLS and RKPM have", f);
    *checked = (struct sphgi_scheme){
        .dimension = scheme->dimension ? scheme->dimension : 3,
        .method = scheme->method,
        .kernel = scheme->kernel,
        .policy = scheme->policy,
        .threshold = scheme->threshold > 0 ? scheme->threshold : 1e-2,
        .order = scheme->order == 2 ? 2 : 1,
        .radii = true,
    };
    return SPHG_OK;
}

sphg_result sphgi_check_scheme(struct sphgi_checker checker, const sphg_scheme *scheme,
                               struct sphgi_scheme *checked)
{
    const sphg_result result = sphgi_check_scheme_beside_radii(checker, scheme, checked);
    if (result)
        return result;
    checked->radius = scheme->support_radius;
    checked->radii = false;
    if (!(scheme->support_radius > 0) || !isfinite(scheme->support_radius))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.support_radius is %s, must be positive and finite",
               checker.function, sphgi_digits(scheme->support_radius).text);
    return SPHG_OK;
}

static bool is_normal_in(double x, sphg_type type)
{
    return type == SPHG_F64 ? isnormal(x) : x >= (double)FLT_MIN && x <= (double)FLT_MAX;
}

sphg_result sphgi_check_range(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                              sphg_type type)
{
    const double h = scheme->radius;
    if (!is_normal_in(h * h, type) || !is_normal_in(sphgi_power(1 / h, scheme->dimension), type))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s %s, its powers leave the range of the precision",
               checker.function,
               scheme->radii ? "a radius in geometry.source_support or geometry.target_support is"
                             : "scheme.support_radius is",
               sphgi_digits(h).text);
    return SPHG_OK;
}
