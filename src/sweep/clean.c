/* SPDX-License-Identifier: MIT */
#include "clean.h"
#include "core/view.h"
#include "rows.h"
#include <string.h>

/* Of lists that name no target. */
static struct sphgi_cleaning cleaning_of(const struct sphgi_worker *w)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    struct sphgi_cleaning how = sphgi_cleaning_of(n, &n->lists);
    how.self = UINT32_MAX;
    return how;
}

/* Remembers the first target whose list holds what is no source, and what that is. */
static void note_bad_index(struct sphgi_tally *tally, int32_t target, const uint32_t *list,
                           int32_t count, const struct sphgi_cleaning *how)
{
    if (tally->bad_target >= 0 && target >= tally->bad_target)
        return;
    for (int32_t k = 0; k < count; ++k) {
        const uint32_t number = list[k] & how->mask;
        if (number < how->sources)
            continue;
        tally->bad_target = target;
        tally->bad_index = (int32_t)number; /* -1 reads as -1 */
        return;
    }
}

void sphgi_clean_list(struct sphgi_worker *w, int32_t target, const uint32_t *list, int32_t count,
                      uint32_t *ids)
{
    struct sphgi_cleaning how = cleaning_of(w);
    how.self = sphgi_self_of(w->sweep->set->neighbors, target);
    if (w->passes->clean_ids((const int32_t *)(const void *)list, count, &how, ids))
        note_bad_index(w->tally, target, list, count, &how);
}

/* The next chunk of the same lists, or the first of those that come. */
static void look_ahead(const struct sphgi_worker *w, const struct sphgi_lane_lists *lists,
                       int32_t begin, struct sphgi_slots *slots)
{
    const int64_t more = (int64_t)w->batch.longest - begin - SPHGI_CHUNK;
    if (w->tile.spread)
        return;
    if (more > 0) {
        slots->ahead = lists->ids;
        slots->ahead_begin = begin + SPHGI_CHUNK;
        slots->ahead_count = more < SPHGI_CHUNK ? (int32_t)more : SPHGI_CHUNK;
    } else if (w->batch.coming) {
        slots->ahead = w->batch.coming->ids;
        slots->ahead_count = sphgi_min32(w->batch.coming_longest, SPHGI_CHUNK);
    }
}

void sphgi_clean_lists(struct sphgi_worker *w, const struct sphgi_lane_lists *lists, int32_t begin)
{
    const int32_t *targets = sphgi_targets(w);
    struct sphgi_slots slots = {.how = cleaning_of(w), .ids = w->rows.clean_ids};
    if (w->sweep->set->neighbors->part_of)
        slots.targets = targets;
    look_ahead(w, lists, begin, &slots);
    if (!w->passes->interleave_hosts(lists, begin, &slots, &w->tile))
        return;
    for (int32_t l = 0; l < w->passes->lanes; ++l)
        if (lists->count[l] > begin)
            note_bad_index(w->tally, targets[l], lists->ids[l] + begin,
                           sphgi_min32(lists->count[l] - begin, w->tile.steps), &slots.how);
}
