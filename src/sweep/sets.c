/* SPDX-License-Identifier: MIT */
#include "sets.h"
#include "core/view.h"
#include "set.h"
#include <string.h>

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
            result = sphgi_sweep_set(task, selection, tally);
    }
    return result;
}

static sphg_result sweep_last(struct sphgi_task *task, struct sphgi_selection *selection,
                              unsigned steps, struct sphgi_tally *tally)
{
    task->sweep.set_number = last_set(task->sweep.plan);
    task->sweep.steps = steps | SPHGI_FINISH;
    return sphgi_sweep_set(task, selection, tally);
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

/* All targets through all sets, step by step. */
static sphg_result sweep_over_table(struct sphgi_task *task, struct sphgi_selection *selection,
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
 * whoever has no moments in a set has nothing there, unless radii of sources count, too. Every
 * sweep runs, also where nobody has a turn: what memory they need depends on counts alone. */
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

sphg_result sphgi_sweep_sets(struct sphgi_task *task, struct sphgi_selection *selection,
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
    const bool table = plan->both_sides ? slopes || plan->diffuses : plan->diffuses;
    const sphg_result result =
        several && table && moments && fields ? sweep_over_table(task, selection, steps, tally)
        : several && slopes                   ? sweep_classic_sets(task, selection, steps, tally)
                                              : sweep_sets(task, selection, steps, tally);
    close_put_away(sweep, result || tally->bad_target >= 0);
    return result;
}
