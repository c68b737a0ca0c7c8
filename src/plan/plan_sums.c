/* Which sums and streams a plan needs, and their numbers. */
#include "plan.h"

int32_t sphgi_square_sums(const struct sphgi_plan *plan)
{
    return plan->classic || !plan->corrects ? 1 : plan->dimension * (plan->dimension + 1) / 2;
}

static void decide_sums(struct sphgi_plan *plan)
{
    const int32_t d = plan->dimension;
    if (plan->computes)
        plan->sums += plan->classic     ? (d == 3 ? 29 : 15)
                      : plan->quadratic ? sphgi_quadratic_moments(d)
                                        : d * (d + 1) / 2;
    plan->volume_sum = plan->sums;
    plan->sums += plan->mean_volume ? 2 : 0;
    plan->moment_sums = plan->sums;
    for (int32_t k = 0; k < 2; ++k) {
        plan->vector_sum[k] = plan->sums;
        plan->sums += plan->transposes[k] ? d : 0;
    }
    for (int32_t k = 0; k < plan->field_count; ++k) {
        struct sphgi_field_plan *field = &plan->fields[k];
        field->sum = plan->sums;
        plan->sums += field->sums_gradient ? field->components * d : 0;
        field->second_sum = plan->sums;
        if (plan->quadratic && field->sums_gradient)
            plan->sums += field->components * d * (d + 1) / 2;
        field->divergence_sum = plan->sums;
        plan->sums += field->contracts ? field->divergence.count : 0;
        field->square_sum = plan->sums;
        plan->sums += field->square.count ? sphgi_square_sums(plan) : 0;
        field->value_sum = field->value.count ? plan->sums : -1;
        plan->sums += field->value.count ? field->components : 0;
    }
}

/* PLAIN: G_ji = -V_i G_ij / V_j, so that the adjoint form needs no other side. A divergence is
 * summed as such wherever nothing stands between the sum and the trace: C_i would. */
static void decide_field(struct sphgi_field_plan *field, sphg_method method)
{
    const bool plain = method == SPHG_PLAIN;
    field->antisymmetric = plain && field->form == SPHG_ADJOINT;
    field->forward = field->form <= SPHG_DIRECT || field->antisymmetric;
    field->contracts = field->divergence.count && (plain || !field->forward);
    field->sums_gradient = field->gradient.count || field->curl.count || field->hessian[0].count ||
                           field->laplacian.count || (field->divergence.count && !field->contracts);
}

void sphgi_plan_decide(struct sphgi_plan *plan, enum sphgi_purpose purpose)
{
    const sphg_method method = plan->scheme.method;
    bool needs_correction = purpose == SPHGI_FOR_PAIR_GRADIENTS;
    plan->differentiates = needs_correction;
    for (int32_t k = 0; k < plan->field_count; ++k) {
        struct sphgi_field_plan *field = &plan->fields[k];
        decide_field(field, method);
        plan->differentiates |= field->differentiates;
        plan->wants_value |= field->value.count > 0;
        plan->adjoint |= field->differentiates && field->form == SPHG_ADJOINT;
        plan->transposes[field->form == SPHG_SYMMETRIC] |= field->differentiates && !field->forward;
        needs_correction |= field->differentiates || (plan->classic && field->value.count);
    }
    plan->corrects = method != SPHG_PLAIN && needs_correction;
    plan->computes |= plan->corrects && !plan->target_correction.count;
    plan->mean_volume = plan->computes && method == SPHG_MLS && !plan->target_volume.count;
    plan->correction_stream = plan->density_stream = -1;
    if ((plan->transposes[0] || plan->transposes[1]) && method != SPHG_PLAIN) {
        plan->correction_stream = plan->stream_count;
        plan->stream_count += plan->classic ? plan->dimension + 1 : plan->dimension - 1;
    }
    if (plan->transposes[1])
        plan->density_stream = plan->stream_count++;
    decide_sums(plan);
}
