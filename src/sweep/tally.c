/* SPDX-License-Identifier: MIT */
#include "tally.h"
#include <math.h>

void sphgi_tally_clear(struct sphgi_tally *tally)
{
    *tally = (struct sphgi_tally){.bad_target = -1};
    tally->stats.lambda_min = (double)INFINITY;
}

void sphgi_tally_add(struct sphgi_tally *total, const struct sphgi_tally *part)
{
    for (int k = 0; k < 4; ++k)
        total->stats.rank[k] += part->stats.rank[k];
    total->stats.certified += part->stats.certified;
    total->stats.decomposed += part->stats.decomposed;
    total->stats.empty += part->stats.empty;
    total->stats.quadratic += part->stats.quadratic;
    if (part->stats.lambda_min < total->stats.lambda_min)
        total->stats.lambda_min = part->stats.lambda_min;
    if (part->bad_target >= 0 && (total->bad_target < 0 || part->bad_target < total->bad_target)) {
        total->bad_target = part->bad_target;
        total->bad_index = part->bad_index;
    }
    total->bad_volume |= part->bad_volume;
    if (part->largest_square > total->largest_square)
        total->largest_square = part->largest_square;
}

void sphgi_tally_verdict(struct sphgi_tally *tally, const struct sphgi_verdict *verdict,
                         int32_t dimension)
{
    sphg_stats *stats = &tally->stats;
    if (verdict->largest_square > tally->largest_square)
        tally->largest_square = verdict->largest_square;
    if (!verdict->decomposed && !verdict->empty) {
        stats->rank[dimension] += verdict->count;
        stats->certified += verdict->count;
        return;
    }
    for (int32_t l = 0; l < verdict->count; ++l) {
        const bool decomposed = verdict->decomposed >> l & 1;
        ++stats->rank[decomposed ? verdict->rank[l] : dimension];
        stats->certified += !decomposed;
        stats->decomposed += decomposed;
        stats->empty += verdict->empty >> l & 1;
        if (decomposed && verdict->lambda_min[l] < stats->lambda_min)
            stats->lambda_min = verdict->lambda_min[l];
    }
}

sphg_stats sphgi_tally_stats(const struct sphgi_tally *tally, sphg_type type)
{
    sphg_stats stats = tally->stats;
    const double certified = type == SPHG_F64
                                 ? 1 / sqrt(tally->largest_square)
                                 : (double)(1.0f / sqrtf((float)tally->largest_square));
    if (tally->largest_square > 0 && certified < stats.lambda_min)
        stats.lambda_min = certified;
    return stats;
}
