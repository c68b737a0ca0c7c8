/* SPDX-License-Identifier: MIT */
#include "sweep.h"
#include "core/digits.h"
#include "set.h"
#include "sets.h"
#include "core/view.h"

/* ---- Errors found on the way ---------------------------------------------------------------- */

static int32_t first_bad_volume(const struct sphgi_columns *volume, sphg_type type, int32_t count,
                                double *value)
{
    for (int32_t k = 0; volume->count && k < count; ++k)
        if (sphgi_is_bad_volume(volume, type, k, value))
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
    if (sphgi_sweep_sets(&task, &selection, &tally))
        return sphgi_fail_memory(context, checker.function);
    if (plan->stats)
        *plan->stats = sphgi_tally_stats(&tally, plan->type);
    if (tally.bad_target >= 0)
        return sphgi_refuse_list(checker, tally.bad_target, tally.bad_index);
    if (tally.bad_volume && !context->config.trusted)
        return report_volume(checker, plan);
    return SPHG_OK;
}
