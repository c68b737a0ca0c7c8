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

/* s_ji of KGC, RKPM and PLAIN hold V_i; those of CRKPM do where sources have radii of their own. */
static bool holds_volume(const struct sphgi_plan *plan)
{
    return plan->classic ? plan->weighted && plan->both_sides : plan->scheme.method != SPHG_MLS;
}

/* folded: C_j came in in units of H, as classic and PLAIN terms do. Sums are in units of H: of the
 * adjoint form V_i is H^-d V_i, and H^d stands before both sides. */
static struct sphgi_two_sided two_sided(const struct sphgi_worker *w, bool symmetric, bool folded)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const bool ours = folded || plan->classic || plan->scheme.method == SPHG_PLAIN;
    const double volume = symmetric ? 1 : sphgi_power(plan->scheme.radius, plan->dimension);
    return (struct sphgi_two_sided){
        .unit = ours ? 1 : 1 / sphgi_table_scales(&plan->scheme).value,
        .factor = w->inverse_h * volume,
        .volume = w->own.volume,
        .density = symmetric ? w->own.density : NULL,
        .holds_volume = holds_volume(plan),
    };
}

static void finish_two_sided(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const bool symmetric = field->form == SPHG_SYMMETRIC;
    const struct sphgi_two_sided apart = two_sided(w, symmetric, false);
    const struct sphgi_two_sided folded = two_sided(w, symmetric, true);
    const int32_t sum_apart = plan->vector_sum[symmetric], in_fold = plan->folded_sum[symmetric];
    const int32_t first = field->rows ? sum_apart : in_fold;
    const int32_t second = field->fold ? in_fold : sum_apart;
    const char *own = sphgi_lane(w, w->own.field, field->at_target);
    if (field->sums_gradient) {
        own_side(w, first, w->extra);
        w->passes->two_sided_gradient(w->batch.width, plan->dimension, field->components,
                                      field->rows ? &apart : &folded, own, w->extra,
                                      sphgi_lane(w, w->reduced, field->sum), w->jacobian);
    }
    if (!field->sums_divergence)
        return;
    if (!field->sums_gradient || second != first)
        own_side(w, second, w->extra);
    w->passes->two_sided_divergence(
        w->batch.width, plan->dimension, field->shape, field->fold ? &folded : &apart, own,
        w->extra, sphgi_lane(w, w->reduced, field->divergence_sum), w->contracted);
}

static void finish_square(struct sphgi_worker *w, const struct sphgi_field_plan *field)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    struct sphgi_square of = {
        .correction = sphgi_square_sums(plan) > 1 ? w->coefficients : NULL,
        .factor = sphgi_common(w, w->inverse_h * w->inverse_h),
        .each = plan->graded ? w->radii.inverse_square : NULL,
    };
    if (plan->classic && plan->own_set >= 0) {
        sphgi_self_gradient(w, w->extra);
        of.self = w->extra;
        of.value = sphgi_lane(w, w->own.field, field->at_target);
    }
    w->passes->square(w->batch.width, plan->dimension, &of,
                      sphgi_lane(w, w->reduced, field->square_sum), w->contracted);
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
                finish_two_sided(w, field);
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
