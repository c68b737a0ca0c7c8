/* SPDX-License-Identifier: MIT */
#include "quadratic.h"
#include "borrow.h"
#include "core/kernel.h"
#include "core/view.h"
#include "lane_radii.h"
#include <math.h>
#include <string.h>

static int32_t pairs_of(const struct sphgi_plan *plan)
{
    return plan->dimension * (plan->dimension + 1) / 2;
}

void sphgi_sum_quadratic(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                         const char *at_target)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const size_t size = sphgi_size_of_type(plan->type);
    for (int32_t k = 0; k < field->streams && field->sums_gradient; ++k) {
        const int32_t first = k * SPHGI_ROW;
        w->passes->sum_quadratic_field(
            &w->tile, plan->dimension, w->rows.at[field->row + k],
            sphgi_min32(SPHGI_ROW, field->components - first),
            at_target + (size_t)first * SPHGI_WIDTH * size,
            sphgi_lane(w, w->reduced, field->sum + first * plan->dimension),
            sphgi_lane(w, w->reduced, field->second_sum + first * pairs_of(plan)));
    }
}

/* Rows hold the host's numbers; those of Q are longer by 1 / H than those of P. */
void sphgi_transpose_quadratic(struct sphgi_worker *w, const void *density,
                               enum sphgi_weight weight)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const void *const *table = w->rows.at + plan->correction_row;
    if (!plan->both_sides) {
        w->passes->transposed_quadratic(&w->tile, plan->dimension, table, plan->scheme.radius,
                                        density, weight);
        return;
    }
    struct sphgi_other_side of = {
        .radii = w->rows.at[plan->radius_row], .density = density, .weight = weight};
    memcpy(of.table, table, (size_t)sphgi_correction_rows(plan) * sizeof *table);
    w->passes->transposed_quadratic_other(&w->shape, &w->tile, &of);
}

void sphgi_apply_to_vectors(struct sphgi_worker *w, int32_t sum, char *to)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t d = plan->dimension;
    w->passes->apply_quadratic(w->batch.width, d, 1, sphgi_lane(w, w->coefficients, 0),
                               sphgi_lane(w, w->reduced, sum), sphgi_lane(w, w->reduced, sum + d),
                               1, to, NULL, w->curvature.hessian);
    if (plan->graded)
        w->passes->scale(w->batch.width, d, to, plan->scheme.radius, sphgi_inverse_lanes(w), to);
}

void sphgi_keep_all(struct sphgi_worker *w, struct sphgi_verdict *verdict)
{
    verdict->kept = sphgi_lane(w, w->curvature.share_kept, 0);
    w->passes->fill(w->batch.width, 1, verdict->kept);
}

void sphgi_invert_quadratic(struct sphgi_worker *w, const void *scale,
                            const struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t all = pairs_of(plan);
    const struct sphgi_borrowing first = sphgi_before_borrowing(w, scale);
    w->passes->invert_quadratic(w->batch.width, plan->dimension, &w->second,
                                sphgi_lane(w, w->reduced, plan->moment_sum), scale, verdict->kept,
                                w->batch.targets, plan->lends ? &first : NULL,
                                sphgi_lane(w, w->coefficients, 0), w->curvature.directions);
    for (int32_t l = 0; l < w->batch.targets; ++l) {
        const bool linear = !(verdict->decomposed >> l & 1) || verdict->rank[l] == plan->dimension;
        w->tally->stats.quadratic += linear && w->curvature.directions[l] == all;
    }
}

uint8_t sphgi_quadratic_rank(const struct sphgi_worker *w, int32_t lane, uint8_t rank)
{
    return rank < w->sweep->plan->dimension ? rank
                                            : (uint8_t)(rank + w->curvature.directions[lane]);
}

static void store_second(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                         const char *laplacian)
{
    for (int32_t c = 0; c < 3; ++c)
        if (field->hessian[c].count)
            w->passes->store_lanes(
                w->batch.targets, &field->hessian[c], sphgi_targets(w),
                sphgi_lane(w, w->curvature.hessian, c * pairs_of(w->sweep->plan)),
                field->accumulate);
    if (field->laplacian.count)
        w->passes->store_lanes(w->batch.targets, &field->laplacian, sphgi_targets(w), laplacian,
                               field->accumulate);
}

/* Where targets have radii of their own results are in units of these ... */
static void take_to_lengths(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                            bool second, char *laplacian)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    const char *square = sphgi_lane(w, w->radii.inverse_square, 0);
    char *hessian = sphgi_lane(w, w->curvature.hessian, 0);
    p->scale(w->batch.width, field->components * plan->dimension, w->jacobian, 1,
             sphgi_inverse_lanes(w), w->jacobian);
    if (!second)
        return;
    p->scale(w->batch.width, field->components * pairs_of(plan), hessian, 1, square, hessian);
    p->scale(w->batch.width, field->components, laplacian, 1, square, laplacian);
}

/* ... and what is lent, Hessians, is taken to them. */
static void take_lent_to_units(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_passes *p = w->passes;
    char *lent = sphgi_lane(w, w->reduced, field->lent_sum + 1);
    p->quotient(w->batch.width, NULL, sphgi_lane(w, w->radii.inverse_square, 0), w->self);
    p->scale(w->batch.width, field->components * pairs_of(w->sweep->plan), lent, 1, w->self, lent);
}

void sphgi_finish_quadratic(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const bool borrows = field->lent_rows > 0, lends = field->curvature.count > 0;
    const bool second = field->hessian[0].count || field->laplacian.count || borrows || lends;
    char *laplacian = sphgi_lane(w, w->curvature.hessian, SPHGI_HESSIANS);
    char *hessian = second ? sphgi_lane(w, w->curvature.hessian, 0) : NULL;
    const char *coefficients = sphgi_lane(w, w->coefficients, 0);
    if (borrows && plan->graded)
        take_lent_to_units(w, field);
    if (borrows)
        coefficients = sphgi_invert_borrowing(w, field);
    w->passes->apply_quadratic(w->batch.width, plan->dimension, field->components, coefficients,
                               sphgi_lane(w, w->reduced, field->sum),
                               sphgi_lane(w, w->reduced, field->second_sum),
                               sphgi_common(w, w->inverse_h), w->jacobian, hessian, laplacian);
    if (borrows)
        sphgi_add_borrowed(w, field, laplacian);
    if (plan->graded)
        take_to_lengths(w, field, second, laplacian);
    if (lends)
        sphgi_store_lent(w, field);
    if (second)
        store_second(w, field, laplacian);
}
