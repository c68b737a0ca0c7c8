/* SPDX-License-Identifier: MIT */
#include "tile.h"
#include "clean.h"
#include "copies.h"
#include "core/view.h"
#include "held.h"
#include "lane_radii.h"
#include "sums.h"

/* Rows that are not at hand are copied. */
static void copy_rows(struct sphgi_worker *w, const struct sphgi_lane_lists *lists)
{
    struct sphgi_lane_lists ready = {.side_by_side = false};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        const int32_t count = lists->count[l], stride = lists->stride[l];
        uint32_t *ids = w->rows.clean_ids + l * SPHGI_CHUNK;
        if (count && lists->numbers)
            sphgi_clean_list(w, sphgi_targets(w)[l], lists->ids[l], count, ids);
        else
            for (int32_t k = 0; k < count; ++k)
                ids[k] = lists->ids[l][(ptrdiff_t)k * stride];
        if (count)
            sphgi_make_local(w, ids, count, l * SPHGI_CHUNK);
        for (int32_t k = count; k % 4; ++k)
            ids[k] = w->gather.dummy;
        ready.ids[l] = ids;
        ready.count[l] = count;
        ready.stride[l] = 1;
    }
    w->passes->interleave(&ready, 0, w->gather.dummy, &w->tile);
}

/* The pairs of each lane in steps [begin, begin + tile.steps). */
static void count_pairs(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    for (int32_t l = 0; l < w->passes->lanes; ++l)
        w->batch.pairs[l] = sphgi_max32(0, sphgi_min32(lists->count[l] - begin, w->tile.steps));
}

static void copy_steps(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    struct sphgi_lane_lists part = {.numbers = lists->numbers};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        part.ids[l] =
            w->batch.pairs[l] ? lists->ids[l] + (ptrdiff_t)begin * lists->stride[l] : NULL;
        part.count[l] = w->batch.pairs[l];
        part.stride[l] = lists->stride[l];
    }
    copy_rows(w, &part);
}

/* s_ij that stand in memory are read instead of formed; what is formed there is kept. */
static void gather_factors(struct sphgi_worker *w, int32_t begin)
{
    const struct sphgi_passes *p = w->passes;
    if (w->sweep->plan->quadratic) {
        p->gather_quadratic(&w->gather, &w->shape, sphgi_places(w), &w->tile);
        return;
    }
    const size_t step = SPHGI_GROUP * sphgi_size_of_type(w->sweep->plan->type);
    char *kept = w->batch.kept ? w->batch.kept + (size_t)begin * step : NULL;
    if (kept && w->batch.kept_stand) {
        p->gather_offsets(&w->gather, kept, sphgi_places(w), &w->tile);
        return;
    }
    p->gather_factors(&w->gather, &w->shape, sphgi_places(w), &w->tile);
    if (kept)
        p->keep_factors(&w->tile, kept);
}

/* From r < max(H_i, H_j) to r < H_i. */
static void narrow(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (w->near_as_gathered) {
        w->passes->gather_factors(&w->near, &w->shape, sphgi_places(w), &w->tile);
        return;
    }
    w->sweep->position_passes->gather[plan->type == SPHG_F64](&w->near, sphgi_places(w),
                                                              w->passes->lanes, &w->tile);
    sphgi_scale_volumes(w);
    sphgi_weigh_tile(w);
}

/* From what a list holds to r < max(H_i, H_j): the others' ids become the dummy's. */
static void sort_out(struct sphgi_worker *w)
{
    struct sphgi_gather either = w->both;
    either.volumes = false; /* those of the tile stay */
    w->sweep->position_passes->gather[w->sweep->plan->type == SPHG_F64](&either, sphgi_places(w),
                                                                        w->passes->lanes, &w->tile);
}

void sphgi_sum_tile(struct sphgi_worker *w)
{
    if (w->sweep->plan->narrows && (w->batch.summing & SPHGI_SUM_FIELDS)) {
        sphgi_sum_over_both_ends(w);
        narrow(w);
    }
    sphgi_evaluate_tile(w);
}

void sphgi_run_tile(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    if (sphgi_is_held(w)) {
        sphgi_take_tile(w, w->batch.tiles++);
        sphgi_sum_tile(w);
        return;
    }
    if (w->rows.local || w->sweep->pairs)
        count_pairs(w, lists, begin);
    if (w->held.room)
        sphgi_place_tile(w);
    w->tile.ids_end = lists->side_by_side ? w->ids_end : NULL;
    if (w->rows.local)
        copy_steps(w, lists, begin);
    else if (lists->numbers)
        sphgi_clean_lists(w, lists, begin);
    else
        w->passes->interleave(lists, begin, w->gather.dummy, &w->tile);
    if (sphgi_sorts_out_pairs(w->sweep))
        sort_out(w);
    if (w->factors_at_once)
        gather_factors(w, begin);
    else if (!w->sweep->plan->both_first)
        w->sweep->position_passes->gather[w->sweep->plan->type == SPHG_F64](
            &w->gather, sphgi_places(w), w->passes->lanes, &w->tile);
    sphgi_scale_volumes(w);
    if (!w->factors_at_once && !w->sweep->plan->both_first)
        sphgi_weigh_tile(w);
    if (w->held.room)
        sphgi_hold_tile(w);
    sphgi_sum_tile(w);
}
