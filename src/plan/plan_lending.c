/* SPDX-License-Identifier: MIT */
/* Curvature that is lent and borrowed: what is refused, what a field offers and reads. */
#include "builder.h"
#include "core/view.h"

/* Of a source: its confidence, and the Hessian of each component. */
static int32_t numbers_lent(int32_t components, int32_t dimension)
{
    return 1 + components * dimension * (dimension + 1) / 2;
}

sphg_result sphgi_check_lending(struct sphgi_plan_builder *builder, int32_t k)
{
    const char *f = builder->checker.function;
    const sphg_field *field = &builder->request->fields[k];
    const bool lends = !sphgi_is_absent(&field->curvature);
    const char *name = field->lenders ? "lenders" : "curvature";
    if (!lends && !field->lenders)
        return SPHG_OK;
    if (!builder->plan->quadratic)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].%s needs scheme.order 2", f, (int)k,
                     name);
    if (field->form != SPHG_DIFFERENCE)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].%s is for the difference form: curvature that is borrowed has "
                     "no adjoint",
                     f, (int)k, name);
    if (builder->plan->target_correction.count)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].%s beside a table of corrections: no table says how well "
                     "curvature is resolved",
                     f, (int)k, name);
    if (field->lenders && builder->plan->correction.count)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED,
                     "%s: fields[%d].lenders beside a wanted correction: no table holds curvature "
                     "that is borrowed; ask for the table without lenders",
                     f, (int)k);
    return SPHG_OK;
}

sphg_result sphgi_take_lending(struct sphgi_plan_builder *builder, int32_t k)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_field *given = &builder->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const int32_t numbers = numbers_lent(field->components, plan->dimension);
    field->lent_stream = plan->stream_count;
    field->lent_rows = given->lenders ? (numbers + SPHGI_ROW - 1) / SPHGI_ROW : 0;
    plan->stream_count += field->lent_rows;
    plan->lends |= field->lent_rows || !sphgi_is_absent(&given->curvature);
    return sphgi_take_output(builder, &given->curvature,
                             sphgi_name_view(builder, "fields[%d].curvature", k, 0), plan->type,
                             (sphg_shape)0, numbers, &field->curvature);
}

sphg_result sphgi_take_lenders(struct sphgi_plan_builder *builder, int32_t s, int32_t k)
{
    const struct sphgi_plan *plan = builder->plan;
    const struct sphgi_field_plan *field = &plan->fields[k];
    if (!field->lent_rows)
        return SPHG_OK;
    return sphgi_take_of_set(builder, s, &builder->request->fields[k].lenders[s],
                             sphgi_name_view(builder, "fields[%d].lenders[%d]", k, s),
                             (sphg_shape)0, numbers_lent(field->components, plan->dimension),
                             field->lent_stream, SPHGI_ROW, NULL);
}

sphg_result sphgi_take_borrows(struct sphgi_plan_builder *builder)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_view *view = &builder->request->borrows;
    if (!sphgi_is_absent(view) && !plan->quadratic)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: borrows needs scheme.order 2",
                     builder->checker.function);
    const sphg_result result =
        sphgi_take_output(builder, view, "borrows", SPHG_U8, SPHG_SCALAR, 1, &plan->borrows);
    plan->lends |= plan->borrows.count > 0;
    return result;
}
