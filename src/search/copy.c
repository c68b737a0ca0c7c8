/* SPDX-License-Identifier: MIT */
#include "copy.h"
#include "core/check.h"

enum { LENGTH_MOST = 256 }; /* numbers of a list that is read at once */

size_t sphgi_copier_size(void)
{
    return (SPHGI_GROUP * (LENGTH_MOST + SPHGI_PAD) + 2 * SPHGI_LANES_MOST) * sizeof(uint32_t);
}

void sphgi_copier_open(struct sphgi_copier *copier, const sphg_context *context,
                       const sphg_neighbors *n, const sphg_lists *lists, int32_t worker,
                       void *memory)
{
    *copier = (struct sphgi_copier){.neighbors = n,
                                    .lists = lists,
                                    .passes = sphgi_passes_of(context, n->position_type),
                                    .find = {.rows = n->sources.rows.data,
                                             .reach = n->radius,
                                             .radii = n->graded,
                                             .stretch = 1,
                                             .mutual = n->mutual,
                                             .periodic = n->periodic,
                                             .dummy = (uint32_t)n->source_count * SPHGI_ID_STEP,
                                             .pack_order = context->pack_order,
                                             .pack_bytes = context->pack_bytes},
                                    .cleaning = sphgi_cleaning_of(n, lists),
                                    .worker = worker,
                                    .ids = memory,
                                    .bad_target = INT32_MAX};
    memcpy(copier->find.period, n->period, sizeof copier->find.period);
}

/* ---- One list ------------------------------------------------------------------------------- */

/* A list that is wrong counts as empty. */
static int32_t row_of(struct sphgi_copier *copier, int32_t target, const int32_t **numbers)
{
    const int64_t count = sphgi_host_row(copier->lists, target, copier->worker, numbers);
    if (sphgi_is_host_row(*numbers, count))
        return (int32_t)count;
    copier->bad_target = sphgi_min32(copier->bad_target, target);
    return 0;
}

/* Up to LENGTH_MOST numbers of a list become ids; returns how many. */
static int32_t copy_part(struct sphgi_copier *copier, int32_t target, const int32_t *numbers,
                         int32_t count, bool pack, uint32_t *ids)
{
    const sphg_neighbors *n = copier->neighbors;
    copier->cleaning.self = sphgi_self_of(n, target);
    if (copier->passes->clean_ids(numbers, count, &copier->cleaning, ids))
        copier->bad_target = sphgi_min32(copier->bad_target, target);
    return copier->passes->keep_near(&copier->find, sphgi_target_row(n, target), ids, count, pack);
}

int64_t sphgi_fault_of_list(const sphg_neighbors *n, const sphg_lists *lists, int32_t target)
{
    const struct sphgi_cleaning how = sphgi_cleaning_of(n, lists);
    const int32_t *numbers;
    const int64_t count = sphgi_host_row(lists, target, 0, &numbers);
    if (sphgi_is_host_row(numbers, count))
        for (int64_t k = 0; k < count; ++k)
            if (((uint32_t)numbers[k] & how.mask) >= how.sources)
                return (int32_t)((uint32_t)numbers[k] & how.mask); /* -1 reads as -1 */
    return SPHGI_BAD_LENGTH;
}

/* ---- Groups --------------------------------------------------------------------------------- */

bool sphgi_copy_group(struct sphgi_copier *copier, int32_t group, const uint32_t **lists,
                      int32_t *lengths)
{
    const int32_t first = group * SPHGI_GROUP, targets = sphgi_targets_in(copier->neighbors, group);
    uint32_t *to = copier->ids;
    copier->listed = 0;
    for (int32_t k = 0; k < SPHGI_GROUP; ++k) {
        const int32_t *numbers;
        const int32_t count = k < targets ? row_of(copier, first + k, &numbers) : 0;
        if (count > LENGTH_MOST)
            return false;
        lists[k] = to;
        lengths[k] =
            count ? copy_part(copier, first + k, numbers, count, count <= SPHGI_CHUNK, to) : 0;
        to += sphgi_round_up((size_t)lengths[k], SPHGI_PAD);
        copier->listed += count;
    }
    return true;
}

void sphgi_copy_target(struct sphgi_copier *copier, int32_t target, sphgi_take *take, void *data)
{
    const int32_t *numbers;
    const int32_t count = row_of(copier, target, &numbers);
    copier->listed = count;
    for (int32_t at = 0; at < count; at += LENGTH_MOST) {
        const int32_t part = sphgi_min32(count - at, LENGTH_MOST);
        take(data, copier->ids,
             copy_part(copier, target, numbers + at, part, count <= SPHGI_CHUNK, copier->ids));
    }
}
