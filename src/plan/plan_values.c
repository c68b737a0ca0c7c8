/* SPDX-License-Identifier: MIT */
/* What fields have beside their derivatives: sums of values, with volumes of their own and divided
 * by those of the weights, and gradients contracted with a tensor of each target. */
#include "builder.h"
#include "core/view.h"

int32_t sphgi_streams_of(const sphg_field *field)
{
    const int32_t lent = 1 + 9 * 6; /* numbers, of a tensor in 3D */
    return 3 + (field->coefficient != NULL) + (field->value_volume != NULL) +
           (field->lenders ? (lent + SPHGI_ROW - 1) / SPHGI_ROW : 0);
}

size_t sphgi_views_of(const sphg_field *field)
{
    return (size_t)(field->lenders != NULL) + (size_t)(field->coefficient != NULL) +
           (size_t)(field->value_volume != NULL);
}

sphg_result sphgi_check_value(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const sphg_field *field = &builder->request->fields[k];
    const bool wanted = !sphgi_is_absent(&field->value), classic = builder->plan->classic;
    const char *name = field->shepard ? "shepard" : "value_volume";
    if (wanted && field->form >= SPHG_SYMMETRIC)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].value outside the difference and direct forms", f, (int)k);
    if (field->shepard && field->form != SPHG_DIRECT)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].shepard outside the direct form", f,
                     (int)k);
    if ((field->shepard || field->value_volume) && !wanted)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].%s is set, but value is absent", f,
                     (int)k, name);
    if ((field->shepard || field->value_volume) && classic)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].%s is not for classic methods, whose weights sum to 1", f,
                     (int)k, name);
    return SPHG_OK;
}

/* Of the targets as sources: what they add to their own value. */
sphg_result sphgi_take_value_volume(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    field->normalises = given->shepard != 0;
    field->own_volume = plan->own_volume;
    field->volume_stream = -1;
    if (!given->value_volume)
        return SPHG_OK;
    field->volume_stream = plan->stream_count++;
    if (plan->own_set < 0)
        return SPHG_OK;
    return sphgi_take_input(
        builder, &given->value_volume[plan->own_set],
        sphgi_name_view(builder, "fields[%d].value_volume[%d]", k, plan->own_set), SPHG_SCALAR, 1,
        plan->target_count, &field->own_volume);
}

sphg_result sphgi_take_value_volume_of_set(struct sphgi_plan_builder *builder, int32_t s, int32_t k)
{
    const struct sphgi_field_plan *field = &builder->plan->fields[k];
    if (field->volume_stream < 0)
        return SPHG_OK;
    return sphgi_take_of_set(builder, s, &builder->request->fields[k].value_volume[s],
                             sphgi_name_view(builder, "fields[%d].value_volume[%d]", k, s),
                             SPHG_SCALAR, 1, field->volume_stream, 1, "");
}

sphg_result sphgi_check_contraction(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const sphg_field *field = &builder->request->fields[k];
    const bool wanted = !sphgi_is_absent(&field->contraction);
    if (wanted && field->shape != SPHG_VECTOR)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].contraction of what is no vector", f,
                     (int)k);
    if (wanted && sphgi_is_absent(&field->tensor) && builder->plan->target_count > 0)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: fields[%d].contraction is wanted, but tensor is absent", f, (int)k);
    if (!wanted && !sphgi_is_absent(&field->tensor))
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].tensor is set, but contraction is absent",
                     f, (int)k);
    return SPHG_OK;
}

sphg_result sphgi_take_contraction(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    const sphg_result result = sphgi_take_input(
        builder, &given->tensor, sphgi_name_view(builder, "fields[%d].tensor", k, 0), SPHG_TENSOR,
        0, plan->target_count, &plan->fields[k].tensor);
    if (result)
        return result;
    return sphgi_take_output(builder, &given->contraction,
                             sphgi_name_view(builder, "fields[%d].contraction", k, 0), plan->type,
                             SPHG_SCALAR, 0, &plan->fields[k].contraction);
}
