/* SPDX-License-Identifier: MIT */
#include "lists.h"
#include "copy.h"
#include "core/parallel.h"
#include <string.h>

enum {
    LEAST_GROUPS = 32,     /* of a task: fewer are not worth a thread */
    MARGIN = 256,          /* ids */
    SAMPLE = 64,           /* one group of so many is looked at for a first guess */
    WAITING_IDS = 1 << 14, /* of groups that are stored together: a copy at once does not read first
                              what it overwrites */
    WAITING_ROOM = WAITING_IDS + 16 * SPHGI_GROUP, /* more steps are woven than count */
    WAITING_GROUPS = 256
};

struct build {
    sphg_context *context;
    sphg_neighbors *neighbors;
    const sphg_lists *lists; /* the host's that are copied; NULL: a search */
    bool all_apart;          /* what is kept must take the least room */
    char *memory;            /* of the workers */
    size_t memory_each;
    int32_t step; /* groups: every one, or a sample */
    const struct sphgi_passes *passes;
    atomic_int_least64_t ids, pairs;
    atomic_bool crowded;
    atomic_int bad_target; /* the lowest whose list is wrong, or INT32_MAX */
};

/* A worker's groups that wait to be stored. */
struct waiting {
    struct build *build;
    struct sphgi_finder finder; /* one of these two */
    struct sphgi_copier copier;
    uint32_t dummy;
    uint32_t *ids; /* WAITING_IDS */
    int32_t used, groups;
    int32_t group[WAITING_GROUPS], place[WAITING_GROUPS], steps[WAITING_GROUPS];
    int64_t pairs;
};

/* What a worker has: its groups that wait, their ids, and memory of its finder or copier. */
struct room {
    struct waiting *waiting;
    uint32_t *ids;
    void *search;
};

/* Returns the bytes. */
static size_t place_worker(const struct build *build, struct room *room, char *base)
{
    struct sphgi_layout layout = {base, 0};
    room->waiting = sphgi_place(&layout, 1, sizeof *room->waiting);
    room->ids = sphgi_place(&layout, WAITING_ROOM, sizeof *room->ids);
    room->search = sphgi_place(
        &layout, build->lists ? sphgi_copier_size() : sphgi_finder_size(build->neighbors), 1);
    return layout.used;
}

static struct waiting *open_worker(struct build *build, int32_t number)
{
    struct room room;
    place_worker(build, &room, build->memory + (size_t)number * build->memory_each);
    struct waiting *w = room.waiting;
    w->build = build;
    w->ids = room.ids;
    w->used = w->groups = 0;
    w->pairs = 0;
    w->dummy = (uint32_t)build->neighbors->source_count * SPHGI_ID_STEP;
    if (build->lists)
        sphgi_copier_open(&w->copier, build->context, build->neighbors, build->lists, number,
                          room.search);
    else
        sphgi_finder_open(&w->finder, build->context, build->neighbors, room.search);
    return w;
}

/* A place for so many ids, -1 if they do not fit; counts them in any case. */
static int64_t claim(struct build *build, int64_t ids)
{
    const int64_t place = atomic_fetch_add(&build->ids, ids);
    return place + ids <= build->neighbors->found.room ? place : -1;
}

static void note_place(const struct build *build, int32_t group, int64_t place, int32_t steps)
{
    struct sphgi_found *found = &build->neighbors->found;
    if (found->room)
        found->groups[group] = place < 0 ? -1 : place << SPHGI_STEPS_BITS | steps;
}

static void store_waiting(struct waiting *w)
{
    const int64_t place = claim(w->build, w->used);
    if (place >= 0)
        memcpy(w->build->neighbors->found.ids + place, w->ids, (size_t)w->used * sizeof *w->ids);
    for (int32_t k = 0; k < w->groups; ++k)
        note_place(w->build, w->group[k], place < 0 ? -1 : place + w->place[k], w->steps[k]);
    w->used = w->groups = 0;
}

/* Where the ids of a group go: to those that wait, or at once to their place if they are too many
 * for that. NULL: they do not fit. */
static uint32_t *place_for(struct waiting *w, int32_t group, int64_t ids, int32_t steps)
{
    if (w->used + ids > WAITING_IDS || w->groups == WAITING_GROUPS)
        store_waiting(w);
    if (ids > WAITING_IDS) {
        const int64_t place = claim(w->build, ids);
        note_place(w->build, group, place, steps);
        return place < 0 ? NULL : w->build->neighbors->found.ids + place;
    }
    const int32_t k = w->groups++;
    w->group[k] = group;
    w->place[k] = w->used;
    w->steps[k] = steps;
    w->used += (int32_t)ids;
    return w->ids + w->place[k];
}

/* ---- Groups --------------------------------------------------------------------------------- */

static int64_t padded(int64_t length)
{
    return (length + SPHGI_PAD - 1) & -(int64_t)SPHGI_PAD;
}

static int64_t ids_apart(const int64_t *lengths)
{
    int64_t ids = SPHGI_GROUP; /* the header */
    for (int32_t k = 0; k < SPHGI_GROUP; ++k)
        ids += padded(lengths[k]);
    return (int64_t)sphgi_round_up((size_t)ids, SPHGI_GROUP);
}

/* A place for lists one after the other, behind a header with their lengths; NULL: they do not fit.
 */
static uint32_t *place_apart(struct waiting *w, int32_t group, const int64_t *lengths)
{
    uint32_t *to = place_for(w, group, ids_apart(lengths), SPHGI_APART);
    for (int32_t k = 0; to && k < SPHGI_GROUP; ++k)
        to[k] = (uint32_t)lengths[k];
    return to ? to + SPHGI_GROUP : NULL;
}

static void store_apart(struct waiting *w, int32_t group, const uint32_t *const *lists,
                        const int64_t *lengths)
{
    uint32_t *to = place_apart(w, group, lengths);
    for (int32_t k = 0; to && k < SPHGI_GROUP; to += padded(lengths[k++]))
        memcpy(to, lists[k], (size_t)padded(lengths[k]) * sizeof *to);
}

static void store_group(struct waiting *w, int32_t group, const uint32_t *const *lists,
                        const int32_t *lengths)
{
    int32_t longest = 0, pairs = 0;
    for (int32_t k = 0; k < SPHGI_GROUP; ++k) {
        longest = sphgi_max32(longest, lengths[k]);
        pairs += lengths[k];
    }
    const int64_t woven = (int64_t)sphgi_round_up((size_t)longest, 4) * SPHGI_GROUP;
    if (woven > 2 * (int64_t)pairs || w->build->all_apart) { /* else they are not more than twice */
        int64_t count[SPHGI_GROUP];
        for (int32_t k = 0; k < SPHGI_GROUP; ++k)
            count[k] = lengths[k];
        if (woven > 2 * ids_apart(count) || w->build->all_apart) {
            store_apart(w, group, lists, count);
            return;
        }
    }
    uint32_t *to = place_for(w, group, woven, longest);
    const bool full = sphgi_targets_in(w->build->neighbors, group) == SPHGI_GROUP;
    const bool found = !w->build->lists && full && woven <= WAITING_IDS;
    if (to)
        w->build->passes->weave(lists, lengths, longest, found ? SPHGI_FIND_PAD : 0, w->dummy, to);
}

/* ---- Clumps --------------------------------------------------------------------------------- */

struct list {
    uint32_t *to; /* NULL: they are counted */
    int64_t count;
};

static void append(void *data, const uint32_t *ids, int32_t count)
{
    struct list *list = data;
    if (list->to)
        memcpy(list->to + list->count, ids, (size_t)count * sizeof *ids);
    list->count += count;
}

static void find_target(struct waiting *w, int32_t target, struct list *list)
{
    if (w->build->lists)
        sphgi_copy_target(&w->copier, target, append, list);
    else
        sphgi_find_target(&w->finder, target, append, list);
}

/* Twice through: a list's place must be known before it can be filled. */
static void find_crowded_group(struct waiting *w, int32_t group)
{
    const sphg_neighbors *n = w->build->neighbors;
    const int32_t first = group * SPHGI_GROUP, targets = sphgi_targets_in(n, group);
    int64_t lengths[SPHGI_GROUP] = {0};
    for (int32_t k = 0; k < targets; ++k) {
        struct list counted = {NULL, 0};
        find_target(w, first + k, &counted);
        lengths[k] = counted.count;
        w->pairs += w->build->lists ? w->copier.listed : counted.count;
    }
    atomic_store(&w->build->crowded, true);
    uint32_t *to = place_apart(w, group, lengths);
    for (int32_t k = 0; to && k < targets; ++k) {
        struct list list = {to, 0};
        find_target(w, first + k, &list);
        for (; list.count < padded(list.count); ++list.count)
            to[list.count] = w->dummy;
        to += list.count;
    }
}

/* ---- All groups ----------------------------------------------------------------------------- */

static bool lists_of(struct waiting *w, int32_t group, const uint32_t **lists, int32_t *lengths)
{
    return w->build->lists ? sphgi_copy_group(&w->copier, group, lists, lengths)
                           : sphgi_find_group(&w->finder, group, lists, lengths);
}

static void find_group(struct waiting *w, int32_t group)
{
    sphg_neighbors *n = w->build->neighbors;
    uint16_t *kept = (uint16_t *)n->found.lengths.data + (size_t)group * SPHGI_GROUP;
    const uint32_t *lists[SPHGI_GROUP];
    int32_t lengths[SPHGI_GROUP];
    if (!lists_of(w, group, lists, lengths)) {
        find_crowded_group(w, group);
        return;
    }
    bool pairs_alone = true;
    for (int32_t k = 0; k < sphgi_targets_in(n, group); ++k) {
        kept[k] = (uint16_t)lengths[k];
        pairs_alone &= lengths[k] <= SPHGI_CHUNK; /* of lists that are copied */
        w->pairs += w->build->lists ? 0 : lengths[k];
    }
    if (w->build->lists)
        w->pairs += w->copier.listed;
    if (w->build->lists && !pairs_alone)
        atomic_store(&w->build->crowded, true);
    store_group(w, group, lists, lengths);
}

static void note_bad_target(struct build *build, int32_t target)
{
    int lowest = atomic_load(&build->bad_target);
    while (target < lowest &&
           !atomic_compare_exchange_weak(&build->bad_target, &lowest, (int)target))
        ;
}

static void build_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct build *build = data;
    struct waiting *w = open_worker(build, worker);
    for (int32_t k = begin; k < end; ++k)
        find_group(w, k * build->step);
    store_waiting(w);
    atomic_fetch_add(&build->pairs, w->pairs);
    if (build->lists)
        note_bad_target(build, w->copier.bad_target);
}

/* Every step-th group, keeping what fits. */
static void find_groups(struct build *build, int32_t step)
{
    struct sphgi_found *found = &build->neighbors->found;
    const int32_t groups = sphgi_group_count(build->neighbors->target_count);
    build->step = step;
    build->passes = sphgi_passes_of(build->context, SPHG_F32);
    atomic_store(&build->ids, 0);
    atomic_store(&build->pairs, 0);
    atomic_store(&build->crowded, false);
    atomic_store(&build->bad_target, INT32_MAX);
    sphgi_parallel_for(build->context, build_task, build, (groups + step - 1) / step, LEAST_GROUPS);
    found->ids_used = atomic_load(&build->ids);
    found->pairs = atomic_load(&build->pairs);
    found->crowded = atomic_load(&build->crowded);
}

/* ---- Memory --------------------------------------------------------------------------------- */

/* Puts places and ids behind the tables, with room for that many ids: first what the memory holds
 * already, else more. The tables move along. */
static bool place_lists(sphg_neighbors *n, int64_t ids)
{
    struct sphgi_buffer *shared = &n->shared;
    const size_t sources = sphgi_tables_of(&n->sources);
    const size_t places = sources + (sphgi_sorts_targets(n) ? sphgi_tables_of(&n->targets) : 0);
    const size_t groups = (size_t)sphgi_group_count(n->target_count);
    const size_t used = places + sphgi_round_up(groups * sizeof(int64_t), SPHGI_ALIGNMENT);
    if (ids > 0 && used + (size_t)ids * sizeof(uint32_t) > shared->size) {
        struct sphgi_buffer more = {NULL, 0};
        if (!sphgi_reserve(&n->allocator, &more, used + (size_t)ids * sizeof(uint32_t), 1))
            return false;
        memcpy(more.data, shared->data, places);
        sphgi_free(&n->allocator, shared);
        *shared = more;
    }
    char *base = shared->data;
    sphgi_grid_use_tables(&n->sources, base);
    if (sphgi_sorts_targets(n))
        sphgi_grid_use_tables(&n->targets, base + sources);
    n->found.groups = (int64_t *)(void *)(base + places);
    n->found.ids = (uint32_t *)(void *)(base + used);
    n->found.room = (int64_t)((shared->size - used) / sizeof(uint32_t));
    return true;
}

/* A little more than needed: pairs come and go from step to step. Once they have outgrown their
 * memory an eighth, lest a slowly rising number asks for more at each step. */
static int64_t with_margin(const struct sphgi_found *found, int64_t ids)
{
    return ids + ids / (found->most_pairs < 0 ? 64 : 8) + MARGIN;
}

/* What lists that are copied take at most if all stand apart. They must be kept wherever they fall,
 * for nobody can find them again: there is room for that once there were so many. */
static int64_t most_apart(const struct sphgi_found *found, const sphg_neighbors *n)
{
    const int64_t groups = sphgi_group_count(n->target_count);
    return found->pairs + (SPHGI_GROUP * (SPHGI_PAD + 1) + SPHGI_GROUP) * groups;
}

/* Before anything is known: as many as a sample of the groups suggests. */
static bool guess(struct build *build)
{
    sphg_neighbors *n = build->neighbors;
    const int32_t groups = sphgi_group_count(n->target_count);
    const int32_t step = sphgi_min32(SAMPLE, sphgi_max32(1, groups / SAMPLE));
    n->found.room = 0; /* only count */
    find_groups(build, step);
    const int32_t sampled = (groups + step - 1) / step;
    const double each = groups ? (double)n->found.ids_used / sampled : 0;
    int64_t ids = (int64_t)(each * groups);
    if (build->lists) {
        const double pairs = groups ? (double)n->found.pairs / sampled * groups : 0;
        n->found.pairs = (int64_t)pairs;
        ids = most_apart(&n->found, n) > ids ? most_apart(&n->found, n) : ids;
    }
    return place_lists(n, with_margin(&n->found, ids));
}

static bool are_more_than_ever(const sphg_neighbors *n)
{
    const struct sphgi_found *found = &n->found;
    return found->pairs > found->most_pairs || n->target_count > found->most_targets ||
           n->source_count > found->most_sources;
}

static void remember_most(sphg_neighbors *n)
{
    struct sphgi_found *found = &n->found;
    found->most_pairs = found->pairs > found->most_pairs ? found->pairs : found->most_pairs;
    found->most_targets = sphgi_max32(found->most_targets, n->target_count);
    found->most_sources = sphgi_max32(found->most_sources, n->source_count);
}

static bool open_build(struct build *build)
{
    sphg_context *context = build->context;
    sphg_neighbors *n = build->neighbors;
    struct room room;
    build->memory_each = place_worker(build, &room, NULL);
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       build->memory_each) ||
        !sphgi_reserve(&n->allocator, &n->found.lengths, (size_t)n->target_count,
                       sizeof(uint16_t)) ||
        !place_lists(n, 0))
        return false;
    build->memory = context->workers.data;
    return n->found.most_pairs >= 0 || guess(build);
}

sphg_result sphgi_lists_build(sphg_context *context, sphg_neighbors *n)
{
    struct sphgi_found *found = &n->found;
    struct build build = {.context = context, .neighbors = n};
    if (!open_build(&build))
        return SPHG_ERROR_MEMORY;
    find_groups(&build, 1);
    if (found->ids_used > found->room && are_more_than_ever(n)) {
        if (!place_lists(n, with_margin(found, found->ids_used)))
            return SPHG_ERROR_MEMORY;
        find_groups(&build, 1);
    }
    remember_most(n);
    return SPHG_OK;
}

/* Room for a number of tables that depends on counts alone. */
static bool reserve_tables(sphg_neighbors *n)
{
    const size_t groups = (size_t)sphgi_group_count(n->target_count);
    const size_t bytes = sphgi_tables_of(&n->sources) + sphgi_tables_of(&n->targets) +
                         groups * sizeof(int64_t) + 2 * SPHGI_ALIGNMENT;
    return sphgi_reserve(&n->allocator, &n->shared, bytes, 1);
}

sphg_result sphgi_lists_copy(struct sphgi_checker checker, sphg_neighbors *n,
                             const sphg_lists *lists)
{
    struct sphgi_found *found = &n->found;
    struct build build = {.context = checker.context, .neighbors = n, .lists = lists};
    if (!reserve_tables(n) || !open_build(&build))
        return SPHG_ERROR_MEMORY;
    find_groups(&build, 1);
    const int64_t apart = most_apart(found, n);
    const int64_t needed = apart > found->ids_used ? apart : found->ids_used;
    if (needed > found->room && (are_more_than_ever(n) || apart > found->room)) {
        if (!place_lists(n, with_margin(found, needed)))
            return SPHG_ERROR_MEMORY;
        find_groups(&build, 1);
    } else if (found->ids_used > found->room) {
        build.all_apart = true;
        find_groups(&build, 1);
    }
    remember_most(n);
    const int32_t bad = atomic_load(&build.bad_target);
    return bad == INT32_MAX ? SPHG_OK
                            : sphgi_refuse_list(checker, bad, sphgi_fault_of_list(n, lists, bad));
}
