/* SPDX-License-Identifier: MIT */
#include "group.h"
#include "batch.h"
#include "own.h"
#include "short_way.h"
#include "waiting.h"

enum { GROUPS_AHEAD = 8 };

/* What stands in order of storage is read front to back, but by so few instructions that the
 * machine does not see it coming. */
static void ask_for_numbers(const sphg_neighbors *n, int32_t place)
{
    if (place + GROUPS_AHEAD * SPHGI_GROUP < n->target_count) {
        __builtin_prefetch((const int32_t *)sphgi_target_grid(n)->order.data + place +
                           GROUPS_AHEAD * SPHGI_GROUP);
        __builtin_prefetch((const uint16_t *)n->found.lengths.data + place +
                           GROUPS_AHEAD * SPHGI_GROUP);
    }
}

/* They stand where the ids do. */
static char *kept_factors(const struct sphgi_worker *w, const uint32_t *ids)
{
    const ptrdiff_t at = ids - w->sweep->set->neighbors->found.ids;
    return w->sweep->kept.factors + (size_t)at * sphgi_size_of_type(w->sweep->plan->type);
}

/* The targets of a whole group: those that are not active are replaced by one that is, so that
 * nothing of theirs is read from the host. */
static void targets_of_group(const struct sphgi_worker *w, int32_t place, uint32_t active,
                             int32_t *targets)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const int32_t *order = (const int32_t *)sphgi_target_grid(n)->order.data + place;
    const int32_t other = order[__builtin_ctz(active)];
    for (int32_t l = 0; l < SPHGI_GROUP; ++l)
        targets[l] = active >> l & 1 ? order[l] : other;
    ask_for_numbers(n, place);
    sphgi_ask_for_targets(w, SPHGI_GROUP, targets);
}

/* A vector of them. */
static void put_into_lanes(struct sphgi_worker *w, const int32_t *targets, int32_t place)
{
    int32_t *const target = w->bundle.target + w->bundle.count;
    int32_t *const places = w->bundle.place + w->bundle.count;
    for (int32_t l = 0; l < w->passes->lanes; ++l) {
        target[l] = targets[l];
        places[l] = place + l;
    }
    w->bundle.count += w->passes->lanes;
}

static int32_t longest_of(const uint16_t *lengths, int32_t count)
{
    int32_t longest = 0;
    for (int32_t l = 0; l < count; ++l)
        longest = sphgi_max32(longest, lengths[l]);
    return longest;
}

static void run_side_by_side(struct sphgi_worker *w, const uint32_t *ids, const uint16_t *lengths)
{
    struct sphgi_lane_lists *lists = w->batch.lists;
    lists->ids[0] = ids;
    lists->stride[0] = SPHGI_GROUP;
    lists->side_by_side = true;
    for (int32_t l = 0; l < w->passes->lanes; ++l)
        lists->count[l] = lengths[l];
    sphgi_batch_run(w);
    lists->side_by_side = false;
}

void sphgi_group_run(struct sphgi_worker *w, int32_t place, const uint32_t *ids, uint32_t active)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const struct sphgi_kept_weights *kept = &w->sweep->kept;
    const uint16_t *lengths = (const uint16_t *)n->found.lengths.data + place;
    const int32_t group = place / SPHGI_GROUP, lanes = w->passes->lanes;
    const uint32_t all = (1u << lanes) - 1;
    if (w->bundle.count > SPHGI_WIDTH - SPHGI_GROUP)
        sphgi_finish_lanes(w);
    int32_t targets[SPHGI_GROUP];
    targets_of_group(w, place, active, targets);
    w->batch.kept_stand = kept->number && kept->marks[group] == kept->number;
    for (int32_t first = 0; first < SPHGI_GROUP; first += lanes) {
        w->batch.kept = kept->number ? kept_factors(w, ids + first) : NULL;
        put_into_lanes(w, targets + first, place + first);
        const bool some = (active >> first & all) != all;
        w->batch.drops = some && w->held.room;
        if (w->is_short)
            sphgi_short_way_run(w, ids + first, longest_of(lengths + first, lanes));
        else
            run_side_by_side(w, ids + first, lengths + first);
        if (some)
            sphgi_batch_keep(w, active >> first & all);
    }
    w->batch.drops = false;
    w->batch.kept = NULL;
    if (kept->number)
        kept->marks[group] = kept->number;
    if (w->bundle.summed == SPHGI_WIDTH)
        sphgi_finish_lanes(w);
}
