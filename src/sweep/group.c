/* A group of targets from its pairs to its results: tiles are filled, summed, finished. */
#include "worker.h"
#include "clean.h"
#include "corrections.h"
#include "finish.h"
#include "lane_radii.h"
#include "sums.h"
#include "core/view.h"
#include <string.h>

/* ---- Lanes ---------------------------------------------------------------------------------- */

/* The lanes from `first` on. Those without a target repeat one: they are read like the others, and
 * never written. */
static void put_to_work(struct sphgi_worker *w, int32_t first)
{
    struct sphgi_group *group = &w->group;
    w->first = first;
    w->targets = group->lanes - first;
    w->width = (int32_t)sphgi_round_up((size_t)w->targets, (size_t)w->passes->lanes);
    for (int32_t l = group->lanes; l < first + w->width; ++l) {
        group->target[l] = group->target[first];
        group->place[l] = group->place[first];
    }
}

static void begin(struct sphgi_worker *w)
{
    put_to_work(w, w->summed);
    sphgi_read_lane_radii(w);
    w->targets_loaded = false;
    w->tiles = 0;
    if (w->sweep->pairs)
        memset(w->written + w->first, 0, (size_t)w->targets * sizeof w->written[0]);
    w->summing = w->sweep->steps & (SPHGI_SUM_MOMENTS | SPHGI_SUM_FIELDS);
    if (w->coefficients_first) {
        if (w->summing & SPHGI_SUM_MOMENTS)
            w->summing = SPHGI_SUM_MOMENTS;
        else
            sphgi_load_corrections(w);
    }
}

/* The sums of this round. */
static int32_t first_sum(const struct sphgi_worker *w)
{
    return w->summing & SPHGI_SUM_MOMENTS ? 0 : w->sweep->plan->moment_sums;
}

static int32_t sums_of_round(const struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    return (w->summing & SPHGI_SUM_FIELDS ? plan->sums : plan->moment_sums) - first_sum(w);
}

/* ---- Tiles ---------------------------------------------------------------------------------- */

/* Rows that are not at hand are copied. */
static void copy_rows(struct sphgi_worker *w, const struct sphgi_lane_lists *lists)
{
    struct sphgi_lane_lists ready = {.side_by_side = false};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        const int32_t count = lists->count[l], stride = lists->stride[l];
        uint32_t *ids = (uint32_t *)(void *)w->clean_ids + l * SPHGI_CHUNK;
        if (count && w->sweep->set->neighbors->kind == SPHGI_HOST_LISTS)
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

/* Steps [begin, begin + tile.steps) of lists whose ids cannot be taken as they are. */
static void ready_ids(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    struct sphgi_lane_lists part = {.side_by_side = false};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        part.ids[l] = w->pairs[l] ? lists->ids[l] + (ptrdiff_t)begin * lists->stride[l] : NULL;
        part.count[l] = w->pairs[l];
        part.stride[l] = lists->stride[l];
    }
    if (w->local)
        copy_rows(w, &part);
    else
        sphgi_clean_lists(w, &part);
}

/* s_ij that stand in memory are read instead of formed; what is formed there is kept. */
static void gather_factors(struct sphgi_worker *w, int32_t begin)
{
    const struct sphgi_passes *p = w->passes;
    const size_t step = SPHGI_GROUP * sphgi_size_of_type(w->sweep->plan->type);
    char *kept = w->kept ? w->kept + (size_t)begin * step : NULL;
    if (kept && w->kept_stand) {
        p->gather_offsets(&w->gather, kept, sphgi_places(w), &w->tile);
        return;
    }
    p->gather_factors(&w->gather, &w->shape, sphgi_places(w), &w->tile);
    if (kept)
        p->keep_factors(&w->tile, kept);
}

static void run_tile(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    const bool ready = !w->local && w->sweep->set->neighbors->kind != SPHGI_HOST_LISTS;
    if (!ready || w->sweep->pairs)
        for (int32_t l = 0; l < w->passes->lanes; ++l)
            w->pairs[l] = sphgi_max32(0, sphgi_min32(lists->count[l] - begin, w->tile.steps));
    if (ready)
        w->passes->interleave(lists, begin, w->gather.dummy, &w->tile);
    else
        ready_ids(w, lists, begin);
    if (w->factors_at_once)
        gather_factors(w, begin);
    else
        w->sweep->position_passes->gather[w->sweep->plan->type == SPHG_F64](
            &w->gather, sphgi_places(w), w->passes->lanes, &w->tile);
    sphgi_scale_volumes(w);
    sphgi_evaluate_tile(w);
}

/* A lane for each target. */
static void run_lanes(struct sphgi_worker *w)
{
    w->tile.spread = false;
    int64_t at = 0; /* lists may be as long as int32_t can tell */
    do {
        w->tile.chunk = (int32_t)(at / SPHGI_CHUNK);
        w->tile.steps = sphgi_min32(SPHGI_CHUNK, w->longest - (int32_t)at);
        run_tile(w, &w->lists, (int32_t)at);
        at += SPHGI_CHUNK;
    } while (at < w->longest);
}

static void join(struct sphgi_worker *w)
{
    const int32_t chunks = (w->spread_pairs + SPHGI_CHUNK - 1) / SPHGI_CHUNK,
                  sums = sums_of_round(w);
    if (w->tile.spread && sums)
        w->passes->join_lanes(&w->tile, sphgi_max32(chunks, 1), sums,
                              sphgi_lane(w, w->reduced, first_sum(w)));
}

/* All lanes for one target: a chunk each, from pair number `at` of its list on.
 */
static void run_spread(struct sphgi_worker *w, const uint32_t *ids, int32_t count, int32_t stride,
                       int32_t at)
{
    struct sphgi_lane_lists lists = {.side_by_side = false};
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        const int32_t first = l * SPHGI_CHUNK;
        lists.ids[l] = ids + (ptrdiff_t)first * stride;
        lists.count[l] = sphgi_max32(0, sphgi_min32(SPHGI_CHUNK, count - first));
        lists.stride[l] = stride;
    }
    w->tile.spread = true;
    w->spread_pairs = count;
    w->tile.chunk = at / SPHGI_CHUNK;
    w->tile.steps = sphgi_min32(SPHGI_CHUNK, count);
    run_tile(w, &lists, 0);
    join(w);
}

static int32_t spread_most(const struct sphgi_worker *w)
{
    return w->passes->lanes * SPHGI_CHUNK;
}

static void run_long_list(struct sphgi_worker *w)
{
    const int32_t stride = w->lists.stride[0], most = spread_most(w);
    for (int64_t at = 0; at < w->longest; at += most)
        run_spread(w, w->lists.ids[0] + at * stride,
                   (int32_t)(w->longest - at < most ? w->longest - at : most), stride, (int32_t)at);
}

/* ---- Rounds --------------------------------------------------------------------------------- */

static void settle(struct sphgi_worker *w)
{
    if (w->longest > SPHGI_PLAIN_CHUNKS * SPHGI_CHUNK)
        w->passes->settle(&w->tile, sums_of_round(w), sphgi_lane(w, w->reduced, first_sum(w)));
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

/* All pairs were added once: is another round over them needed? Classic, corrections and fields in
 * one sweep: the first round gives the coefficients. If one tile held everything, it is still
 * there. */
static bool again(struct sphgi_worker *w)
{
    settle(w);
    if (!w->coefficients_first || !(w->sweep->steps & SPHGI_SUM_MOMENTS) ||
        w->summing != SPHGI_SUM_MOMENTS)
        return false;
    sphgi_finish_corrections(w);
    if (w->tile.spread)
        repeat_coefficients(w);
    w->summing = SPHGI_SUM_FIELDS;
    const bool held = w->tiles == 1;
    w->tiles = 0;
    if (!held)
        return true;
    sphgi_evaluate_tile(w);
    join(w);
    settle(w);
    return false;
}

static void end(struct sphgi_worker *w)
{
    w->summed = w->group.lanes;
    if (!w->sweep->pairs && (w->summing & SPHGI_SUM_FIELDS))
        sphgi_load_targets(w);
}

void sphgi_group_run(struct sphgi_worker *w)
{
    begin(w);
    w->longest = 0;
    for (int32_t l = 0; l < w->targets; ++l)
        w->longest = sphgi_max32(w->longest, w->lists.count[l]);
    for (int32_t l = w->targets; l < w->passes->lanes; ++l) {
        w->lists.ids[l] = w->lists.ids[0];
        w->lists.count[l] = 0;
        w->lists.stride[l] = 1;
    }
    const bool spread = w->targets == 1 && w->longest > SPHGI_CHUNK;
    do
        if (spread)
            run_long_list(w);
        else
            run_lanes(w);
    while (again(w));
    end(w);
}

void sphgi_group_keep(struct sphgi_worker *w, uint32_t kept)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    struct sphgi_group *group = &w->group;
    sphgi_keep_lane_radii(w, kept);
    p->pack_lanes(kept, plan->sums, sphgi_lane(w, w->reduced, 0));
    p->pack_lanes(kept, plan->target_lanes, sphgi_lane(w, w->at_target, 0));
    if (plan->adjoint || plan->transposes[1]) {
        p->pack_lanes(kept, 1, sphgi_lane(w, w->volume, 0));
        p->pack_lanes(kept, 1, sphgi_lane(w, w->density, 0));
    }
    int32_t to = w->first;
    for (int32_t l = w->first; l < group->lanes; ++l, kept >>= 1) {
        group->target[to] = group->target[l];
        group->place[to] = group->place[l];
        to += (int32_t)(kept & 1);
    }
    group->lanes = w->summed = to;
}

void sphgi_stream_begin(struct sphgi_worker *w)
{
    begin(w);
    w->streamed = w->waiting = 0;
}

static void run_waiting(struct sphgi_worker *w)
{
    uint32_t *ids = (uint32_t *)(void *)w->waiting_ids;
    for (int32_t k = w->waiting; k % 4; ++k)
        ids[k] = w->gather.dummy;
    run_spread(w, ids, w->waiting, 1, w->streamed);
    w->streamed += w->waiting;
    w->waiting = 0;
}

void sphgi_stream_add(struct sphgi_worker *w, const uint32_t *ids, int32_t count)
{
    while (count > 0) {
        const int32_t part = sphgi_min32(count, spread_most(w) - w->waiting);
        memcpy((uint32_t *)(void *)w->waiting_ids + w->waiting, ids, (size_t)part * sizeof *ids);
        w->waiting += part;
        ids += part;
        count -= part;
        if (w->waiting == spread_most(w))
            run_waiting(w);
    }
}

bool sphgi_stream_again(struct sphgi_worker *w)
{
    if (w->waiting || !w->streamed)
        run_waiting(w);
    w->longest = w->streamed;
    w->streamed = 0;
    return again(w);
}

void sphgi_stream_end(struct sphgi_worker *w)
{
    end(w);
}

/* ---- The arena: sums of several source sets ------------------------------------------------- */

static void each_arena_part(struct sphgi_worker *w, bool load)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const size_t size = sphgi_size_of_type(plan->type);
    for (int32_t s = 0; s < plan->sums; s += SPHGI_COLUMNS_MOST) {
        const int32_t count = sphgi_min32(SPHGI_COLUMNS_MOST, plan->sums - s);
        const struct sphgi_columns columns =
            sphgi_dense_columns(sweep->arena + (size_t)s * size, count, plan->sums, plan->type);
        char *lanes = sphgi_lane(w, w->reduced, s);
        if (load)
            w->passes->load_lanes(w->width, &columns, sphgi_targets(w), lanes);
        else
            w->passes->store_lanes(w->targets, &columns, sphgi_targets(w), lanes,
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
    const int32_t target = w->group.target[lane], d = plan->dimension;
    const int64_t place = pairs->offsets[pairs->row_of_target[target]] + w->written[lane];
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
    for (int32_t l = 0; l < w->group.lanes; ++l) {
        if (w->sweep->plan->classic && w->sweep->plan->own_set >= 0) {
            if (pairs->offsets)
                write_self(w, l);
            ++w->written[l];
        }
        if (!pairs->offsets)
            pairs->counts[pairs->row_of_target[w->group.target[l]]] = w->written[l];
    }
}

void sphgi_group_finish(struct sphgi_worker *w)
{
    put_to_work(w, 0);
    if (w->sweep->pairs)
        finish_pairs(w);
    else if (w->sweep->steps & SPHGI_FINISH)
        finish(w);
    else
        each_arena_part(w, false);
    w->group.lanes = w->summed = 0;
}

void sphgi_group_finish_from_arena(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    put_to_work(w, 0);
    sphgi_find_lane_radii(w);
    w->targets_loaded = false;
    sphgi_load_targets(w);
    each_arena_part(w, true);
    if ((w->sweep->steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_corrections(w);
    else if (plan->corrects)
        sphgi_load_corrections(w);
    if (w->sweep->coefficients && (w->sweep->steps & SPHGI_SUM_MOMENTS))
        w->passes->store_lanes(w->targets, w->sweep->coefficients, sphgi_targets(w),
                               w->coefficients, false);
    if (w->sweep->steps & SPHGI_SUM_FIELDS)
        sphgi_finish_fields(w);
    w->group.lanes = 0;
}
