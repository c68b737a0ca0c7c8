/* SPDX-License-Identifier: MIT */
#include "selection.h"
#include "core/parallel.h"
#include <stdatomic.h>
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

static void mark_place(struct sphgi_selection *selection, int32_t place)
{
    const int32_t group = place / SPHGI_GROUP;
    selection->active_count += !(selection->active[group] >> place % SPHGI_GROUP & 1);
    selection->active[group] |= (uint16_t)(1u << place % SPHGI_GROUP);
}

static void mark_few(struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target < 0)
            continue;
        if (!selection->active[place[target] / SPHGI_GROUP])
            selection->groups[selection->group_count++] = place[target] / SPHGI_GROUP;
        mark_place(selection, place[target]);
    }
}

/* ---- A mask that selects few ---------------------------------------------------------------- */

enum { EIGHT = sizeof(uint64_t) };

static uint64_t eight_of(const uint8_t *mask)
{
    uint64_t bytes;
    memcpy(&bytes, mask, sizeof bytes);
    return bytes;
}

/* By samples: of a subset that is a mask. */
static bool selects_few(const struct sphgi_selection *selection)
{
    enum { SHARE = 32, STRIDE = 61 * EIGHT };
    const uint8_t *mask = selection->subset->mask;
    int32_t looked_at = 0, selected = 0;
    if (!mask || selection->subset->indices)
        return false;
    for (int64_t k = selection->begin; k + EIGHT <= selection->end; k += STRIDE)
        for (int32_t l = 0; l < EIGHT; ++l, ++looked_at)
            selected += mask[k + l] != 0;
    return (int64_t)selected * SHARE < looked_at;
}

/* The targets that a stretch of the mask selects. */
static int32_t selected_from(const uint8_t *mask, int32_t begin, int32_t end, int32_t *targets)
{
    int32_t count = 0;
    for (int32_t k = begin; k < end; k += EIGHT) {
        const int32_t most = sphgi_min32(EIGHT, end - k);
        if (most == EIGHT && !eight_of(mask + k))
            continue;
        for (int32_t l = 0; l < most; ++l) {
            targets[count] = k + l;
            count += mask[k + l] != 0;
        }
    }
    return count;
}

struct masked {
    struct sphgi_selection *selection;
    const int32_t *place;
    atomic_int selected;
};

/* First the targets, then their places, which come from memory. */
static void mark_masked_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    enum { STRETCH = 2048 };
    struct masked *masked = data;
    struct sphgi_selection *selection = masked->selection;
    const int32_t first = selection->begin;
    int32_t targets[STRETCH + 1];
    (void)worker;
    for (int32_t k = begin; k < end; k += STRETCH) {
        const int32_t count = selected_from(selection->subset->mask, first + k,
                                            first + sphgi_min32(end, k + STRETCH), targets);
        for (int32_t l = 0; l < count; ++l) {
            /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.ArraySubscript): l < count */
            const int32_t place = masked->place[targets[l]];
            __atomic_fetch_or(&selection->active[place / SPHGI_GROUP],
                              (uint16_t)(1u << place % SPHGI_GROUP), __ATOMIC_RELAXED);
        }
        atomic_fetch_add(&masked->selected, count);
    }
}

static void mark_masked(sphg_context *context, struct sphgi_selection *selection,
                        const sphg_neighbors *n)
{
    struct masked masked = {.selection = selection, .place = n->target_place.data};
    sphgi_parallel_for(context, mark_masked_task, &masked, selection->end - selection->begin,
                       8 * GRAIN);
    selection->active_count = atomic_load(&masked.selected);
}

/* ---- Many: all groups are looked at --------------------------------------------------------- */

/* In the order of storage; without a branch that nobody can foresee. One more is written. */
static void list_groups(struct sphgi_selection *selection, int32_t count)
{
    int32_t listed = 0;
    for (int32_t g = 0; g < count; ++g) {
        selection->groups[listed] = g;
        listed += selection->active[g] != 0;
    }
    selection->group_count = listed;
}

struct marking {
    const struct sphgi_selection *selection;
    const sphg_neighbors *neighbors;
    uint8_t *marks; /* by place, of targets that a list names; NULL where there is no list */
    atomic_int selected;
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
    struct marking *marking = data;
    const struct sphgi_selection *selection = marking->selection;
    const int32_t *order = sphgi_target_grid(marking->neighbors)->order.data;
    int32_t selected = 0;
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        const int32_t first = g * SPHGI_GROUP, count = sphgi_targets_in(marking->neighbors, g);
        uint8_t *marks = marking->marks ? marking->marks + first : NULL;
        uint32_t active = 0;
        for (int32_t k = 0; k < count; ++k)
            active |= (marks ? marks[k] : (uint32_t)is_in_range(selection, order[first + k])) << k;
        selection->active[g] = (uint16_t)active;
        selected += __builtin_popcount(active);
        if (marks)
            memset(marks, 0, (size_t)count);
    }
    atomic_fetch_add(&marking->selected, selected);
}

static void look_at_groups(sphg_context *context, struct sphgi_selection *selection,
                           const sphg_neighbors *n, uint8_t *marks)
{
    struct marking marking = {
        .selection = selection, .neighbors = n, .marks = selection->subset->indices ? marks : NULL};
    const int32_t items = selection->end - selection->begin;
    const int32_t count = sphgi_group_count(n->target_count);
    if (marking.marks)
        sphgi_parallel_for(context, mark_task, &marking, items, GRAIN);
    sphgi_parallel_for(context, look_task, &marking, count, GROUPS);
    list_groups(selection, count);
    selection->active_count = atomic_load(&marking.selected);
}

/* ---- Both ----------------------------------------------------------------------------------- */

static bool are_few(const struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int64_t items = selection->end - selection->begin;
    return items * FEW < sphgi_group_count(n->target_count);
}

/* Groups, a bit for each of their targets, and a mark for each target. Returns the bytes. */
static size_t place_selection(struct sphgi_selection *selection, uint8_t **marks, char *base,
                              int32_t targets)
{
    struct sphgi_layout layout = {base, 0};
    const size_t groups = (size_t)sphgi_group_count(targets) + 1;
    selection->groups = sphgi_place(&layout, groups, sizeof *selection->groups);
    selection->active = sphgi_place(&layout, groups, sizeof *selection->active);
    *marks = sphgi_place(&layout, (size_t)targets + 1, sizeof **marks);
    return layout.used;
}

bool sphgi_selection_open(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *n)
{
    struct sphgi_buffer *memory = &context->selection;
    const size_t before = memory->size;
    uint8_t *marks;
    if (!sphgi_reserve(&context->allocator, memory,
                       place_selection(selection, &marks, NULL, n->target_count), 1))
        return false;
    if (memory->size != before) /* all is 0 between calls */
        memset(memory->data, 0, memory->size);
    place_selection(selection, &marks, memory->data, n->target_count);
    selection->group_count = selection->active_count = 0;
    if (are_few(selection, n))
        mark_few(selection, n);
    else if (selects_few(selection)) {
        mark_masked(context, selection, n);
        list_groups(selection, sphgi_group_count(n->target_count));
    } else
        look_at_groups(context, selection, n, marks);
    return true;
}

void sphgi_selection_close(struct sphgi_selection *selection)
{
    for (int32_t k = 0; k < selection->group_count; ++k)
        selection->active[selection->groups[k]] = 0;
    memset(selection->groups, 0, ((size_t)selection->group_count + 1) * sizeof *selection->groups);
    selection->active = NULL;
    selection->groups = NULL;
}
