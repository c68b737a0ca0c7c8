/* SPDX-License-Identifier: MIT */
#include "group.h"
#include "batch.h"
#include "classic_way.h"
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

/* They stand where the ids do. NULL: none are kept. */
static char *kept_factors(const struct sphgi_worker *w, const struct sphgi_group *group,
                          const uint32_t *ids)
{
    if (!group->kept || !w->sweep->kept.number)
        return NULL;
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

/* Those of a mixed group, all of which are wanted; returns how many. */
static int32_t targets_of_mixed(const struct sphgi_worker *w, const struct sphgi_group *group,
                                int32_t *targets)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const int32_t *order = sphgi_target_grid(n)->order.data;
    int32_t count = 0;
    for (uint32_t left = group->active; left; left >>= 1, ++count)
        targets[count] = order[group->places[count]];
    sphgi_ask_for_targets(w, count, targets);
    return count;
}

/* Some of them; a vector, unless it is the last of a mixed group. */
static void put_into_lanes(struct sphgi_worker *w, const struct sphgi_group *group,
                           const int32_t *targets, int32_t first, int32_t count)
{
    int32_t *const target = w->bundle.target + w->bundle.count;
    int32_t *const places = w->bundle.place + w->bundle.count;
    for (int32_t l = 0; l < count; ++l) {
        target[l] = targets[first + l];
        places[l] = group->places ? group->places[first + l] : group->place + first + l;
    }
    w->bundle.count += count;
}

static int32_t longest_of(const uint16_t *lengths, int32_t count)
{
    int32_t longest = 0;
    for (int32_t l = 0; l < count; ++l)
        longest = sphgi_max32(longest, lengths[l]);
    return longest;
}

static void run_side_by_side(struct sphgi_worker *w, const uint32_t *ids, const uint16_t *lengths,
                             int32_t count)
{
    struct sphgi_lane_lists *lists = w->batch.lists;
    lists->ids[0] = ids;
    lists->stride[0] = SPHGI_GROUP;
    lists->side_by_side = true;
    for (int32_t l = 0; l < count; ++l)
        lists->count[l] = lengths[l];
    sphgi_run_lists(w);
    lists->side_by_side = false;
}

static bool is_short(const struct sphgi_worker *w, int32_t steps)
{
    return w->is_short &&
           (!w->sweep->plan->classic || (!w->batch.drops && sphgi_has_tiles_for(w, steps)));
}

/* Vectors that wait for each other stand one behind the other. */
static bool is_in_vectors(const struct sphgi_worker *w)
{
    return !w->sweep->plan->classic || w->bundle.count % w->passes->lanes == 0;
}

void sphgi_group_run(struct sphgi_worker *w, const struct sphgi_group *group)
{
    const struct sphgi_kept_weights *kept = &w->sweep->kept;
    const int32_t number = group->place / SPHGI_GROUP, lanes = w->passes->lanes;
    if (w->bundle.count > SPHGI_WIDTH - SPHGI_GROUP || !is_in_vectors(w))
        sphgi_finish_lanes(w);
    int32_t targets[SPHGI_GROUP], count = SPHGI_GROUP;
    if (group->places)
        count = targets_of_mixed(w, group, targets);
    else
        targets_of_group(w, group->place, group->active, targets);
    w->batch.kept_stand = group->kept && kept->number && kept->marks[number] == kept->number;
    for (int32_t first = 0; first < count; first += lanes) {
        const int32_t some = sphgi_min32(count - first, lanes);
        const uint32_t all = (1u << some) - 1, *ids = group->ids + first;
        const uint32_t active = group->active >> first & all;
        const uint16_t *lengths = group->lengths + first;
        const int32_t steps = w->is_short ? longest_of(lengths, some) : 0;
        w->batch.kept = kept_factors(w, group, ids);
        put_into_lanes(w, group, targets, first, some);
        w->batch.drops = active != all && w->held.room;
        if (is_short(w, steps))
            sphgi_short_way_run(w, ids, steps);
        else
            run_side_by_side(w, ids, lengths, some);
        if (active != all)
            sphgi_batch_keep(w, active);
    }
    w->batch.drops = false;
    w->batch.kept = NULL;
    if (!group->kept)
        sphgi_classic_complete(w); /* these ids do not stay */
    if (group->kept && kept->number)
        kept->marks[number] = kept->number;
    if (w->bundle.summed == SPHGI_WIDTH)
        sphgi_finish_lanes(w);
}

/* ---- Found on the spot ----------------------------------------------------------------------- */

void sphgi_woven_run(struct sphgi_worker *w)
{
    struct sphgi_woven *woven = &w->woven;
    const uint32_t *end = w->ids_end;
    w->ids_end = w->waiting.ids + woven->used;
    for (int32_t k = 0; k < woven->count; ++k)
        sphgi_group_run(w, &woven->group[k]);
    w->ids_end = end;
    woven->count = woven->used = 0;
}

bool sphgi_woven_add(struct sphgi_worker *w, int32_t place, uint32_t active,
                     const uint32_t *const *lists, const int32_t *lengths)
{
    enum { STEPS = 16 /* that are woven at once */ };
    struct sphgi_woven *woven = &w->woven;
    int32_t longest = 0;
    for (int32_t l = 0; l < SPHGI_GROUP; ++l)
        longest = sphgi_max32(longest, lengths[l]);
    const int32_t ids = (int32_t)sphgi_round_up((size_t)longest, STEPS) * SPHGI_GROUP;
    if (woven->count == SPHGI_WOVEN_MOST || woven->used + ids > SPHGI_WAITING_IDS)
        sphgi_woven_run(w);
    if (ids > SPHGI_WAITING_IDS)
        return false;
    uint32_t *to = w->waiting.ids + woven->used;
    uint16_t *kept = woven->lengths[woven->count];
    for (int32_t l = 0; l < SPHGI_GROUP; ++l)
        kept[l] = (uint16_t)lengths[l];
    woven->group[woven->count++] =
        (struct sphgi_group){.place = place, .active = active, .ids = to, .lengths = kept};
    woven->used += (int32_t)sphgi_round_up((size_t)longest, 4) * SPHGI_GROUP;
    const struct sphgi_passes *of_ids = sphgi_passes_of(w->sweep->context, SPHG_F32);
    of_ids->weave(lists, lengths, longest, SPHGI_FIND_PAD, w->gather.dummy, to);
    return true;
}
