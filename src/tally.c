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
    if (part->stats.lambda_min < total->stats.lambda_min)
        total->stats.lambda_min = part->stats.lambda_min;
    if (part->bad_target >= 0 && (total->bad_target < 0 || part->bad_target < total->bad_target)) {
        total->bad_target = part->bad_target;
        total->bad_index = part->bad_index;
    }
    total->bad_volume |= part->bad_volume;
}

void sphgi_tally_verdict(struct sphgi_tally *tally, const struct sphgi_verdict *verdict,
                         const void *lambda_min, sphg_type type, int32_t lanes)
{
    sphg_stats *stats = &tally->stats;
    for (int32_t l = 0; l < lanes; ++l) {
        const double lambda = type == SPHG_F64 ? ((const double *)lambda_min)[l]
                                               : (double)((const float *)lambda_min)[l];
        ++stats->rank[verdict->rank[l]];
        stats->certified += !verdict->decomposed[l];
        stats->decomposed += verdict->decomposed[l];
        stats->empty += verdict->empty[l];
        if (lambda < stats->lambda_min)
            stats->lambda_min = lambda;
    }
}
