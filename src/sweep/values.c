/* SPDX-License-Identifier: MIT */
#include "values.h"
#include "core/kernel.h"
#include "own.h"
#include "lane_radii.h"

void sphgi_weigh_values(struct sphgi_worker *w, int32_t count)
{
    w->passes->shape_values(w->tile.arrays, count);
    sphgi_scale_values(w);
    if (w->sweep->plan->values_by_own)
        w->passes->keep_kernel(w->tile.arrays, count);
}

void sphgi_sum_value(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                     const char *at_target)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const size_t lane = SPHGI_WIDTH * sphgi_size_of_type(plan->type);
    if (field->volume_row >= 0)
        w->passes->values_of_volumes(&w->tile, w->rows.at[field->volume_row],
                                     sphgi_volume_unit(w->sweep),
                                     plan->graded ? sphgi_lane(w, w->radii.ratio, 0) : NULL);
    for (int32_t s = 0; s < field->streams; ++s)
        w->passes->sum_value(&w->tile, w->rows.at[field->row + s],
                             sphgi_min32(SPHGI_ROW, field->components - s * SPHGI_ROW),
                             at_target + (size_t)(s * SPHGI_ROW) * lane,
                             sphgi_lane(w, w->reduced, field->value_sum + s * SPHGI_ROW));
    if (field->normalises)
        w->passes->sum_weights(&w->tile, sphgi_lane(w, w->reduced, field->filling_sum));
}

static void load_own_weight(struct sphgi_worker *w, const struct sphgi_field_plan *field, char *to)
{
    const struct sphgi_passes *p = w->passes;
    const bool graded = w->sweep->plan->graded;
    p->load_lanes(w->batch.width, &field->own_volume, sphgi_targets(w), to);
    p->scale(w->batch.width, 1, to, sphgi_volume_unit(w->sweep),
             graded ? sphgi_lane(w, w->radii.ratio, 0) : NULL, to);
}

/* Phi_i(x_i), the weight of the target's own value. */
static void load_self_weight(struct sphgi_worker *w, const struct sphgi_field_plan *field, char *to)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const double at_zero = w->shape.value_scale * sphgi_kernel_w(plan->scheme.kernel, 0);
    if (plan->classic) {
        sphgi_self_weight(w, w->self);
        w->passes->scale(w->batch.width, 1, w->coefficients, 1, w->self, to);
        return;
    }
    if (field->volume_row < 0)
        sphgi_load_own_volume(w, &field->own_volume, to);
    else /* whatever the host weighs with */
        load_own_weight(w, field, to);
    w->passes->scale(w->batch.width, 1, to, at_zero, NULL, to);
}

static void add_self(struct sphgi_worker *w, const struct sphgi_field_plan *field, char *value)
{
    const struct sphgi_passes *p = w->passes;
    load_self_weight(w, field, w->extra);
    p->add_outer(w->batch.width, 1, field->components,
                 sphgi_lane(w, w->own.field, field->at_target), w->extra, NULL, value);
    if (!field->normalises)
        return;
    p->fill(w->batch.width, 1, w->self);
    p->add_outer(w->batch.width, 1, 1, w->self, w->extra, NULL,
                 sphgi_lane(w, w->reduced, field->filling_sum));
}

void sphgi_finish_value(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    char *value = sphgi_lane(w, w->reduced, field->value_sum);
    if (field->form == SPHG_DIRECT && plan->own_set >= 0)
        add_self(w, field, value);
    if (field->normalises)
        w->passes->means(w->batch.width, field->components,
                         sphgi_lane(w, w->reduced, field->filling_sum), value);
    w->passes->store_lanes(w->batch.targets, &field->value, sphgi_targets(w), value,
                           field->accumulate);
}
