/* SPDX-License-Identifier: MIT */
#include "job.h"
#include "core/kernel.h"

double sphgi_volume_unit(const struct sphgi_sweep *sweep)
{
    return sphgi_power(1 / sweep->plan->scheme.radius, sweep->plan->dimension);
}

struct sphgi_sums sphgi_sums_of(const struct sphgi_plan *plan, unsigned steps)
{
    const int32_t first = steps & SPHGI_SUM_MOMENTS  ? 0
                          : steps & SPHGI_SUM_SLOPES ? plan->slope_sum
                                                     : plan->moment_sums;
    const int32_t end = steps & SPHGI_SUM_FIELDS   ? plan->sums
                        : steps & SPHGI_SUM_SLOPES ? plan->moment_sums
                                                   : plan->slope_sum;
    return (struct sphgi_sums){first, end - first};
}

bool sphgi_must_finish(const struct sphgi_sweep *sweep)
{
    return sweep->pairs || (sweep->steps & SPHGI_FINISH);
}

bool sphgi_is_superset(const struct sphgi_sweep *sweep)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    if (sweep->plan->graded)
        return n->kind == SPHGI_HOST_LISTS || n->skin > 0 ||
               (n->mutual && !sweep->pairs && !sweep->plan->both_sides);
    return n->kind == SPHGI_HOST_LISTS || n->skin > 0 || sweep->plan->scheme.radius < n->radius;
}

bool sphgi_is_masked(const struct sphgi_sweep *sweep)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    return sphgi_is_superset(sweep) || n->periodic || !n->dummy_is_far;
}

bool sphgi_forms_factors_alone(const struct sphgi_sweep *sweep)
{
    const struct sphgi_plan *plan = sweep->plan;
    const sphg_neighbors *n = sweep->set->neighbors;
    const bool tested = plan->quadratic ? sphgi_is_masked(sweep) : n->periodic;
    return (sweep->packed || !sphgi_is_masked(sweep)) && !plan->both_sides && !tested &&
           !plan->classic && !plan->wants_value && !plan->mean_volume &&
           (plan->differentiates || plan->computes) && n->position_type == plan->type;
}

bool sphgi_weighs_near_at_once(const struct sphgi_sweep *sweep)
{
    const struct sphgi_plan *plan = sweep->plan;
    const sphg_neighbors *n = sweep->set->neighbors;
    return plan->narrows && !plan->classic && !plan->quadratic && !n->periodic &&
           !plan->wants_value && n->position_type == plan->type;
}

bool sphgi_sorts_out_pairs(const struct sphgi_sweep *sweep)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    if (sweep->plan->both_sides)
        return sphgi_is_superset(sweep) && !sweep->plan->both_first;
    return sweep->pairs && sweep->plan->graded && n->mutual && sphgi_is_superset(sweep);
}

bool sphgi_weighs_both_at_once(const struct sphgi_sweep *sweep)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    return !n->periodic && n->position_type == sweep->plan->type;
}
