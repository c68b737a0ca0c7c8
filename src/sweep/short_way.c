/* SPDX-License-Identifier: MIT */
#include "short_way.h"
#include "batch.h"
#include "lane_radii.h"
#include "own.h"
#include "records.h"
#include "sums.h"

/* Nothing is summed but what its pass knows. */
static bool is_short(const struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    return w->factors_at_once && !w->gather.masked && !w->held.room && !sweep->pairs &&
           !plan->quadratic && !plan->diffuses;
}

/* One field whose gradient or, if nothing stands between, divergence is summed over G_ij. */
static bool is_short_field(const struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const bool gradient =
        field->sums_gradient && !field->sums_divergence &&
        (field->components == 1 || field->components == w->sweep->plan->dimension);
    const bool divergence =
        field->sums_divergence && !field->sums_gradient && field->shape == SPHG_VECTOR;
    return field->one_sided && field->rows == 1 && !field->square.count && field->value_sum < 0 &&
           (gradient || divergence);
}

void sphgi_short_way_open(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const bool moments = (sweep->steps & SPHGI_SUM_MOMENTS) && plan->computes;
    if (sweep->records) {
        w->by_records = sphgi_record_sums(w);
        w->is_short = true;
        return;
    }
    w->short_way = (struct sphgi_group_sums){
        .gather = &w->gather, .three = plan->dimension == 3, .moments = moments};
    w->is_short = is_short(w) && (moments || (sweep->steps & SPHGI_SUM_FIELDS));
    if (!w->is_short || !(sweep->steps & SPHGI_SUM_FIELDS) || !plan->field_count)
        return;
    const struct sphgi_field_plan *field = plan->fields;
    w->is_short =
        plan->field_count == 1 && is_short_field(w, field) && !(moments && field->sums_divergence);
    if (!w->is_short)
        return;
    w->short_way.divergence = field->sums_divergence;
    w->short_way.numbers = field->components;
    if (!field->mirrors && (field->form == SPHG_DIRECT || (w->own.in_rows & 1)))
        w->short_way.own = field->antisymmetric ? -1 : field->form == SPHG_DIFFERENCE;
    else
        w->short_way.at_target = sphgi_subtracted(w, field);
    w->short_way.field = w->rows.at[field->row];
}

static int32_t first_sum(const struct sphgi_field_plan *field)
{
    return field->sums_divergence ? field->divergence_sum : field->sum;
}

void sphgi_short_way_run(struct sphgi_worker *w, const uint32_t *ids, int32_t steps)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_put_to_work(w, w->bundle.summed);
    sphgi_read_lane_radii(w);
    const bool records = w->sweep->records, folded = records && w->by_records.fold;
    const bool fields = records ? w->by_records.shape != 0 : w->short_way.numbers > 0;
    w->own.loaded = false;
    if (!records && w->short_way.at_target)
        sphgi_load_targets(w);
    const struct sphgi_group_lists lists = {
        .ids = ids,
        .steps = steps,
        .kept = w->batch.kept,
        .kept_stand = w->batch.kept_stand,
        .places = sphgi_places(w),
        .first = w->batch.first,
        .moments = sphgi_lane(w, w->reduced, plan->moment_sum),
        .sums = fields ? sphgi_lane(w, w->reduced, first_sum(plan->fields)) : NULL,
        .vectors =
            folded ? sphgi_lane(w, w->reduced, plan->folded_sum[w->by_records.dense]) : NULL};
    w->tile.ids_end = w->ids_end;
    if (records)
        w->passes->sum_records(&w->by_records, &w->shape, &lists, &w->tile);
    else
        w->passes->sum_group(&w->short_way, &w->shape, &lists, &w->tile);
    w->batch.longest = steps;
    w->batch.summing = w->sweep->steps & SPHGI_SUMS;
    sphgi_batch_settle(w);
    if (folded)
        sphgi_load_targets(w);
    else if (fields && !w->own.loaded)
        sphgi_load_target_volumes(w);
    w->bundle.summed = w->bundle.count;
}
