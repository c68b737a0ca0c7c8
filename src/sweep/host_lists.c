/* SPDX-License-Identifier: MIT */
#include "host_lists.h"
#include "held.h"
#include "own.h"
#include "rows.h"
#include "waiting.h"
#include "core/check.h"

static void note_bad_length(struct sphgi_tally *tally, int32_t target)
{
    if (tally->bad_target < 0 || target < tally->bad_target) {
        tally->bad_target = target;
        tally->bad_index = SPHGI_BAD_LENGTH;
    }
}

/* The host's numbers become ids when they are used. */
static const uint32_t *numbers_of(const int32_t *list)
{
    return (const uint32_t *)(const void *)list;
}

/* Numbers that come from memory should be on their way before the lanes are full: those of a list
 * of usual length, without a question that nobody could foresee. */
static void ask_for_list(const sphg_lists *lists, int32_t target, int32_t count)
{
    enum { LINE = 64 };
    if (target >= count || lists->row)
        return;
    const uintptr_t ids = lists->offsets ? (uintptr_t)lists->indices +
                                               (size_t)lists->offsets[target] * sizeof(int32_t)
                                         : (uintptr_t)lists->rows[target];
    __builtin_prefetch((const void *)ids);
    __builtin_prefetch((const void *)(ids + LINE));
    __asm__ volatile("");
}

void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    sphgi_held_open(&w);
    sphgi_find_targets_in_rows(&w);
    sphgi_use_rows(&w);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target < 0 || !sphgi_is_turn(&task->sweep, target))
            continue;
        ask_for_list(&n->lists, target + SPHGI_LANES_MOST, n->target_count);
        const int32_t *ids;
        const int64_t count = sphgi_host_row(&n->lists, target, number, &ids);
        if (!sphgi_is_host_row(ids, count))
            note_bad_length(w.tally, target);
        else if (!count && !sphgi_must_finish(w.sweep))
            continue;
        else if (n->lists.row) /* the host may use its array again */
            sphgi_add_copied(&w, target, target, numbers_of(ids), (int32_t)count, (int32_t)count);
        else
            sphgi_add_list(&w, target, target, numbers_of(ids), (int32_t)count, 1);
    }
    sphgi_run_rest(&w);
}
