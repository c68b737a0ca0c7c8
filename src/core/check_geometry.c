/* SPDX-License-Identifier: MIT */
#include "check.h"
#include "digits.h"
#include "refuse.h"
#include "view.h"
#include <float.h>
#include <math.h>

static sphg_result check_counts(struct sphgi_checker checker, const sphg_geometry *geometry)
{
    const char *f = checker.function;
    if (geometry->source_count < 0)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.source_count is %d", f,
               (int)geometry->source_count);
    if (geometry->target_count < 0)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.target_count is %d", f,
               (int)geometry->target_count);
    if (!geometry->targets.x && geometry->target_count > geometry->source_count)
        REFUSE(SPHG_ERROR_SIZE,
               "%s: geometry.target_count is %d, but the targets are part of %d sources", f,
               (int)geometry->target_count, (int)geometry->source_count);
    return SPHG_OK;
}

static sphg_result check_skin(struct sphgi_checker checker, const sphg_geometry *geometry)
{
    const char *f = checker.function;
    if (!(geometry->skin >= 0) || !isfinite(geometry->skin))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.skin is %s, must be >= 0 and finite", f,
               sphgi_digits(geometry->skin).text);
    if (geometry->keep_weights && geometry->list_free)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.keep_weights is %d, but list_free keeps no pairs",
               f, (int)geometry->keep_weights);
    if (geometry->skin > 0 && geometry->list_free)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.skin is %s, but list_free keeps no pairs", f,
               sphgi_digits(geometry->skin).text);
    return SPHG_OK;
}

static sphg_result check_period(struct sphgi_checker checker, const sphg_geometry *geometry,
                                const struct sphgi_scheme *scheme)
{
    const char *f = checker.function;
    /* A period of twice the reach that was rounded on its way is what it was meant to be. Such an
     * axis has one cell, so that every pair is tested. */
    const bool f64 = sphgi_type_of_positions(geometry) == SPHG_F64;
    const double rounding = f64 ? 0x1p-51 : 0x1p-22;
    const double most = f64 ? DBL_MAX / 4 : (double)FLT_MAX / 4; /* differences do not overflow */
    for (int32_t a = 0; a < scheme->dimension; ++a) {
        const double period = geometry->period[a], least = 2 * (scheme->radius + geometry->skin);
        if (!(period >= 0 && period <= most))
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.period[%d] is %s, must be >= 0 and <= %s", f,
                   (int)a, sphgi_digits(period).text, sphgi_digits(most).text);
        if (period > 0 && period < least * (1 - rounding))
            REFUSE(SPHG_ERROR_ARGUMENT,
                   "%s: geometry.period[%d] is %s, must be at least 2 (H + skin) = %s", f, (int)a,
                   sphgi_digits(period).text, sphgi_digits(least).text);
    }
    return SPHG_OK;
}

sphg_type sphgi_type_of_positions(const sphg_geometry *geometry)
{
    const sphg_view *some = geometry->sources.x ? &geometry->sources : &geometry->targets;
    if (some->x)
        return some->type;
    if (geometry->sources.type == SPHG_F64 || some->type == SPHG_F64)
        return SPHG_F64;
    return geometry->precision ? geometry->precision : SPHG_F32; /* an absent view is f32, too */
}

/* A stride of 0 would put all particles in one place. */
static sphg_result check_positions(struct sphgi_checker checker, const sphg_view *view,
                                   const struct sphgi_expected *expected)
{
    const sphg_result result = sphgi_check_view(checker, view, expected);
    if (!result && !sphgi_is_absent(view) && !view->stride && expected->count > 1)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is 0, but there are %d positions",
               checker.function, expected->name, (int)expected->count);
    return result;
}

static sphg_result check_support(struct sphgi_checker checker, const sphg_view *view,
                                 const char *name, sphg_type type, int32_t count)
{
    const struct sphgi_expected expected = {
        .name = name, .type = type, .shape = SPHG_SCALAR, .count = count};
    return sphgi_check_view(checker, view, &expected);
}

/* Radii of their own: of everybody or of nobody. */
static sphg_result check_supports(struct sphgi_checker checker, const sphg_geometry *geometry,
                                  sphg_type type)
{
    const char *f = checker.function;
    const bool apart = geometry->targets.x || !geometry->target_count;
    const bool sources = geometry->source_support.x, targets = geometry->target_support.x;
    sphg_result result = check_support(checker, &geometry->source_support,
                                       "geometry.source_support", type, geometry->source_count);
    if (!result)
        result = check_support(checker, &geometry->target_support, "geometry.target_support", type,
                               geometry->target_count);
    if (result)
        return result;
    if (targets && !apart)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: geometry.target_support is set, but the targets are part of the sources", f);
    if (targets && !sources && geometry->source_count > 0)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: geometry.target_support is set, but source_support is absent", f);
    if (sources && !targets && geometry->targets.x && geometry->target_count > 0)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: geometry.source_support is set, but target_support is absent", f);
    return SPHG_OK;
}

sphg_result sphgi_check_geometry(struct sphgi_checker checker, const sphg_geometry *geometry,
                                 const struct sphgi_scheme *scheme, bool searched)
{
    const char *f = checker.function;
    sphg_result result = sphgi_check_pointer(checker, geometry, "geometry");
    if (!result)
        result = check_counts(checker, geometry);
    if (result)
        return result;
    const sphg_type type = sphgi_type_of_positions(geometry);
    if (type != SPHG_F32 && type != SPHG_F64)
        REFUSE(SPHG_ERROR_TYPE, "%s: geometry.sources.type is %d, must be 1 (f32) or 2 (f64)", f,
               (int)type);
    struct sphgi_expected expected = {.name = "geometry.sources",
                                      .type = type,
                                      .shape = SPHG_VECTOR,
                                      .dimension = scheme->dimension,
                                      .count = geometry->source_count,
                                      .required = geometry->source_count > 0};
    result = check_positions(checker, &geometry->sources, &expected);
    expected.name = "geometry.targets";
    expected.count = geometry->target_count;
    expected.required = false;
    if (!result)
        result = check_positions(checker, &geometry->targets, &expected);
    if (result)
        return result;
    if (geometry->precision && geometry->precision != SPHG_F32 && geometry->precision != SPHG_F64)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.precision is %d, must be 0, 1 (f32) or 2 (f64)",
               f, (int)geometry->precision);
    if (geometry->precision == SPHG_F64 && type == SPHG_F32)
        REFUSE(SPHG_ERROR_TYPE, "%s: geometry.precision is f64, but the positions are f32", f);
    if (!searched && geometry->skin != 0)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.skin is %s, it is for searches only", f,
               sphgi_digits(geometry->skin).text);
    if (!searched && geometry->keep_weights)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.keep_weights is %d, it is for searches only", f,
               (int)geometry->keep_weights);
    if (!searched && geometry->list_free)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.list_free is %d, it is for searches only", f,
               (int)geometry->list_free);
    result = check_skin(checker, geometry);
    return result ? result : check_supports(checker, geometry, type);
}

sphg_result sphgi_check_extent(struct sphgi_checker checker, const sphg_geometry *geometry,
                               const struct sphgi_scheme *scheme)
{
    sphg_result result = check_period(checker, geometry, scheme);
    if (!result)
        result = sphgi_check_range(checker, scheme, sphgi_type_of_positions(geometry));
    if (!result && geometry->precision == SPHG_F32)
        result = sphgi_check_range(checker, scheme, SPHG_F32);
    return result;
}
