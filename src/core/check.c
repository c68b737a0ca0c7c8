/* SPDX-License-Identifier: MIT */
#include "check.h"
#include "digits.h"
#include "kernel.h"
#include "view.h"
#include <float.h>
#include <math.h>

#define REFUSE(result, ...) return sphgi_fail(checker.context, result, __VA_ARGS__)

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

/* ---- Scheme --------------------------------------------------------------------------------- */

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

/* ---- Views ---------------------------------------------------------------------------------- */

static bool is_aligned(const void *pointer, size_t size)
{
    return (uintptr_t)pointer % size == 0;
}

/* Bytes from one item to the next, whatever the direction; PTRDIFF_MIN has no opposite. */
static size_t span_of(ptrdiff_t stride)
{
    return stride < 0 ? (size_t)0 - (size_t)stride : (size_t)stride;
}

static sphg_result check_stride(struct sphgi_checker checker, const sphg_view *view,
                                const struct sphgi_expected *expected, int32_t numbers)
{
    const size_t size = sphgi_size_of_type(expected->type), span = span_of(view->stride);
    if (span % size)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, must be a multiple of %zu",
               checker.function, expected->name, view->stride, size);
    if (expected->count > 1 && span > (size_t)PTRDIFF_MAX / (size_t)expected->count)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, more than memory has for %d items",
               checker.function, expected->name, view->stride, (int)expected->count);
    if (expected->use == SPHGI_OUTPUT && expected->count > 1 && span < (size_t)numbers * size)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, but an item of this output takes %zu",
               checker.function, expected->name, view->stride, (size_t)numbers * size);
    return SPHG_OK;
}

static sphg_result check_layout(struct sphgi_checker checker, const sphg_view *view,
                                const struct sphgi_expected *expected)
{
    const char *f = checker.function, *name = expected->name;
    if (view->layout < SPHG_AS_SHAPE || view->layout > SPHG_FULL)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.layout is %d, not a layout", f, name,
               (int)view->layout);
    if (view->layout == SPHG_COLUMN_MAJOR && expected->shape != SPHG_TENSOR)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.layout is COLUMN_MAJOR, but these are no tensors", f,
               name);
    if (view->layout == SPHG_FULL && expected->shape != SPHG_SYM_TENSOR)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: %s.layout is FULL, but these are no symmetric tensors or linear corrections", f,
               name);
    return SPHG_OK;
}

/* Numbers that stand behind view->x. */
static int32_t numbers_in_item(const sphg_view *view, const struct sphgi_expected *expected,
                               bool split)
{
    const int32_t d = expected->dimension;
    if (!expected->shape)
        return expected->numbers;
    if (view->layout == SPHG_FULL)
        return d * d;
    return sphgi_components(expected->shape, d) / (split ? d : 1);
}

sphg_result sphgi_check_view(struct sphgi_checker checker, const sphg_view *view,
                             const struct sphgi_expected *expected)
{
    const char *f = checker.function, *name = expected->name;
    const size_t size = sphgi_size_of_type(expected->type);
    if (sphgi_is_absent(view)) {
        if (expected->required)
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s is absent", f, name);
        return SPHG_OK;
    }
    if (view->type < SPHG_F32 || view->type > SPHG_U8)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.type is %d, not a type", f, name, (int)view->type);
    if (view->type != expected->type)
        REFUSE(SPHG_ERROR_TYPE, "%s: %s.type is %d, must be %d here (1: f32, 2: f64, 3: u8)", f,
               name, (int)view->type, (int)expected->type);
    const bool many = expected->shape == SPHG_VECTOR || expected->shape == SPHG_TENSOR;
    const bool split = many && view->y;
    if (many && expected->dimension == 3 && !view->y != !view->z)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: of %s.y and %s.z only one is set", f, name, name);
    if (!is_aligned(view->x, size) || (split && !is_aligned(view->y, size)) ||
        (split && expected->dimension == 3 && !is_aligned(view->z, size)))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s does not start at a multiple of %zu", f, name, size);
    const sphg_result result = check_layout(checker, view, expected);
    return result ? result
                  : check_stride(checker, view, expected, numbers_in_item(view, expected, split));
}

/* ---- Geometry, lists, subsets --------------------------------------------------------------- */

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
                                  sphg_type type, bool searched)
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
    if ((sources || targets) && !searched)
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: geometry.%s is set, but radii are for searches only", f,
               sources ? "source_support" : "target_support");
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
    return result ? result : check_supports(checker, geometry, type, searched);
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

static sphg_result check_offsets(struct sphgi_checker checker, const int64_t *offsets,
                                 int32_t target_count)
{
    if (offsets[0] != 0)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.offsets[0] is %lld, must be 0", checker.function,
               (long long)offsets[0]);
    for (int32_t i = 0; i < target_count; ++i)
        if (offsets[i + 1] < offsets[i])
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.offsets[%d] is %lld, less than the one before",
                   checker.function, (int)i + 1, (long long)offsets[i + 1]);
    return SPHG_OK;
}

sphg_result sphgi_check_lists(struct sphgi_checker checker, const sphg_lists *lists,
                              int32_t target_count)
{
    const char *f = checker.function;
    const sphg_result missing = sphgi_check_pointer(checker, lists, "lists");
    if (missing)
        return missing;
    const int csr = lists->offsets || lists->indices, rows = lists->rows || lists->lengths;
    if (!target_count && !lists->offsets && !lists->row) /* rows of nobody */
        return SPHG_OK;
    if (csr + rows + !!lists->row != 1)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: lists needs exactly one of offsets + indices, rows + lengths, row", f);
    if (csr) {
        if (!lists->offsets || (!lists->indices && lists->offsets[target_count] > 0))
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.%s is NULL", f,
                   lists->offsets ? "indices" : "offsets");
        if (!checker.context->config.trusted)
            return check_offsets(checker, lists->offsets, target_count);
    }
    if (rows && (!lists->rows || !lists->lengths))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.%s is NULL", f, lists->rows ? "lengths" : "rows");
    return SPHG_OK;
}

sphg_result sphgi_refuse_list(struct sphgi_checker checker, int32_t target, int64_t index)
{
    if (index == SPHGI_BAD_LENGTH)
        REFUSE(SPHG_ERROR_INDEX, "%s: the list of target %d has a negative length or is NULL",
               checker.function, (int)target);
    REFUSE(SPHG_ERROR_INDEX, "%s: the list of target %d holds %lld, which is no source",
           checker.function, (int)target, (long long)index);
}

sphg_result sphgi_check_subset(struct sphgi_checker checker, const sphg_subset *subset,
                               int32_t target_count)
{
    const char *f = checker.function;
    if (!subset)
        return SPHG_OK;
    if (subset->begin < 0 || subset->end < subset->begin ||
        (!subset->indices && subset->end > target_count))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: subset is [%d, %d) of %d targets", f, (int)subset->begin,
               (int)subset->end, (int)target_count);
    if ((subset->indices || subset->mask) && !subset->end && target_count > 0)
        REFUSE(SPHG_ERROR_ARGUMENT,
               subset->indices ? "%s: subset.indices is set, but subset.end is 0; if nobody is "
                                 "meant, indices is NULL, as sphg_listed(indices, 0) makes it"
                               : "%s: subset.mask is set, but subset.end is 0; "
                                 "sphg_masked(mask, target_count) sets both",
               f);
    for (int32_t k = subset->begin; subset->indices && k < subset->end; ++k)
        if (subset->indices[k] < 0 || subset->indices[k] >= target_count)
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: subset.indices[%d] is %d of %d targets", f, (int)k,
                   (int)subset->indices[k], (int)target_count);
    return SPHG_OK;
}
