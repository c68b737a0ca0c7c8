/* SPDX-License-Identifier: MIT */
#include "waiting.h"
#include "batch.h"
#include "bundle.h"
#include "classic_way.h"
#include <string.h>

int32_t sphgi_add_target(struct sphgi_worker *w, int32_t target, int32_t place)
{
    const int32_t lane = w->bundle.count++;
    w->bundle.target[lane] = target;
    w->bundle.place[lane] = place;
    return lane;
}

void sphgi_finish_lanes(struct sphgi_worker *w)
{
    if (w->bundle.count)
        sphgi_bundle_finish(w);
}

void sphgi_run_lists(struct sphgi_worker *w)
{
    sphgi_classic_complete(w);
    sphgi_batch_run(w);
}

void sphgi_run_rest(struct sphgi_worker *w)
{
    if (w->bundle.count > w->bundle.summed)
        sphgi_run_lists(w);
    sphgi_finish_lanes(w);
    w->waiting.used = 0;
}

void sphgi_add_list(struct sphgi_worker *w, int32_t target, int32_t place, const uint32_t *ids,
                    int32_t count, int32_t stride)
{
    if (w->bundle.count == w->bundle.summed && w->bundle.summed > SPHGI_WIDTH - w->passes->lanes)
        sphgi_finish_lanes(w); /* no room for a vector more */
    const int32_t lane = sphgi_add_target(w, target, place) - w->bundle.summed;
    w->batch.lists->ids[lane] = ids;
    w->batch.lists->count[lane] = count;
    w->batch.lists->stride[lane] = stride;
    if (lane + 1 == w->passes->lanes)
        sphgi_run_lists(w);
    if (w->bundle.summed == SPHGI_WIDTH)
        sphgi_finish_lanes(w);
    if (w->bundle.count == w->bundle.summed)
        w->waiting.used = 0;
}

/* A place for a list that will not stay where it is: it waits there until the lanes are full. NULL:
 * it is too long for that. */
static uint32_t *room_to_wait(struct sphgi_worker *w, int32_t count)
{
    if (w->waiting.used + (int64_t)count > SPHGI_WAITING_IDS)
        sphgi_run_rest(w);
    if (count > SPHGI_WAITING_IDS)
        return NULL;
    uint32_t *room = w->waiting.ids + w->waiting.used;
    w->waiting.used += count;
    return room;
}

void sphgi_add_copied(struct sphgi_worker *w, int32_t target, int32_t place, const uint32_t *ids,
                      int32_t count, int32_t copied)
{
    uint32_t *copy = room_to_wait(w, copied);
    if (!copy)
        sphgi_run_rest(w);
    else if (copied)
        memcpy(copy, ids, (size_t)copied * sizeof *ids);
    sphgi_add_list(w, target, place, copy ? copy : ids, count, 1);
    if (!copy)
        sphgi_run_rest(w);
}
