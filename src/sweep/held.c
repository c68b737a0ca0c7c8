/* SPDX-License-Identifier: MIT */
#include "held.h"
#include <string.h>

static void use_place(struct sphgi_worker *w, int32_t k)
{
    const size_t bytes = SPHGI_ARRAYS * SPHGI_TILE * sphgi_size_of_type(w->sweep->plan->type);
    w->tile.arrays = w->held.arrays + (size_t)k * bytes;
    w->tile.own_ids = w->held.own_ids + (size_t)k * SPHGI_TILE;
}

/* Where all volumes are the same, they stand in the arrays from the beginning. */
void sphgi_held_open(struct sphgi_worker *w)
{
    const size_t volumes = SPHGI_V * SPHGI_TILE * sphgi_size_of_type(w->sweep->plan->type);
    for (int32_t k = sphgi_tiles_of(w->sweep); k-- > 0;) {
        use_place(w, k);
        if (!w->sweep->volumes)
            w->passes->fill(SPHGI_TILE, w->sweep->volume, (char *)w->tile.arrays + volumes);
    }
    w->held.room = sphgi_is_summed_in_rounds(w->sweep) ? sphgi_tiles_of(w->sweep) : 0;
}

void sphgi_place_tile(struct sphgi_worker *w)
{
    use_place(w, sphgi_min32(w->batch.tiles, w->held.room - 1));
}

void sphgi_hold_tile(struct sphgi_worker *w)
{
    if (++w->batch.tiles > w->held.room)
        return;
    struct sphgi_held_tile *held = &w->held.tile[w->batch.tiles - 1];
    held->tile = w->tile;
    held->spread_pairs = w->batch.spread_pairs;
    if (w->sweep->pairs)
        memcpy(held->pairs, w->batch.pairs, sizeof held->pairs);
}

void sphgi_take_tile(struct sphgi_worker *w, int32_t k)
{
    const struct sphgi_held_tile *held = &w->held.tile[k];
    w->tile = held->tile;
    w->batch.spread_pairs = held->spread_pairs;
    if (w->sweep->pairs)
        memcpy(w->batch.pairs, held->pairs, sizeof held->pairs);
}
