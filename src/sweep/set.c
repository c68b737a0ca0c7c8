/* SPDX-License-Identifier: MIT */
#include "set.h"
#include "core/parallel.h"
#include "core/view.h"
#include "host_lists.h"
#include "records.h"
#include "rows.h"
#include "traverse.h"
#include <math.h>

enum {
    LEAST_TARGETS = 512, /* of a task: fewer are not worth a thread */
    PACK_WORTH = 40      /* fields are packed for a 40th of as many targets, or more */
};

/* Groups that have no weights yet are swept over rows that are copied, which takes more. */
static size_t memory_of_worker(const struct sphgi_sweep *sweep)
{
    struct sphgi_sweep local = *sweep;
    local.packed &= !sweep->may_read_records;
    return sphgi_worker_size(&local);
}

/* Memory for the workers, tallies cleared. */
static bool open_workers(struct sphgi_sweep *sweep)
{
    sphg_context *context = sweep->context;
    sweep->memory_each = memory_of_worker(sweep);
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

bool sphgi_is_bad_volume(const struct sphgi_columns *volume, sphg_type type, int64_t item,
                         double *value)
{
    const char *at = volume->at[0] + item * volume->stride;
    *value = type == SPHG_F64 ? *(const double *)(const void *)at
                              : (double)*(const float *)(const void *)at;
    return !(*value >= 0) || !isfinite(*value);
}

/* One volume for all sources needs no place in their rows; rounded like those that have one. */
static void look_at_volumes(struct sphgi_sweep *sweep, struct sphgi_tally *tally)
{
    const struct sphgi_columns *volume = &sweep->set->volume;
    const double unit = sphgi_volume_unit(sweep);
    double value = 0;
    sweep->volumes = volume->count && volume->stride && !sweep->plan->both_alone;
    sweep->volume = 0;
    if (!volume->count || volume->stride)
        return;
    tally->bad_volume |= sphgi_is_bad_volume(volume, sweep->plan->type, 0, &value);
    sweep->volume =
        sweep->plan->type == SPHG_F64 ? value * unit : (double)((float)value * (float)unit);
}

static struct sphgi_kept_weights take_weights(const struct sphgi_sweep *sweep)
{
    const struct sphgi_scheme *scheme = &sweep->plan->scheme;
    const struct sphgi_weights_of of = {.kernel = scheme->kernel,
                                        .method = scheme->method == SPHG_PLAIN ? SPHG_KGC
                                                                               : scheme->method,
                                        .radius = scheme->radius,
                                        .volume = sweep->volumes ? -1 : sweep->volume};
    const struct sphgi_columns *volume = &sweep->set->volume;
    const bool same = sweep->set->same_volumes || !volume->count || !volume->stride;
    if (!sweep->packed || !sphgi_forms_factors_alone(sweep) || sphgi_is_masked(sweep) ||
        sweep->plan->quadratic) {
        sphgi_weights_pass(sweep->set->neighbors, same);
        return (struct sphgi_kept_weights){.number = 0};
    }
    return sphgi_weights_take(sweep->set->neighbors, &of, same);
}

/* Over so many groups, or of the host's lists so many targets. */
static bool sweep_targets(struct sphgi_task *task, int32_t count, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    if (!open_workers(sweep))
        return false;
    if (sweep->set->neighbors->kind != SPHGI_HOST_LISTS)
        sphgi_parallel_for(sweep->context, sphgi_group_task, task, count,
                           LEAST_TARGETS / SPHGI_GROUP);
    else
        sphgi_parallel_for(sweep->context, sphgi_list_task, task, count, LEAST_TARGETS);
    close_workers(sweep, tally);
    return true;
}

static bool sweep_rows(struct sphgi_task *task, int32_t count, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    return !(sweep->packed && sphgi_pack(sweep, &tally->bad_volume)) &&
           sweep_targets(task, count, tally);
}

/* The rows of the few groups that do not go by records are copied one by one. Weights that are
 * formed meanwhile change nothing about who they are. */
static bool sweep_records(struct sphgi_task *task, int32_t groups, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    sweep->groups = SPHGI_GROUPS_BY_RECORDS;
    bool done = sweep_rows(task, groups, tally);
    sweep->records = NULL;
    sweep->reads_records = false;
    sweep->groups = SPHGI_OTHER_GROUPS;
    if (done && sweep->groups_left) {
        sweep->packed = false;
        done = sweep_targets(task, groups, tally);
    }
    sweep->groups = SPHGI_ALL_GROUPS;
    return done;
}

sphg_result sphgi_sweep_set(struct sphgi_task *task, struct sphgi_selection *selection,
                            struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    sphg_context *context = sweep->context;
    sweep->set = &sweep->plan->sets[sweep->set_number];
    const sphg_neighbors *n = sweep->set->neighbors;
    const int32_t items = selection->end - selection->begin;
    const bool searched = n->kind != SPHGI_HOST_LISTS, some = searched && selection->subset;
    sweep->position_passes = sphgi_passes_of(context, n->position_type);
    look_at_volumes(sweep, tally);
    if (some && !sphgi_selection_open(context, selection, n))
        return SPHG_ERROR_MEMORY;
    const int32_t active = some ? selection->active_count : items;
    const int32_t groups = some ? selection->group_count : sphgi_group_count(n->target_count);
    const bool nothing_to_pack = !sweep->volumes && !sphgi_rows_read(sweep);
    sweep->packed = nothing_to_pack || sweep->plan->both_sides || sphgi_sorts_out_pairs(sweep) ||
                    (int64_t)active * PACK_WORTH >= n->source_count;
    sweep->kept = take_weights(sweep);
    sweep->may_read_records = sphgi_may_read_records(sweep, selection);
    sweep->reads_records = sphgi_reads_records(sweep);
    const bool done = sweep->reads_records ? sweep_records(task, groups, tally)
                                           : sweep_rows(task, searched ? groups : items, tally);
    if (some)
        sphgi_selection_close(selection);
    sphgi_weights_give_back(n, &sweep->kept, done && !tally->bad_volume);
    return done ? SPHG_OK : SPHG_ERROR_MEMORY;
}
