/* SPDX-License-Identifier: MIT */
#include "mixed.h"
#include "copies.h"
#include "group.h"
#include "waiting.h"

/* ---- Lists ----------------------------------------------------------------------------------- */

/* The first `count` bits of `active` that are set. */
static uint32_t first_bits(uint32_t active, int32_t count)
{
    uint32_t left = active;
    for (; count > 0; --count)
        left &= left - 1;
    return active & ~left;
}

/* Lists that end before the longest, and lanes without a target. */
static void fill_up(const struct sphgi_mixed *mixed, int32_t longest, uint32_t dummy, uint32_t *to)
{
    int32_t lane = 0;
    for (int32_t p = 0; p < mixed->parts; ++p) {
        const struct sphgi_part *part = &mixed->part[p];
        for (int32_t k = part->steps; k < longest; ++k)
            for (int32_t l = 0; l < part->count; ++l)
                to[k * SPHGI_GROUP + lane + l] = dummy;
        lane += part->count;
    }
    for (int32_t k = 0; k < longest && lane < SPHGI_GROUP; ++k)
        for (int32_t l = lane; l < SPHGI_GROUP; ++l)
            to[k * SPHGI_GROUP + l] = dummy;
}

static void lay_side_by_side(const struct sphgi_worker *w, int32_t longest, uint32_t *to)
{
    const struct sphgi_mixed *mixed = &w->mixed;
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const struct sphgi_passes *of_ids = sphgi_passes_of(w->sweep->context, SPHG_F32);
    int32_t lane = 0;
    for (int32_t p = 0; p < mixed->parts; ++p) {
        const struct sphgi_part *part = &mixed->part[p];
        of_ids->pick_lists(part->ids, part->active, part->steps, lane, to);
        lane += part->count;
    }
    fill_up(mixed, longest, (uint32_t)n->source_count * SPHGI_ID_STEP, to);
}

/* ---- Groups ---------------------------------------------------------------------------------- */

/* Those that wait, from the oldest on; behind them stands the one that is not full. */
static struct sphgi_mixed_group *group_at(struct sphgi_mixed *mixed, int32_t k)
{
    return &mixed->group[(mixed->oldest + k) % SPHGI_MIXED_MOST];
}

static struct sphgi_copies *copies_of(struct sphgi_worker *w, const struct sphgi_mixed_group *group)
{
    return &w->rows.copies[group - w->mixed.group];
}

/* Its rows, if they are to be copied: what these are copied from will soon be read. */
static void number_rows(struct sphgi_worker *w, struct sphgi_mixed_group *group)
{
    if (!w->rows.local || group->numbered)
        return;
    group->numbered = true;
    sphgi_number_copies(w, copies_of(w, group), group->ids, group->longest * SPHGI_GROUP, 0);
    sphgi_ask_for_copying(w, copies_of(w, group));
}

/* Pairs may look ahead as far as ids of rows were written. */
static void run_oldest(struct sphgi_worker *w)
{
    struct sphgi_mixed *mixed = &w->mixed;
    struct sphgi_mixed_group *oldest = group_at(mixed, 0);
    const struct sphgi_group group = {.places = oldest->places,
                                      .active = (1u << oldest->count) - 1,
                                      .ids = oldest->ids,
                                      .lengths = oldest->lengths};
    const uint32_t *end = w->ids_end;
    if (w->bundle.count > w->bundle.summed)
        sphgi_run_lists(w); /* lists that came one by one meanwhile */
    number_rows(w, oldest);
    if (w->rows.local)
        sphgi_copy_rows(w, copies_of(w, oldest), 0);
    w->ids_end = w->rows.local ? NULL : w->waiting.ids + mixed->used;
    w->tile.scattered = !w->rows.local;
    sphgi_group_run(w, &group);
    w->tile.scattered = false;
    w->ids_end = end;
    mixed->oldest = (mixed->oldest + 1) % SPHGI_MIXED_MOST;
    --mixed->waiting;
}

static void run_all(struct sphgi_worker *w)
{
    while (w->mixed.waiting)
        run_oldest(w);
    w->mixed.used = 0;
}

/* The lists of those that are together stand side by side, and the oldest group is summed: what it
 * reads was asked for meanwhile. */
static void weave(struct sphgi_worker *w)
{
    struct sphgi_mixed *mixed = &w->mixed;
    struct sphgi_mixed_group *group = group_at(mixed, mixed->waiting);
    const int32_t ids = group->longest * SPHGI_GROUP, wait = w->rows.local ? 2 : 1;
    if (!group->count)
        return;
    if (mixed->used + ids > SPHGI_WAITING_IDS)
        run_all(w);
    group->ids = w->waiting.ids + mixed->used;
    mixed->used += ids;
    lay_side_by_side(w, group->longest, group->ids);
    if (w->rows.local)
        sphgi_ask_for_numbering(w, group->ids, ids, 1);
    if (mixed->waiting)
        number_rows(w, group_at(mixed, mixed->waiting - 1));
    if (++mixed->waiting > wait)
        run_oldest(w);
    mixed->parts = 0;
    group = group_at(mixed, mixed->waiting);
    group->count = group->longest = 0;
    group->numbered = false;
}

void sphgi_mixed_run(struct sphgi_worker *w)
{
    weave(w);
    run_all(w);
}

/* ---- Targets --------------------------------------------------------------------------------- */

static void add_part(struct sphgi_worker *w, int32_t number, uint32_t active)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    struct sphgi_mixed_group *group = group_at(&w->mixed, w->mixed.waiting);
    struct sphgi_part part = {.ids = sphgi_kept_ids(n, number), .active = active};
    const int32_t first = number * SPHGI_GROUP;
    const uint16_t *lengths = (const uint16_t *)n->found.lengths.data + first;
    for (uint32_t left = active; left; left &= left - 1) {
        const int32_t k = __builtin_ctz(left);
        group->places[group->count] = first + k;
        group->lengths[group->count++] = lengths[k];
        part.steps = sphgi_max32(part.steps, lengths[k]);
        ++part.count;
    }
    group->longest = sphgi_max32(group->longest, part.steps);
    w->mixed.part[w->mixed.parts++] = part;
}

bool sphgi_mixed_add(struct sphgi_worker *w, int32_t group, uint32_t active)
{
    const int32_t steps = sphgi_kept_steps(w->sweep->set->neighbors, group);
    if (steps * SPHGI_GROUP > SPHGI_WAITING_IDS ||
        (w->rows.local && (!w->is_short || steps > SPHGI_CHUNK)))
        return false;
    sphgi_woven_run(w);
    if (w->bundle.count > w->bundle.summed)
        sphgi_run_rest(w);
    while (active) {
        const int32_t count = group_at(&w->mixed, w->mixed.waiting)->count;
        const uint32_t part = first_bits(active, SPHGI_GROUP - count);
        add_part(w, group, part);
        active &= ~part;
        if (group_at(&w->mixed, w->mixed.waiting)->count == SPHGI_GROUP)
            weave(w);
    }
    return true;
}
