/* SPDX-License-Identifier: MIT */
#include "host_lists.h"
#include "batch.h"
#include "held.h"
#include "own.h"
#include "rows.h"
#include "waiting.h"
#include "core/check.h"
#include <string.h>

/* ---- Lists ---------------------------------------------------------------------------------- */

struct reading {
    const struct sphgi_task *task;
    int32_t number;                     /* of the worker */
    int32_t at, end;                    /* items that are left */
    bool all;                           /* targets without pairs, too */
    uintptr_t before[SPHGI_LANES_MOST]; /* arrays that a function handed out last, by lanes */
    struct sphgi_worker worker;
};

struct host_list {
    int32_t target, count;
    const uint32_t *numbers;
};

static void note_bad_length(struct sphgi_tally *tally, int32_t target)
{
    if (tally->bad_target < 0 || target < tally->bad_target) {
        tally->bad_target = target;
        tally->bad_index = SPHGI_BAD_LENGTH;
    }
}

/* The list of the next item from *at on that is to be summed; false: there is none. */
SPHGI_TEMPLATE bool next_list(const struct reading *reading, const sphg_lists *lists, int32_t *at,
                              struct host_list *list)
{
    const struct sphgi_selection *selection = reading->task->selection;
    while (*at < reading->end) {
        const int32_t target = sphgi_selected(selection, selection->begin + (*at)++);
        if (target < 0 || !sphgi_is_turn(&reading->task->sweep, target))
            continue;
        const int32_t *numbers;
        const int64_t count = sphgi_host_row(lists, target, reading->number, &numbers);
        if (!sphgi_is_host_row(numbers, count)) {
            note_bad_length(reading->worker.tally, target);
        } else if (count || reading->all) {
            *list =
                (struct host_list){target, (int32_t)count, (const uint32_t *)(const void *)numbers};
            return true;
        }
    }
    return false;
}

/* ---- Lanes ---------------------------------------------------------------------------------- */

/* Targets that are summed at once, and their lists. */
struct lanes {
    int32_t count, longest, target[SPHGI_LANES_MOST];
    struct sphgi_lane_lists lists;
};

SPHGI_TEMPLATE void put(struct lanes *lanes, const struct host_list *list, const uint32_t *ids)
{
    const int32_t lane = lanes->count++;
    lanes->target[lane] = list->target;
    lanes->lists.ids[lane] = ids;
    lanes->lists.count[lane] = list->count;
    lanes->lists.stride[lane] = 1;
}

/* Of arrays, which stay. */
static void fill(struct reading *reading, struct lanes *lanes)
{
    const sphg_lists lists = reading->task->sweep.set->neighbors->lists;
    const int32_t most = reading->worker.passes->lanes;
    struct host_list list;
    int32_t at = reading->at, longest = 0;
    lanes->count = 0;
    while (lanes->count < most && next_list(reading, &lists, &at, &list)) {
        put(lanes, &list, list.numbers);
        longest = sphgi_max32(longest, list.count);
    }
    lanes->longest = longest;
    reading->at = at;
}

/* A function mostly hands out one array after another: that of as many targets further on will
 * stand as far behind this one as this one does behind that of as many targets before. */
static void ask_for_later(const struct host_list *list, uintptr_t *before)
{
    enum { MOST = 4 * SPHGI_CHUNK }; /* numbers that will be read soon */
    const uintptr_t here = (uintptr_t)list->numbers;
    sphgi_ask_for_numbers(here + (here - *before), sphgi_min32(list->count, MOST));
    *before = here;
}

/* Of a function, which may use its array again: copies wait. A list for which there is no room
 * beside others is asked for again, and one that is longer than all room is summed alone. */
static void fill_by_function(struct reading *reading, struct lanes *lanes)
{
    const sphg_lists lists = reading->task->sweep.set->neighbors->lists;
    const int32_t most = reading->worker.passes->lanes;
    uint32_t *copy = reading->worker.waiting.ids;
    struct host_list list;
    int32_t at = reading->at, room = SPHGI_WAITING_IDS;
    lanes->count = 0;
    while (lanes->count < most && next_list(reading, &lists, &at, &list)) {
        if (list.count > room) {
            if (lanes->count)
                --at;
            else
                put(lanes, &list, list.numbers);
            break;
        }
        ask_for_later(&list, &reading->before[lanes->count]);
        if (list.count)
            memcpy(copy, list.numbers, (size_t)list.count * sizeof *copy);
        put(lanes, &list, copy);
        copy += list.count;
        room -= list.count;
    }
    reading->at = at;
}

static void run(struct sphgi_worker *w, struct lanes *lanes, const struct lanes *coming)
{
    if (w->bundle.count > SPHGI_WIDTH - w->passes->lanes)
        sphgi_finish_lanes(w);
    int32_t *const target = w->bundle.target + w->bundle.count;
    int32_t *const place = w->bundle.place + w->bundle.count;
    for (int32_t l = 0; l < lanes->count; ++l)
        target[l] = place[l] = lanes->target[l];
    w->bundle.count += lanes->count;
    w->batch.lists = &lanes->lists;
    w->batch.coming = coming && coming->count ? &coming->lists : NULL;
    w->batch.coming_longest = coming ? coming->longest : 0;
    sphgi_ask_for_targets(w, lanes->count, lanes->target);
    sphgi_batch_run(w);
    if (w->bundle.summed == SPHGI_WIDTH)
        sphgi_finish_lanes(w);
}

/* ---- The task -------------------------------------------------------------------------------- */

static void read_by_function(struct reading *reading)
{
    struct lanes lanes = {.lists.numbers = true};
    for (fill_by_function(reading, &lanes); lanes.count; fill_by_function(reading, &lanes))
        run(&reading->worker, &lanes, NULL);
}

/* The lists of the next lanes are known, and asked for, while pairs are summed. */
static void read_arrays(struct reading *reading)
{
    struct lanes lanes[2] = {{.lists.numbers = true}, {.lists.numbers = true}};
    int now = 0;
    for (fill(reading, lanes); lanes[now].count; now = !now) {
        fill(reading, &lanes[!now]);
        run(&reading->worker, &lanes[now], &lanes[!now]);
    }
}

void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    struct reading reading = {.task = task, .number = number, .at = begin, .end = end};
    sphgi_worker_open(&reading.worker, &task->sweep, number);
    sphgi_held_open(&reading.worker);
    sphgi_find_targets_in_rows(&reading.worker);
    sphgi_use_rows(&reading.worker);
    reading.all = sphgi_must_finish(&task->sweep);
    if (task->sweep.set->neighbors->lists.row)
        read_by_function(&reading);
    else
        read_arrays(&reading);
    sphgi_finish_lanes(&reading.worker);
}
