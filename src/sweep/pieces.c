/* SPDX-License-Identifier: MIT */
#include "pieces.h"
#include "batch.h"
#include "core/view.h"
#include <string.h>

void sphgi_pieces_begin(struct sphgi_worker *w)
{
    sphgi_batch_begin(w);
    w->waiting.summed = w->waiting.pairs = 0;
}

static void run_waiting(struct sphgi_worker *w)
{
    uint32_t *ids = w->waiting.ids;
    for (int32_t k = w->waiting.pairs; k % 4; ++k)
        ids[k] = w->gather.dummy;
    sphgi_run_spread(w, ids, w->waiting.pairs, 1, w->waiting.summed);
    w->waiting.summed += w->waiting.pairs;
    w->waiting.pairs = 0;
}

void sphgi_pieces_add(struct sphgi_worker *w, const uint32_t *ids, int32_t count)
{
    while (count > 0) {
        const int32_t part = sphgi_min32(count, sphgi_spread_most(w) - w->waiting.pairs);
        memcpy(w->waiting.ids + w->waiting.pairs, ids, (size_t)part * sizeof *ids);
        w->waiting.pairs += part;
        ids += part;
        count -= part;
        if (w->waiting.pairs == sphgi_spread_most(w))
            run_waiting(w);
    }
}

bool sphgi_pieces_again(struct sphgi_worker *w)
{
    if (w->waiting.pairs || !w->waiting.summed)
        run_waiting(w);
    w->batch.longest = w->waiting.summed;
    w->waiting.summed = 0;
    return sphgi_batch_again(w);
}

void sphgi_pieces_end(struct sphgi_worker *w)
{
    sphgi_batch_end(w);
}
