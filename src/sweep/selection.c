/* SPDX-License-Identifier: MIT */
#include "selection.h"
#include "core/parallel.h"
#include <string.h>

enum {
    FEW = 4,      /* items are few if there are so many times as many groups */
    GRAIN = 4096, /* items of a task that marks */
    GROUPS = 512  /* of a task that looks at places */
};
_Static_assert(SPHGI_GROUP == 16, "a group has a bit for each target");

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count)
{
    struct sphgi_selection selection = {.subset = subset, .target_count = target_count};
    selection.begin = subset ? subset->begin : 0;
    selection.end = subset ? subset->end : target_count;
    return selection;
}

/* ---- Few items: the group of each is looked up ---------------------------------------------- */

static void mark_few(struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target < 0)
            continue;
        const int32_t group = place[target] / SPHGI_GROUP;
        if (!selection->active[group])
            selection->groups[selection->group_count++] = group;
        selection->active[group] |= (uint16_t)(1u << place[target] % SPHGI_GROUP);
    }
}

/* ---- Many: all groups are looked at --------------------------------------------------------- */

struct marking {
    const struct sphgi_selection *selection;
    const sphg_neighbors *neighbors;
    uint8_t *marks; /* by place, of targets that a list names; NULL where there is no list */
};

static void mark_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct marking *marking = data;
    const struct sphgi_selection *selection = marking->selection;
    const int32_t *place = marking->neighbors->target_place.data;
    (void)worker;
    for (int32_t k = selection->begin + begin; k < selection->begin + end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target >= 0)
            marking->marks[place[target]] = 1;
    }
}

static bool is_in_range(const struct sphgi_selection *selection, int32_t target)
{
    const uint8_t *mask = selection->subset->mask;
    return target >= selection->begin && target < selection->end && (!mask || mask[target]);
}

static void look_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct marking *marking = data;
    const struct sphgi_selection *selection = marking->selection;
    const int32_t *order = sphgi_target_grid(marking->neighbors)->order.data;
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        const int32_t first = g * SPHGI_GROUP, count = sphgi_targets_in(marking->neighbors, g);
        uint8_t *marks = marking->marks ? marking->marks + first : NULL;
        uint32_t active = 0;
        for (int32_t k = 0; k < count; ++k)
            active |= (marks ? marks[k] : (uint32_t)is_in_range(selection, order[first + k])) << k;
        selection->active[g] = (uint16_t)active;
        if (marks)
            memset(marks, 0, (size_t)count);
    }
}

static void look_at_groups(sphg_context *context, struct sphgi_selection *selection,
                           const sphg_neighbors *n, uint8_t *marks)
{
    struct marking marking = {selection, n, selection->subset->indices ? marks : NULL};
    const int32_t items = selection->end - selection->begin;
    const int32_t count = sphgi_group_count(n->target_count);
    if (marking.marks)
        sphgi_parallel_for(context, mark_task, &marking, items, GRAIN);
    sphgi_parallel_for(context, look_task, &marking, count, GROUPS);
    for (int32_t g = 0; g < count; ++g)
        if (selection->active[g])
            selection->groups[selection->group_count++] = g;
}

/* ---- Both ----------------------------------------------------------------------------------- */

static bool are_few(const struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int64_t items = selection->end - selection->begin;
    return items * FEW < sphgi_group_count(n->target_count);
}

bool sphgi_selection_open(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *n)
{
    const size_t targets = sphgi_round_up((size_t)n->target_count + 1, SPHGI_ALIGNMENT);
    const size_t groups =
        sphgi_round_up((size_t)sphgi_group_count(n->target_count) + 1, SPHGI_ALIGNMENT);
    const size_t before = context->selection.size;
    if (!sphgi_reserve(&context->allocator, &context->selection,
                       targets + groups * (sizeof(uint16_t) + sizeof(int32_t)), 1))
        return false;
    uint8_t *base = context->selection.data;
    if (context->selection.size != before) /* all is 0 between calls */
        memset(base, 0, context->selection.size);
    selection->groups = (int32_t *)(void *)base;
    selection->active = (uint16_t *)(void *)(base + groups * sizeof(int32_t));
    selection->group_count = selection->active_count = 0;
    if (are_few(selection, n))
        mark_few(selection, n);
    else
        look_at_groups(context, selection, n, (uint8_t *)(selection->active + groups));
    for (int32_t k = 0; k < selection->group_count; ++k)
        selection->active_count += __builtin_popcount(selection->active[selection->groups[k]]);
    return true;
}

void sphgi_selection_close(struct sphgi_selection *selection)
{
    for (int32_t k = 0; k < selection->group_count; ++k)
        selection->active[selection->groups[k]] = 0;
    memset(selection->groups, 0, (size_t)selection->group_count * sizeof *selection->groups);
    selection->active = NULL;
    selection->groups = NULL;
}
