#include "traverse.h"
#include "stage.h"

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

/* Lists wait in the piece until a vector of targets is there. wide: they hold 32-bit numbers. */
static void run_rest(struct sphgi_worker *w, bool wide)
{
    if (w->group.lanes > w->summed)
        sphgi_group_run(w, wide);
    finish_group(w);
}

static void add_listed(struct sphgi_worker *w, int32_t target, int32_t place, const void *row,
                       const void *ids, int32_t count, bool wide)
{
    const int32_t lane = add_target(w, target, place, row) - w->summed;
    w->piece.ids[lane] = ids;
    w->piece.count[lane] = count;
    if (lane + 1 == w->passes->lanes)
        sphgi_group_run(w, wide);
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
    return !task->selection->active || task->selection->active[place];
}

static void sweep_run(const struct sphgi_task *task, struct sphgi_worker *w, int32_t begin,
                      int32_t end, const uint16_t *ids, const uint16_t *lengths)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t *order = sphgi_target_grid(n)->order.data;
    const size_t row_size = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    const char *row = sphgi_target_row(n, begin);
    const uint8_t *active = task->selection->active;
    for (int32_t t = begin; t < end; ++t, ++lengths, row += row_size) {
        if (!active || active[t])
            add_listed(w, order[t], t, row, ids, *lengths, false);
        ids += (*lengths + SPHGI_PAD - 1) & -SPHGI_PAD;
    }
}

static void sweep_kept_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const uint16_t *lengths = n->found.lengths.data;
    const int32_t first = grid->blocks[block].first, end = grid->blocks[block + 1].first;
    struct sphgi_surroundings around;
    const uint16_t *ids = sphgi_kept_ids(n, block, &around);
    sphgi_stage_block(w, &around);
    sweep_run(task, w, first, end, ids, lengths + first);
    run_rest(w, false);
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
                run_rest(w, false);
                used = 0;
            }
            uint16_t *ids = finder->ids + used;
            used += sphgi_find_targets(finder, n, around, &runs, c, t, end, ids, finder->lengths);
            sweep_run(task, w, t, end, ids, finder->lengths);
        }
    }
    run_rest(w, false);
}

static void sweep_kept_wide_block(const struct sphgi_task *task, struct sphgi_worker *w,
                                  int32_t block)
{
    enum { HEADER = 8 };
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const uint32_t *row = (const uint32_t *)(const void *)sphgi_kept_units(n, block);
    for (int32_t t = grid->blocks[block].first; t < grid->blocks[block + 1].first; ++t) {
        const size_t count = row[0];
        if (is_active(task, t))
            add_listed(w, target_at(n, t), t, sphgi_target_row(n, t), row + HEADER, (int32_t)count,
                       true);
        row += HEADER + sphgi_round_up(count, SPHGI_PAD);
    }
    run_rest(w, true);
}

static void take_wide(void *data, const uint32_t *rows, int32_t count)
{
    sphgi_group_add(data, 0, rows, count, true);
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
            sphgi_group_begin(w);
            do
                sphgi_find_wide(finder, n, around, c, t, take_wide, w);
            while (sphgi_group_again(w));
            sphgi_group_end(w);
            finish_group(w);
        }
}

static void sweep_unkept_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block,
                               const struct sphgi_finder *finder)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_surroundings around;
    sphgi_block_surroundings(n, block, &around);
    if (sphgi_is_crowded(n, &around)) {
        sphgi_use_local_rows(w);
        sweep_found_wide_block(task, w, finder, &around);
    } else {
        sphgi_stage_block(w, &around);
        sweep_found_block(task, w, finder, &around);
    }
}

static void sweep_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block,
                        const struct sphgi_finder *finder)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    if (!sphgi_is_kept(n, block)) {
        sweep_unkept_block(task, w, block, finder);
    } else if (sphgi_is_kept_wide(n, block)) {
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
}

/* ---- The host's lists ----------------------------------------------------------------------- */

static int64_t host_row(const sphg_lists *lists, int32_t target, int32_t worker,
                        const int32_t **ids)
{
    if (lists->offsets) {
        *ids = lists->indices + lists->offsets[target];
        return lists->offsets[target + 1] - lists->offsets[target];
    }
    if (lists->rows) {
        *ids = lists->rows[target];
        return lists->lengths[target];
    }
    *ids = NULL;
    return lists->row(target, worker, ids, lists->user);
}

void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct sphgi_task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    if (task->sweep.packed)
        sphgi_use_packed_rows(&w);
    else
        sphgi_use_local_rows(&w);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target < 0)
            continue;
        const int32_t *ids;
        const int64_t count = host_row(&n->lists, target, number, &ids);
        if (count < 0 || count > INT32_MAX || (count > 0 && !ids)) {
            if (w.tally->bad_target < 0 || target < w.tally->bad_target) {
                w.tally->bad_target = target;
                w.tally->bad_index = SPHGI_BAD_LENGTH;
            }
            continue;
        }
        add_listed(&w, target, target, sphgi_target_row(n, target), ids, (int32_t)count, true);
        if (n->lists.row)
            run_rest(&w, true); /* the function may reuse its array */
    }
    run_rest(&w, true);
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
