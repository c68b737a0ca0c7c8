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
    return sphgi_is_selected(task->selection, place, target_at(task->sweep.set->neighbors, place));
}

static int32_t padded(int32_t length)
{
    return (length + SPHGI_PAD - 1) & -SPHGI_PAD;
}

static void sweep_all_of(const struct sphgi_task *task, struct sphgi_worker *w, int32_t begin,
                         int32_t end, const uint16_t *ids, const uint16_t *lengths)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const int32_t *order = sphgi_target_grid(n)->order.data;
    const size_t row_size = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    const char *row = sphgi_target_row(n, begin);
    for (int32_t t = begin; t < end; ++t, ++lengths, row += row_size) {
        add_listed(w, order[t], t, row, ids, *lengths, false);
        ids += padded(*lengths);
    }
}

/* The selected ones are picked first, without a branch that nobody could foresee. */
static void sweep_some_of(const struct sphgi_task *task, struct sphgi_worker *w, int32_t begin,
                          int32_t end, const uint16_t *ids, const uint16_t *lengths)
{
    enum { PICKED = 64 };
    const sphg_neighbors *n = task->sweep.set->neighbors;
    int32_t place[PICKED + 1];
    const uint16_t *list[PICKED + 1];
    for (int32_t t = begin; t < end;) {
        const int32_t stop = sphgi_min32(t + PICKED, end);
        int32_t picked = 0;
        for (; t < stop; ++t) {
            place[picked] = t;
            list[picked] = ids;
            ids += padded(lengths[t - begin]);
            picked += is_active(task, t) ? 1 : 0;
        }
        for (int32_t k = 0; k < picked; ++k)
            add_listed(w, target_at(n, place[k]), place[k], sphgi_target_row(n, place[k]), list[k],
                       lengths[place[k] - begin], false);
    }
}

/* Targets [begin, end), whose lists follow one another. */
static void sweep_run(const struct sphgi_task *task, struct sphgi_worker *w, int32_t begin,
                      int32_t end, const uint16_t *ids, const uint16_t *lengths)
{
    if (task->selection->subset)
        sweep_some_of(task, w, begin, end, ids, lengths);
    else
        sweep_all_of(task, w, begin, end, ids, lengths);
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

/* Staged numbers to those of rows: ranges follow one another among the staged ones. */
static void unstage(const struct sphgi_surroundings *around, const uint16_t *ids, int32_t count,
                    uint32_t *rows)
{
    int32_t range = 0, first = 1; /* the staged number of its first row */
    for (int32_t k = 0; k < count; ++k) {
        const int32_t number = ids[k] / SPHGI_ID_STEP;
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

/* So few targets that it does not pay to stage everything around them: their rows alone. */
static void sweep_sparse_block(const struct sphgi_task *task, struct sphgi_worker *w, int32_t block,
                               const struct sphgi_finder *finder)
{
    enum { ROOM = SPHGI_UNITS_MOST / 2 }; /* numbers */
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const uint16_t *lengths = n->found.lengths.data;
    uint32_t *rows = (uint32_t *)(void *)finder->ids;
    int32_t used = 0;
    struct sphgi_surroundings around;
    const uint16_t *ids = sphgi_kept_ids(n, block, &around);
    sphgi_use_local_rows(w);
    for (int32_t t = grid->blocks[block].first; t < grid->blocks[block + 1].first; ++t) {
        const int32_t length = lengths[t];
        if (is_active(task, t)) {
            if (used + length > ROOM) {
                run_rest(w, true);
                used = 0;
            }
            unstage(&around, ids, length, rows + used);
            ask_for_rows(n, rows + used, length);
            add_listed(w, target_at(n, t), t, sphgi_target_row(n, t), rows + used, length, true);
            used += length;
        }
        ids += padded(length);
    }
    run_rest(w, true);
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
    const bool sparse = number < 0;
    const int32_t block = sparse ? ~number : number;
    if (!sphgi_is_kept(n, block)) {
        sweep_unkept_block(task, w, block, finder);
    } else if (sphgi_is_kept_wide(n, block)) {
        sphgi_use_local_rows(w);
        sweep_kept_wide_block(task, w, block);
    } else if (sparse) {
        sweep_sparse_block(task, w, block, finder);
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
        const int64_t count = sphgi_host_row(&n->lists, target, number, &ids);
        if (!sphgi_is_host_row(ids, count)) {
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
