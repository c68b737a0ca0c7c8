/* SPDX-License-Identifier: MIT */
#include "worker.h"
#include "core/kernel.h"
#include "core/view.h"
#include <string.h>

/* Classic gradients, L_ij of diffusion, and gradients pair by pair, need the target's coefficients
 * before they can be formed; other sums are multiplied with them at the end. */
static bool needs_coefficients_first(const struct sphgi_sweep *sweep)
{
    const struct sphgi_plan *plan = sweep->plan;
    if (sweep->steps & SPHGI_SUM_SLOPES)
        return true;
    return (plan->classic || plan->diffuses || sweep->pairs) && (sweep->steps & SPHGI_SUM_FIELDS) &&
           plan->corrects;
}

bool sphgi_is_summed_in_rounds(const struct sphgi_sweep *sweep)
{
    return (sweep->steps & SPHGI_SUM_MOMENTS) && needs_coefficients_first(sweep);
}

int32_t sphgi_tiles_of(const struct sphgi_sweep *sweep)
{
    return sweep->packed && sphgi_is_summed_in_rounds(sweep) ? SPHGI_TILES_HELD : 1;
}

/* Lays out the memory of one worker. Returns the bytes. */
static size_t lay_out(struct sphgi_worker *w, const struct sphgi_sweep *sweep, char *base)
{
    const struct sphgi_plan *plan = sweep->plan;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = sphgi_size_of_type(plan->type);
    const size_t position = sphgi_size_of_type(n->position_type);
    const size_t local = sweep->packed ? 0 : SPHGI_TILE + 1;
    const size_t tiles = (size_t)sphgi_tiles_of(sweep);
    const size_t arrays = (size_t)plan->row_count, row = SPHGI_ROW * size;
    const size_t numbers = plan->quadratic ? (size_t)sphgi_plan_width(plan) : 16;
    const size_t lending = plan->lends ? SPHGI_WIDTH : 0;
    struct sphgi_layout layout = {base, 0};
#define PLACE(member, count, bytes) w->member = sphgi_place(&layout, count, bytes)
    PLACE(tally, 1, sizeof(struct sphgi_tally));
    PLACE(rows.at, arrays + 1, sizeof(void *));
    PLACE(rows.positions, local, SPHGI_ROW * position);
    PLACE(rows.numbers, local * arrays, row);
    PLACE(rows.copies, local ? SPHGI_MIXED_MOST + 1 : 0, sizeof(struct sphgi_copies));
    PLACE(held.tile, tiles, sizeof(struct sphgi_held_tile));
    PLACE(held.arrays, tiles * SPHGI_ARRAYS * SPHGI_TILE, size);
    PLACE(held.own_ids, tiles * SPHGI_TILE, sizeof(uint32_t));
    PLACE(rows.clean_ids, SPHGI_TILE, sizeof(uint32_t));
    PLACE(rows.own_items, SPHGI_TILE, sizeof(uint32_t));
    PLACE(waiting.ids, n->kind == SPHGI_HOST_LISTS && !n->lists.row ? 0 : SPHGI_WAITING_IDS,
          sizeof(uint32_t));
    PLACE(reduced, SPHGI_SECTIONS * (size_t)plan->sums * SPHGI_WIDTH, size);
    PLACE(own.field, (size_t)plan->target_lanes * SPHGI_WIDTH, size);
    PLACE(own.opposite, plan->mirrors ? (size_t)plan->target_lanes * SPHGI_WIDTH : 0, size);
    PLACE(raw, numbers * SPHGI_WIDTH, size);
    PLACE(coefficients, numbers * SPHGI_WIDTH, size);
    PLACE(lambda_min, SPHGI_WIDTH, size);
    PLACE(own.volume, SPHGI_WIDTH, size);
    PLACE(own.density, SPHGI_WIDTH, size);
    PLACE(self, SPHGI_WIDTH, size);
    PLACE(zeros, 16 * SPHGI_WIDTH, size);
    PLACE(jacobian, 27 * SPHGI_WIDTH, size);
    PLACE(contracted, 6 * SPHGI_WIDTH, size);
    PLACE(extra, 8 * SPHGI_WIDTH, size);
    PLACE(radii.ratio, plan->graded ? SPHGI_WIDTH : 0, size);
    PLACE(radii.inverse, plan->graded ? SPHGI_WIDTH : 0, size);
    PLACE(radii.inverse_square, plan->graded ? SPHGI_WIDTH : 0, size);
    PLACE(radii.factor, plan->graded ? SPHGI_WIDTH : 0, size);
    PLACE(radii.table_units, plan->graded ? 3 * SPHGI_TABLE_UNITS * SPHGI_WIDTH : 0, size);
    PLACE(curvature.share_kept, plan->quadratic ? SPHGI_WIDTH : 0, size);
    PLACE(curvature.hessian, plan->quadratic ? (SPHGI_HESSIANS + 9) * SPHGI_WIDTH : 0, size);
    PLACE(lending.linear, 6 * lending, size);
    PLACE(lending.moment_scale, lending, size);
    PLACE(lending.confidence, lending, size);
    PLACE(lending.lent_confidence, lending, size);
    PLACE(lending.lent, (SPHGI_HESSIANS + 1) * lending, size);
    PLACE(lending.borrowed, numbers * lending, size);
    PLACE(lending.prior, 21 * lending, size);
    PLACE(lending.transport, 18 * lending, size);
    PLACE(finder_memory, n->kind == SPHGI_SEARCHED ? sphgi_finder_size(n) : 0, 1);
#undef PLACE
    return layout.used;
}

size_t sphgi_worker_size(const struct sphgi_sweep *sweep)
{
    struct sphgi_worker measured;
    return lay_out(&measured, sweep, NULL);
}

/* Of order 2: second derivatives, or a table of all numbers. */
static bool wants_second(const struct sphgi_sweep *sweep)
{
    const struct sphgi_plan *plan = sweep->plan;
    bool wanted = plan->correction.count || plan->lends || sweep->coefficients;
    for (int32_t k = 0; k < plan->field_count; ++k)
        wanted |= plan->fields[k].hessian[0].count || plan->fields[k].laplacian.count;
    return wanted;
}

/* Linearised methods sum in the units of the positions, classic ones and order 2 in units of H:
 * their sums mix powers of the offsets. */
static void open_scheme(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_scheme *scheme = &plan->scheme;
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const int32_t d = plan->dimension;
    const double h = scheme->radius;
    const bool scaled = plan->classic || plan->quadratic;
    w->gather = (struct sphgi_gather){.unit = scaled ? 1 / h : 1,
                                      .cutoff = h,
                                      .periodic = n->periodic,
                                      .volumes = w->sweep->volumes,
                                      .volume = w->sweep->volume,
                                      .dimension = d};
    memcpy(w->gather.period, n->period, sizeof n->period);
    w->gather.radii = plan->graded;
    w->gather.all = n->mutual && (w->sweep->pairs || plan->both_sides);
    if (plan->graded && scaled)
        w->gather.unit = 0;
    w->gather.keeps = scaled && plan->both_sides;
    w->gather.superset = sphgi_is_superset(w->sweep);
    w->gather.masked = sphgi_is_masked(w->sweep);
    w->shape =
        (struct sphgi_shape){.kernel = scheme->kernel,
                             .method = scheme->method == SPHG_PLAIN ? SPHG_KGC : scheme->method,
                             .dimension = d,
                             .inverse_h = scaled ? 1 : 1 / h,
                             .w_scale = sphgi_factor_of_h(scheme) / (plan->quadratic ? 1 : h),
                             .value_scale = sphgi_kernel_sigma(scheme->kernel, d)};
    w->factor_of_h = sphgi_factor_of_h(scheme);
    w->gather.target_rows = sphgi_target_row(n, 0);
    w->threshold = (struct sphgi_threshold){.policy = scheme->policy,
                                            .eps = scheme->threshold,
                                            .dimension = d,
                                            .unit = plan->quadratic ? 1 : 1 / h};
    if (plan->quadratic)
        w->second = sphgi_second_of(scheme);
    w->second.whole = wants_second(w->sweep);
}

void sphgi_worker_open(struct sphgi_worker *w, const struct sphgi_sweep *sweep, int32_t number)
{
    *w = (struct sphgi_worker){.sweep = sweep, .passes = sweep->passes};
    w->batch.lists = &w->batch.own_lists;
    lay_out(w, sweep, sweep->memory + (size_t)number * sweep->memory_each);
    open_scheme(w);
    w->inverse_h = 1 / sweep->plan->scheme.radius;
    sphgi_table_units(sweep->plan, w->table_units);
    w->coefficients_first = needs_coefficients_first(sweep);
    w->tile.section = (ptrdiff_t)sweep->plan->sums * SPHGI_WIDTH;
    memset(w->zeros, 0, (size_t)(sphgi_lane(w, w->zeros, 16) - w->zeros));
    w->factors_at_once = sphgi_forms_factors_alone(sweep);
    w->both_as_gathered = sphgi_weighs_both_at_once(sweep);
    w->near_as_gathered = sphgi_weighs_near_at_once(sweep);
}
