/* SPDX-License-Identifier: MIT */
#include "bundle.h"
#include "batch.h"
#include "core/view.h"
#include "corrections.h"
#include "finish.h"
#include "lane_radii.h"
#include "own.h"
#include "table.h"
#include <string.h>

/* ---- Sums that wait for other source sets ------------------------------------------------- */

static void each_part(struct sphgi_worker *w, bool load)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const size_t size = sphgi_size_of_type(plan->type);
    for (int32_t s = 0; s < plan->sums; s += SPHGI_COLUMNS_MOST) {
        const int32_t count = sphgi_min32(SPHGI_COLUMNS_MOST, plan->sums - s);
        const struct sphgi_columns columns =
            sphgi_dense_columns(sweep->set_sums + (size_t)s * size, count, plan->sums, plan->type);
        char *lanes = sphgi_lane(w, w->reduced, s);
        if (load)
            w->passes->load_lanes(w->batch.width, &columns, sphgi_targets(w), lanes);
        else
            w->passes->store_lanes(w->batch.targets, &columns, sphgi_targets(w), lanes,
                                   sweep->set_number > 0);
    }
}

static void finish(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const unsigned steps = w->sweep->steps;
    const bool done = w->coefficients_first; /* corrections, before the fields */
    if (!done && (steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_corrections(w);
    else if (!done && plan->corrects)
        sphgi_load_corrections(w);
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
    if (!pairs->gradient.count)
        return;
    sphgi_self_gradient(w, w->extra);
    for (int32_t a = 0; a < d; ++a)
        memcpy((char *)(uintptr_t)(pairs->gradient.at[a] + place * pairs->gradient.stride),
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
        if (!pairs->offsets)
            pairs->counts[pairs->row_of_target[w->bundle.target[l]]] = w->bundle.written[l];
    }
}

void sphgi_bundle_finish(struct sphgi_worker *w)
{
    sphgi_put_to_work(w, 0);
    if (w->sweep->pairs)
        finish_pairs(w);
    else if (w->sweep->steps & SPHGI_FINISH)
        finish(w);
    else
        each_part(w, false);
    w->bundle.count = w->bundle.summed = 0;
}

void sphgi_bundle_finish_from_sums(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_put_to_work(w, 0);
    sphgi_find_lane_radii(w);
    w->own.loaded = false;
    sphgi_load_targets(w);
    each_part(w, true);
    if ((w->sweep->steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_corrections(w);
    else if (plan->corrects)
        sphgi_load_corrections(w);
    if (w->sweep->coefficients && (w->sweep->steps & SPHGI_SUM_MOMENTS))
        w->passes->store_lanes(w->batch.targets, w->sweep->coefficients, sphgi_targets(w),
                               w->coefficients, false);
    if (w->sweep->steps & SPHGI_SUM_FIELDS)
        sphgi_finish_fields(w);
    w->bundle.count = 0;
}
