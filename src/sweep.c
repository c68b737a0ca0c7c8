#include "sweep.h"
#include "parallel.h"
#include "selection.h"
#include "view.h"
#include "worker.h"
#include <math.h>
#include <string.h>

enum {
    BLOCK_GRAIN = 2,
    LIST_GRAIN = 64, /* targets of the host's lists */
    PACK_GRAIN = 4096,
    PACK_WORTH = 4 /* fields are packed when at least a 4th of the targets is selected */
};

/* What a task of a sweep is given. */
struct task {
    struct sphgi_sweep sweep;
    const struct sphgi_selection *selection;
};

/* ---- Groups --------------------------------------------------------------------------------- */

/* Where the pairs of a lane stand. */
struct supply {
    const void *ids[SPHGI_LANES_MOST];
    int64_t count[SPHGI_LANES_MOST];
    bool wide;
};

static void run_listed(struct sphgi_worker *w, const struct supply *supply)
{
    sphgi_group_begin(w);
    do {
        for (int32_t l = 0; l < w->group.lanes; ++l)
            sphgi_group_add(w, l, supply->ids[l], supply->count[l], supply->wide);
    } while (sphgi_group_again(w));
    sphgi_group_end(w);
    w->group.lanes = 0;
}

static void add_target(struct sphgi_worker *w, struct supply *supply, int32_t target,
                       const void *row, const void *ids, int64_t count)
{
    const int32_t lane = w->group.lanes++;
    w->group.target[lane] = target;
    w->group.x[lane] = row;
    supply->ids[lane] = ids;
    supply->count[lane] = count;
    if (w->group.lanes == w->passes->lanes)
        run_listed(w, supply);
}

static void run_rest(struct sphgi_worker *w, const struct supply *supply)
{
    if (w->group.lanes)
        run_listed(w, supply);
}

/* ---- Staging -------------------------------------------------------------------------------- */

static size_t row_size(sphg_type type)
{
    return SPHGI_ROW * sphgi_size_of_type(type);
}

/* Rows of one stream around the block, behind a dummy row of zeros. */
static void stage_stream(struct sphgi_worker *w, const struct sphgi_surroundings *around,
                         int32_t number, char *to)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const struct sphgi_stream *stream = &sweep->set->streams[number];
    const size_t size = row_size(sweep->plan->type);
    const char *packed = sweep->packed_rows + (size_t)number * ((size_t)n->source_count + 1) * size;
    w->rows[number] = to;
    memset(to, 0, size);
    to += size;
    for (int32_t r = 0; r < around->ranges; ++r) {
        const size_t count = (size_t)around->count[r];
        if (sweep->packed)
            memcpy(to, packed + (size_t)around->begin[r] * size, count * size);
        else
            w->passes->load_rows(&stream->columns, n->sources.order.data, around->begin[r],
                                 around->begin[r] + around->count[r], stream->first,
                                 stream->columns.count ? stream->count : 0, to);
        to += count * size;
    }
}

/* The sources behind the staged numbers. */
static void stage_items(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const int32_t *order = w->sweep->set->neighbors->sources.order.data;
    int32_t *to = (int32_t *)(void *)w->staged_items;
    *to++ = -1;
    for (int32_t r = 0; r < around->ranges; ++r)
        for (int32_t k = 0; k < around->count[r]; ++k)
            *to++ = order[around->begin[r] + k];
    w->items = (const int32_t *)(const void *)w->staged_items;
}

/* Positions with their volumes; packed rows were checked when they were packed. */
static void stage_positions(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = row_size(n->position_type);
    char *to = w->staged_positions;
    memset(to, 0, size);
    to += size;
    for (int32_t r = 0; r < around->ranges; ++r) {
        const size_t count = (size_t)around->count[r];
        if (sweep->packed)
            memcpy(to, sweep->packed_positions + (size_t)around->begin[r] * size, count * size);
        else if (!sweep->position_passes->stage[sweep->plan->type == SPHG_F64](
                     n->sources.rows.data, &sweep->set->volume, n->sources.order.data,
                     around->begin[r], around->count[r], to))
            w->tally->bad_volume = true;
        to += count * size;
    }
}

static void stage_block(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const size_t stream_size = (size_t)around->staged * row_size(sweep->plan->type);
    stage_positions(w, around);
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s)
        stage_stream(w, around, s, w->staged_rows + (size_t)s * stream_size);
    if (sweep->pairs)
        stage_items(w, around);
    w->gather.rows = w->staged_positions;
    w->gather.dummy = 0;
    w->local = false;
}

/* Rows are copied pair by pair; the one behind the last is the dummy. */
static void use_local_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const size_t position = row_size(sweep->set->neighbors->position_type);
    const size_t size = row_size(sweep->plan->type);
    memset(w->staged_positions + SPHGI_PIECE * position, 0, position);
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        char *rows = w->staged_rows + (size_t)s * (SPHGI_PIECE + 1) * size;
        memset(rows + SPHGI_PIECE * size, 0, size);
        w->rows[s] = rows;
    }
    w->gather.rows = w->staged_positions;
    w->gather.dummy = SPHGI_PIECE;
    w->items = (const int32_t *)(const void *)w->local_items;
    w->local = true;
}

/* ---- Blocks of a searched object ------------------------------------------------------------ */

static int32_t target_at(const sphg_neighbors *n, int32_t place)
{
    return ((const int32_t *)sphgi_target_grid(n)->order.data)[place];
}

static bool is_active(const struct task *task, int32_t place)
{
    return !task->selection->active || task->selection->active[place];
}

/* The next groups' data are asked for while this one is summed. */
static void prefetch_ahead(const struct sphgi_worker *w, int32_t place)
{
    enum { AHEAD = 2 * SPHGI_LANES_MOST };
    const sphg_neighbors *n = w->sweep->set->neighbors;
    if (place + AHEAD < n->target_count)
        sphgi_group_prefetch(w->sweep->plan, target_at(n, place + AHEAD));
}

static void sweep_kept_block(const struct task *task, struct sphgi_worker *w, int32_t block)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t first = block * grid->cells;
    const int32_t *start = (const int32_t *)grid->cell_start.data + first;
    const int64_t *cell_list = (const int64_t *)n->found.cell_list.data + first;
    const uint16_t *lengths = n->found.lengths.data;
    struct supply supply = {.wide = false};
    for (int32_t c = 0; c < grid->cells; ++c) {
        const uint16_t *ids = (const uint16_t *)n->found.ids.data + cell_list[c];
        for (int32_t t = start[c]; t < start[c + 1]; ++t) {
            prefetch_ahead(w, t);
            if (is_active(task, t))
                add_target(w, &supply, target_at(n, t), sphgi_target_row(n, t), ids, lengths[t]);
            ids += sphgi_round_up(lengths[t], SPHGI_PAD);
        }
    }
    run_rest(w, &supply);
}

/* Nothing is kept: pairs are found cell by cell and used at once. */
static void sweep_found_block(const struct task *task, struct sphgi_worker *w, int32_t block,
                              const struct sphgi_finder *finder,
                              const struct sphgi_surroundings *around)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells;
    struct supply supply = {.wide = false};
    sphgi_stage_coordinates(finder, n, around);
    for (int32_t c = 0; c < grid->cells; ++c)
        for (int32_t t = start[c]; t < start[c + 1]; t += SPHGI_FIND_MOST) {
            const int32_t end = sphgi_min32(t + SPHGI_FIND_MOST, start[c + 1]);
            bool any = false;
            for (int32_t k = t; k < end; ++k)
                any |= is_active(task, k);
            if (!any)
                continue;
            const uint16_t *ids = finder->ids;
            sphgi_find_targets(finder, n, around, c, t, end, finder->ids, finder->lengths);
            for (int32_t k = t; k < end; ++k) {
                const uint16_t length = finder->lengths[k - t];
                if (is_active(task, k))
                    add_target(w, &supply, target_at(n, k), sphgi_target_row(n, k), ids, length);
                ids += sphgi_round_up(length, SPHGI_PAD);
            }
            run_rest(w, &supply); /* the next search overwrites the ids */
        }
}

static void sweep_kept_wide_block(const struct task *task, struct sphgi_worker *w, int32_t block)
{
    enum { HEADER = 8 };
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t first = block * grid->cells;
    const int32_t *start = (const int32_t *)grid->cell_start.data + first;
    const int64_t *cell_list = (const int64_t *)n->found.cell_list.data + first;
    struct supply supply = {.wide = true};
    for (int32_t c = 0; c < grid->cells; ++c) {
        const uint32_t *row =
            (const uint32_t *)(const void *)((const uint16_t *)n->found.ids.data + cell_list[c]);
        for (int32_t t = start[c]; t < start[c + 1]; ++t) {
            const size_t count = row[0];
            if (is_active(task, t))
                add_target(w, &supply, target_at(n, t), sphgi_target_row(n, t), row + HEADER,
                           (int64_t)count);
            row += HEADER + sphgi_round_up(count, SPHGI_PAD);
        }
    }
    run_rest(w, &supply);
}

static void take_wide(void *data, const uint32_t *rows, int32_t count)
{
    sphgi_group_add(data, 0, rows, count, true);
}

static void sweep_found_wide_block(const struct task *task, struct sphgi_worker *w, int32_t block,
                                   const struct sphgi_finder *finder,
                                   const struct sphgi_surroundings *around)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *start = (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells;
    for (int32_t c = 0; c < grid->cells; ++c)
        for (int32_t t = start[c]; t < start[c + 1]; ++t) {
            if (!is_active(task, t))
                continue;
            w->group.lanes = 1;
            w->group.target[0] = target_at(n, t);
            w->group.x[0] = sphgi_target_row(n, t);
            sphgi_group_begin(w);
            do
                sphgi_find_wide(finder, n, around, c, t, take_wide, w);
            while (sphgi_group_again(w));
            sphgi_group_end(w);
            w->group.lanes = 0;
        }
}

static void sweep_block(const struct task *task, struct sphgi_worker *w, int32_t block,
                        const struct sphgi_finder *finder)
{
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const struct sphgi_block *at = (const struct sphgi_block *)grid->blocks.data + block;
    const int32_t *start = (const int32_t *)grid->cell_start.data + (ptrdiff_t)block * grid->cells;
    struct sphgi_surroundings around;
    sphgi_surroundings_of(&n->sources, at->at, &around);
    const bool wide = n->list_free ? sphgi_is_wide(n, &around, start, grid->cells)
                                   : ((const uint8_t *)n->found.wide.data)[block];
    if (wide)
        use_local_rows(w);
    else
        stage_block(w, &around);
    if (n->list_free && wide)
        sweep_found_wide_block(task, w, block, finder, &around);
    else if (n->list_free)
        sweep_found_block(task, w, block, finder, &around);
    else if (wide)
        sweep_kept_wide_block(task, w, block);
    else
        sweep_kept_block(task, w, block);
}

static void block_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct task *task = data;
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

static void list_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct task *task = data;
    const sphg_neighbors *n = task->sweep.set->neighbors;
    const size_t size = row_size(task->sweep.plan->type);
    struct supply supply = {.wide = true};
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    if (task->sweep.packed) {
        w.gather.rows = task->sweep.packed_positions;
        w.gather.dummy = (uint32_t)n->source_count;
        for (int32_t s = 0; s < task->sweep.plan->stream_count; ++s)
            w.rows[s] = task->sweep.packed_rows + (size_t)s * ((size_t)n->source_count + 1) * size;
    } else
        use_local_rows(&w);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target < 0)
            continue;
        const int32_t *ids;
        const int64_t count = host_row(&n->lists, target, number, &ids);
        if (count < 0 || (count > 0 && !ids)) {
            if (w.tally->bad_target < 0 || target < w.tally->bad_target) {
                w.tally->bad_target = target;
                w.tally->bad_index = SPHGI_BAD_LENGTH;
            }
            continue;
        }
        add_target(&w, &supply, target, sphgi_target_row(n, target), ids, count);
        if (n->lists.row)
            run_rest(&w, &supply); /* the function may reuse its array */
    }
    run_rest(&w, &supply);
}

/* ---- Finishing the sums of several sets ----------------------------------------------------- */

static void finish_task(void *data, int32_t begin, int32_t end, int32_t number)
{
    const struct task *task = data;
    struct sphgi_worker w;
    sphgi_worker_open(&w, &task->sweep, number);
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(task->selection, task->selection->begin + k);
        if (target >= 0)
            w.group.target[w.group.lanes++] = target;
        if (w.group.lanes == w.passes->lanes || (k + 1 == end && w.group.lanes)) {
            sphgi_group_finish_from_arena(&w);
            w.group.lanes = 0;
        }
    }
}

/* ---- Packing -------------------------------------------------------------------------------- */

struct packing {
    const struct sphgi_sweep *sweep;
    char *rows, *positions;
    const int32_t *order; /* NULL: rows stand in the order of the host */
    atomic_bool bad_volume;
};

static void pack_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct packing *packing = data;
    const struct sphgi_sweep *sweep = packing->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const sphg_type type = sweep->plan->type;
    const size_t size = row_size(type);
    (void)worker;
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        const struct sphgi_stream *stream = &sweep->set->streams[s];
        const size_t at = (size_t)s * ((size_t)n->source_count + 1) + (size_t)begin;
        sweep->passes->load_rows(&stream->columns, packing->order, begin, end, stream->first,
                                 stream->columns.count ? stream->count : 0,
                                 packing->rows + at * size);
    }
    if (!sweep->position_passes->stage[type == SPHG_F64](
            n->sources.rows.data, &sweep->set->volume, packing->order, begin, end - begin,
            packing->positions + (size_t)begin * row_size(n->position_type)))
        atomic_store(&packing->bad_volume, true);
}

/* Positions with volumes, and fields, as rows in storage order. */
static sphg_result pack(struct task *task, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const sphg_type type = sweep->plan->type;
    const size_t rows = (size_t)n->source_count + 1, streams = (size_t)sweep->plan->stream_count;
    const size_t positions_size =
        sphgi_round_up(rows * row_size(n->position_type), SPHGI_ALIGNMENT);
    if (!sphgi_reserve(&sweep->context->allocator, &sweep->context->packed,
                       positions_size + streams * rows * row_size(type), 1))
        return SPHG_ERROR_MEMORY;
    char *memory = sweep->context->packed.data;
    struct packing packing = {.sweep = sweep,
                              .positions = memory,
                              .rows = memory + positions_size,
                              .order = n->kind == SPHGI_HOST_LISTS ? NULL : n->sources.order.data};
    atomic_store(&packing.bad_volume, false);
    sphgi_parallel_for(sweep->context, pack_task, &packing, n->source_count, PACK_GRAIN);
    for (size_t s = 0; s < streams; ++s) /* the dummy rows */
        memset(packing.rows + ((s + 1) * rows - 1) * row_size(type), 0, row_size(type));
    memset(packing.positions + (rows - 1) * row_size(n->position_type), 0,
           row_size(n->position_type));
    sweep->packed_positions = packing.positions;
    sweep->packed_rows = packing.rows;
    tally->bad_volume |= atomic_load(&packing.bad_volume);
    return SPHG_OK;
}

/* ---- One sweep ------------------------------------------------------------------------------ */

/* Memory for the workers, tallies cleared. */
static bool open_workers(struct sphgi_sweep *sweep)
{
    sphg_context *context = sweep->context;
    const sphg_neighbors *n = sweep->set->neighbors;
    sweep->staged_most = n->kind == SPHGI_SEARCHED ? sphgi_finder_room(n) : 0;
    sweep->memory_each = sphgi_worker_size(sweep);
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       sweep->memory_each))
        return false;
    sweep->memory = context->workers.data;
    for (int32_t t = 0; t < context->threads; ++t) /* the tally stands first */
        sphgi_tally_clear((void *)(sweep->memory + (size_t)t * sweep->memory_each));
    return true;
}

static void close_workers(const struct sphgi_sweep *sweep, struct sphgi_tally *total)
{
    for (int32_t t = 0; t < sweep->context->threads; ++t)
        sphgi_tally_add(total, (const void *)(sweep->memory + (size_t)t * sweep->memory_each));
}

static sphg_result sweep_set(struct task *task, struct sphgi_selection *selection,
                             struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    sphg_context *context = sweep->context;
    const sphg_neighbors *n = sweep->set->neighbors;
    const int64_t items = selection->end - selection->begin;
    sweep->position_passes = sphgi_passes_of(context, n->position_type);
    sweep->packed = items * PACK_WORTH >= n->source_count;
    const bool searched = n->kind == SPHGI_SEARCHED;
    const bool marks = searched && selection->subset;
    if ((sweep->packed && pack(task, tally)) || !open_workers(sweep) ||
        (marks && !sphgi_selection_mark(context, selection, n)))
        return SPHG_ERROR_MEMORY;
    if (searched)
        sphgi_parallel_for(context, block_task, task,
                           marks ? selection->block_count : sphgi_target_grid(n)->block_count,
                           BLOCK_GRAIN);
    else
        sphgi_parallel_for(context, list_task, task, (int32_t)items, LIST_GRAIN);
    if (marks)
        sphgi_selection_unmark(selection, n);
    close_workers(sweep, tally);
    return SPHG_OK;
}

static sphg_result finish_all(struct task *task, const struct sphgi_selection *selection,
                              struct sphgi_tally *tally)
{
    if (!open_workers(&task->sweep))
        return SPHG_ERROR_MEMORY;
    sphgi_parallel_for(task->sweep.context, finish_task, task, selection->end - selection->begin,
                       LIST_GRAIN);
    close_workers(&task->sweep, tally);
    return SPHG_OK;
}

/* One step over all sets: at once for a single one, through the arena for several. */
static sphg_result sweep_sets(struct task *task, struct sphgi_selection *selection, unsigned steps,
                              struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const bool single = plan->set_count == 1;
    sphg_result result = SPHG_OK;
    sweep->steps = steps | (single ? SPHGI_FINISH : 0u);
    for (int32_t s = 0; s < plan->set_count && !result; ++s) {
        sweep->set = &plan->sets[s];
        sweep->set_number = s;
        result = sweep_set(task, selection, tally);
    }
    return result || single ? result : finish_all(task, selection, tally);
}

static sphg_result sweep_all(struct task *task, struct sphgi_selection *selection,
                             struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    sphg_context *context = sweep->context;
    const struct sphgi_plan *plan = sweep->plan;
    const size_t targets = (size_t)plan->target_count, size = sphgi_size_of_type(plan->type);
    const unsigned moments = plan->computes ? SPHGI_SUM_MOMENTS : 0u;
    const unsigned fields = plan->field_count || sweep->pairs ? SPHGI_SUM_FIELDS : 0u;
    if (plan->set_count == 1)
        return sweep_sets(task, selection, moments | fields, tally);
    if (!sphgi_reserve(&context->allocator, &context->sums, targets * (size_t)plan->sums, size))
        return SPHG_ERROR_MEMORY;
    sweep->arena = context->sums.data;
    if (!plan->classic || !moments || !fields)
        return sweep_sets(task, selection, moments | fields, tally);
    /* Classic gradients of several sets: all moments first. */
    const int32_t width = sphgi_correction_width(plan->scheme.method, plan->dimension);
    if (!sphgi_reserve(&context->allocator, &context->coefficients, targets * (size_t)width, size))
        return SPHG_ERROR_MEMORY;
    const struct sphgi_columns table =
        sphgi_dense_columns(context->coefficients.data, width, width, plan->type);
    sweep->coefficients = &table;
    sphg_result result = sweep_sets(task, selection, moments, tally);
    if (!result)
        result = sweep_sets(task, selection, fields, tally);
    sweep->coefficients = NULL;
    return result;
}

/* ---- Errors found on the way ---------------------------------------------------------------- */

static bool is_bad_volume(const struct sphgi_columns *volume, sphg_type type, int64_t item,
                          double *value)
{
    const char *at = volume->at[0] + item * volume->stride;
    *value = type == SPHG_F64 ? *(const double *)(const void *)at
                              : (double)*(const float *)(const void *)at;
    return !(*value >= 0) || !isfinite(*value);
}

static int32_t first_bad_volume(const struct sphgi_columns *volume, sphg_type type, int32_t count,
                                double *value)
{
    for (int32_t k = 0; volume->count && k < count; ++k)
        if (is_bad_volume(volume, type, k, value))
            return k;
    return -1;
}

static sphg_result report_volume(struct sphgi_checker checker, const struct sphgi_plan *plan)
{
    static const char *const rule = "must be >= 0 and finite";
    double value = 0;
    for (int32_t s = 0; s < plan->set_count; ++s) {
        const struct sphgi_set_plan *set = &plan->sets[s];
        const int32_t k =
            first_bad_volume(&set->volume, plan->type, set->neighbors->source_count, &value);
        if (k >= 0)
            return sphgi_fail(checker.context, SPHG_ERROR_VOLUME,
                              "%s: sources[%d].volume[%d] is %g, %s", checker.function, (int)s,
                              (int)k, value, rule);
    }
    const int32_t k =
        first_bad_volume(&plan->target_volume, plan->type, plan->target_count, &value);
    return sphgi_fail(checker.context, SPHG_ERROR_VOLUME, "%s: target_volume[%d] is %g, %s",
                      checker.function, (int)k, value, rule);
}

static sphg_result report_index(struct sphgi_checker checker, const struct sphgi_tally *tally)
{
    if (tally->bad_index == SPHGI_BAD_LENGTH)
        return sphgi_fail(checker.context, SPHG_ERROR_INDEX,
                          "%s: the list of target %d has a negative length or is NULL",
                          checker.function, (int)tally->bad_target);
    return sphgi_fail(checker.context, SPHG_ERROR_INDEX,
                      "%s: the list of target %d holds %lld, which is no source", checker.function,
                      (int)tally->bad_target, (long long)tally->bad_index);
}

int32_t sphgi_selected_rows(const sphg_subset *subset, int32_t target_count, int32_t *row_of_target)
{
    const struct sphgi_selection selection = sphgi_selection_of(subset, target_count);
    int32_t rows = 0;
    for (int32_t k = selection.begin; k < selection.end; ++k) {
        const int32_t target = sphgi_selected(&selection, k);
        if (target >= 0)
            row_of_target[target] = rows++;
    }
    return rows;
}

sphg_result sphgi_sweep_run(struct sphgi_checker checker, const struct sphgi_plan *plan,
                            const sphg_subset *subset, const struct sphgi_pair_sink *pairs)
{
    sphg_context *context = checker.context;
    struct sphgi_selection selection = sphgi_selection_of(subset, plan->target_count);
    struct task task = {.sweep = {.context = context,
                                  .plan = plan,
                                  .pairs = pairs,
                                  .passes = sphgi_passes_of(context, plan->type)},
                        .selection = &selection};
    struct sphgi_tally tally;
    sphgi_tally_clear(&tally);
    if (sweep_all(&task, &selection, &tally))
        return sphgi_fail_memory(context, checker.function);
    if (plan->stats)
        *plan->stats = tally.stats;
    if (tally.bad_target >= 0)
        return report_index(checker, &tally);
    if (tally.bad_volume && !context->config.trusted)
        return report_volume(checker, plan);
    return SPHG_OK;
}
