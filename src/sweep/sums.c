/* SPDX-License-Identifier: MIT */
#include "sums.h"
#include "borrow.h"
#include "diffusion.h"
#include "fold.h"
#include "folded.h"
#include "lane_radii.h"
#include "own.h"
#include "pair_rows.h"
#include "quadratic.h"
#include "values.h"
#include "core/view.h"
#include <string.h>

/* V_j is part of the classic weights, and not in them yet. */
static bool lacks_volumes(const struct sphgi_worker *w)
{
    return w->sweep->plan->weighted && !w->tile.weighed;
}

/* Classic gradients are whole; those of the linearised methods still lack C_i. */
static enum sphgi_vectors vectors_of(const struct sphgi_worker *w)
{
    return w->sweep->plan->classic ? SPHGI_GRADIENTS : SPHGI_FACTORS;
}

/* A times the vectors, A_i subtracted: what gradients are made of, and divergences. */
static void sum_rows(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                     enum sphgi_vectors vectors, const char *at_target)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (field->sums_divergence && !field->fold)
        w->passes->sum_divergence(&w->tile, plan->dimension, field->shape, vectors,
                                  w->rows.at + field->row, at_target,
                                  sphgi_lane(w, w->reduced, field->divergence_sum));
    for (int32_t k = 0; k < field->streams && field->sums_gradient; ++k) {
        const int32_t first = k * SPHGI_ROW;
        const int32_t count = sphgi_min32(SPHGI_ROW, field->components - first);
        w->passes->sum_field(&w->tile, plan->dimension, vectors, w->rows.at[field->row + k], count,
                             at_target +
                                 (size_t)first * SPHGI_WIDTH * sphgi_size_of_type(plan->type),
                             sphgi_lane(w, w->reduced, field->sum + first * plan->dimension));
    }
}

/* Rows of what is mirrored are zeros: A_j = A_i comes in by subtracting A_i less. */
const char *sphgi_subtracted(const struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const bool difference = field->form == SPHG_DIFFERENCE;
    if (sphgi_is_mirrored(w, field))
        return difference ? w->zeros : sphgi_lane(w, w->own.opposite, field->at_target);
    return difference || field->antisymmetric ? sphgi_lane(w, w->own.field, field->at_target)
                                              : w->zeros;
}

static void sum_one_sided(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    if (w->sweep->plan->quadratic) {
        sphgi_sum_quadratic(w, field, sphgi_subtracted(w, field));
        sphgi_sum_lent(w, field);
        return;
    }
    sum_rows(w, field, vectors_of(w), sphgi_subtracted(w, field));
    if (field->square.count)
        w->passes->sum_squares(&w->tile, w->sweep->plan->dimension, vectors_of(w),
                               sphgi_square_sums(w->sweep->plan), w->rows.at[field->row],
                               sphgi_subtracted(w, field),
                               sphgi_lane(w, w->reduced, field->square_sum));
}

/* ... where sources have radii of their own. */
static void form_transposed_other(struct sphgi_worker *w, const void *const *table,
                                  const void *density)
{
    struct sphgi_other_side of = {.radii = w->rows.at[w->sweep->plan->radius_row],
                                  .density = density};
    memcpy(of.table, table, 4 * sizeof *table);
    w->passes->transposed_classic_other(&w->shape, &w->tile, &of);
}

/* T, the other half of what a pair is multiplied with. */
static void form_transposed(struct sphgi_worker *w, bool symmetric)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const enum sphgi_weight weight = sphgi_source_weight(plan, symmetric);
    const void *density = plan->density_row < 0 ? NULL : w->rows.at[plan->density_row];
    const void *table[4] = {NULL, NULL, NULL, NULL};
    const int32_t rows = plan->correction_row < 0 ? 0 : sphgi_correction_rows(plan);
    if (plan->quadratic) {
        sphgi_transpose_quadratic(w, density, weight);
        return;
    }
    for (int32_t k = 0; k < rows; ++k)
        table[k] = w->rows.at[plan->correction_row + k];
    if (plan->classic && plan->both_sides) {
        form_transposed_other(w, table, symmetric ? density : NULL);
    } else if (plan->classic) {
        const struct sphgi_scales units = sphgi_table_scales(&plan->scheme);
        w->passes->transposed_classic(&w->tile, plan->dimension, table, &units,
                                      plan->weighted ? sphgi_lane(w, w->own.volume, 0) : NULL,
                                      density, weight);
    } else
        w->passes->transposed(&w->tile, plan->dimension, table, density, weight);
}

/* sum s_ij x_ij, or of rho_j times that: what A_i is multiplied with. */
static void sum_own_vectors(struct sphgi_worker *w, bool symmetric)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const void *density = symmetric ? w->rows.at[plan->density_row] : NULL;
    char *vectors = sphgi_lane(w, w->reduced, plan->vector_sum[symmetric]);
    if (plan->quadratic)
        w->passes->sum_quadratic_vectors(&w->tile, plan->dimension, density, vectors);
    else
        w->passes->sum_vectors(&w->tile, plan->dimension, vectors_of(w), density, vectors);
}

/* Adjoint ([0]) or symmetric ([1]): all fields of that form, and what they share. */
static void sum_transposed(struct sphgi_worker *w, bool symmetric)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (plan->sums_transposed[symmetric])
        form_transposed(w, symmetric);
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (!field->differentiates || field->one_sided ||
            symmetric != (field->form == SPHG_SYMMETRIC))
            continue;
        if (field->fold && !plan->both_sides)
            sphgi_sum_folded(w, k);
        if (field->rows)
            sum_rows(w, field, SPHGI_TRANSPOSED, sphgi_subtracted(w, field));
    }
    if (plan->carrier[symmetric] < 0 && !plan->both_sides)
        sum_own_vectors(w, symmetric);
}

static void form_classic_vectors(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    w->passes->classic_vectors(&w->tile, plan->dimension, lacks_volumes(w),
                               sphgi_lane(w, w->coefficients, 0));
}

/* Where G_ji has a radius of its own, all that has ours comes first. G_ji of the classic methods
 * and of order 2 leave the weights of our side alone; where these pairs come before all others,
 * nobody has formed yet what ours are made of. */
static void turn_to_other_side(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (plan->classic && plan->narrows)
        form_classic_vectors(w);
    if (plan->quadratic && plan->narrows)
        w->passes->shape_products(&w->tile, plan->dimension);
    for (int symmetric = 0; symmetric < 2; ++symmetric)
        if (plan->sums_transposed[symmetric])
            sum_own_vectors(w, symmetric);
    if (!plan->classic && !plan->quadratic)
        sphgi_weigh_other_side(w);
}

void sphgi_sum_over_both_ends(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_load_targets(w);
    if (plan->diffuses)
        sphgi_begin_diffusion(w);
    if (plan->radius_row >= 0)
        turn_to_other_side(w);
    if (plan->diffuses)
        sphgi_sum_diffusion(w);
    for (int symmetric = 0; symmetric < 2; ++symmetric)
        if (plan->transposes[symmetric])
            sum_transposed(w, symmetric);
    if (plan->both_at_once)
        sphgi_sum_both_sides(w);
}

/* One gradient of few components, and nothing else: G_ij need not be put into the tile. */
static bool is_one_gradient(const struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_field_plan *field = plan->fields;
    return plan->field_count == 1 && !w->sweep->pairs && field->one_sided && field->sums_gradient &&
           field->streams == 1 && !field->square.count && field->value_sum < 0;
}

static void sum_fields(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_load_targets(w);
    if (plan->classic && plan->corrects && is_one_gradient(w)) {
        const struct sphgi_field_plan *field = plan->fields;
        w->passes->sum_classic_field(&w->tile, plan->dimension, lacks_volumes(w),
                                     sphgi_lane(w, w->coefficients, 0), w->rows.at[field->row],
                                     field->components, sphgi_subtracted(w, field),
                                     sphgi_lane(w, w->reduced, field->sum));
        return;
    }
    if (plan->classic && plan->corrects)
        form_classic_vectors(w);
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (field->differentiates && field->one_sided)
            sum_one_sided(w, field);
        if (field->value_sum >= 0 && field->volume_row < 0)
            sphgi_sum_value(w, field, sphgi_subtracted(w, field));
    }
    for (int32_t k = 0; plan->values_by_own && k < plan->field_count; ++k)
        if (plan->fields[k].value_sum >= 0 && plan->fields[k].volume_row >= 0)
            sphgi_sum_value(w, &plan->fields[k], sphgi_subtracted(w, &plan->fields[k]));
    if (!plan->narrows)
        sphgi_sum_over_both_ends(w);
}

/* Hands on the pairs inside the cutoff; counts them in any case. */
static void write_pairs(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (w->sweep->pairs->gradient.columns.count && plan->quadratic)
        w->passes->quadratic_gradients(&w->tile, plan->dimension, sphgi_lane(w, w->coefficients, 0),
                                       sphgi_common(w, w->inverse_h));
    else if (w->sweep->pairs->gradient.columns.count)
        w->passes->pair_gradients(
            &w->tile, plan->dimension, vectors_of(w),
            plan->classic || !plan->corrects ? NULL : sphgi_lane(w, w->coefficients, 0),
            sphgi_common(w, w->inverse_h));
    if (w->sweep->pairs->gradient.columns.count && plan->graded)
        w->passes->scale_pairs(&w->tile, SPHGI_GX, plan->dimension,
                               sphgi_lane(w, w->radii.inverse, 0));
    const int32_t lanes = w->tile.spread ? w->passes->lanes : w->batch.targets;
    for (int32_t l = 0; l < lanes; ++l)
        sphgi_write_lane(w, l, w->batch.first + (w->tile.spread ? 0 : l));
}

void sphgi_weigh_tile(struct sphgi_worker *w)
{
    const int32_t count = w->tile.steps * w->passes->lanes;
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    if (plan->classic || plan->wants_value || plan->mean_volume)
        p->shape_weights(&w->shape, w->tile.arrays, count);
    if (plan->classic)
        return;
    if (plan->wants_value || plan->mean_volume)
        sphgi_weigh_values(w, count);
    if (plan->mean_volume && (w->batch.summing & SPHGI_SUM_MOMENTS))
        p->sum_volume(&w->tile, sphgi_lane(w, w->reduced, plan->volume_sum));
    if (plan->differentiates || plan->computes) /* takes the place of the weights */
        p->shape_factors(&w->shape, w->tile.arrays, count);
}

void sphgi_evaluate_tile(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    const struct sphgi_tile *tile = &w->tile;
    char *moments = sphgi_lane(w, w->reduced, plan->moment_sum);
    if ((w->batch.summing & SPHGI_SUM_MOMENTS) && plan->classic)
        p->sum_classic(tile, plan->dimension, plan->weighted, moments);
    else if ((w->batch.summing & SPHGI_SUM_MOMENTS) && plan->computes && plan->quadratic)
        p->sum_quadratic_moments(tile, plan->dimension, moments);
    else if (plan->quadratic)
        p->shape_products(tile, plan->dimension);
    else if ((w->batch.summing & SPHGI_SUM_MOMENTS) && plan->computes)
        p->sum_moments(tile, plan->dimension, moments);
    if (w->batch.summing & SPHGI_SUM_SLOPES)
        p->sum_classic_slopes(tile, plan->dimension, lacks_volumes(w),
                              sphgi_lane(w, w->coefficients, 0),
                              sphgi_lane(w, w->reduced, plan->slope_sum));
    if (w->batch.summing & SPHGI_SUM_FIELDS)
        sum_fields(w);
    if ((w->batch.summing & SPHGI_SUM_FIELDS) && w->sweep->pairs)
        write_pairs(w);
}
