/* SPDX-License-Identifier: MIT */
/* Pairs one by one: export as CSR, with their G_ij. */
#include "core/overlap.h"
#include "entries.h"
#include "core/parallel.h"
#include "pair_order.h"
#include "plan/make.h"
#include "sweep/selection.h"
#include "sweep/sweep.h"
#include "core/view.h"
#include "sweep/worker.h"
#include <string.h>

enum { LIST_GRAIN = 32 /* groups */ };

/* ---- Export --------------------------------------------------------------------------------- */

struct exporting {
    struct sphgi_checker checker;
    const struct sphgi_plan *plan;
    const sphg_subset *subset;
    sphg_pairs *pairs;
    struct sphgi_pair_numbers gradient;
    int32_t rows;
    int32_t *row_of_target;
    int64_t *offsets; /* rows + 1: first counts, then offsets */
    int32_t *lengths; /* NULL where nobody asks for them and no block is filled up */
};

static struct sphgi_extent array_extent(const char *name, const void *array, int64_t count,
                                        size_t item_size)
{
    const sphg_view view = {array, NULL, NULL, (ptrdiff_t)item_size, SPHG_U8, SPHG_AS_SHAPE};
    const int32_t items = (int32_t)(count < INT32_MAX ? count : INT32_MAX);
    return (struct sphgi_extent){name, sphgi_flat_columns(&view, array != NULL), items, item_size,
                                 true};
}

/* The request's views were compared with each other when the plan was made: these are all that
 * the pairs may touch beside them. */
static sphg_result check_pair_overlap(const struct exporting *e)
{
    const struct sphgi_plan *plan = e->plan;
    const sphg_pairs *pairs = e->pairs;
    const size_t size = sphgi_size_of_type(plan->type);
    const int64_t rows = (int64_t)plan->target_count + 1;
    struct sphgi_extent gradient = array_extent("pairs.gradient", NULL, pairs->capacity, size);
    gradient.columns = e->gradient.columns;
    const struct sphgi_extent extents[] = {
        {"sources[0].volume", plan->sets[0].volume, plan->sets[0].neighbors->source_count, size,
         false},
        sphgi_extent_of("target_correction", &plan->target_correction, plan->target_count, size,
                        false),
        gradient,
        array_extent("pairs.indices", pairs->indices, pairs->capacity, sizeof *pairs->indices),
        array_extent("pairs.offsets", pairs->offsets, e->subset ? 1 : rows, sizeof *pairs->offsets),
        array_extent("pairs.lengths", pairs->lengths, e->subset ? 1 : plan->target_count,
                     sizeof *pairs->lengths)};
    return sphgi_check_overlap(e->checker, extents, 6);
}

static sphg_result check_block(const struct exporting *e)
{
    const struct sphgi_checker checker = e->checker;
    const sphg_pairs *pairs = e->pairs;
    const sphg_view *g = &pairs->gradient;
    const int32_t block = pairs->block;
    const size_t pair = (size_t)e->plan->dimension * sphgi_size_of_type(e->plan->type);
    if (block != 0 && block != 4 && block != 8 && block != 16)
        return sphgi_fail(checker.context, SPHG_ERROR_ARGUMENT,
                          "%s: pairs.block is %d, must be 0, 4, 8 or 16", checker.function,
                          (int)block);
    if (block && g->x && (g->y || g->z || g->stride != (ptrdiff_t)pair))
        return sphgi_fail(
            checker.context, SPHG_ERROR_ARGUMENT,
            "%s: pairs.gradient must be one array of stride %d where pairs.block is %d",
            checker.function, (int)pair, (int)block);
    return SPHG_OK;
}

static sphg_result check_pairs(struct exporting *e)
{
    const struct sphgi_checker checker = e->checker;
    sphg_pairs *pairs = e->pairs;
    if (pairs->capacity < 0)
        return sphgi_fail(checker.context, SPHG_ERROR_ARGUMENT, "%s: pairs.capacity is %lld",
                          checker.function, (long long)pairs->capacity);
    const int64_t most = pairs->capacity < INT32_MAX ? pairs->capacity : INT32_MAX;
    const struct sphgi_expected expected = {.name = "pairs.gradient",
                                            .type = e->plan->type,
                                            .shape = SPHG_VECTOR,
                                            .dimension = e->plan->dimension,
                                            .count = (int32_t)most,
                                            .use = SPHGI_OUTPUT};
    sphg_result result = sphgi_check_view(checker, &pairs->gradient, &expected);
    if (!result)
        result = check_block(e);
    if (result)
        return result;
    e->gradient = (struct sphgi_pair_numbers){
        .columns = sphgi_columns_of(&pairs->gradient, SPHG_VECTOR, e->plan->dimension),
        .size = sphgi_size_of_type(e->plan->type),
        .block = pairs->block};
    return check_pair_overlap(e);
}

/* Lists that are kept for this very radius hold nothing else. */
static bool are_lengths_counts(const struct exporting *e)
{
    const sphg_neighbors *n = e->plan->sets[0].neighbors;
    return n->kind != SPHGI_HOST_LISTS && !n->list_free && !n->found.crowded && n->skin == 0 &&
           e->plan->scheme.radius == n->radius;
}

static int32_t self_pairs(const struct exporting *e)
{
    return e->plan->classic && e->plan->own_set >= 0;
}

static void count_by_lengths(struct exporting *e)
{
    const sphg_neighbors *n = e->plan->sets[0].neighbors;
    const struct sphgi_selection selection = sphgi_selection_of(e->subset, e->plan->target_count);
    const int32_t *place = n->target_place.data;
    const uint16_t *lengths = n->found.lengths.data;
    const int32_t self = self_pairs(e);
    for (int32_t k = selection.begin; k < selection.end; ++k) {
        const int32_t target = sphgi_selected(&selection, k);
        if (target >= 0)
            e->offsets[e->row_of_target[target] + 1] = lengths[place[target]] + self;
    }
}

static sphg_result count_by_sweep(struct exporting *e)
{
    struct sphgi_plan counting = *e->plan; /* only pairs are looked at */
    counting.computes = counting.corrects = counting.differentiates = false;
    counting.sums = 0;
    const struct sphgi_pair_sink sink = {.row_of_target = e->row_of_target,
                                         .counts = e->offsets + 1};
    return sphgi_sweep_run(e->checker, &counting, e->subset, &sink);
}

/* Rows, lengths where they are asked for, and offsets. Returns the bytes. */
static size_t place_counts(struct exporting *e, char *base)
{
    struct sphgi_layout layout = {base, 0};
    const size_t targets = (size_t)e->plan->target_count;
    const bool lengths = e->pairs->lengths || e->pairs->block;
    e->row_of_target = sphgi_place(&layout, targets + 1, sizeof(int32_t));
    e->lengths = lengths ? sphgi_place(&layout, targets + 1, sizeof(int32_t)) : NULL;
    e->offsets = sphgi_place(&layout, targets + 1, sizeof(int64_t));
    return layout.used;
}

static sphg_result count_pairs(struct exporting *e)
{
    sphg_context *context = e->checker.context;
    if (!sphgi_reserve(&context->allocator, &context->sums, place_counts(e, NULL), 1))
        return sphgi_fail_memory(context, e->checker.function);
    place_counts(e, context->sums.data);
    e->rows = sphgi_selected_rows(e->subset, e->plan->target_count, e->row_of_target);
    sphg_result result = SPHG_OK;
    if (are_lengths_counts(e))
        count_by_lengths(e);
    else
        result = count_by_sweep(e);
    e->offsets[0] = 0;
    for (int32_t k = 0; k < e->rows && !result; ++k) {
        const int64_t count = e->offsets[k + 1];
        if (e->lengths)
            e->lengths[k] = (int32_t)count;
        e->offsets[k + 1] = e->offsets[k] + sphgi_in_blocks(count, e->pairs->block);
    }
    return result;
}

/* ---- Lists as they are ----------------------------------------------------------------------- */

struct listing {
    const struct exporting *e;
    const sphg_neighbors *neighbors;
    struct sphgi_selection selection;
};

/* One kept list becomes a row. */
static void write_row(const struct exporting *e, const sphg_neighbors *n, int32_t place,
                      const uint32_t *ids, int32_t stride)
{
    const int32_t *order = n->sources.order.data;
    const int32_t target = ((const int32_t *)sphgi_target_grid(n)->order.data)[place];
    const int32_t count = ((const uint16_t *)n->found.lengths.data)[place];
    int32_t *row = e->pairs->indices + e->offsets[e->row_of_target[target]];
    for (int32_t k = 0; k < count; ++k, ids += stride)
        row[k] = order[*ids / SPHGI_ID_STEP];
    if (self_pairs(e))
        row[count] = target;
    sphgi_fill_up_row(&e->gradient, row, 0, count + self_pairs(e));
}

/* Targets [first, last) of a group. */
static void write_rows(const struct exporting *e, const sphg_neighbors *n, int32_t group,
                       int32_t first, int32_t last)
{
    struct sphgi_kept_list list = sphgi_first_list(n, group);
    for (int32_t k = 0; k < last; ++k, sphgi_to_next_list(&list))
        if (k >= first)
            write_row(e, n, group * SPHGI_GROUP + k, list.ids, list.stride);
}

static void group_rows_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct listing *listing = data;
    (void)worker;
    for (int32_t group = begin; group < end; ++group)
        write_rows(listing->e, listing->neighbors, group, 0,
                   sphgi_targets_in(listing->neighbors, group));
}

static void target_rows_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct listing *listing = data;
    const sphg_neighbors *n = listing->neighbors;
    (void)worker;
    for (int32_t k = begin; k < end; ++k) {
        const int32_t target = sphgi_selected(&listing->selection, listing->selection.begin + k);
        if (target < 0)
            continue;
        const int32_t place = ((const int32_t *)n->target_place.data)[target];
        const int32_t lane = place % SPHGI_GROUP;
        write_rows(listing->e, n, place / SPHGI_GROUP, lane, lane + 1);
    }
}

static bool are_all_kept(const sphg_neighbors *n)
{
    bool kept = true;
    for (int32_t group = 0; group < sphgi_group_count(n->target_count); ++group)
        kept &= n->found.groups[group] >= 0;
    return kept;
}

/* All targets in the order of storage, or those that are asked for in their own. */
static void write_lists(struct exporting *e)
{
    const sphg_neighbors *n = e->plan->sets[0].neighbors;
    struct listing listing = {e, n, sphgi_selection_of(e->subset, n->target_count)};
    sphg_context *context = e->checker.context;
    if (!e->subset)
        sphgi_parallel_for(context, group_rows_task, &listing, sphgi_group_count(n->target_count),
                           LIST_GRAIN);
    else
        sphgi_parallel_for(context, target_rows_task, &listing,
                           listing.selection.end - listing.selection.begin,
                           LIST_GRAIN * SPHGI_GROUP);
}

static sphg_result fill_pairs(struct exporting *e)
{
    sphg_context *context = e->checker.context;
    const size_t count = (size_t)e->offsets[e->rows];
    struct sphgi_pair_sink sink = {.row_of_target = e->row_of_target,
                                   .offsets = e->offsets,
                                   .indices = e->pairs->indices,
                                   .gradient = e->gradient};
    if (!sink.indices) { /* gradients alone: still in that order */
        if (!sphgi_reserve(&context->allocator, &context->coefficients, count, sizeof(int32_t)))
            return sphgi_fail_memory(context, e->checker.function);
        sink.indices = context->coefficients.data;
    }
    sphg_result result = SPHG_OK;
    if (!sink.gradient.columns.count && are_lengths_counts(e) &&
        are_all_kept(e->plan->sets[0].neighbors))
        write_lists(e);
    else
        result = sphgi_sweep_run(e->checker, e->plan, e->subset, &sink);
    const struct sphgi_pair_order order = {e->offsets, e->lengths, sink.indices, e->gradient};
    if (!result && !e->pairs->any_order)
        sphgi_sort_pairs(context, &order, e->rows);
    return result;
}

static sphg_result export_pairs(struct exporting *e)
{
    sphg_pairs *pairs = e->pairs;
    sphg_result result = check_pairs(e);
    if (!result)
        result = count_pairs(e);
    if (result)
        return result;
    pairs->count = e->offsets[e->rows];
    const bool arrays = pairs->indices || e->gradient.columns.count;
    if (arrays && pairs->count > pairs->capacity)
        return sphgi_fail(e->checker.context, SPHG_ERROR_CAPACITY,
                          "%s: pairs.capacity is %lld, there are %lld pairs", e->checker.function,
                          (long long)pairs->capacity, (long long)pairs->count);
    if (arrays)
        result = fill_pairs(e);
    if (!result && pairs->offsets)
        memcpy(pairs->offsets, e->offsets, ((size_t)e->rows + 1) * sizeof *pairs->offsets);
    if (!result && pairs->lengths)
        memcpy(pairs->lengths, e->lengths, (size_t)e->rows * sizeof *pairs->lengths);
    return result;
}

sphg_result sphg_pair_gradients(sphg_context *context, const sphg_scheme *scheme,
                                const sphg_sources *sources, const sphg_subset *subset,
                                sphg_view target_correction, sphg_pairs *pairs)
{
    const struct sphgi_checker checker = {context, "sphg_pair_gradients"};
    struct sphgi_plan plan;
    struct exporting e = {.checker = checker, .plan = &plan, .subset = subset, .pairs = pairs};
    const sphg_request request = {.sources = sources,
                                  .set_count = 1,
                                  .subset = subset,
                                  .target_correction = target_correction};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_pointer(checker, pairs, "pairs");
    if (!result)
        result = sphgi_plan_make(
            checker, scheme, &request,
            sphgi_is_absent(&pairs->gradient) ? SPHGI_FOR_PAIRS : SPHGI_FOR_PAIR_GRADIENTS, &plan);
    if (!result)
        result = export_pairs(&e);
    return sphgi_leave(context, result);
}

/* ---- For other entries ---------------------------------------------------------------------- */

static sphg_result keep_pairs(struct exporting *e, struct sphgi_rows *rows)
{
    const struct sphgi_allocator *allocator = &e->checker.context->allocator;
    sphg_result result = count_pairs(e);
    if (result)
        return result;
    const size_t offsets = (size_t)e->rows + 1, pairs = (size_t)e->offsets[e->rows];
    if (!sphgi_reserve(allocator, &rows->offsets, offsets, sizeof *e->offsets) ||
        !sphgi_reserve(allocator, &rows->indices, pairs + 1, sizeof(int32_t)))
        return sphgi_fail_memory(e->checker.context, e->checker.function);
    e->pairs->indices = rows->indices.data;
    result = fill_pairs(e);
    memcpy(rows->offsets.data, e->offsets, offsets * sizeof *e->offsets);
    return result;
}

sphg_result sphgi_list_pairs(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                             const sphg_neighbors *neighbors, struct sphgi_rows *rows)
{
    const sphg_scheme plain = {
        .dimension = scheme->dimension, .method = SPHG_PLAIN, .support_radius = scheme->radius};
    const sphg_sources sources = {.neighbors = neighbors};
    const sphg_request request = {.sources = &sources, .set_count = 1};
    struct sphgi_plan plan;
    sphg_pairs pairs = {.offsets = NULL};
    struct exporting e = {.checker = checker, .plan = &plan, .pairs = &pairs};
    const sphg_result result = sphgi_plan_make(checker, &plain, &request, SPHGI_FOR_PAIRS, &plan);
    return result ? result : keep_pairs(&e, rows);
}
