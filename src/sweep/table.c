/* SPDX-License-Identifier: MIT */
#include "table.h"
#include "core/view.h"
#include "lane_radii.h"

/* ---- Units ----------------------------------------------------------------------------------- */

/* Shares that somebody reads: of order 2 the last one only for second derivatives. */
static int table_units_in_use(const struct sphgi_worker *w)
{
    return w->sweep->plan->quadratic && !w->second.whole ? SPHGI_TABLE_UNITS - 1
                                                         : SPHGI_TABLE_UNITS;
}

void sphgi_round_as_table(struct sphgi_worker *w, char *coefficients, bool wanted)
{
    if (w->sweep->plan->graded) {
        sphgi_round_by_radius(w, coefficients, wanted);
        return;
    }
    for (int k = 0; k < table_units_in_use(w) && w->table_units[k].count; ++k) {
        const struct sphgi_table_unit *unit = &w->table_units[k];
        const bool exact = unit->mantissa == 1;
        char *ours = sphgi_lane(w, coefficients, unit->first);
        char *raw = sphgi_lane(w, w->raw, unit->first);
        if (!exact || wanted)
            w->passes->scale(w->batch.width, unit->count, ours, unit->mantissa, NULL, raw);
        if (!exact)
            w->passes->divide(w->batch.width, unit->count, raw, unit->mantissa, ours);
        for (int p = 0; wanted && p < 2; ++p)
            if (unit->power[p] != 1)
                w->passes->scale(w->batch.width, unit->count, raw, unit->power[p], NULL, raw);
    }
}

void sphgi_take_from_table(const struct sphgi_passes *passes, const struct sphgi_table_unit *units,
                           int32_t width, sphg_type type, char *raw, char *ours)
{
    for (int k = 0; k < SPHGI_TABLE_UNITS && units[k].count; ++k) {
        const struct sphgi_table_unit *unit = &units[k];
        const size_t first = (size_t)unit->first * SPHGI_WIDTH * sphgi_size_of_type(type);
        for (int p = 0; p < 2; ++p)
            if (unit->power[p] != 1)
                passes->scale(width, unit->count, raw + first, 1 / unit->power[p], NULL,
                              raw + first);
        passes->divide(width, unit->count, raw + first, unit->mantissa, ours + first);
    }
}

/* ---- The host's memory: tables of order 2 do not fit the columns of one view ----------------- */

static void store_long_table(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    for (int32_t first = 0; first < plan->correction.count; first += SPHGI_COLUMNS_MOST) {
        const struct sphgi_columns part = sphgi_some_columns(&plan->correction, first, plan->type);
        w->passes->store_lanes(w->batch.targets, &part, sphgi_targets(w),
                               sphgi_lane(w, w->raw, first), false);
    }
}

void sphgi_store_table(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (plan->quadratic && plan->correction.count)
        store_long_table(w);
    else if (plan->correction.count)
        w->passes->store_lanes(w->batch.targets, &plan->correction, sphgi_targets(w),
                               sphgi_lane(w, w->raw, 0), false);
}

static void load_long_table(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    for (int32_t first = 0; first < plan->target_correction.count; first += SPHGI_COLUMNS_MOST) {
        const struct sphgi_columns part =
            sphgi_some_columns(&plan->target_correction, first, plan->type);
        w->passes->load_lanes(w->batch.width, &part, sphgi_targets(w),
                              sphgi_lane(w, w->raw, first));
    }
}

void sphgi_load_corrections(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (w->sweep->coefficients) {
        w->passes->load_lanes(w->batch.width, w->sweep->coefficients, sphgi_targets(w),
                              sphgi_lane(w, w->coefficients, 0));
        return;
    }
    if (plan->quadratic)
        load_long_table(w);
    else
        w->passes->load_lanes(w->batch.width, &plan->target_correction, sphgi_targets(w),
                              sphgi_lane(w, w->raw, 0));
    if (plan->graded)
        sphgi_take_by_radius(w);
    else
        sphgi_take_from_table(w->passes, w->table_units, w->batch.width, plan->type,
                              sphgi_lane(w, w->raw, 0), sphgi_lane(w, w->coefficients, 0));
}
