/* SPDX-License-Identifier: MIT */
#include "selection.h"
#include "core/parallel.h"
#include <string.h>

enum {
    FEW = 4,      /* items are few if there are so many times as many groups */
    GRAIN = 4096, /* items of a task that marks */
    GROUPS = 512  /* of a task that looks at places */
};

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count)
{
    struct sphgi_selection selection = {.subset = subset, .target_count = target_count};
    selection.begin = subset ? subset->begin : 0;
    selection.end = subset ? subset->end : target_count;
    return selection;
}

/* ---- Few items: the group of each is looked up ---------------------------------------------- */

/* seen: a byte per group, 0, and 0 again afterwards. */
static void mark_few(struct sphgi_selection *selection, const sphg_neighbors *n, uint8_t *seen)
{
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target < 0 || selection->active[place[target]])
            continue;
        selection->active[place[target]] = 1;
        ++selection->active_count;
        const int32_t group = place[target] / SPHGI_GROUP;
        if (!seen[group])
            selection->groups[selection->group_count++] = group;
        seen[group] = 1;
    }
    for (int32_t k = 0; k < selection->group_count; ++k)
        seen[selection->groups[k]] = 0;
}

/* ---- Many: all groups are looked at --------------------------------------------------------- */

struct marking {
    const struct sphgi_selection *selection;
    const sphg_neighbors *neighbors;
    uint8_t *seen; /* active targets per group */
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
            selection->active[place[target]] = 1;
    }
}

static void look_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct marking *marking = data;
    const sphg_neighbors *n = marking->neighbors;
    const int32_t *order = sphgi_target_grid(n)->order.data;
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        const int32_t first = g * SPHGI_GROUP;
        uint8_t active = 0;
        for (int32_t k = first; k < first + sphgi_targets_in(n, g); ++k)
            active += sphgi_is_selected(marking->selection, k, order[k]);
        marking->seen[g] = active;
    }
}

static void look_at_groups(sphg_context *context, struct sphgi_selection *selection,
                           const sphg_neighbors *n, uint8_t *seen)
{
    struct marking marking = {selection, n, seen};
    const int32_t items = selection->end - selection->begin;
    const int32_t count = sphgi_group_count(n->target_count);
    if (selection->active)
        sphgi_parallel_for(context, mark_task, &marking, items, GRAIN);
    sphgi_parallel_for(context, look_task, &marking, count, GROUPS);
    for (int32_t g = 0; g < count; ++g) {
        if (seen[g])
            selection->groups[selection->group_count++] = g;
        selection->active_count += seen[g];
    }
    memset(seen, 0, (size_t)count);
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
                       targets + groups * (1 + sizeof(int32_t)), 1))
        return false;
    if (context->selection.size != before) /* marks are all taken back between calls */
        memset(context->selection.data, 0, context->selection.size);
    /* Marks stand at fixed ends of the buffer, the list of groups between them is scratch. */
    uint8_t *base = context->selection.data;
    uint8_t *seen = base + context->selection.size - groups;
    const bool few = are_few(selection, n);
    selection->active = few || selection->subset->indices ? base : NULL;
    selection->groups = (int32_t *)(void *)(base + targets);
    selection->group_count = selection->active_count = 0;
    if (few)
        mark_few(selection, n, seen);
    else
        look_at_groups(context, selection, n, seen);
    return true;
}

void sphgi_selection_close(struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int32_t *place = n->target_place.data;
    const bool few = are_few(selection, n);
    for (int32_t k = selection->begin; few && k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target >= 0)
            selection->active[place[target]] = 0;
    }
    if (selection->active && !few)
        memset(selection->active, 0, (size_t)n->target_count);
    memset(selection->groups, 0, (size_t)selection->group_count * sizeof *selection->groups);
    selection->active = NULL;
    selection->groups = NULL;
}
