/* SPDX-License-Identifier: MIT */
#include "short_way.h"
#include "batch.h"
#include "classic_way.h"
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
           !plan->diffuses;
}

/* A field whose gradient or, if nothing stands between, divergence is summed over G_ij. */
static bool is_short_field(const struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const bool gradient =
        field->sums_gradient && !field->sums_divergence &&
        (field->components == 1 || field->components == w->sweep->plan->dimension);
    const bool divergence =
        field->sums_divergence && !field->sums_gradient && field->shape == SPHG_VECTOR;
    return field->one_sided && field->rows == 1 && !field->square.count && field->value_sum < 0 &&
           !field->lent_rows && (gradient || divergence);
}

/* Of one field A_i is read where it stands, if it does. */
static struct sphgi_group_field group_field(const struct sphgi_worker *w,
                                            const struct sphgi_field_plan *field)
{
    struct sphgi_group_field of = {.numbers = field->components,
                                   .divergence = field->sums_divergence,
                                   .rows = w->rows.at[field->row],
                                   .sums = sphgi_lane(w, w->reduced, sphgi_first_sum(field))};
    if (w->sweep->plan->quadratic)
        of.second = sphgi_lane(w, w->reduced, field->second_sum);
    const bool alone = w->sweep->plan->field_count == 1 && !field->mirrors;
    if (alone && (field->form == SPHG_DIRECT || (w->own.in_rows & 1)))
        of.own = field->antisymmetric ? -1 : field->form == SPHG_DIFFERENCE;
    else
        of.at_target = sphgi_subtracted(w, field);
    return of;
}

void sphgi_short_way_open(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    struct sphgi_group_sums *way = &w->short_way;
    if (sweep->records) {
        w->by_records = sphgi_record_sums(w);
        w->is_short = true;
        return;
    }
    if (plan->classic) {
        w->is_short = sphgi_is_classic_way(w);
        return;
    }
    const bool moments = (sweep->steps & SPHGI_SUM_MOMENTS) && plan->computes;
    const int32_t fields = sweep->steps & SPHGI_SUM_FIELDS ? plan->field_count : 0;
    *way = (struct sphgi_group_sums){.gather = &w->gather, .three = plan->dimension == 3};
    if (moments)
        way->moments = sphgi_lane(w, w->reduced, plan->moment_sum);
    w->is_short = is_short(w) && (moments || fields) && fields <= SPHGI_GROUP_FIELDS;
    for (int32_t k = 0; w->is_short && k < fields; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        w->is_short = is_short_field(w, field) && !(moments && field->sums_divergence);
        if (w->is_short)
            way->field[way->fields++] = group_field(w, field);
    }
}

void sphgi_short_way_run(struct sphgi_worker *w, const uint32_t *ids, int32_t steps)
{
    const struct sphgi_group_sums *way = &w->short_way;
    if (w->sweep->plan->classic) {
        sphgi_classic_begin(w, ids, steps);
        return;
    }
    sphgi_put_to_work(w, w->bundle.summed);
    sphgi_read_lane_radii(w);
    const bool records = w->sweep->records;
    w->own.loaded = false;
    if (way->fields && way->field->at_target)
        sphgi_load_targets(w);
    const struct sphgi_group_lists lists = {.ids = ids,
                                            .steps = steps,
                                            .kept = w->batch.kept,
                                            .kept_stand = w->batch.kept_stand,
                                            .places = sphgi_places(w),
                                            .first = w->batch.first};
    w->tile.ids_end = w->ids_end;
    if (records)
        w->passes->sum_records(&w->by_records, &w->shape, &lists, &w->tile);
    else if (w->sweep->plan->quadratic)
        w->passes->sum_quadratic_group(way, &w->shape, &lists, &w->tile);
    else
        w->passes->sum_group(way, &w->shape, &lists, &w->tile);
    w->batch.longest = steps;
    w->batch.summing = w->sweep->steps & SPHGI_SUMS;
    sphgi_batch_settle(w);
    if (records && w->by_records.fold)
        sphgi_load_targets(w);
    else if ((records ? w->by_records.shape != 0 : way->fields > 0) && !w->own.loaded)
        sphgi_load_target_volumes(w);
    w->bundle.summed = w->bundle.count;
}
