/* SPDX-License-Identifier: MIT */
#include "finish.h"
#include "diffusion.h"
#include "core/kernel.h"
#include "lane_radii.h"
#include "own.h"
#include "quadratic.h"
#include "values.h"

/* The target's own term of the direct form. */
static void add_self_gradient(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    sphgi_self_gradient(w, w->extra);
    w->passes->add_outer(w->batch.width, w->sweep->plan->dimension, field->components,
                         sphgi_lane(w, w->own.field, field->at_target), w->extra, NULL,
                         w->jacobian);
}

static void finish_one_sided(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const bool multiply = plan->corrects && !plan->classic;
    if (!field->sums_gradient)
        return;
    w->passes->apply(w->batch.width, plan->dimension, field->components,
                     multiply ? w->coefficients : NULL, sphgi_lane(w, w->reduced, field->sum),
                     sphgi_common(w, w->inverse_h), sphgi_inverse_lanes(w), w->jacobian);
    if (field->form == SPHG_DIRECT && plan->classic && plan->own_set >= 0)
        add_self_gradient(w, field);
}

/* PLAIN: no matrix stands between the sums and the results, adjoint ones lack V_i. */
static void finish_plain(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t d = plan->dimension;
    const double volume = field->antisymmetric ? sphgi_power(plan->scheme.radius, d) : 1;
    const char *each = field->antisymmetric ? w->own.volume
                       : plan->graded       ? w->radii.inverse
                                            : NULL;
    const double factor = sphgi_common(w, w->inverse_h * volume);
    if (field->sums_gradient)
        w->passes->scale(w->batch.width, field->components * d,
                         sphgi_lane(w, w->reduced, field->sum), factor, each, w->jacobian);
    if (field->sums_divergence)
        w->passes->scale(w->batch.width, field->divergence.count,
                         sphgi_lane(w, w->reduced, field->divergence_sum), factor, each,
                         w->contracted);
}

/* C_i sum a_j s_ij x_ij; classic: the sum is made of gradients already. Where targets have radii of
 * their own it is taken to units of the plan's H, in which the other side of pairs stands. */
static void own_side(struct sphgi_worker *w, int32_t sum, char *to)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const bool multiply = plan->corrects && !plan->classic;
    if (plan->quadratic) {
        sphgi_apply_to_vectors(w, sum, to);
        return;
    }
    w->passes->apply(w->batch.width, plan->dimension, 1, multiply ? w->coefficients : NULL,
                     sphgi_lane(w, w->reduced, sum), plan->graded ? plan->scheme.radius : 1,
                     sphgi_inverse_lanes(w), to);
}

/* What the terms of both sides are multiplied with; NULL: 1. */
struct sides {
    double table; /* from sums over G_ji to units of H ... */
    const void *other, *own;
    double factor; /* ... and of the result */
    const void *each;
};

/* adjoint: f = (1/H) (V_i A_i G + H^d sum V_j A_j T), with H^d V_i = V_i H^-d H^d; KGC and
 * RKPM have V_i inside T, too, and CRKPM where sources have radii of their own. symmetric: f =
 * (1/H) (A_i G / rho_i + rho_i [/ V_i] sum A_j T). */
static struct sides sides_of(struct sphgi_worker *w, bool symmetric)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_passes *p = w->passes;
    const bool volume_inside =
        plan->classic ? plan->weighted && plan->both_sides : plan->scheme.method != SPHG_MLS;
    const bool ours = plan->classic || plan->scheme.method == SPHG_PLAIN;
    struct sides sides = {.table = ours ? 1 : 1 / sphgi_table_scales(&plan->scheme).value};
    if (symmetric) {
        char *ratio = sphgi_lane(w, w->extra, 4), *inverse = sphgi_lane(w, w->extra, 5);
        if (!volume_inside)
            p->quotient(w->batch.width, w->own.density, w->own.volume, ratio);
        p->quotient(w->batch.width, NULL, w->own.density, inverse);
        sides.other = volume_inside ? w->own.density : ratio;
        sides.own = inverse;
        sides.factor = w->inverse_h;
    } else {
        sides.own = volume_inside ? NULL : w->own.volume;
        sides.factor = w->inverse_h * sphgi_power(plan->scheme.radius, plan->dimension);
        sides.each = volume_inside ? w->own.volume : NULL;
    }
    return sides;
}

/* The table comes first: its factor times a density need not be a number of f32. */
static void join_sides(struct sphgi_worker *w, const struct sphgi_field_plan *field,
                       const struct sides *sides, bool divergence)
{
    const struct sphgi_passes *p = w->passes;
    const int32_t d = w->sweep->plan->dimension;
    const int32_t count = divergence ? field->divergence.count : field->components * d;
    const char *own = sphgi_lane(w, w->own.field, field->at_target);
    char *to = divergence ? w->contracted : w->jacobian;
    p->scale(w->batch.width, count,
             sphgi_lane(w, w->reduced, divergence ? field->divergence_sum : field->sum),
             sides->table, NULL, to);
    if (sides->other)
        p->scale(w->batch.width, count, to, 1, sides->other, to);
    if (divergence)
        p->add_product(w->batch.width, d, field->shape, own, w->extra, sides->own, to);
    else
        p->add_outer(w->batch.width, d, field->components, own, w->extra, sides->own, to);
    p->scale(w->batch.width, count, to, sides->factor, sides->each, to);
}

static void finish_transposed(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const bool symmetric = field->form == SPHG_SYMMETRIC;
    const struct sides sides = sides_of(w, symmetric);
    struct sides folded = sides; /* whose C_j came in in units of H */
    folded.table = 1;
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t apart = plan->vector_sum[symmetric], in_fold = plan->folded_sum[symmetric];
    const int32_t first = field->rows ? apart : in_fold, second = field->fold ? in_fold : apart;
    if (field->sums_gradient) {
        own_side(w, first, w->extra);
        join_sides(w, field, field->rows ? &sides : &folded, false);
    }
    if (!field->sums_divergence)
        return;
    if (!field->sums_gradient || second != first)
        own_side(w, second, w->extra);
    join_sides(w, field, field->fold ? &folded : &sides, true);
}

static void finish_square(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const char *sums = sphgi_lane(w, w->reduced, field->square_sum);
    if (sphgi_square_sums(plan) > 1) {
        w->passes->trace_between(w->batch.width, plan->dimension, w->coefficients, sums, w->self);
        sums = w->self;
    }
    w->passes->scale(w->batch.width, 1, sums, sphgi_common(w, w->inverse_h * w->inverse_h),
                     plan->graded ? w->radii.inverse_square : NULL, w->contracted);
    if (plan->classic && plan->own_set >= 0) {
        sphgi_self_gradient(w, w->extra);
        w->passes->add_product(w->batch.width, plan->dimension, SPHG_VECTOR, w->extra, w->extra,
                               sphgi_lane(w, w->own.field, field->at_target), w->contracted);
    }
    w->passes->store_lanes(w->batch.targets, &field->square, sphgi_targets(w), w->contracted,
                           field->accumulate);
}

/* J : T_i */
static void store_contraction(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_passes *p = w->passes;
    const int32_t d = w->sweep->plan->dimension;
    p->load_lanes(w->batch.width, &field->tensor, sphgi_targets(w), w->raw);
    p->double_product(w->batch.width, d * d, w->jacobian, w->raw, w->extra);
    p->store_lanes(w->batch.targets, &field->contraction, sphgi_targets(w), w->extra,
                   field->accumulate);
}

static void store_results(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    char *divergence = w->contracted, *curl = sphgi_lane(w, w->contracted, 3);
    w->passes->contract(w->batch.width, plan->dimension, field->shape, w->jacobian,
                        field->divergence.count && !field->sums_divergence ? divergence : NULL,
                        field->curl.count ? curl : NULL);
    const struct sphgi_columns *columns[3] = {&field->gradient, &field->divergence, &field->curl};
    const char *lanes[3] = {w->jacobian, divergence, curl};
    for (int32_t k = 0; k < 3; ++k)
        if (columns[k]->count)
            w->passes->store_lanes(w->batch.targets, columns[k], sphgi_targets(w), lanes[k],
                                   field->accumulate);
    if (field->contraction.count)
        store_contraction(w, field);
}

void sphgi_finish_fields(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (field->differentiates) {
            if (!field->one_sided)
                finish_transposed(w, field);
            else if (plan->quadratic)
                sphgi_finish_quadratic(w, field);
            else if (plan->scheme.method == SPHG_PLAIN)
                finish_plain(w, field);
            else
                finish_one_sided(w, field);
            store_results(w, field);
        }
        if (field->diffuses)
            sphgi_finish_diffusion(w, field);
        if (field->square.count)
            finish_square(w, field);
        if (field->value_sum >= 0)
            sphgi_finish_value(w, field);
    }
}
