/* SPDX-License-Identifier: MIT */
#include "records.h"
#include "fold.h"
#include "own.h"
#include <string.h>

enum {
    FAR_BYTES = 8 << 20, /* what is more is written past the caches */
    WORTH = 16           /* groups, of which one may be left to the sweep that comes after */
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

/* Coordinates stand in records only where factors need not be formed of them. */
static int32_t axes_of(const struct sphgi_sweep *sweep)
{
    return sweep->weights_stand ? sweep->plan->dimension : 0;
}

static int32_t width_of(const struct sphgi_sweep *sweep)
{
    return sphgi_record_width(axes_of(sweep), numbers_of(sweep));
}

size_t sphgi_record_size(const struct sphgi_sweep *sweep)
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

/* Where weights are yet to be formed, what is a row or less goes by rows as well. */
static bool is_worth_two_loops(const struct sphgi_sweep *sweep)
{
    const struct sphgi_field_plan *field = field_of(sweep);
    return field && sweep->plan->dimension == 3 &&
           (field->fold || field->shape == SPHG_SYM_TENSOR) && numbers_of(sweep) > SPHGI_ROW &&
           !sums_moments(sweep) && sphgi_forms_factors_alone(sweep) && !sphgi_is_masked(sweep);
}

/* They have no list beside those of fifteen others. */
static int32_t groups_apart(const sphg_neighbors *n)
{
    const int32_t full = n->list_free ? 0 : n->target_count / SPHGI_GROUP;
    int32_t without = sphgi_group_count(n->target_count) - full;
    for (int32_t k = 0; k < full; ++k)
        without += !sphgi_is_kept(n, k) || sphgi_kept_steps(n, k) == SPHGI_APART;
    return without;
}

static int32_t groups_without_weights(const struct sphgi_sweep *sweep)
{
    const uint32_t *marks = sweep->kept.marks, number = sweep->kept.number;
    const int32_t groups = sphgi_group_count(sweep->set->neighbors->target_count);
    int32_t without = 0;
    for (int32_t k = 0; k < groups; ++k)
        without += marks[k] != number;
    return without;
}

bool sphgi_may_read_records(const struct sphgi_sweep *sweep,
                            const struct sphgi_selection *selection)
{
    return sweep->passes->sum_records && sweep->set->neighbors->kind != SPHGI_HOST_LISTS &&
           !selection->subset && is_known(sweep) &&
           (sweep->kept.number || is_worth_two_loops(sweep));
}

bool sphgi_reads_records(struct sphgi_sweep *sweep)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const int32_t few = sphgi_group_count(n->target_count) / WORTH;
    if (!sweep->may_read_records)
        return false;
    sweep->groups_left = sweep->kept.number ? groups_without_weights(sweep) : INT32_MAX;
    sweep->weights_stand = sweep->groups_left <= few;
    if (!sweep->weights_stand)
        sweep->groups_left = is_worth_two_loops(sweep) ? groups_apart(n) : INT32_MAX;
    return sweep->groups_left <= few;
}

/* With or without coordinates. */
size_t sphgi_record_bytes(const struct sphgi_sweep *sweep)
{
    struct sphgi_sweep most = *sweep;
    const size_t records = (size_t)sweep->set->neighbors->source_count + 1;
    most.weights_stand = true;
    return field_of(sweep) ? records * sphgi_record_size(&most) : 0;
}

/* ---- Packing --------------------------------------------------------------------------------- */

bool sphgi_fill_records(const struct sphgi_sweep *sweep, const int32_t *order, int64_t begin,
                        int64_t end, char *to)
{
    const struct sphgi_field_plan *field = sweep->plan->fields; /* there is one */
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = sphgi_size_of_type(sweep->plan->type);
    const int32_t axes = axes_of(sweep), width = width_of(sweep);
    const char *rows = (const char *)n->sources.rows.data + (size_t)begin * SPHGI_ROW * size;
    if (axes || !field->fold)
        sweep->passes->put_records(
            rows, field->fold ? NULL : &sweep->set->streams[field->stream].columns, order + begin,
            end - begin, axes, width, sphgi_record_bytes(sweep) > FAR_BYTES, to);
    return !field->fold ||
           sphgi_fold_records(sweep, field, order, begin, end, to + (size_t)axes * size, width);
}

char *sphgi_put_dummy_record(const struct sphgi_sweep *sweep, char *records)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = sphgi_size_of_type(sweep->plan->type), sources = (size_t)n->source_count;
    char *dummy = records + sources * sphgi_record_size(sweep);
    memset(dummy, 0, sphgi_record_size(sweep));
    memcpy(dummy, (const char *)n->sources.rows.data + sources * SPHGI_ROW * size,
           (size_t)axes_of(sweep) * size);
    return records;
}

struct sphgi_record_sums sphgi_record_sums(const struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_field_plan *field = field_of(sweep);
    struct sphgi_record_sums sums = {.gather = &w->gather,
                                     .records = sweep->records,
                                     .dimension = sweep->plan->dimension,
                                     .apart = !sweep->weights_stand,
                                     .moments = sums_moments(sweep)};
    if (sums.moments)
        sums.moment_sums = sphgi_lane(w, w->reduced, sweep->plan->moment_sum);
    if (!field)
        return sums;
    sums.sums = sphgi_lane(w, w->reduced, sphgi_first_sum(field));
    sums.shape = field->shape;
    sums.divergence = field->sums_divergence;
    sums.fold = field->fold;
    sums.dense = is_dense(field);
    if (sums.fold)
        sums.vectors = sphgi_lane(w, w->reduced, sweep->plan->folded_sum[sums.dense]);
    sums.own = field->antisymmetric ? -1 : field->form == SPHG_DIFFERENCE;
    return sums;
}
