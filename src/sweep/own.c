/* SPDX-License-Identifier: MIT */
#include "own.h"
#include "core/kernel.h"
#include "core/view.h"
#include "lane_radii.h"
#include <string.h>

/* ---- Fields ---------------------------------------------------------------------------------- */

bool sphgi_are_targets_sources(const struct sphgi_sweep *sweep,
                               const struct sphgi_field_plan *field)
{
    const struct sphgi_stream *stream = &sweep->set->streams[field->stream];
    return sweep->set_number == sweep->plan->own_set && sweep->set->neighbors->same &&
           field->target.stride == stream->columns.stride &&
           memcmp(field->target.at, stream->columns.at,
                  (size_t)field->components * sizeof field->target.at[0]) == 0;
}

/* These stand packed already. */
static bool are_targets_in_rows(const struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    return w->sweep->packed && field->streams == 1 && field->rows &&
           sphgi_are_targets_sources(w->sweep, field);
}

void sphgi_find_targets_in_rows(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    for (int32_t k = 0; k < plan->field_count && k < 32; ++k)
        if (are_targets_in_rows(w, &plan->fields[k]))
            w->own.in_rows |= 1u << k;
}

bool sphgi_is_mirrored(const struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    return w->sweep->set->streams[field->stream].mirrored;
}

static void load_target(struct sphgi_worker *w, int32_t number, char *to)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_field_plan *field = &sweep->plan->fields[number];
    const size_t row = SPHGI_ROW * sphgi_size_of_type(sweep->plan->type);
    if (number < 32 && (w->own.in_rows >> number & 1)) {
        const size_t rows = (size_t)sweep->set->neighbors->source_count + 1;
        struct sphgi_columns columns; /* all of it would be cleared for nothing */
        columns.layout = SPHG_AS_SHAPE;
        columns.at[0] = sweep->packed_rows + (size_t)field->row * rows * row;
        columns.stride = (ptrdiff_t)row;
        columns.count = SPHGI_ROW;
        columns.together = true;
        w->passes->load_lanes(w->batch.width, &columns, w->bundle.place + w->batch.first, to);
    } else if (field->target.count) {
        w->passes->load_lanes(w->batch.width, &field->target, sphgi_targets(w), to);
    } else {
        for (int32_t c = 0; c < field->components; ++c)
            w->passes->fill(w->batch.width, 0, to + (size_t)c * SPHGI_WIDTH * row / SPHGI_ROW);
    }
    if (field->antisymmetric)
        w->passes->scale(w->batch.width, field->components, to, -1, NULL, to);
    if (sphgi_is_mirrored(w, field))
        w->passes->scale(w->batch.width, field->components, to, field->antisymmetric ? 2 : -1, NULL,
                         sphgi_lane(w, w->own.opposite, field->at_target));
    if (field->coefficient.count)
        w->passes->load_lanes(w->batch.width, &field->coefficient, sphgi_targets(w),
                              sphgi_lane(w, w->own.field, field->coefficient_at_target));
}

void sphgi_load_target_volumes(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (!plan->adjoint && !plan->transposes[1])
        return;
    if (plan->target_volume.count)
        sphgi_load_volume(w, &plan->target_volume, sphgi_lane(w, w->own.volume, 0));
    if (plan->target_density.count)
        w->passes->load_lanes(w->batch.width, &plan->target_density, sphgi_targets(w),
                              sphgi_lane(w, w->own.density, 0));
}

void sphgi_load_targets(struct sphgi_worker *w)
{
    if (w->own.loaded)
        return;
    w->own.loaded = true;
    const struct sphgi_plan *plan = w->sweep->plan;
    for (int32_t k = 0; k < plan->field_count; ++k)
        load_target(w, k, sphgi_lane(w, w->own.field, plan->fields[k].at_target));
    sphgi_load_target_volumes(w);
}

/* Most results are not wanted: a call for each of them would cost what asking gains. */
static void ask_for(const struct sphgi_worker *w, const struct sphgi_columns *columns,
                    int32_t count, const int32_t *targets, bool writes)
{
    if (columns->count)
        w->passes->ask_for_lanes(count, columns, targets, writes);
}

void sphgi_ask_for_targets(const struct sphgi_worker *w, int32_t count, const int32_t *targets)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    ask_for(w, &plan->target_correction, count, targets, false);
    ask_for(w, &plan->correction, count, targets, true);
    if (plan->weighted && plan->own_set >= 0 && plan->computes)
        ask_for(w, &plan->own_volume, count, targets, false);
    if (plan->adjoint || plan->transposes[1]) {
        ask_for(w, &plan->target_volume, count, targets, false);
        ask_for(w, &plan->target_density, count, targets, false);
    }
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (k >= 32 || !(w->own.in_rows >> k & 1))
            ask_for(w, &field->target, count, targets, false);
        ask_for(w, &field->gradient, count, targets, true);
        ask_for(w, &field->divergence, count, targets, true);
        ask_for(w, &field->curl, count, targets, true);
        ask_for(w, &field->tensor, count, targets, false);
        ask_for(w, &field->contraction, count, targets, true);
        ask_for(w, &field->coefficient, count, targets, false);
        ask_for(w, &field->value, count, targets, true);
        ask_for(w, &field->laplacian, count, targets, true);
        ask_for(w, &field->curvature, count, targets, true);
        for (int32_t c = 0; c < 3; ++c)
            ask_for(w, &field->hessian[c], count, targets, true);
    }
}

/* ---- Volumes, and the pair of a target with itself ------------------------------------------- */

void sphgi_load_volume(struct sphgi_worker *w, const struct sphgi_columns *columns, char *to)
{
    w->passes->load_lanes(w->batch.width, columns, sphgi_targets(w), to);
    w->tally->bad_volume |= !w->passes->valid_volumes(w->batch.width, to);
    w->passes->scale(w->batch.width, 1, to, sphgi_volume_unit(w->sweep), NULL, to);
}

void sphgi_load_own_volume(struct sphgi_worker *w, const struct sphgi_columns *columns, char *to)
{
    sphgi_load_volume(w, columns, to);
    if (w->sweep->plan->graded)
        w->passes->scale(w->batch.width, 1, to, 1, sphgi_lane(w, w->radii.ratio, 0), to);
}

void sphgi_self_weight(struct sphgi_worker *w, char *to)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const double at_zero = w->shape.value_scale * sphgi_kernel_w(plan->scheme.kernel, 0);
    w->passes->fill(w->batch.width, plan->own_set < 0 ? 0 : at_zero, to);
    if (plan->own_set >= 0 && plan->weighted) {
        sphgi_load_own_volume(w, &plan->own_volume, to);
        w->passes->scale(w->batch.width, 1, to, at_zero, NULL, to);
    }
}

void sphgi_self_gradient(struct sphgi_worker *w, char *gradient)
{
    const int32_t d = w->sweep->plan->dimension;
    sphgi_self_weight(w, w->self);
    if (w->sweep->plan->graded)
        w->passes->scale(w->batch.width, 1, w->self, 1, sphgi_inverse_lanes(w), w->self);
    for (int32_t k = 0; k < d; ++k)
        w->passes->scale(w->batch.width, 1, sphgi_lane(w, w->coefficients, (k + 1) * (d + 1)),
                         sphgi_common(w, w->inverse_h), w->self, sphgi_lane(w, gradient, k));
}
