/* SPDX-License-Identifier: MIT */
/* The fields of a request: what is read of them, and where their results go. */
#include "builder.h"
#include "core/view.h"

/* ---- Fields --------------------------------------------------------------------------------- */

/* What order 2 has, and what it has not. */
static sphg_result check_second_order(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const sphg_field *field = &builder->request->fields[k];
    const bool hessian = !sphgi_is_absent(&field->hessian);
    const bool laplacian = !sphgi_is_absent(&field->laplacian) && field->form != SPHG_ADJOINT;
    if (builder->plan->quadratic && field->form == SPHG_DIRECT)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].form is direct: order 2 would read the surface as curvature; "
                     "use order 1 there",
                     f, (int)k);
    if ((hessian || laplacian) && !builder->plan->quadratic)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].%s needs scheme.order 2", f, (int)k,
                     hessian ? "hessian" : "laplacian");
    if ((hessian || laplacian) && field->form != SPHG_DIFFERENCE)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].%s", f, (int)k,
                     hessian ? "hessian outside the difference form"
                             : "laplacian outside the difference and adjoint forms");
    if (hessian && field->shape >= SPHG_SYM_TENSOR)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].hessian of a tensor", f, (int)k);
    return SPHG_OK;
}

/* Forms that are summed over G_ji, too, where G_ij and G_ji have radii of their own. */
static sphg_result check_both_sides(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const struct sphgi_plan *plan = builder->plan;
    const char *form = builder->request->fields[k].form == SPHG_ADJOINT ? "adjoint" : "symmetric";
    for (int32_t s = 0; s < plan->set_count; ++s) {
        const sphg_neighbors *n = plan->sets[s].neighbors;
        if (n->graded && !n->mutual)
            SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                         "%s: fields[%d].form is %s, but sources[%d].neighbors are not mutual", f,
                         (int)k, form, (int)s);
    }
    return SPHG_OK;
}

static sphg_result check_field(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const sphg_field *field = &builder->request->fields[k];
    if (field->shape < SPHG_SCALAR || field->shape > SPHG_TENSOR)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].shape is %d, not a shape", f, (int)k,
                     (int)field->shape);
    if (field->form < SPHG_DIFFERENCE || field->form > SPHG_ADJOINT)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].form is %d, not a form", f, (int)k,
                     (int)field->form);
    if (!field->at_sources)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].at_sources is NULL", f, (int)k);
    const bool tensor = field->shape >= SPHG_SYM_TENSOR, scalar = field->shape == SPHG_SCALAR;
    if (tensor && !sphgi_is_absent(&field->gradient))
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].gradient of a tensor", f, (int)k);
    if (scalar && !sphgi_is_absent(&field->divergence))
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].divergence of a scalar", f, (int)k);
    if (field->shape != SPHG_VECTOR && !sphgi_is_absent(&field->curl))
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].curl of what is no vector", f, (int)k);
    if ((field->form != SPHG_DIRECT || !scalar) && !sphgi_is_absent(&field->square))
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].square outside the direct form of a scalar", f, (int)k);
    sphg_result result = check_second_order(builder, k);
    if (!result)
        result = sphgi_check_lending(builder, k);
    if (!result)
        result = sphgi_check_diffusion(builder, k);
    if (!result)
        result = sphgi_check_value(builder, k);
    if (!result)
        result = sphgi_check_contraction(builder, k);
    if (!result && builder->plan->graded && field->form >= SPHG_SYMMETRIC)
        result = check_both_sides(builder, k);
    return result;
}

/* The Hessian of each component, as if it had a view of its own. */
static sphg_result take_hessian(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    const int32_t d = plan->dimension;
    const sphg_view *view = &given->hessian;
    const int32_t numbers = view->layout == SPHG_FULL ? d * d : d * (d + 1) / 2;
    const size_t bytes = (size_t)numbers * sphgi_size_of_type(plan->type);
    const void *start[3] = {view->x, view->y, view->z};
    const bool split = given->shape == SPHG_VECTOR && view->y;
    if (sphgi_is_absent(view))
        return SPHG_OK;
    if (given->shape == SPHG_VECTOR && d == 3 && !view->y != !view->z)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: of fields[%d].hessian.y and .z only one is set",
                     builder->checker.function, (int)k);
    for (int32_t c = 0; c < (given->shape == SPHG_VECTOR ? d : 1); ++c) {
        sphg_view one = *view;
        /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): c < d, which is at most 3 */
        one.x = split ? start[c] : (const char *)view->x + (size_t)c * bytes;
        one.y = one.z = NULL;
        const char *name = sphgi_name_view(builder, "fields[%d].hessian, component %d", k, c);
        const sphg_result result = sphgi_take_output(
            builder, &one, name, plan->type, SPHG_SYM_TENSOR, 0, &plan->fields[k].hessian[c]);
        if (result)
            return result;
    }
    return SPHG_OK;
}

static sphg_result take_results(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_shape gradient = given->shape == SPHG_SCALAR ? SPHG_VECTOR : SPHG_TENSOR;
    const sphg_shape divergence = given->shape == SPHG_VECTOR ? SPHG_SCALAR : SPHG_VECTOR;
    const sphg_shape curl = plan->dimension == 3 ? SPHG_VECTOR : SPHG_SCALAR;
    sphg_result result = sphgi_take_output(builder, &given->value,
                                           sphgi_name_view(builder, "fields[%d].value", k, 0),
                                           plan->type, given->shape, 0, &field->value);
    if (!result)
        result = sphgi_take_output(builder, &given->gradient,
                                   sphgi_name_view(builder, "fields[%d].gradient", k, 0),
                                   plan->type, gradient, 0, &field->gradient);
    if (!result)
        result = sphgi_take_output(builder, &given->divergence,
                                   sphgi_name_view(builder, "fields[%d].divergence", k, 0),
                                   plan->type, divergence, 0, &field->divergence);
    if (!result)
        result = sphgi_take_output(builder, &given->curl,
                                   sphgi_name_view(builder, "fields[%d].curl", k, 0), plan->type,
                                   curl, 0, &field->curl);
    if (!result)
        result = sphgi_take_output(builder, &given->square,
                                   sphgi_name_view(builder, "fields[%d].square", k, 0), plan->type,
                                   SPHG_SCALAR, 0, &field->square);
    if (!result)
        result = sphgi_take_output(builder, &given->laplacian,
                                   sphgi_name_view(builder, "fields[%d].laplacian", k, 0),
                                   plan->type, given->shape, 0, &field->laplacian);
    if (!result)
        result = take_hessian(builder, k);
    if (!result)
        result = sphgi_take_contraction(builder, k);
    if (!result)
        result = sphgi_take_lending(builder, k);
    field->diffuses = given->form == SPHG_ADJOINT && field->laplacian.count;
    field->differentiates = field->gradient.count || field->divergence.count || field->curl.count ||
                            field->square.count || (field->laplacian.count && !field->diffuses) ||
                            field->hessian[0].count || field->curvature.count ||
                            field->contraction.count;
    return result;
}

/* Does set s carry the values of the targets? */
static bool is_mirrored(const struct sphgi_plan_builder *builder, int32_t s, int32_t k)
{
    const sphg_field *field = &builder->request->fields[k];
    return field->mirror && sphgi_is_absent(&field->at_sources[s]);
}

static bool has_mirrors(const struct sphgi_plan_builder *builder, int32_t k)
{
    for (int32_t s = 0; s < builder->plan->set_count; ++s)
        if (is_mirrored(builder, s, k) && builder->plan->sets[s].neighbors->source_count > 0)
            return true;
    return false;
}

/* A_i: as a target in difference, adjoint and symmetric; as a source (self term), and by what is
 * mirrored, in direct. */
static sphg_result take_field_at_target(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_view absent = sphg_absent();
    const sphg_view *of_set = plan->own_set < 0 ? NULL : &given->at_sources[plan->own_set];
    const bool direct = given->form == SPHG_DIRECT, mirrors = has_mirrors(builder, k);
    const bool of_set_only = direct && !(mirrors && (!of_set || sphgi_is_absent(of_set)));
    const sphg_view *own = of_set_only ? &absent : &given->at_targets;
    const bool read =
        direct ? mirrors : field->differentiates || field->diffuses || field->value.count;
    field->mirrors = mirrors;
    plan->mirrors |= mirrors;
    if (sphgi_is_absent(own) && mirrors && of_set && sphgi_is_absent(of_set))
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: fields[%d].mirror is set, but neither at_targets nor at_sources[%d] is "
                     "there to be mirrored",
                     builder->checker.function, (int)k, (int)plan->own_set);
    if (sphgi_is_absent(own) && !of_set && read && plan->target_count > 0)
        SPHGI_REFUSE(
            SPHG_ERROR_ARGUMENT,
            "%s: fields[%d].at_targets is absent, and the targets are part of no source set",
            builder->checker.function, (int)k);
    const bool from_set = sphgi_is_absent(own) && of_set;
    const char *name =
        sphgi_name_view(builder, from_set ? "fields[%d].at_sources[%d]" : "fields[%d].at_targets",
                        k, plan->own_set);
    return sphgi_take_target_side(builder, own, of_set, name, name, given->shape, 0,
                                  &field->target);
}

sphg_result sphgi_take_field(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    sphg_result result = check_field(builder, k);
    if (result)
        return result;
    *field =
        (struct sphgi_field_plan){.shape = given->shape,
                                  .form = given->form,
                                  .accumulate = given->accumulate != 0,
                                  .components = sphgi_components(given->shape, plan->dimension)};
    field->streams = (field->components + SPHGI_ROW - 1) / SPHGI_ROW;
    field->stream = plan->stream_count;
    plan->stream_count += field->streams;
    field->at_target = plan->target_lanes;
    plan->target_lanes += field->streams * SPHGI_ROW; /* whole rows may be loaded */
    result = take_results(builder, k);
    if (!result)
        result = take_field_at_target(builder, k);
    if (!result)
        result = sphgi_take_coefficient_at_target(builder, k);
    return result ? result : sphgi_take_value_volume(builder, k);
}

/* ---- Streams: what is read of each source --------------------------------------------------- */

static sphg_result take_field_at_sources(struct sphgi_plan_builder *builder, int32_t s, int32_t k)
{
    const struct sphgi_plan *plan = builder->plan;
    const struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_view *view = &builder->request->fields[k].at_sources[s];
    const int32_t count = plan->sets[s].neighbors->source_count;
    struct sphgi_columns columns = {.count = 0};
    const bool mirrored = is_mirrored(builder, s, k);
    const bool difference = field->diffuses || (field->form == SPHG_DIFFERENCE &&
                                                (field->differentiates || field->value.count));
    if (sphgi_is_absent(view) && !mirrored && count > 0 && difference)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: fields[%d].at_sources[%d] is absent: set mirror for A_j = A_i, or give "
                     "one value for all",
                     builder->checker.function, (int)k, (int)s);
    const sphg_result result =
        sphgi_take_input(builder, view, sphgi_name_view(builder, "fields[%d].at_sources[%d]", k, s),
                         field->shape, 0, count, &columns);
    sphgi_add_streams(builder, s, field->stream, &columns, field->components, SPHGI_ROW);
    builder->streams[(ptrdiff_t)s * plan->stream_count + field->stream].mirrored = mirrored;
    return result;
}

/* A set needs its own corrections only where one of its fields is summed from the other side. */
static bool set_transposes(const struct sphgi_plan_builder *builder, int32_t s, sphg_form form)
{
    for (int32_t k = 0; k < builder->plan->field_count; ++k) {
        const sphg_field *field = &builder->request->fields[k];
        const struct sphgi_field_plan *planned = &builder->plan->fields[k];
        if (field->form == form && (planned->differentiates || planned->diffuses) &&
            (field->mirror || !sphgi_is_absent(&field->at_sources[s])))
            return true;
    }
    return false;
}

static sphg_result take_correction_of_set(struct sphgi_plan_builder *builder, int32_t s)
{
    struct sphgi_plan *plan = builder->plan;
    const int32_t width = sphgi_plan_width(plan);
    const sphg_view *view = &builder->request->sources[s].correction;
    struct sphgi_columns columns = {.count = 0};
    const bool needed =
        plan->sets[s].neighbors->source_count > 0 &&
        (set_transposes(builder, s, SPHG_ADJOINT) || set_transposes(builder, s, SPHG_SYMMETRIC));
    if (needed && sphgi_is_absent(view))
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: sources[%d].correction is absent; adjoint and symmetric forms read it",
                     builder->checker.function, (int)s);
    const sphg_result result = sphgi_take_input(
        builder, view, sphgi_name_view(builder, "sources[%d].correction", s, 0),
        sphgi_shape_of_table(plan), width, plan->sets[s].neighbors->source_count, &columns);
    const int32_t read = /* of order 2 all but R */
        plan->quadratic ? sphgi_correction_rows(plan) * SPHGI_ROW : width;
    sphgi_add_streams(builder, s, plan->correction_stream, &columns, sphgi_min32(read, width),
                      plan->classic ? plan->dimension + 1 : SPHGI_ROW);
    return result;
}

static sphg_result take_density_of_set(struct sphgi_plan_builder *builder, int32_t s)
{
    return sphgi_take_of_set(builder, s, &builder->request->sources[s].density,
                             sphgi_name_view(builder, "sources[%d].density", s, 0), SPHG_SCALAR, 1,
                             builder->plan->density_stream, 1, "; the symmetric form reads it");
}

sphg_result sphgi_take_streams(struct sphgi_plan_builder *builder)
{
    struct sphgi_plan *plan = builder->plan;
    for (int32_t s = 0; s < plan->set_count; ++s) {
        sphg_result result = SPHG_OK;
        plan->sets[s].streams = builder->streams + (ptrdiff_t)s * plan->stream_count;
        for (int32_t k = 0; k < plan->field_count && !result; ++k) {
            result = take_field_at_sources(builder, s, k);
            if (!result)
                result = sphgi_take_lenders(builder, s, k);
            if (!result)
                result = sphgi_take_coefficient_at_sources(builder, s, k);
            if (!result)
                result = sphgi_take_value_volume_of_set(builder, s, k);
        }
        if (!result && plan->correction_stream >= 0)
            result = take_correction_of_set(builder, s);
        if (!result && plan->density_stream >= 0)
            result = take_density_of_set(builder, s);
        if (result)
            return result;
    }
    return SPHG_OK;
}
