/* SPDX-License-Identifier: MIT */
/* Which sums, streams and rows a plan needs, and their numbers. */
#include "plan.h"

int32_t sphgi_square_sums(const struct sphgi_plan *plan)
{
    return plan->classic || !plan->corrects ? 1 : plan->dimension * (plan->dimension + 1) / 2;
}

static void decide_sums(struct sphgi_plan *plan)
{
    const int32_t d = plan->dimension;
    if (plan->computes)
        plan->sums += plan->classic     ? 1 + d + d * (d + 1) / 2
                      : plan->quadratic ? sphgi_quadratic_moments(d)
                                        : d * (d + 1) / 2;
    plan->volume_sum = plan->sums;
    plan->sums += plan->mean_volume ? 2 : 0;
    plan->slope_sum = plan->sums;
    plan->sums += plan->classic && plan->computes ? d + d * (d + 1) / 2 : 0;
    plan->moment_sums = plan->sums;
    for (int32_t k = 0; k < 2; ++k) {
        plan->vector_sum[k] = plan->folded_sum[k] = plan->sums;
        if (plan->transposes[k] && !(plan->both_sides && !plan->sums_transposed[k]))
            plan->sums += plan->quadratic ? d + d * (d + 1) / 2 : d;
        if (plan->both_sides && plan->carrier[k] >= 0) {
            plan->folded_sum[k] = plan->sums;
            plan->sums += d;
        }
    }
    for (int32_t k = 0; k < plan->field_count; ++k) {
        struct sphgi_field_plan *field = &plan->fields[k];
        field->sum = plan->sums;
        plan->sums += field->sums_gradient ? field->components * d : 0;
        field->second_sum = plan->sums;
        if (plan->quadratic && field->sums_gradient && field->one_sided)
            plan->sums += field->components * d * (d + 1) / 2;
        field->lent_sum = plan->sums;
        plan->sums += field->lent_rows ? 1 + field->components * d * (d + 1) / 2 : 0;
        field->divergence_sum = plan->sums;
        plan->sums += field->sums_divergence ? field->divergence.count : 0;
        field->square_sum = plan->sums;
        plan->sums += field->square.count ? sphgi_square_sums(plan) : 0;
        field->value_sum = field->value.count ? plan->sums : -1;
        plan->sums += field->value.count ? field->components : 0;
        field->filling_sum = plan->sums;
        plan->sums += field->normalises ? 1 : 0;
        field->diffusion_sum = plan->sums;
        plan->sums += field->diffuses ? field->components : 0;
    }
}

/* PLAIN: G_ji = -V_i G_ij / V_j, so that the adjoint form needs no other side. A divergence is
 * summed as such wherever nothing stands between the sum and the trace: C_i would. */
static void decide_field(struct sphgi_field_plan *field, sphg_method method, bool graded)
{
    const bool plain = method == SPHG_PLAIN;
    field->antisymmetric = plain && field->form == SPHG_ADJOINT && !graded && !field->diffuses;
    field->one_sided = field->form <= SPHG_DIRECT || field->antisymmetric;
    field->sums_divergence = field->divergence.count && (plain || !field->one_sided);
    field->sums_gradient = field->gradient.count || field->curl.count || field->hessian[0].count ||
                           field->contraction.count ||
                           (field->laplacian.count && !field->diffuses) || field->curvature.count ||
                           (field->divergence.count && !field->sums_divergence);
}

/* Classic gradients and those of order 2 hold products of offsets, which do not come apart; a
 * gradient of a vector would become three times as many numbers as A_j and C_j are. What is
 * mirrored belongs to the target. A result alone is summed like one among others. */
static enum sphgi_fold fold_of(const struct sphgi_plan *plan, const struct sphgi_field_plan *field)
{
    const bool plain = plan->scheme.method == SPHG_PLAIN;
    if (!field->differentiates || field->one_sided || field->mirrors || field->diffuses ||
        plan->classic || plan->quadratic)
        return SPHGI_NOT_FOLDED;
    if (field->shape == SPHG_SCALAR)
        return plain ? SPHGI_FOLDED_NUMBER : SPHGI_FOLDED_SYMMETRIC;
    if (field->shape == SPHG_VECTOR)
        return field->sums_divergence ? SPHGI_FOLDED_VECTOR : SPHGI_NOT_FOLDED;
    return plain && field->shape == SPHG_SYM_TENSOR ? SPHGI_FOLDED_SYMMETRIC : SPHGI_FOLDED_MATRIX;
}

/* The first folded field of a form carries what is summed once for all of them: with two radii the
 * weights of the sources, which are not in s_ij then, stand behind its b_j. */
static void fold_field(struct sphgi_plan *plan, int32_t k)
{
    struct sphgi_field_plan *field = &plan->fields[k];
    const bool symmetric = field->form == SPHG_SYMMETRIC;
    if (!field->fold)
        return;
    const bool carries = plan->carrier[symmetric] < 0;
    const bool dense = carries && (symmetric || plan->both_sides);
    const int32_t numbers = sphgi_folded_numbers(field->fold, plan->dimension) + (dense ? 1 : 0);
    if (carries)
        plan->carrier[symmetric] = k;
    field->folded_row = plan->row_count;
    field->folded_rows = (numbers + SPHGI_ROW - 1) / SPHGI_ROW;
    plan->row_count += field->folded_rows;
    plan->both_at_once |= plan->both_sides;
}

static void decide_rows_of(struct sphgi_plan *plan, int32_t k)
{
    struct sphgi_field_plan *field = &plan->fields[k];
    field->fold = fold_of(plan, field);
    fold_field(plan, k);
    field->lent_row = plan->row_count;
    plan->row_count += field->lent_rows;
    field->volume_row = field->volume_stream < 0 ? -1 : plan->row_count++;
    field->coefficient_row = field->coefficient_stream < 0 ? -1 : plan->row_count++;
    if (field->fold && !(field->shape == SPHG_VECTOR && field->sums_gradient))
        return;
    field->row = plan->row_count;
    field->rows = field->streams;
    plan->row_count += field->rows;
    if (field->differentiates && !field->one_sided)
        plan->sums_transposed[field->form == SPHG_SYMMETRIC] = true;
}

static void decide_rows(struct sphgi_plan *plan)
{
    const bool transposes = plan->transposes[0] || plan->transposes[1];
    const int32_t correction = sphgi_correction_rows(plan);
    plan->correction_stream = plan->density_stream = -1;
    plan->correction_row = plan->density_row = -1;
    plan->carrier[0] = plan->carrier[1] = -1;
    plan->both_sides = plan->graded && (transposes || plan->diffuses);
    for (int32_t k = 0; k < plan->field_count; ++k)
        decide_rows_of(plan, k);
    if ((transposes || plan->diffuses) && plan->scheme.method != SPHG_PLAIN) {
        plan->correction_stream = plan->stream_count;
        plan->stream_count += correction;
        if (plan->sums_transposed[0] || plan->sums_transposed[1] || plan->diffuses) {
            plan->correction_row = plan->row_count;
            plan->row_count += correction;
        }
    }
    if (plan->transposes[1]) {
        plan->density_stream = plan->stream_count++;
        if (plan->sums_transposed[1])
            plan->density_row = plan->row_count++;
    }
    const bool apart = plan->sums_transposed[0] || plan->sums_transposed[1] || plan->diffuses;
    plan->radius_row = plan->both_sides && apart ? plan->row_count++ : -1;
}

/* Pairs are weighed for folded fields of two radii, and for nobody else. */
static bool are_both_alone(const struct sphgi_plan *plan, enum sphgi_purpose purpose)
{
    bool alone = plan->both_at_once && plan->radius_row < 0 && !plan->computes &&
                 !plan->wants_value && purpose == SPHGI_FOR_RESULTS;
    for (int32_t k = 0; k < plan->field_count; ++k)
        alone &= plan->fields[k].fold != SPHGI_NOT_FOLDED;
    return alone;
}

/* Lists that hold r < max(H_i, H_j) are narrowed for what sees r < H_i, lest a value that is not
 * finite enters as 0 * NaN. Matrices read no values: they go along where that costs nothing. */
static bool sums_within(const struct sphgi_plan *plan)
{
    bool within = plan->wants_value || (plan->computes && plan->radius_row < 0);
    for (int32_t k = 0; k < plan->field_count; ++k)
        within |= plan->fields[k].differentiates && plan->fields[k].one_sided;
    return within;
}

void sphgi_plan_decide(struct sphgi_plan *plan, enum sphgi_purpose purpose)
{
    const sphg_method method = plan->scheme.method;
    bool needs_correction = purpose == SPHGI_FOR_PAIR_GRADIENTS;
    plan->differentiates = needs_correction;
    for (int32_t k = 0; k < plan->field_count; ++k) {
        struct sphgi_field_plan *field = &plan->fields[k];
        decide_field(field, method, plan->graded);
        plan->differentiates |= field->differentiates || field->diffuses;
        plan->diffuses |= field->diffuses;
        plan->wants_value |= field->value.count > 0;
        plan->values_by_volume |= field->value.count && field->volume_stream < 0;
        plan->values_by_own |= field->value.count && field->volume_stream >= 0;
        plan->adjoint |= (field->differentiates || field->diffuses) && field->form == SPHG_ADJOINT;
        plan->transposes[field->form == SPHG_SYMMETRIC] |=
            field->differentiates && !field->one_sided;
        needs_correction |=
            field->differentiates || field->diffuses || (plan->classic && field->value.count);
    }
    plan->corrects = method != SPHG_PLAIN && needs_correction;
    plan->computes |= plan->corrects && !plan->target_correction.count;
    plan->mean_volume = plan->computes && method == SPHG_MLS && !plan->target_volume.count;
    decide_rows(plan);
    plan->both_alone = are_both_alone(plan, purpose);
    plan->narrows = plan->both_sides && sums_within(plan);
    plan->both_first = plan->both_alone || (plan->narrows && plan->radius_row < 0);
    decide_sums(plan);
}
