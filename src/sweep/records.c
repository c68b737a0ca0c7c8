/* SPDX-License-Identifier: MIT */
#include "records.h"
#include "core/parallel.h"
#include "fold.h"
#include "own.h"
#include <string.h>

enum {
    PACK_GRAIN = 4096, /* particles */
    WORTH = 16         /* groups, of which one may be without weights */
};

static const struct sphgi_field_plan *field_of(const struct sphgi_sweep *sweep)
{
    return sweep->steps & SPHGI_SUM_FIELDS && sweep->plan->field_count ? sweep->plan->fields : NULL;
}

static bool sums_moments(const struct sphgi_sweep *sweep)
{
    return (sweep->steps & SPHGI_SUM_MOMENTS) && sweep->plan->computes;
}

static int32_t numbers_of(const struct sphgi_sweep *sweep)
{
    const struct sphgi_field_plan *field = field_of(sweep);
    return !field ? 0 : !field->fold ? field->components : sphgi_numbers_folded(sweep->plan, field);
}

static int32_t width_of(const struct sphgi_sweep *sweep)
{
    return sphgi_record_width(sweep->plan->dimension, numbers_of(sweep));
}

static size_t record_size(const struct sphgi_sweep *sweep)
{
    return (size_t)width_of(sweep) * sphgi_size_of_type(sweep->plan->type);
}

/* One gradient or divergence over G_ij. */
static bool is_one_sided(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field)
{
    const bool vector = field->shape == SPHG_VECTOR;
    const bool gradient =
        field->sums_gradient && !field->sums_divergence && (vector || field->shape == SPHG_SCALAR);
    const bool divergence = field->sums_divergence && !field->sums_gradient &&
                            (vector || field->shape == SPHG_SYM_TENSOR);
    return (gradient || divergence) &&
           sweep->set->streams[field->stream].columns.count == field->components &&
           (field->form == SPHG_DIRECT || sphgi_are_targets_sources(sweep, field));
}

/* rho_j stands behind b_j. */
static bool is_dense(const struct sphgi_field_plan *field)
{
    return field->fold && field->form == SPHG_SYMMETRIC;
}

/* What the pass knows. */
static bool is_known(const struct sphgi_sweep *sweep)
{
    const struct sphgi_plan *plan = sweep->plan;
    const struct sphgi_field_plan *field = field_of(sweep);
    if (plan->graded || plan->diffuses || sweep->pairs || sweep->turn.waits ||
        !(field || sums_moments(sweep)))
        return false;
    if (!field)
        return true;
    if (plan->field_count > 1 || !field->differentiates || field->mirrors || field->square.count ||
        field->value_sum >= 0)
        return false;
    if (field->fold)
        return !field->rows && !sums_moments(sweep) &&
               (field->fold > SPHGI_FOLDED_NUMBER || is_dense(field));
    return field->one_sided && is_one_sided(sweep, field) &&
           !(field->sums_divergence && sums_moments(sweep));
}

static int32_t groups_without(const struct sphgi_sweep *sweep)
{
    const int32_t groups = sphgi_group_count(sweep->set->neighbors->target_count);
    int32_t without = 0;
    for (int32_t k = 0; k < groups; ++k)
        without += sweep->kept.marks[k] != sweep->kept.number;
    return without;
}

bool sphgi_lacks_weights(const struct sphgi_sweep *sweep)
{
    return groups_without(sweep) > 0;
}

bool sphgi_may_read_records(const struct sphgi_sweep *sweep,
                            const struct sphgi_selection *selection)
{
    return sweep->passes->sum_records && sweep->kept.number && !selection->subset &&
           is_known(sweep);
}

bool sphgi_reads_records(const struct sphgi_sweep *sweep)
{
    return sweep->may_read_records && (int64_t)groups_without(sweep) * WORTH <=
                                        sphgi_group_count(sweep->set->neighbors->target_count);
}

size_t sphgi_record_bytes(const struct sphgi_sweep *sweep)
{
    const size_t records = (size_t)sweep->set->neighbors->source_count + 1;
    return field_of(sweep) ? records * record_size(sweep) : 0;
}

/* ---- Packing --------------------------------------------------------------------------------- */

struct packing {
    const struct sphgi_sweep *sweep;
    char *records;
    atomic_bool bad_volume;
};

static void pack_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct packing *packing = data;
    const struct sphgi_sweep *sweep = packing->sweep;
    const struct sphgi_field_plan *field = field_of(sweep);
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = sphgi_size_of_type(sweep->plan->type);
    const int32_t d = sweep->plan->dimension, width = width_of(sweep);
    const int32_t *order = n->sources.order.data;
    char *to = packing->records + (size_t)begin * record_size(sweep);
    (void)worker;
    sweep->passes->put_records((const char *)n->sources.rows.data +
                                   (size_t)begin * SPHGI_ROW * size,
                               field->fold ? NULL : &sweep->set->streams[field->stream].columns,
                               order + begin, end - begin, d, width, to);
    if (field->fold &&
        !sphgi_fold_records(sweep, field, order, begin, end, to + (size_t)d * size, width))
        atomic_store(&packing->bad_volume, true);
}

/* Where the dummy is, with a field of 0. */
static void put_dummy(const struct sphgi_sweep *sweep, char *record)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = sphgi_size_of_type(sweep->plan->type);
    memset(record, 0, record_size(sweep));
    memcpy(record, (const char *)n->sources.rows.data + (size_t)n->source_count * SPHGI_ROW * size,
           (size_t)sweep->plan->dimension * size);
}

sphg_result sphgi_pack_records(struct sphgi_sweep *sweep, bool *bad_volume)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t bytes = sphgi_record_bytes(sweep);
    sweep->records = n->sources.rows.data;
    if (!bytes)
        return SPHG_OK;
    if (!sphgi_reserve(&sweep->context->allocator, &sweep->context->packed, bytes, 1))
        return SPHG_ERROR_MEMORY;
    struct packing packing = {.sweep = sweep, .records = sweep->context->packed.data};
    atomic_store(&packing.bad_volume, false);
    sphgi_parallel_for(sweep->context, pack_task, &packing, n->source_count, PACK_GRAIN);
    put_dummy(sweep, packing.records + (size_t)n->source_count * record_size(sweep));
    sweep->records = packing.records;
    *bad_volume |= atomic_load(&packing.bad_volume);
    return SPHG_OK;
}

struct sphgi_record_sums sphgi_record_sums(const struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_field_plan *field = field_of(sweep);
    struct sphgi_record_sums sums = {.gather = &w->gather,
                                     .records = sweep->records,
                                     .dimension = sweep->plan->dimension,
                                     .moments = sums_moments(sweep)};
    if (!field)
        return sums;
    sums.shape = field->shape;
    sums.divergence = field->sums_divergence;
    sums.fold = field->fold;
    sums.dense = is_dense(field);
    sums.own = field->antisymmetric ? -1 : field->form == SPHG_DIFFERENCE;
    return sums;
}
