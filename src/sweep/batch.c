/* SPDX-License-Identifier: MIT */
#include "batch.h"
#include "core/view.h"
#include "corrections.h"
#include "held.h"
#include "lane_radii.h"
#include "own.h"
#include "sums.h"
#include "table.h"
#include "tile.h"
#include <string.h>

void sphgi_put_to_work(struct sphgi_worker *w, int32_t first)
{
    struct sphgi_bundle *bundle = &w->bundle;
    w->batch.first = first;
    w->batch.targets = bundle->count - first;
    w->batch.width = (int32_t)sphgi_round_up((size_t)w->batch.targets, (size_t)w->passes->lanes);
    for (int32_t l = bundle->count; l < first + w->batch.width; ++l) {
        bundle->target[l] = bundle->target[first];
        bundle->place[l] = bundle->place[first];
    }
}

void sphgi_batch_begin(struct sphgi_worker *w)
{
    sphgi_put_to_work(w, w->bundle.summed);
    sphgi_read_lane_radii(w);
    w->own.loaded = false;
    w->batch.tiles = 0;
    if (w->sweep->pairs)
        memset(w->bundle.written + w->batch.first, 0,
               (size_t)w->batch.targets * sizeof w->bundle.written[0]);
    w->batch.summing = w->sweep->steps & SPHGI_SUMS;
    if (w->coefficients_first) {
        if (w->batch.summing & SPHGI_SUM_MOMENTS)
            w->batch.summing = SPHGI_SUM_MOMENTS;
        else
            sphgi_load_corrections(w);
    }
}

static struct sphgi_sums sums_of_round(const struct sphgi_worker *w)
{
    return sphgi_sums_of(w->sweep->plan, w->batch.summing);
}

/* ---- From lists to tiles --------------------------------------------------------------------- */

/* A lane for each target. */
static void run_lanes(struct sphgi_worker *w)
{
    w->tile.spread = false;
    w->tile.carries = w->batch.longest > SPHGI_PLAIN_CHUNKS * SPHGI_CHUNK;
    int64_t at = 0; /* lists may be as long as int32_t can tell */
    do {
        w->tile.chunk = (int32_t)(at / SPHGI_CHUNK);
        w->tile.steps = sphgi_min32(SPHGI_CHUNK, w->batch.longest - (int32_t)at);
        sphgi_run_tile(w, w->batch.lists, (int32_t)at);
        at += SPHGI_CHUNK;
    } while (at < w->batch.longest);
}

static void join(struct sphgi_worker *w)
{
    const int32_t chunks = (w->batch.spread_pairs + SPHGI_CHUNK - 1) / SPHGI_CHUNK;
    const struct sphgi_sums sums = sums_of_round(w);
    if (w->tile.spread && sums.count)
        w->passes->join_lanes(&w->tile, sphgi_max32(chunks, 1), sums.count,
                              sphgi_lane(w, w->reduced, sums.first));
}

void sphgi_run_spread(struct sphgi_worker *w, const uint32_t *ids, int32_t count, int32_t stride,
                      int32_t at)
{
    struct sphgi_lane_lists lists = {.numbers = w->batch.lists->numbers};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        const int32_t first = l * SPHGI_CHUNK;
        lists.ids[l] = ids + (ptrdiff_t)first * stride;
        lists.count[l] = sphgi_max32(0, sphgi_min32(SPHGI_CHUNK, count - first));
        lists.stride[l] = stride;
    }
    w->tile.spread = w->tile.carries = true;
    w->batch.spread_pairs = count;
    w->tile.chunk = at / SPHGI_CHUNK;
    w->tile.steps = sphgi_min32(SPHGI_CHUNK, count);
    sphgi_run_tile(w, &lists, 0);
    join(w);
}

static void run_long_list(struct sphgi_worker *w)
{
    const int32_t stride = w->batch.lists->stride[0], most = sphgi_spread_most(w);
    for (int64_t at = 0; at < w->batch.longest; at += most)
        sphgi_run_spread(w, w->batch.lists->ids[0] + at * stride,
                         (int32_t)(w->batch.longest - at < most ? w->batch.longest - at : most),
                         stride, (int32_t)at);
}

/* ---- Rounds ---------------------------------------------------------------------------------- */

void sphgi_batch_settle(struct sphgi_worker *w)
{
    const struct sphgi_sums sums = sums_of_round(w);
    if (w->batch.longest > SPHGI_PLAIN_CHUNKS * SPHGI_CHUNK)
        w->passes->settle(&w->tile, sums.count, sphgi_lane(w, w->reduced, sums.first));
}

/* One target in all lanes: the matrices of lanes without a target of their own are not decomposed.
 */
static void repeat_coefficients(struct sphgi_worker *w)
{
    const size_t size = sphgi_size_of_type(w->sweep->plan->type);
    for (int32_t number = 0; number < sphgi_plan_width(w->sweep->plan); ++number) {
        char *lane = sphgi_lane(w, w->coefficients, number);
        for (int32_t l = 1; l < w->passes->lanes; ++l)
            memcpy(lane + (size_t)l * size, lane, size);
    }
}

/* Corrections that later rounds need. Those of several source sets wait for the sums of all. */
static void finish_round(struct sphgi_worker *w)
{
    const unsigned step = w->batch.summing;
    if (step == SPHGI_SUM_MOMENTS && w->batch.drops)
        sphgi_solve_for_slopes(w);
    else if (step == SPHGI_SUM_MOMENTS)
        sphgi_finish_moments(w);
    else if (step == SPHGI_SUM_SLOPES && !w->batch.drops)
        sphgi_finish_slopes(w);
    if (w->tile.spread && step != SPHGI_SUM_FIELDS)
        repeat_coefficients(w);
}

/* The step after this round's; 0: there is none. */
static unsigned next_step(const struct sphgi_worker *w)
{
    const unsigned left = w->sweep->steps & SPHGI_SUMS & ~(2 * w->batch.summing - 1);
    return left & -left;
}

/* A round over tiles that are still there. */
static void sum_held(struct sphgi_worker *w)
{
    for (int32_t k = 0; k < w->batch.tiles; ++k) {
        sphgi_take_tile(w, k);
        sphgi_sum_tile(w);
        join(w);
    }
    sphgi_batch_settle(w);
}

/* All pairs were added once: is another round over them needed? Moments, slopes and fields of one
 * sweep are summed one after the other where each needs what the one before gave. */
bool sphgi_batch_again(struct sphgi_worker *w)
{
    sphgi_batch_settle(w);
    while (w->held.room) {
        finish_round(w);
        const unsigned next = next_step(w);
        if (!next)
            break;
        w->batch.summing = next;
        if (!sphgi_are_held(w)) {
            w->batch.tiles = 0;
            return true;
        }
        sum_held(w);
    }
    return false;
}

void sphgi_batch_end(struct sphgi_worker *w)
{
    w->bundle.summed = w->bundle.count;
    if (!w->sweep->pairs && (w->batch.summing & SPHGI_SUM_FIELDS))
        sphgi_load_targets(w);
}

void sphgi_batch_run(struct sphgi_worker *w)
{
    sphgi_batch_begin(w);
    w->batch.longest = 0;
    for (int32_t l = 0; l < w->batch.targets; ++l)
        w->batch.longest = sphgi_max32(w->batch.longest, w->batch.lists->count[l]);
    for (int32_t l = w->batch.targets; l < w->passes->lanes; ++l) {
        w->batch.lists->ids[l] = w->batch.lists->ids[0];
        w->batch.lists->count[l] = 0;
        w->batch.lists->stride[l] = 1;
    }
    const bool spread = w->batch.targets == 1 && w->batch.longest > SPHGI_CHUNK;
    do
        if (spread)
            run_long_list(w);
        else
            run_lanes(w);
    while (sphgi_batch_again(w));
    sphgi_batch_end(w);
}

void sphgi_batch_keep(struct sphgi_worker *w, uint32_t kept)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    struct sphgi_bundle *bundle = &w->bundle;
    sphgi_keep_lane_radii(w, kept);
    p->pack_lanes(kept, plan->sums, sphgi_lane(w, w->reduced, 0));
    p->pack_lanes(kept, plan->target_lanes, sphgi_lane(w, w->own.field, 0));
    if (plan->adjoint || plan->transposes[1]) {
        p->pack_lanes(kept, 1, sphgi_lane(w, w->own.volume, 0));
        p->pack_lanes(kept, 1, sphgi_lane(w, w->own.density, 0));
    }
    int32_t to = w->batch.first;
    for (int32_t l = w->batch.first; l < bundle->count; ++l, kept >>= 1) {
        bundle->target[to] = bundle->target[l];
        bundle->place[to] = bundle->place[l];
        to += (int32_t)(kept & 1);
    }
    bundle->count = w->bundle.summed = to;
    if (w->batch.drops && to > w->batch.first) {
        sphgi_put_to_work(w, w->batch.first);
        sphgi_finish_moments(w);
        sphgi_finish_slopes(w);
    }
}
