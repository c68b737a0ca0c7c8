#include "traverse.h"
#include "stage.h"
#include <string.h>

/* ---- Groups --------------------------------------------------------------------------------- */

static int32_t add_target(struct sphgi_worker *w, int32_t target, int32_t place, const void *row)
{
    const int32_t lane = w->group.lanes++;
    w->group.target[lane] = target;
    w->group.place[lane] = place;
    w->group.x[lane] = row;
    return lane;
}

static void finish_group(struct sphgi_worker *w)
{
    if (w->group.lanes)
        sphgi_group_finish(w);
}

/* Lists wait until a vector of targets is there. */
static void run_rest(struct sphgi_worker *w)
{
    if (w->group.lanes > w->summed)
        sphgi_group_run(w);
    finish_group(w);
    w->waiting_ids_used = 0;
}

/* Of 32-bit numbers, or of 16-bit ids that stand `stride` apart. */
static void add_list(struct sphgi_worker *w, int32_t target, int32_t place, const void *row,
                     const void *ids, int32_t count, int32_t stride)
{
    const int32_t lane = add_target(w, target, place, row) - w->summed;
    w->lists.ids[lane] = ids;
    w->lists.count[lane] = count;
    w->lists.stride[lane] = stride;
    if (lane + 1 == w->passes->lanes)
        sphgi_group_run(w);
    if (w->summed == SPHGI_WIDTH)
        finish_group(w);
}

/* ---- Blocks of a searched object ------------------------------------------------------------ */

static int32_t target_at(const sphg_neighbors *n, int32_t place)
{
    return ((const int32_t *)sphgi_target_grid(n)->order.data)[place];
}

static bool is_active(const struct sphgi_task *task, int32_t place)
{
    return sphgi_is_selected(task->selection, place, target_at(task->sweep.set->neighbors, place));
}

static int32_t padded(int32_t length)
{
    return (length + SPHGI_PAD - 1) & -SPHGI_PAD;
}

/* Lists of some targets, one by one. */
struct walk {
    const uint16_t *ids, *lengths;
    int32_t begin, end; /* targets, in grid order */
    bool woven;         /* in groups side by side, as lists are kept; else one after the other */
};

/* The lists of the next targets: all of a group, or one; each ids[] and the distance of its ids.
 * Returns how many. */
static int32_t next_lists(struct walk *walk, const uint16_t **ids, int32_t *stride)
{
    struct sphgi_list_group group = {.count = 1, .units = padded(*walk->lengths)};
    if (walk->woven)
        group = sphgi_list_group_of(walk->lengths, walk->end - walk->begin);
    const uint16_t *list = walk->ids;
    for (int32_t k = 0; k < group.count; ++k) {
        ids[k] = list;
        list += group.side_by_side ? 1 : padded(walk->lengths[k]);
    }
    *stride = group.side_by_side ? group.count : 1;
    walk->ids += group.units;
    walk->lengths += group.count;
    walk->begin += group.count;
    return group.count;
}

/* As many targets as a vector has lanes, whose lists stand side by side from ids on. */
static void add_vector(struct sphgi_worker *w, const int32_t *order, int32_t place,
                       const uint16_t *ids, const uint16_t *lengths, int32_t stride)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const size_t size = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    const char *row = sphgi_target_row(n, place);
    const int32_t lanes = w->passes->lanes, first = w->group.lanes;
    for (int32_t l = 0; l < lanes; ++l) {
        w->group.target[first + l] = order[place + l];
        w->group.place[first + l] = place + l;
        w->group.x[first + l] = row + (size_t)l * size;
        w->lists.count[l] = lengths[l];
    }
    w->group.lanes += lanes;
    w->lists.ids[0] = ids;
    w->lists.stride[0] = stride;
    w->lists.side_by_side = true;
    sphgi_group_run(w);
    if (w->summed == SPHGI_WIDTH)
        finish_group(w);
}

/* Whole groups: their lanes stand as the tiles want them. What is left of a group does not fill the
 * lanes. */
static void sweep_all_of(const struct sphgi_task *task, struct sphgi_worker *w, struct walk walk)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t *order = sphgi_target_grid(n)->order.data;
    while (walk.begin < walk.end) {
        const uint16_t *ids[SPHGI_LANES_MOST], *lengths = walk.lengths;
        int32_t stride;
        const int32_t first = walk.begin, count = next_lists(&walk, ids, &stride);
        int32_t k = 0;
        for (; stride > 1 && k + w->passes->lanes <= count; k += w->passes->lanes)
            add_vector(w, order, first + k, ids[k], lengths + k, stride);
        w->lists.side_by_side = false;
        for (; k < count; ++k)
            add_list(w, order[first + k], first + k, sphgi_target_row(n, first + k), ids[k],
                     lengths[k], stride);
    }
}

/* The selected ones are picked first, without a branch that nobody could foresee. */
static void sweep_some_of(const struct sphgi_task *task, struct sphgi_worker *w, struct walk walk)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    w->lists.side_by_side = false;
    while (walk.begin < walk.end) {
        const uint16_t *ids[SPHGI_LANES_MOST], *lengths = walk.lengths;
        int32_t stride, picked = 0, number[SPHGI_LANES_MOST + 1];
        const int32_t first = walk.begin, count = next_lists(&walk, ids, &stride);
        for (int32_t k = 0; k < count; ++k) {
            number[picked] = k;
            picked += is_active(task, first + k) ? 1 : 0;
        }
        for (int32_t p = 0; p < picked; ++p) {
            const int32_t k = number[p], place = first + k;
            add_list(w, target_at(n, place), place, sphgi_target_row(n, place), ids[k], lengths[k],
                     stride);
        }
    }
}

static void sweep_lists(const struct sphgi_task *task, struct sphgi_worker *w, struct walk walk)
{
    w->lists.wide = false;
    if (task->selection->subset)
        sweep_some_of(task, w, walk);
    else
        sweep_all_of(task, w, walk);
}

/* Of a block that is kept and not wide; around: what is staged for it. */
static struct walk walk_block(const sphg_neighbors *n, int32_t block,
                              struct sphgi_surroundings *around)
{
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t first = grid->blocks[block].first;
    const uint16_t *lengths = n->found.lengths.data;
    return (struct walk){.ids = sphgi_kept_ids(n, block, around),
                         .lengths = lengths + first,
                         .begin = first,
                         .end = grid->blocks[block + 1].first,
                         .woven = true};
}

static void sweep_kept_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block)
{
    struct sphgi_surroundings around;
    const struct walk walk = walk_block(task->sweep.set->neighbors, block, &around);
    sphgi_stage_block(w, &around);
    sweep_lists(task, w, walk);
    run_rest(w);
}

/* Staged numbers to those of rows: ranges follow one another among the staged ones. */
static void unstage(const struct sphgi_surroundings *around, const uint16_t *ids, int32_t count,
                    int32_t stride, uint32_t *rows)
{
    int32_t range = 0, first = 1; /* the staged number of its first row */
    for (int32_t k = 0; k < count; ++k) {
        const int32_t number = ids[k * stride] / SPHGI_ID_STEP;
        if (number < first) /* lists go up but for one step back */
            range = 0, first = 1;
        while (number >= first + around->count[range])
            first += around->count[range++];
        rows[k] = (uint32_t)(around->begin[range] + number - first);
    }
}

/* What is far apart in memory should be on its way before the first of it is read. */
static void ask_for_rows(const sphg_neighbors *n, const uint32_t *rows, int32_t count)
{
    const size_t size = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    const char *position = n->sources.rows.data;
    const int32_t *order = n->sources.order.data;
    for (int32_t k = 0; k < count; ++k) {
        __builtin_prefetch(position + rows[k] * size);
        __builtin_prefetch(order + rows[k]);
    }
    __asm__ volatile(""); /* GCC takes a function that only prefetches for one without effect */
}

/* A target whose neighbours are read row by row: it may wait for those of other blocks. */
static void add_sparse(struct sphgi_worker *w, const struct sphgi_surroundings *around,
                       int32_t place, const uint16_t *ids, int32_t length, int32_t stride)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    if (w->waiting_ids_used + length > SPHGI_WAITING_IDS)
        run_rest(w);
    uint32_t *rows = (uint32_t *)(void *)w->waiting_ids + w->waiting_ids_used;
    unstage(around, ids, length, stride, rows);
    ask_for_rows(n, rows, length);
    w->waiting_ids_used += length;
    add_list(w, target_at(n, place), place, sphgi_target_row(n, place), rows, length, 1);
    if (w->group.lanes == w->summed)
        w->waiting_ids_used = 0;
}

/* So few targets that it does not pay to stage everything around them: their rows alone. */
static void sweep_sparse_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block)
{
    struct sphgi_surroundings around;
    struct walk walk = walk_block(task->sweep.set->neighbors, block, &around);
    while (walk.begin < walk.end) {
        const uint16_t *ids[SPHGI_LANES_MOST], *lengths = walk.lengths;
        int32_t stride;
        const int32_t first = walk.begin, count = next_lists(&walk, ids, &stride);
        for (int32_t k = 0; k < count; ++k)
            if (is_active(task, first + k))
                add_sparse(w, &around, first + k, ids[k], lengths[k], stride);
    }
}

/* Nothing is kept: pairs are found cell by cell and used at once; they only have to stay until the
 * group that they belong to is full. */
static void sweep_found_block(const struct sphgi_task *task, struct sphgi_worker *w,
                              const struct sphgi_finder *finder,
                              const struct sphgi_surroundings *around)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = around->start;
    int64_t used = 0;
    sphgi_stage_coordinates(finder, n, around);
    for (int32_t c = 0; c < grid->cells; ++c) {
        struct sphgi_runs runs;
        sphgi_candidate_runs(&grid->lattice, around, c, &runs);
        for (int32_t t = start[c]; t < start[c + 1]; t += SPHGI_FIND_MOST) {
            const int32_t end = sphgi_min32(t + SPHGI_FIND_MOST, start[c + 1]);
            bool any = false;
            for (int32_t k = t; k < end; ++k)
                any |= is_active(task, k);
            if (!any)
                continue;
            if (used + (int64_t)(end - t) * (runs.candidates + SPHGI_PAD) > SPHGI_UNITS_MOST) {
                run_rest(w);
                used = 0;
            }
            uint16_t *ids = finder->ids + used;
            used += sphgi_find_targets(finder, n, around, &runs, c, t, end, ids, finder->lengths);
            sweep_lists(
                task, w,
                (struct walk){.ids = ids, .lengths = finder->lengths, .begin = t, .end = end});
        }
    }
    run_rest(w);
}

static void sweep_kept_wide_block(const struct sphgi_task *task, struct sphgi_worker *w,
                                  int32_t block)
{
    enum { HEADER = 8 };
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const uint32_t *row = (const uint32_t *)(const void *)sphgi_kept_units(n, block);
    w->lists.wide = true;
    for (int32_t t = grid->blocks[block].first; t < grid->blocks[block + 1].first; ++t) {
        const size_t count = row[0];
        if (is_active(task, t))
            add_list(w, target_at(n, t), t, sphgi_target_row(n, t), row + HEADER, (int32_t)count,
                     1);
        row += HEADER + sphgi_round_up(count, SPHGI_PAD);
    }
    run_rest(w);
}

static void take_wide(void *data, const uint32_t *rows, int32_t count)
{
    sphgi_stream_add(data, rows, count);
}

static void sweep_found_wide_block(const struct sphgi_task *task, struct sphgi_worker *w,
                                   const struct sphgi_finder *finder,
                                   const struct sphgi_surroundings *around)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = around->start;
    for (int32_t c = 0; c < grid->cells; ++c)
        for (int32_t t = start[c]; t < start[c + 1]; ++t) {
            if (!is_active(task, t))
                continue;
            w->group.lanes = 1;
            w->group.target[0] = target_at(n, t);
            w->group.place[0] = t;
            w->group.x[0] = sphgi_target_row(n, t);
            sphgi_stream_begin(w);
            do
                sphgi_find_wide(finder, n, around, c, t, take_wide, w);
            while (sphgi_stream_again(w));
            sphgi_stream_end(w);
            finish_group(w);
        }
}

static void sweep_unkept_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block,
                               const struct sphgi_finder *finder)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_surroundings around;
    sphgi_block_surroundings(n, block, &around);
    if (sphgi_is_crowded(&around)) {
        sphgi_use_local_rows(w);
        sweep_found_wide_block(task, w, finder, &around);
    } else {
        sphgi_stage_block(w, &around);
        sweep_found_block(task, w, finder, &around);
    }
}

static void sweep_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t number,
                        const struct sphgi_finder *finder)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_block *blocks = sphgi_target_grid(n)->blocks;
    const int32_t block = number < 0 ? ~number : number;
    const bool kept = sphgi_is_kept(n, block), wide = kept && sphgi_is_kept_wide(n, block);
    /* few targets, or few of them selected: they would leave most lanes empty */
    const bool few = number < 0 || blocks[block + 1].first - blocks[block].first < w->passes->lanes;
    const bool sparse = kept && !wide && few;
    if (sparse != w->sparse) {
        run_rest(w);
        if (sparse)
            sphgi_use_local_rows(w);
        w->lists.wide = w->sparse = sparse;
        w->lists.side_by_side = false;
    }
    if (sparse) {
        sweep_sparse_block(task, w, block);
    } else if (!kept) {
        sweep_unkept_block(task, w, block, finder);
    } else if (wide) {
        sphgi_use_local_rows(w);
        sweep_kept_wide_block(task, w, block);
    } else {
        sweep_kept_block(task, w, block);
    }
}

void sphgi_block_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    const struct sphgi_finder finder =
        sphgi_finder_at(task->sweep.context, n, sphgi_finder_room(n), w.finder_memory);
    for (int32_t k = begin; k < end; ++k)
        sweep_block(task, &w, task->selection->blocks ? task->selection->blocks[k] : k, &finder);
    run_rest(&w);
}

/* ---- The host's lists ----------------------------------------------------------------------- */

static void note_bad_length(struct sphgi_tally *tally, int32_t target)
{
    if (tally->bad_target < 0 || target < tally->bad_target) {
        tally->bad_target = target;
        tally->bad_index = SPHGI_BAD_LENGTH;
    }
}

/* A function of the host may reuse its array: lists are copied until a vector of targets is there.
 * What is too long for that is summed at once. */
static void add_copied(struct sphgi_worker *w, int32_t target, const int32_t *ids, int32_t count)
{
    const char *row = sphgi_target_row(w->sweep->set->neighbors, target);
    if (w->waiting_ids_used + (int64_t)count > SPHGI_WAITING_IDS)
        run_rest(w);
    if (count > SPHGI_WAITING_IDS) {
        add_list(w, target, target, row, ids, count, 1);
        run_rest(w);
        return;
    }
    int32_t *copy = (int32_t *)(void *)w->waiting_ids + w->waiting_ids_used;
    if (count)
        memcpy(copy, ids, (size_t)count * sizeof *ids);
    w->waiting_ids_used += count;
    add_list(w, target, target, row, copy, count, 1);
    if (w->group.lanes == w->summed)
        w->waiting_ids_used = 0;
}

void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    w.lists.wide = true;
    if (task->sweep.packed)
        sphgi_use_packed_rows(&w);
    else
        sphgi_use_local_rows(&w);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target < 0)
            continue;
        const int32_t *ids;
        const int64_t count = sphgi_host_row(&n->lists, target, number, &ids);
        if (!sphgi_is_host_row(ids, count))
            note_bad_length(w.tally, target);
        else if (n->lists.row)
            add_copied(&w, target, ids, (int32_t)count);
        else
            add_list(&w, target, target, sphgi_target_row(n, target), ids, (int32_t)count, 1);
    }
    run_rest(&w);
}

/* ---- Finishing the sums of several sets ----------------------------------------------------- */

void sphgi_finish_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target >= 0)
            w.group.target[w.group.lanes++] = target;
        if (w.group.lanes == SPHGI_WIDTH || (k + 1 == end && w.group.lanes))
            sphgi_group_finish_from_arena(&w);
    }
}
