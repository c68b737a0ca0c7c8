#include "corrections.h"
#include "borrow.h"
#include "core/kernel.h"
#include "lane_radii.h"
#include "quadratic.h"

void sphgi_round_as_table(struct sphgi_worker *w, char *coefficients, bool wanted)
{
    if (w->sweep->plan->graded) {
        sphgi_round_by_radius(w, wanted);
        return;
    }
    for (int k = 0; k < SPHGI_SHARES && w->share[k].count; ++k) {
        const struct sphgi_share *share = &w->share[k];
        const bool exact = share->mantissa == 1;
        char *ours = sphgi_lane(w, coefficients, share->first);
        char *raw = sphgi_lane(w, w->raw, share->first);
        if (!exact || wanted)
            w->passes->scale(w->width, share->count, ours, share->mantissa, NULL, raw);
        if (!exact)
            w->passes->divide(w->width, share->count, raw, share->mantissa, ours);
        for (int p = 0; wanted && p < 2; ++p)
            if (share->power[p] != 1)
                w->passes->scale(w->width, share->count, raw, share->power[p], NULL, raw);
    }
}

void sphgi_take_from_table(const struct sphgi_passes *passes, const struct sphgi_share *shares,
                           int32_t width, sphg_type type, char *raw, char *ours)
{
    for (int k = 0; k < SPHGI_SHARES && shares[k].count; ++k) {
        const struct sphgi_share *share = &shares[k];
        const size_t first = (size_t)share->first * SPHGI_WIDTH * sphgi_size_of_type(type);
        for (int p = 0; p < 2; ++p)
            if (share->power[p] != 1)
                passes->scale(width, share->count, raw + first, 1 / share->power[p], NULL,
                              raw + first);
        passes->divide(width, share->count, raw + first, share->mantissa, ours + first);
    }
}

void sphgi_load_volume(struct sphgi_worker *w, const struct sphgi_columns *columns, char *to)
{
    w->passes->load_lanes(w->width, columns, sphgi_targets(w), to);
    w->tally->bad_volume |= !w->passes->valid_volumes(w->width, to);
    w->passes->scale(w->width, 1, to, sphgi_volume_unit(w->sweep), NULL, to);
}

void sphgi_load_own_volume(struct sphgi_worker *w, const struct sphgi_columns *columns, char *to)
{
    sphgi_load_volume(w, columns, to);
    if (w->sweep->plan->graded)
        w->passes->scale(w->width, 1, to, 1, sphgi_lane(w, w->ratio, 0), to);
}

static void invert_linearised(struct sphgi_worker *w, struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const void *scale = NULL;
    if (plan->scheme.method == SPHG_MLS) {
        if (plan->mean_volume)
            w->passes->quotient(w->width, sphgi_lane(w, w->reduced, plan->volume_sum),
                                sphgi_lane(w, w->reduced, plan->volume_sum + 1), w->extra);
        else
            sphgi_load_own_volume(w, &plan->target_volume, w->extra);
        scale = w->extra;
    }
    const void *moments = sphgi_lane(w, w->reduced, plan->moment_sum);
    if (plan->graded) {
        const int32_t numbers = plan->dimension * (plan->dimension + 1) / 2;
        w->passes->scale(w->width, numbers, moments, 1, sphgi_lane(w, w->inverse, 0),
                         sphgi_lane(w, w->raw, 0));
        moments = sphgi_lane(w, w->raw, 0);
    }
    void *correction = sphgi_lane(w, w->coefficients, 0);
    void *lambda_min = plan->lambda_min.count ? w->lambda_min : NULL;
    if (plan->quadratic)
        sphgi_keep_all(w, verdict);
    w->passes->invert(w->width, &w->threshold, moments, scale, correction, lambda_min, verdict);
    if (verdict->decomposed)
        w->passes->decompose(w->width, &w->threshold, moments, scale, correction, lambda_min,
                             verdict);
    if (plan->quadratic)
        sphgi_invert_quadratic(w, scale, verdict);
}

void sphgi_self_weight(struct sphgi_worker *w, char *to)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const double at_zero = w->shape.value_scale * sphgi_kernel_w(plan->scheme.kernel, 0);
    w->passes->fill(w->width, plan->own_set < 0 ? 0 : at_zero, to);
    if (plan->own_set >= 0 && plan->weighted) {
        sphgi_load_own_volume(w, &plan->own_volume, to);
        w->passes->scale(w->width, 1, to, at_zero, NULL, to);
    }
}

static void store_verdict(struct sphgi_worker *w, const struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (plan->quadratic && plan->correction.count)
        sphgi_store_table(w);
    else if (plan->correction.count)
        w->passes->store_lanes(w->targets, &plan->correction, sphgi_targets(w),
                               sphgi_lane(w, w->raw, 0), false);
    if (plan->lambda_min.count)
        w->passes->store_lanes(w->targets, &plan->lambda_min, sphgi_targets(w), w->lambda_min,
                               false);
    for (int32_t l = 0; plan->rank.count && l < w->targets; ++l) {
        const uint8_t rank =
            verdict->decomposed >> l & 1 ? verdict->rank[l] : (uint8_t)plan->dimension;
        *(uint8_t *)(uintptr_t)(plan->rank.at[0] + sphgi_targets(w)[l] * plan->rank.stride) =
            plan->quadratic ? sphgi_quadratic_rank(w, l, rank) : rank;
    }
    sphgi_store_borrows(w);
}

void sphgi_finish_corrections(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    struct sphgi_verdict verdict = {.lanes = w->targets};
    if (plan->classic) {
        sphgi_self_weight(w, w->self);
        w->passes->invert_classic(
            w->width, &w->threshold, sphgi_kernel_mu2(plan->scheme.kernel, plan->dimension),
            sphgi_lane(w, w->reduced, plan->moment_sum), w->self, sphgi_lane(w, w->coefficients, 0),
            plan->lambda_min.count ? w->lambda_min : NULL, &verdict);
    } else
        invert_linearised(w, &verdict);
    sphgi_round_as_table(w, w->coefficients, plan->correction.count > 0);
    sphgi_tally_verdict(w->tally, &verdict, plan->dimension);
    store_verdict(w, &verdict);
}

void sphgi_load_corrections(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    if (w->sweep->coefficients) {
        w->passes->load_lanes(w->width, w->sweep->coefficients, sphgi_targets(w),
                              sphgi_lane(w, w->coefficients, 0));
        return;
    }
    if (plan->quadratic)
        sphgi_load_table(w);
    else
        w->passes->load_lanes(w->width, &plan->target_correction, sphgi_targets(w),
                              sphgi_lane(w, w->raw, 0));
    if (plan->graded)
        sphgi_take_by_radius(w);
    else
        sphgi_take_from_table(w->passes, w->share, w->width, plan->type, sphgi_lane(w, w->raw, 0),
                              sphgi_lane(w, w->coefficients, 0));
}

void sphgi_self_gradient(struct sphgi_worker *w, char *gradient)
{
    const int32_t d = w->sweep->plan->dimension;
    sphgi_self_weight(w, w->self);
    sphgi_scale_by_radius(w, 1, w->self);
    for (int32_t k = 0; k < d; ++k)
        w->passes->scale(w->width, 1, sphgi_lane(w, w->coefficients, (k + 1) * (d + 1)),
                         sphgi_common(w, w->inverse_h), w->self, sphgi_lane(w, gradient, k));
}
