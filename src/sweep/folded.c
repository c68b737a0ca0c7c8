/* SPDX-License-Identifier: MIT */
#include "folded.h"
#include "core/view.h"

void sphgi_sum_folded(struct sphgi_worker *w, int32_t number)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_field_plan *field = &plan->fields[number];
    const bool symmetric = field->form == SPHG_SYMMETRIC,
               carrier = plan->carrier[symmetric] == number;
    const int32_t sum = field->sums_divergence ? field->divergence_sum : field->sum;
    w->passes->sum_folded(&w->tile, plan->dimension, field->fold,
                          carrier && (symmetric || plan->both_sides),
                          plan->both_sides ? SPHGI_D : SPHGI_S, w->rows.at + field->folded_row,
                          sphgi_lane(w, w->reduced, sum),
                          carrier ? sphgi_lane(w, w->reduced, plan->folded_sum[symmetric]) : NULL);
}

/* The volume of all stands where a guard puts radii. */
static void weigh_pairs(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_passes *p = w->passes;
    const size_t size = sphgi_size_of_type(sweep->plan->type);
    if (w->both_as_gathered) {
        p->gather_both(&w->both, &w->shape, sphgi_places(w), &w->tile);
        return;
    }
    sweep->position_passes->gather[sweep->plan->type == SPHG_F64](&w->both, sphgi_places(w),
                                                                  p->lanes, &w->tile);
    p->weigh_both(&w->shape, &w->tile);
    if (!sweep->volumes)
        p->fill(w->tile.steps * p->lanes, sweep->volume,
                (char *)w->tile.arrays + SPHGI_V * SPHGI_TILE * size);
}

void sphgi_sum_both_sides(struct sphgi_worker *w)
{
    weigh_pairs(w);
    for (int32_t k = 0; k < w->sweep->plan->field_count; ++k)
        if (w->sweep->plan->fields[k].fold)
            sphgi_sum_folded(w, k);
}
