/* SPDX-License-Identifier: MIT */
#include "borrow.h"
#include "core/view.h"
#include "lane_radii.h"
#include "table.h"

static int32_t pairs_of(const struct sphgi_plan *plan)
{
    return plan->dimension * (plan->dimension + 1) / 2;
}

static int32_t numbers_lent(const struct sphgi_plan *plan, const struct sphgi_field_plan *field)
{
    return 1 + field->components * pairs_of(plan);
}

void sphgi_sum_lent(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const int32_t numbers = numbers_lent(w->sweep->plan, field);
    for (int32_t k = 0; k < field->lent_rows; ++k)
        w->passes->sum_lent(&w->tile, w->rows.at[field->lent_row + k],
                            sphgi_min32(SPHGI_ROW, numbers - k * SPHGI_ROW),
                            sphgi_lane(w, w->reduced, field->lent_sum + k * SPHGI_ROW));
}

struct sphgi_borrowing sphgi_before_borrowing(struct sphgi_worker *w, const void *scale)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (!plan->lends)
        return (struct sphgi_borrowing){.lent = NULL};
    w->passes->scale(w->batch.width, pairs_of(plan), sphgi_lane(w, w->coefficients, 0), 1, NULL,
                     sphgi_lane(w, w->lending.linear, 0));
    w->lending.scaled = scale != NULL;
    if (w->lending.scaled)
        w->passes->scale(w->batch.width, 1, scale, 1, NULL,
                         sphgi_lane(w, w->lending.moment_scale, 0));
    return (struct sphgi_borrowing){.confidence = sphgi_lane(w, w->lending.confidence, 0),
                                    .open = w->lending.open};
}

static struct sphgi_borrowing borrowing_of(struct sphgi_worker *w,
                                           const struct sphgi_field_plan *field)
{
    return (struct sphgi_borrowing){.lent = sphgi_lane(w, w->reduced, field->lent_sum),
                                    .linear = sphgi_lane(w, w->lending.linear, 0),
                                    .prior = sphgi_lane(w, w->lending.prior, 0),
                                    .transport = sphgi_lane(w, w->lending.transport, 0),
                                    .confidence = sphgi_lane(w, w->lending.lent_confidence, 0),
                                    .open = w->lending.open};
}

const char *sphgi_invert_borrowing(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_borrowing borrowing = borrowing_of(w, field);
    char *coefficients = sphgi_lane(w, w->lending.borrowed, 0);
    uint8_t directions[SPHGI_WIDTH];
    w->passes->scale(w->batch.width, pairs_of(plan), borrowing.linear, 1, NULL, coefficients);
    w->passes->invert_quadratic(
        w->batch.width, plan->dimension, &w->second, sphgi_lane(w, w->reduced, plan->moment_sum),
        w->lending.scaled ? sphgi_lane(w, w->lending.moment_scale, 0) : NULL,
        sphgi_lane(w, w->curvature.share_kept, 0), w->batch.targets, &borrowing, coefficients,
        directions);
    sphgi_round_as_table(w, w->lending.borrowed, false);
    return coefficients;
}

void sphgi_add_borrowed(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                        char *laplacian)
{
    const struct sphgi_borrowing borrowing = borrowing_of(w, field);
    w->passes->add_borrowed(w->batch.width, w->sweep->plan->dimension, field->components,
                            &w->second, &borrowing, sphgi_common(w, w->inverse_h), w->jacobian,
                            w->curvature.hessian, laplacian);
}

void sphgi_store_lent(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t numbers = numbers_lent(plan, field);
    w->passes->lend(
        w->batch.width, numbers - 1,
        sphgi_lane(w, field->lent_rows ? w->lending.lent_confidence : w->lending.confidence, 0),
        w->curvature.hessian, w->lending.lent);
    for (int32_t first = 0; first < numbers; first += SPHGI_COLUMNS_MOST) {
        const struct sphgi_columns part = sphgi_some_columns(&field->curvature, first, plan->type);
        w->passes->store_lanes(w->batch.targets, &part, sphgi_targets(w),
                               sphgi_lane(w, w->lending.lent, first), false);
    }
}

void sphgi_store_borrows(struct sphgi_worker *w)
{
    const struct sphgi_columns *to = &w->sweep->plan->borrows;
    for (int32_t l = 0; to->count && l < w->batch.targets; ++l)
        *(uint8_t *)(uintptr_t)(to->at[0] + sphgi_targets(w)[l] * to->stride) = w->lending.open[l];
}
