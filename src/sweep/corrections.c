/* SPDX-License-Identifier: MIT */
#include "corrections.h"
#include "borrow.h"
#include "core/kernel.h"
#include "own.h"
#include "quadratic.h"
#include "table.h"

static void invert_linearised(struct sphgi_worker *w, struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const void *scale = NULL;
    if (plan->scheme.method == SPHG_MLS) {
        if (plan->mean_volume)
            w->passes->quotient(w->batch.width, sphgi_lane(w, w->reduced, plan->volume_sum),
                                sphgi_lane(w, w->reduced, plan->volume_sum + 1), w->extra);
        else
            sphgi_load_own_volume(w, &plan->target_volume, w->extra);
        scale = w->extra;
    }
    const void *moments = sphgi_lane(w, w->reduced, plan->moment_sum);
    if (plan->graded && !plan->quadratic)
        w->threshold.unit_lanes = sphgi_lane(w, w->radii.inverse, 0);
    void *correction = sphgi_lane(w, w->coefficients, 0);
    void *lambda_min = plan->lambda_min.count ? w->lambda_min : NULL;
    if (plan->quadratic)
        sphgi_keep_all(w, verdict);
    w->passes->invert(w->batch.width, &w->threshold, moments, scale, correction, lambda_min,
                      verdict);
    if (verdict->decomposed)
        w->passes->decompose(w->batch.width, &w->threshold, moments, scale, correction, lambda_min,
                             verdict);
    if (plan->quadratic)
        sphgi_invert_quadratic(w, scale, verdict);
}

static void store_verdict(struct sphgi_worker *w, const struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_tally_verdict(w->tally, verdict, plan->dimension);
    if (plan->lambda_min.count)
        w->passes->store_lanes(w->batch.targets, &plan->lambda_min, sphgi_targets(w), w->lambda_min,
                               false);
    for (int32_t l = 0; plan->rank.count && l < w->batch.targets; ++l) {
        const uint8_t rank =
            verdict->decomposed >> l & 1 ? verdict->rank[l] : (uint8_t)plan->dimension;
        *(uint8_t *)(uintptr_t)(plan->rank.at[0] + sphgi_targets(w)[l] * plan->rank.stride) =
            plan->quadratic ? sphgi_quadratic_rank(w, l, rank) : rank;
    }
}

static void store_corrections(struct sphgi_worker *w)
{
    sphgi_round_as_table(w, w->coefficients, w->sweep->plan->correction.count > 0);
    sphgi_store_table(w);
    sphgi_store_borrows(w);
}

/* y is known, z_k are not. */
static void solve_classic(struct sphgi_worker *w, struct sphgi_verdict *verdict)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    sphgi_self_weight(w, w->self);
    w->passes->solve_classic(
        w->batch.width, &w->threshold, sphgi_kernel_mu2(plan->scheme.kernel, plan->dimension),
        sphgi_lane(w, w->reduced, plan->moment_sum), w->self, sphgi_lane(w, w->coefficients, 0),
        plan->lambda_min.count ? w->lambda_min : NULL, verdict);
}

void sphgi_solve_for_slopes(struct sphgi_worker *w)
{
    struct sphgi_verdict verdict = {.count = w->batch.targets};
    solve_classic(w, &verdict);
}

void sphgi_finish_moments(struct sphgi_worker *w)
{
    struct sphgi_verdict verdict = {.count = w->batch.targets};
    if (w->sweep->plan->classic) {
        solve_classic(w, &verdict);
        store_verdict(w, &verdict);
    } else {
        invert_linearised(w, &verdict);
        store_verdict(w, &verdict);
        store_corrections(w);
    }
}

void sphgi_finish_slopes(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    w->passes->finish_classic(w->batch.width, plan->dimension,
                              sphgi_lane(w, w->reduced, plan->slope_sum),
                              sphgi_lane(w, w->coefficients, 0));
    store_corrections(w);
}
