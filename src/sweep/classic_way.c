/* SPDX-License-Identifier: MIT */
#include "classic_way.h"
#include "batch.h"
#include "corrections.h"
#include "held.h"
#include "own.h"
#include "sums.h"
#include "table.h"

static int32_t chunks_of(int32_t steps)
{
    return sphgi_max32(1, (steps + SPHGI_CHUNK - 1) / SPHGI_CHUNK);
}

static bool are_gradients(const struct sphgi_plan *plan)
{
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (!field->one_sided || field->value_sum >= 0 || field->square.count)
            return false;
    }
    return true;
}

bool sphgi_is_classic_way(const struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const bool one_round = (sweep->steps & SPHGI_SUMS) == SPHGI_SUM_FIELDS && w->coefficients_first;
    return plan->classic && sweep->packed && !plan->graded && !w->gather.masked && !sweep->pairs &&
           sweep->set->neighbors->position_type == plan->type && (w->held.room || one_round) &&
           (!(sweep->steps & SPHGI_SUM_FIELDS) || are_gradients(plan));
}

bool sphgi_has_tiles_for(const struct sphgi_worker *w, int32_t steps)
{
    return !w->held.room || chunks_of(steps) <= w->held.room;
}

/* ---- Tiles ----------------------------------------------------------------------------------- */

/* The next chunk of the lists; moments only where they are wanted. */
static void fill_tile(struct sphgi_worker *w, const uint32_t *ids, int32_t steps, int32_t chunk)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t done = chunk * SPHGI_CHUNK;
    w->tile.ids = ids + (ptrdiff_t)done * SPHGI_GROUP;
    w->tile.id_stride = SPHGI_GROUP;
    w->tile.ids_end = w->ids_end;
    w->tile.spread = false;
    w->tile.carries = steps > SPHGI_PLAIN_CHUNKS * SPHGI_CHUNK;
    w->tile.chunk = chunk;
    w->tile.steps = sphgi_min32(steps - done, SPHGI_CHUNK);
    w->passes->begin_classic(
        &w->gather, &w->shape, sphgi_places(w), plan->weighted, &w->tile,
        w->batch.summing & SPHGI_SUM_MOMENTS ? sphgi_lane(w, w->reduced, plan->moment_sum) : NULL);
}

/* Corrections are there: nothing waits. */
static void sum_fields_at_once(struct sphgi_worker *w, const uint32_t *ids, int32_t steps)
{
    w->own.loaded = false;
    w->batch.summing = SPHGI_SUM_FIELDS;
    sphgi_load_corrections(w);
    for (int32_t k = 0; k < chunks_of(steps); ++k) {
        fill_tile(w, ids, steps, k);
        sphgi_evaluate_tile(w);
    }
    w->tile.weighed = false;
    sphgi_batch_settle(w);
    sphgi_load_targets(w);
    w->bundle.summed = w->bundle.count;
}

/* ---- Rounds ---------------------------------------------------------------------------------- */

void sphgi_classic_begin(struct sphgi_worker *w, const uint32_t *ids, int32_t steps)
{
    struct sphgi_begun *begun = &w->begun;
    if (begun->tiles + chunks_of(steps) > w->held.room)
        sphgi_classic_complete(w);
    sphgi_put_to_work(w, w->bundle.summed);
    w->batch.longest = steps;
    if (!w->held.room) {
        sum_fields_at_once(w, ids, steps);
        return;
    }
    if (!begun->vectors)
        begun->first = w->batch.first;
    w->batch.summing = SPHGI_SUM_MOMENTS;
    for (int32_t k = 0; k < chunks_of(steps); ++k) {
        w->batch.tiles = begun->tiles++;
        sphgi_place_tile(w);
        fill_tile(w, ids, steps, k);
        sphgi_hold_tile(w);
    }
    w->tile.weighed = false;
    sphgi_batch_settle(w);
    begun->longest[begun->vectors] = steps;
    begun->end[begun->vectors++] = begun->tiles;
    w->bundle.summed = w->bundle.count;
}

/* All targets that wait; others may stand behind them. */
static void put_begun_to_work(struct sphgi_worker *w)
{
    sphgi_put_to_work(w, w->begun.first);
    w->batch.targets = w->bundle.summed - w->begun.first;
    w->batch.width = (int32_t)sphgi_round_up((size_t)w->batch.targets, (size_t)w->passes->lanes);
}

/* A round over the tiles of all vectors, one after the other. */
static void sum_round(struct sphgi_worker *w, unsigned step)
{
    const struct sphgi_begun *begun = &w->begun;
    w->batch.summing = step;
    w->batch.width = w->passes->lanes;
    for (int32_t v = 0, tile = 0; v < begun->vectors; ++v) {
        w->batch.first = begun->first + v * w->passes->lanes;
        w->batch.longest = begun->longest[v];
        for (; tile < begun->end[v]; ++tile) {
            sphgi_take_tile(w, tile);
            sphgi_evaluate_tile(w);
        }
        sphgi_batch_settle(w);
    }
    put_begun_to_work(w);
}

void sphgi_classic_complete(struct sphgi_worker *w)
{
    if (!w->begun.vectors)
        return;
    const struct sphgi_tile tile = w->tile; /* of who comes next */
    const unsigned steps = w->sweep->steps;
    put_begun_to_work(w);
    sphgi_finish_moments(w);
    if (steps & SPHGI_SUM_SLOPES) {
        sum_round(w, SPHGI_SUM_SLOPES);
        sphgi_finish_slopes(w);
    }
    w->own.loaded = false;
    if (steps & SPHGI_SUM_FIELDS) {
        sphgi_load_targets(w);
        sum_round(w, SPHGI_SUM_FIELDS);
    }
    w->begun.vectors = w->begun.tiles = 0;
    w->tile = tile;
}
