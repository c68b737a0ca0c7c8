/* SPDX-License-Identifier: MIT */
#include "traverse.h"
#include "copies.h"
#include "group.h"
#include "held.h"
#include "mixed.h"
#include "own.h"
#include "pieces.h"
#include "records.h"
#include "short_way.h"
#include "waiting.h"
#include "rows.h"
#include "search/find.h"
#include <string.h>

static int32_t target_at(const sphg_neighbors *n, int32_t place)
{
    return ((const int32_t *)sphgi_target_grid(n)->order.data)[place];
}

/* A bit for each target of a group that is selected, and whose turn it is. */
static uint32_t active_of(const struct sphgi_task *task, int32_t group)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const uint32_t all = (1u << sphgi_targets_in(n, group)) - 1;
    const uint32_t selected = task->selection->subset ? task->selection->active[group] : all;
    if (!task->sweep.turn.waits)
        return selected;
    uint32_t active = 0;
    for (uint32_t left = selected; left; left &= left - 1) {
        const int32_t k = __builtin_ctz(left);
        active |= (uint32_t)sphgi_is_turn(&task->sweep, target_at(n, group * SPHGI_GROUP + k)) << k;
    }
    return active;
}

static void add_kept(struct sphgi_worker *w, int32_t place, const uint32_t *ids, int32_t count,
                     int32_t stride)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    if (w->rows.local)
        sphgi_ask_for_numbering(w, ids, count, stride);
    sphgi_add_list(w, target_at(n, place), place, ids, count, stride);
}

/* Are groups of which some targets are active summed whole? Dropped ones must leave no trace: where
 * matrices come before fields, those of all would be counted. Where they come alone, they are
 * finished when the others are gone. All groups go the same way: one that goes the other way in
 * between costs both of them more. */
static bool are_summed_whole(const struct sphgi_task *task, const struct sphgi_worker *w)
{
    enum { WORTH = 11 }; /* active targets of the sixteen, on average */
    const struct sphgi_selection *selection = task->selection;
    const bool corrections = w->held.room && !(w->sweep->steps & SPHGI_SUM_FIELDS);
    return selection->groups && (!w->coefficients_first || corrections) && !w->sweep->pairs &&
           selection->active_count >= (int64_t)WORTH * selection->group_count;
}

/* Lists that stand one after the other. */
static void sweep_apart(const struct sphgi_task *task, struct sphgi_worker *w, int32_t group)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const uint32_t active = active_of(task, group);
    const int32_t first = group * SPHGI_GROUP;
    struct sphgi_kept_list list = sphgi_first_apart(n, group);
    for (int32_t k = 0; k < sphgi_targets_in(n, group); ++k, sphgi_to_next_list(&list))
        if (active >> k & 1)
            add_kept(w, first + k, list.ids, (int32_t)*list.length, 1);
}

/* Is all of a group summed at once? Its lists stand side by side, and no others wait. */
static bool is_summed_whole(const struct sphgi_task *task, const struct sphgi_worker *w,
                            int32_t group, uint32_t active)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const bool whole =
        active == (1u << SPHGI_GROUP) - 1 ||
        (active && sphgi_targets_in(n, group) == SPHGI_GROUP && are_summed_whole(task, w));
    return whole && !w->rows.local && w->bundle.count == w->bundle.summed;
}

static void sweep_kept(const struct sphgi_task *task, struct sphgi_worker *w, int32_t group)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t first = group * SPHGI_GROUP;
    if (sphgi_kept_steps(n, group) == SPHGI_APART) {
        sweep_apart(task, w, group);
        return;
    }
    if (!sphgi_kept_steps(n, group) && !sphgi_must_finish(w->sweep))
        return;
    const uint32_t *ids = sphgi_kept_ids(n, group);
    const uint16_t *lengths = (const uint16_t *)n->found.lengths.data + first;
    const uint32_t active = active_of(task, group);
    if (is_summed_whole(task, w, group, active)) {
        sphgi_group_run(
            w, &(struct sphgi_group){
                   .place = first, .active = active, .ids = ids, .lengths = lengths, .kept = true});
        return;
    }
    if (sphgi_mixed_add(w, group, active))
        return;
    for (uint32_t left = active; left; left &= left - 1) {
        const int32_t k = __builtin_ctz(left);
        add_kept(w, first + k, ids + k, lengths[k], SPHGI_GROUP);
    }
}

static void take_ids(void *data, const uint32_t *ids, int32_t count)
{
    sphgi_pieces_add(data, ids, count);
}

/* Pairs are found and used at once. */
static void stream_target(struct sphgi_worker *w, struct sphgi_finder *finder, int32_t place)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    sphgi_run_rest(w);
    sphgi_add_target(w, target_at(n, place), place);
    sphgi_pieces_begin(w);
    do
        sphgi_find_target(finder, place, take_ids, w);
    while (sphgi_pieces_again(w));
    sphgi_pieces_end(w);
    sphgi_finish_lanes(w);
}

static bool are_empty(const int32_t *lengths)
{
    int32_t some = 0;
    for (int32_t k = 0; k < SPHGI_GROUP; ++k)
        some |= lengths[k];
    return !some;
}

/* Nothing is kept: lists stay until the next group is looked for, then they would have to be
 * copied. */
static void sweep_found(const struct sphgi_task *task, struct sphgi_worker *w,
                        struct sphgi_finder *finder, int32_t group)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t first = group * SPHGI_GROUP;
    const uint32_t *lists[SPHGI_GROUP];
    int32_t lengths[SPHGI_GROUP];
    const uint32_t active = active_of(task, group);
    if (!active)
        return;
    sphgi_mixed_run(w);
    const bool collected = sphgi_find_group(finder, group, lists, lengths);
    if (collected && !sphgi_must_finish(w->sweep) && are_empty(lengths))
        return;
    if (collected && is_summed_whole(task, w, group, active) &&
        sphgi_woven_add(w, first, active, lists, lengths))
        return;
    sphgi_woven_run(w);
    const bool all = active == (1u << SPHGI_GROUP) - 1 && w->bundle.count == w->bundle.summed;
    for (uint32_t left = active; left; left &= left - 1) {
        const int32_t k = __builtin_ctz(left), place = first + k, target = target_at(n, place);
        if (!collected)
            stream_target(w, finder, place);
        else if (all)
            sphgi_add_list(w, target, place, lists[k], lengths[k], 1);
        else
            sphgi_add_copied(w, target, place, lists[k], lengths[k],
                             (int32_t)sphgi_round_up((size_t)lengths[k], SPHGI_PAD));
    }
}

/* Behind the last id that was written. */
static const uint32_t *end_of_ids(const sphg_neighbors *n)
{
    const struct sphgi_found *found = &n->found;
    if (!found->ids)
        return NULL;
    return found->ids + (found->ids_used < found->room ? found->ids_used : found->room);
}

static bool is_left_out(const struct sphgi_sweep *sweep, int32_t group)
{
    return sweep->groups != SPHGI_ALL_GROUPS &&
           sphgi_goes_by_records(sweep, group) != (sweep->groups == SPHGI_GROUPS_BY_RECORDS);
}

/* What is known of groups, unless nothing is kept, is read before their lists can be asked for. */
static void ask_for_group(const struct sphgi_sweep *sweep, int32_t group, int32_t end)
{
    enum { GROUPS = 16, MARKS = 32 };
    const sphg_neighbors *n = sweep->set->neighbors;
    if (!n->list_free && group + GROUPS < end)
        __builtin_prefetch(n->found.groups + group + GROUPS);
    if (sweep->kept.number && group + MARKS < end)
        __builtin_prefetch(sweep->kept.marks + group + MARKS);
}

/* Of a group whose targets are not all active, so that its lists are not read one step after the
 * other. */
static void ask_for_lists(const struct sphgi_task *task, int32_t group)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t steps = sphgi_kept_steps(n, group);
    if (!sphgi_is_kept(n, group) || steps == SPHGI_APART ||
        task->selection->active[group] == (1u << SPHGI_GROUP) - 1)
        return;
    const uint32_t *ids = sphgi_kept_ids(n, group);
    for (int32_t k = 0; k < steps; ++k)
        __builtin_prefetch(ids + (ptrdiff_t)k * SPHGI_GROUP);
    __asm__ volatile(""); /* GCC takes a function that only prefetches for one without effect */
}

/* Of groups of a subset: what is known of them, and later their lists. */
static void ask_for_some(const struct sphgi_task *task, int32_t k, int32_t end)
{
    enum { LISTS = 8, GROUPS = 24 };
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t *groups = task->selection->groups, *order = sphgi_target_grid(n)->order.data;
    if (n->list_free)
        return;
    if (k + GROUPS < end) {
        const ptrdiff_t group = groups[k + GROUPS];
        __builtin_prefetch(n->found.groups + group);
        __builtin_prefetch((const uint16_t *)n->found.lengths.data + group * SPHGI_GROUP);
        __builtin_prefetch(order + group * SPHGI_GROUP);
    }
    if (k + LISTS < end)
        ask_for_lists(task, groups[k + LISTS]);
}

void sphgi_group_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t *groups = task->selection->groups;
    struct sphgi_worker w;
    struct sphgi_finder finder;
    sphgi_worker_open(&w, &task->sweep, number);
    sphgi_held_open(&w);
    sphgi_find_targets_in_rows(&w);
    sphgi_use_rows(&w);
    sphgi_short_way_open(&w);
    w.ids_end = end_of_ids(n);
    sphgi_finder_open(&finder, task->sweep.context, n, w.finder_memory);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t group = groups ? groups[k] : k;
        if (groups)
            ask_for_some(task, k, end);
        else
            ask_for_group(&task->sweep, k, end);
        if (is_left_out(&task->sweep, group))
            continue;
        if (sphgi_is_kept(n, group))
            sweep_kept(task, &w, group);
        else
            sweep_found(task, &w, &finder, group);
    }
    sphgi_woven_run(&w);
    sphgi_mixed_run(&w);
    sphgi_run_rest(&w);
}
