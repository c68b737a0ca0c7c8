/* SPDX-License-Identifier: MIT */
#include "diffusion.h"
#include "core/kernel.h"
#include "fold.h"
#include "lane_radii.h"

/* V_i that is no part of s_ij: as a source's weight, it differs from particle to particle. */
static bool is_volume_apart(const struct sphgi_worker *w)
{
    return sphgi_source_weight(w->sweep->plan, false) == SPHGI_WEIGHT_V;
}

/* E_i: C_i, times V_i where s_ij lack it, in the unit that both sides of a pair have. */
static const char *own_matrix(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t numbers = plan->dimension * (plan->dimension + 1) / 2;
    const char *matrix = sphgi_lane(w, w->coefficients, 0);
    char *scaled = sphgi_lane(w, w->raw, 0);
    if (is_volume_apart(w)) {
        w->passes->scale(w->batch.width, numbers, matrix, 1, sphgi_lane(w, w->own.volume, 0),
                         scaled);
        matrix = scaled;
    }
    if (plan->graded) {
        w->passes->scale(w->batch.width, numbers, matrix, plan->scheme.radius,
                         sphgi_lane(w, w->radii.inverse, 0), scaled);
        matrix = scaled;
    }
    return matrix;
}

/* What a pair has of E_i, if `own` is set, and of C_j, if `other` is; added to what there is unless
 * it begins with its own. */
static void form(struct sphgi_worker *w, bool own, bool other)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const void *table[2] = {NULL, NULL};
    for (int32_t k = 0; other && k < sphgi_correction_rows(plan); ++k)
        table[k] = w->rows.at[plan->correction_row + k];
    w->passes->pair_laplacian(
        &w->tile, plan->dimension, own ? own_matrix(w) : NULL, other ? table : NULL, w->inverse_h,
        1 / sphgi_table_scales(&plan->scheme).value, sphgi_source_weight(plan, false), !own);
}

/* C is 1 on both sides. */
static void form_plain(struct sphgi_worker *w, bool own, bool other)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const char *radius = sphgi_lane(w, w->radii.inverse, 0);
    if (own && other)
        w->passes->pair_laplacian_plain(&w->tile, 2, NULL, false);
    else if (own)
        w->passes->pair_laplacian_plain(&w->tile, plan->scheme.radius, radius, false);
    else
        w->passes->pair_laplacian_plain(&w->tile, 1, NULL, true);
}

static void form_sides(struct sphgi_worker *w, bool own, bool other)
{
    if (w->sweep->plan->scheme.method == SPHG_PLAIN)
        form_plain(w, own, other);
    else
        form(w, own, other);
}

void sphgi_begin_diffusion(struct sphgi_worker *w)
{
    form_sides(w, true, !w->sweep->plan->graded);
}

/* Sets whose values are those of the targets have rows of zeros, and exchange nothing. */
static void sum_field(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const bool mirrored = w->sweep->set->streams[field->stream].mirrored;
    const bool weighted = field->coefficient_row >= 0;
    for (int32_t s = 0; s < field->rows; ++s) {
        const int32_t first = s * SPHGI_ROW;
        w->passes->sum_diffusion(
            &w->tile, w->rows.at[field->row + s], sphgi_min32(SPHGI_ROW, field->components - first),
            weighted ? w->rows.at[field->coefficient_row] : NULL,
            weighted ? sphgi_lane(w, w->own.field, field->coefficient_at_target) : NULL,
            mirrored ? w->zeros : sphgi_lane(w, w->own.field, field->at_target + first),
            sphgi_lane(w, w->reduced, field->diffusion_sum + first));
    }
}

void sphgi_sum_diffusion(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (plan->graded)
        form_sides(w, false, true);
    for (int32_t k = 0; k < plan->field_count; ++k)
        if (plan->fields[k].diffuses)
            sum_field(w, &plan->fields[k]);
}

/* Sums stand in units of H: f = H^(d - 1) [V_i] sum. */
void sphgi_finish_diffusion(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const double unit = sphgi_power(plan->scheme.radius, plan->dimension) * w->inverse_h;
    const char *volume = is_volume_apart(w) ? NULL : sphgi_lane(w, w->own.volume, 0);
    char *result = sphgi_lane(w, w->reduced, field->diffusion_sum);
    w->passes->scale(w->batch.width, field->components, result, unit, volume, result);
    w->passes->store_lanes(w->batch.targets, &field->laplacian, sphgi_targets(w), result,
                           field->accumulate);
}
