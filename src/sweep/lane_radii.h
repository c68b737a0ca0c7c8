/* SPDX-License-Identifier: MIT */
/* Targets with radii of their own: what takes the place of H, a number per lane. */
#ifndef SPHGI_LANE_RADII_H
#define SPHGI_LANE_RADII_H
#include "worker.h"

/* Of the lanes at work. */
void sphgi_read_lane_radii(struct sphgi_worker *worker);
/* Those of lanes with a bit in `kept` stay, one after the other. */
void sphgi_keep_lane_radii(struct sphgi_worker *worker, uint32_t kept);

/* Of classic methods the volumes of the tile, of others V_j W, become those in units of H_i^d. */
void sphgi_scale_volumes(struct sphgi_worker *worker);
void sphgi_scale_values(struct sphgi_worker *worker);

/* 1 / H of the targets at work; NULL where all radii are the same. */
static inline const char *sphgi_inverse_lanes(const struct sphgi_worker *worker)
{
    return worker->sweep->plan->graded ? sphgi_lane(worker, worker->radii.inverse, 0) : NULL;
}
/* What a scalar factor of 1 / H becomes: 1 where the lanes have their own. */
static inline double sphgi_common(const struct sphgi_worker *worker, double factor)
{
    return worker->sweep->plan->graded ? 1 : factor;
}

/* s_ij of the tile become those with H_j. */
void sphgi_weigh_other_side(struct sphgi_worker *worker);

/* As for one radius: coefficients rounded like those of a table, in `raw` if one is wanted; and
 * back. */
void sphgi_round_by_radius(struct sphgi_worker *worker, char *coefficients, bool wanted);
void sphgi_take_by_radius(struct sphgi_worker *worker);

#endif
