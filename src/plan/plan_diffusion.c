/* SPDX-License-Identifier: MIT */
/* Diffusion, the Laplacian of the adjoint form: what is refused, and the coefficients of both
 * sides. */
#include "builder.h"
#include "core/view.h"

sphg_result sphgi_check_diffusion(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const struct sphgi_plan *plan = builder->plan;
    const sphg_field *field = &builder->request->fields[k];
    const bool diffuses = field->form == SPHG_ADJOINT && !sphgi_is_absent(&field->laplacian);
    const bool at_targets = !sphgi_is_absent(&field->coefficient_at_targets);
    if (diffuses && plan->quadratic)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].laplacian of the adjoint form has order 1: with order 2 heat "
                     "could flow from cold to warm",
                     f, (int)k);
    if (diffuses && plan->classic)
        SPHGI_REFUSE(
            SPHG_ERROR_UNSUPPORTED,
            "%s: fields[%d].laplacian of the adjoint form is not for classic methods, with "
            "which heat could flow from cold to warm",
            f, (int)k);
    if ((field->coefficient || at_targets) && !diffuses)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].%s is for the laplacian of the adjoint form", f, (int)k,
                     field->coefficient ? "coefficient" : "coefficient_at_targets");
    if (at_targets && !field->coefficient)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: fields[%d].coefficient is NULL, but coefficient_at_targets is there", f,
                     (int)k);
    return SPHG_OK;
}

sphg_result sphgi_take_coefficient_at_target(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_view *own = &given->coefficient_at_targets;
    const sphg_view *of_set =
        plan->own_set < 0 || !given->coefficient ? NULL : &given->coefficient[plan->own_set];
    field->coefficient_stream = -1;
    if (!given->coefficient)
        return SPHG_OK;
    field->coefficient_stream = plan->stream_count++;
    field->coefficient_at_target = plan->target_lanes++;
    if (sphgi_is_absent(own) && !of_set && plan->target_count > 0)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: fields[%d].coefficient_at_targets is absent, and the targets are part of "
                     "no source set",
                     builder->checker.function, (int)k);
    const bool from_set = sphgi_is_absent(own) && of_set;
    const char *name = sphgi_name_view(
        builder, from_set ? "fields[%d].coefficient[%d]" : "fields[%d].coefficient_at_targets", k,
        plan->own_set);
    return sphgi_take_target_side(builder, own, of_set, name, name, SPHG_SCALAR, 1,
                                  &field->coefficient);
}

/* A set that is mirrored exchanges nothing: its coefficients are not read, unless the targets have
 * theirs there. */
sphg_result sphgi_take_coefficient_at_sources(struct sphgi_plan_builder *builder, int32_t s,
                                              int32_t k)
{
    const struct sphgi_plan *plan = builder->plan;
    const struct sphgi_field_plan *field = &plan->fields[k];
    if (field->coefficient_stream < 0)
        return SPHG_OK;
    const struct sphgi_stream *values =
        builder->streams + (ptrdiff_t)s * plan->stream_count + field->stream;
    const bool of_targets = s == plan->own_set && !field->coefficient.count;
    return sphgi_take_of_set(
        builder, s, &builder->request->fields[k].coefficient[s],
        sphgi_name_view(builder, "fields[%d].coefficient[%d]", k, s), SPHG_SCALAR, 1,
        field->coefficient_stream, 1,
        values->mirrored && !of_targets
            ? NULL
            : "; give one value for all, or leave coefficient NULL for 1 everywhere");
}
