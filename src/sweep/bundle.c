/* SPDX-License-Identifier: MIT */
#include "bundle.h"
#include "batch.h"
#include "classic_way.h"
#include "core/view.h"
#include "corrections.h"
#include "finish.h"
#include "lane_radii.h"
#include "own.h"
#include "table.h"
#include <string.h>

/* ---- Sums of several source sets ------------------------------------------------------------ */

static char *rows_put_away(const struct sphgi_sweep *sweep, int32_t first)
{
    return sweep->put_away.sums + (size_t)first * sphgi_size_of_type(sweep->plan->type);
}

static void put_sums_away(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_sums sums = sphgi_sums_of(sweep->plan, sweep->steps);
    w->passes->put_away(w->batch.targets, sums.count, sphgi_lane(w, w->reduced, sums.first),
                        sphgi_targets(w), rows_put_away(sweep, sums.first), sweep->plan->sums,
                        sweep->put_away.marks);
}

static void add_sums_put_away(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_sums sums = sphgi_sums_of(sweep->plan, sweep->steps);
    const int32_t *targets = sphgi_targets(w);
    w->passes->add_put_away(w->batch.targets, sums.count, rows_put_away(sweep, sums.first),
                            sweep->plan->sums, targets, sweep->put_away.marks,
                            sphgi_lane(w, w->reduced, sums.first));
    for (int32_t l = 0; l < w->batch.targets; ++l)
        sweep->put_away.marks[targets[l]] = 0;
}

/* ---- Results -------------------------------------------------------------------------------- */

static void finish(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const unsigned steps = w->sweep->steps;
    const bool done = w->coefficients_first; /* corrections, or the half of them that slopes need */
    if (w->sweep->put_away.marks)
        add_sums_put_away(w);
    if (!done && (steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_moments(w);
    else if (!done && plan->corrects)
        sphgi_load_corrections(w);
    if (w->sweep->coefficients && (steps & SPHGI_SUM_SLOPES))
        sphgi_finish_slopes(w);
    if (w->sweep->coefficients && !(steps & SPHGI_SUM_FIELDS)) /* for the sweep that comes next */
        w->passes->store_lanes(w->batch.targets, w->sweep->coefficients, sphgi_targets(w),
                               w->coefficients, false);
    if (steps & SPHGI_SUM_FIELDS)
        sphgi_finish_fields(w);
}

/* The pair of a target with itself, whose classic gradient is not 0. */
static void write_self(struct sphgi_worker *w, int32_t lane)
{
    const struct sphgi_pair_sink *pairs = w->sweep->pairs;
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t target = w->bundle.target[lane], d = plan->dimension;
    const int64_t place = pairs->offsets[pairs->row_of_target[target]] + w->bundle.written[lane];
    const size_t size = sphgi_size_of_type(plan->type);
    pairs->indices[place] = target;
    if (!pairs->gradient.columns.count)
        return;
    sphgi_self_gradient(w, w->extra);
    for (int32_t a = 0; a < d; ++a)
        memcpy(sphgi_pair_number(&pairs->gradient, a, place),
               sphgi_lane(w, w->extra, a) + (size_t)lane * size, size);
}

static void finish_pairs(struct sphgi_worker *w)
{
    const struct sphgi_pair_sink *pairs = w->sweep->pairs;
    for (int32_t l = 0; l < w->bundle.count; ++l) {
        if (w->sweep->plan->classic && w->sweep->plan->own_set >= 0) {
            if (pairs->offsets)
                write_self(w, l);
            ++w->bundle.written[l];
        }
        const int32_t row = pairs->row_of_target[w->bundle.target[l]];
        if (!pairs->offsets)
            pairs->counts[row] = w->bundle.written[l];
        else
            sphgi_fill_up_row(&pairs->gradient, pairs->indices, pairs->offsets[row],
                              w->bundle.written[l]);
    }
}

void sphgi_bundle_finish(struct sphgi_worker *w)
{
    sphgi_classic_complete(w);
    sphgi_put_to_work(w, 0);
    if (w->sweep->pairs)
        finish_pairs(w);
    else if (w->sweep->steps & SPHGI_FINISH)
        finish(w);
    else
        put_sums_away(w);
    w->bundle.count = w->bundle.summed = 0;
}
