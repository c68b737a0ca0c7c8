/* SPDX-License-Identifier: MIT */
#include "sweep.h"
#include "core/digits.h"
#include "core/parallel.h"
#include "rows.h"
#include "host_lists.h"
#include "traverse.h"
#include "core/view.h"
#include <math.h>
#include <string.h>

enum {
    LEAST_TARGETS = 512, /* of a task: fewer are not worth a thread */
    PACK_WORTH = 16      /* fields are packed for a 16th of as many targets, or more */
};

/* ---- One sweep ------------------------------------------------------------------------------ */

/* Memory for the workers, tallies cleared. */
static bool open_workers(struct sphgi_sweep *sweep)
{
    sphg_context *context = sweep->context;
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

static bool is_bad_volume(const struct sphgi_columns *volume, sphg_type type, int64_t item,
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
    tally->bad_volume |= is_bad_volume(volume, sweep->plan->type, 0, &value);
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
    if (!sphgi_forms_factors_alone(sweep) || sphgi_is_masked(sweep) || sweep->plan->quadratic)
        return (struct sphgi_kept_weights){.number = 0};
    return sphgi_weights_take(sweep->set->neighbors, &of, sweep->set->same_volumes);
}

static sphg_result sweep_set(struct sphgi_task *task, struct sphgi_selection *selection,
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
    const bool ready =
        !(sweep->packed && sphgi_pack(sweep, &tally->bad_volume)) && open_workers(sweep);
    if (ready)
        sweep->kept = take_weights(sweep);
    if (ready && searched)
        sphgi_parallel_for(context, sphgi_group_task, task, groups, LEAST_TARGETS / SPHGI_GROUP);
    else if (ready)
        sphgi_parallel_for(context, sphgi_list_task, task, items, LEAST_TARGETS);
    if (some)
        sphgi_selection_close(selection, n);
    if (!ready)
        return SPHG_ERROR_MEMORY;
    close_workers(sweep, tally);
    sphgi_weights_give_back(n, &sweep->kept, !tally->bad_volume);
    return SPHG_OK;
}

/* The set whose sweep writes the results: that of the targets themselves, which most pairs are of.
 */
static int32_t last_set(const struct sphgi_plan *plan)
{
    return plan->own_set < 0 ? 0 : plan->own_set;
}

/* The sums of all other sets are put away. */
static sphg_result sweep_others(struct sphgi_task *task, struct sphgi_selection *selection,
                                unsigned steps, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    const int32_t last = last_set(sweep->plan);
    sphg_result result = SPHG_OK;
    sweep->steps = steps;
    for (int32_t s = 0; s < sweep->plan->set_count && !result; ++s) {
        sweep->set_number = s;
        if (s != last)
            result = sweep_set(task, selection, tally);
    }
    return result;
}

static sphg_result sweep_last(struct sphgi_task *task, struct sphgi_selection *selection,
                              unsigned steps, struct sphgi_tally *tally)
{
    task->sweep.set_number = last_set(task->sweep.plan);
    task->sweep.steps = steps | SPHGI_FINISH;
    return sweep_set(task, selection, tally);
}

static sphg_result sweep_sets(struct sphgi_task *task, struct sphgi_selection *selection,
                              unsigned steps, struct sphgi_tally *tally)
{
    const sphg_result result = sweep_others(task, selection, steps, tally);
    return result ? result : sweep_last(task, selection, steps, tally);
}

/* Room for what later steps need of the earlier, by counts alone. */
static bool open_table(struct sphgi_sweep *sweep, struct sphgi_columns *table)
{
    sphg_context *context = sweep->context;
    const struct sphgi_plan *plan = sweep->plan;
    const int32_t width = sphgi_plan_width(plan);
    if (!sphgi_reserve(&context->allocator, &context->coefficients,
                       (size_t)plan->target_count * (size_t)width, sphgi_size_of_type(plan->type)))
        return false;
    *table = sphgi_dense_columns(context->coefficients.data, width, width, plan->type);
    return true;
}

/* One step after the other, each over all sets. begun: the other sets' sums of the first one are
 * put away. */
static sphg_result sweep_by_steps(struct sphgi_task *task, struct sphgi_selection *selection,
                                  unsigned steps, bool begun, struct sphgi_tally *tally)
{
    sphg_result result = SPHG_OK;
    for (unsigned left = steps; left && !result; left &= left - 1)
        result = left == steps && begun ? sweep_last(task, selection, left & -left, tally)
                                        : sweep_sets(task, selection, left & -left, tally);
    return result;
}

static sphg_result sweep_diffusion_sets(struct sphgi_task *task, struct sphgi_selection *selection,
                                        unsigned steps, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    struct sphgi_columns table;
    if (!open_table(sweep, &table))
        return SPHG_ERROR_MEMORY;
    sweep->coefficients = &table;
    const sphg_result result = sweep_by_steps(task, selection, steps, false, tally);
    sweep->coefficients = NULL;
    return result;
}

/* Who has sums put away. */
static bool see_who_waits(struct sphgi_sweep *sweep)
{
    sphg_context *context = sweep->context;
    const size_t targets = (size_t)sweep->plan->target_count;
    if (!sphgi_reserve(&context->allocator, &context->waits, targets + 1, 1))
        return false;
    uint8_t *waits = context->waits.data;
    memcpy(waits, sweep->put_away.marks, targets);
    sweep->turn = (struct sphgi_turn){.waits = waits, .whose = 0};
    return true;
}

/* Targets far from all other sets are done by a single sweep, in rounds. Weights are not negative:
 * whoever has no moments in a set has nothing there. Every sweep runs, also where nobody has a
 * turn: what memory they need depends on counts alone. */
static sphg_result sweep_classic_sets(struct sphgi_task *task, struct sphgi_selection *selection,
                                      unsigned steps, struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    struct sphgi_columns table;
    if (!open_table(sweep, &table))
        return SPHG_ERROR_MEMORY;
    sphg_result result = sweep_others(task, selection, SPHGI_SUM_MOMENTS, tally);
    if (!result && !see_who_waits(sweep))
        result = SPHG_ERROR_MEMORY;
    if (!result)
        result = sweep_last(task, selection, steps, tally);
    sweep->turn.whose = 1;
    sweep->coefficients = &table;
    if (!result)
        result = sweep_by_steps(task, selection, steps, true, tally);
    sweep->coefficients = NULL;
    sweep->turn.waits = NULL;
    return result;
}

static bool open_put_away(struct sphgi_sweep *sweep)
{
    sphg_context *context = sweep->context;
    const struct sphgi_plan *plan = sweep->plan;
    const size_t targets = (size_t)plan->target_count, before = context->marks.size;
    if (plan->set_count == 1)
        return true;
    if (!sphgi_reserve(&context->allocator, &context->sums, targets * (size_t)plan->sums,
                       sphgi_size_of_type(plan->type)) ||
        !sphgi_reserve(&context->allocator, &context->marks, targets + 1, 1))
        return false;
    if (context->marks.size != before)
        memset(context->marks.data, 0, context->marks.size);
    sweep->put_away = (struct sphgi_put_away){context->sums.data, context->marks.data};
    return true;
}

/* Targets that were refused on the way still have a mark. */
static void close_put_away(const struct sphgi_sweep *sweep, bool failed)
{
    if (failed && sweep->put_away.marks)
        memset(sweep->put_away.marks, 0, (size_t)sweep->plan->target_count);
}

static sphg_result sweep_all(struct sphgi_task *task, struct sphgi_selection *selection,
                             struct sphgi_tally *tally)
{
    struct sphgi_sweep *sweep = &task->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const unsigned moments = plan->computes ? SPHGI_SUM_MOMENTS : 0u;
    const unsigned slopes = plan->computes && plan->classic ? SPHGI_SUM_SLOPES : 0u;
    const unsigned fields = plan->field_count || sweep->pairs ? SPHGI_SUM_FIELDS : 0u;
    const unsigned steps = moments | slopes | fields;
    if (!open_put_away(sweep))
        return SPHG_ERROR_MEMORY;
    const bool several = plan->set_count > 1;
    const sphg_result result = several && slopes ? sweep_classic_sets(task, selection, steps, tally)
                               : several && plan->diffuses && moments && fields
                                   ? sweep_diffusion_sets(task, selection, steps, tally)
                                   : sweep_sets(task, selection, steps, tally);
    close_put_away(sweep, result || tally->bad_target >= 0);
    return result;
}

/* ---- Errors found on the way ---------------------------------------------------------------- */

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
                              "%s: sources[%d].volume[%d] is %s, %s", checker.function, (int)s,
                              (int)k, sphgi_digits(value).text, rule);
    }
    const int32_t k =
        first_bad_volume(&plan->target_volume, plan->type, plan->target_count, &value);
    return sphgi_fail(checker.context, SPHG_ERROR_VOLUME, "%s: target_volume[%d] is %s, %s",
                      checker.function, (int)k, sphgi_digits(value).text, rule);
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
    struct sphgi_task task = {.sweep = {.context = context,
                                        .plan = plan,
                                        .set = plan->sets,
                                        .pairs = pairs,
                                        .passes = sphgi_passes_of(context, plan->type)},
                              .selection = &selection};
    struct sphgi_tally tally;
    sphgi_tally_clear(&tally);
    if (sweep_all(&task, &selection, &tally))
        return sphgi_fail_memory(context, checker.function);
    if (plan->stats)
        *plan->stats = sphgi_tally_stats(&tally, plan->type);
    if (tally.bad_target >= 0)
        return sphgi_refuse_list(checker, tally.bad_target, tally.bad_index);
    if (tally.bad_volume && !context->config.trusted)
        return report_volume(checker, plan);
    return SPHG_OK;
}
