/* SPDX-License-Identifier: MIT */
/* Pairs and their factors in one loop (gather_factors.inl.h) for order 2, whose offsets are in
 * units of H. Few sweeps are of this kind: what costs an instruction is asked in the loop, not
 * before. */

SPHGI_TEMPLATE void quadratic_of_pairs(const struct sphgi_gather *g,
                                       const struct sphgi_shape *shape, const int32_t *targets,
                                       struct sphgi_tile *tile, sphg_kernel kernel, bool slope,
                                       bool three)
{
    const sphg_method method = slope ? SPHG_KGC : SPHG_RKPM;
    const struct four own = target_rows(g, targets);
    const vec scale = factor_scale(shape, method), inverse_h = inverse_radius(shape);
    const vec volume = splat(R(g->volume)), unit = unit_of_offsets(g, own.w), one = splat(R(1));
    const mask in_rows = first_lanes(g->volumes ? LANES : 0);
    const mask weighed = first_lanes(shape->method == SPHG_MLS ? 0 : LANES);
    const uint32_t *ids = tile->ids;
    const int32_t steps = tile->steps;
    const ptrdiff_t stride = tile->id_stride;
    const ptrdiff_t ahead = ids == tile->own_ids ? 0 : AHEAD * stride;
    const uint32_t *to_come = ids_ahead(tile);
    const real *rows = g->rows, *also = tile->also ? tile->also : rows;
    real *at = tile->arrays;
    for (int32_t k = 0; k < steps; ++k, at += LANES, ids += stride) {
        __builtin_prefetch(ids + ahead);
        ask_for_rows(rows, also, to_come, tile->scattered);
        to_come += stride;
        const struct four row = gather_rows(rows, ids);
        const vec dx = own.x - row.x, dy = own.y - row.y, dz = own.z - row.z;
        const vec v = select(in_rows, row.w, volume);
        vec square = plus(dx * dx, dy, dy);
        if (three)
            square = plus(square, dz, dz);
        store(at + SPHGI_X * SPHGI_TILE, dx * unit);
        store(at + SPHGI_Y * SPHGI_TILE, dy * unit);
        if (three)
            store(at + SPHGI_Z * SPHGI_TILE, dz * unit);
        store(at + SPHGI_V * SPHGI_TILE, v);
        store(at + SPHGI_S * SPHGI_TILE, factor_of(scale, inverse_h, vsqrt(square) * unit,
                                                   select(weighed, v, one), kernel, method));
    }
}

SPHGI_TEMPLATE void quadratic_by_method(const struct sphgi_gather *g,
                                        const struct sphgi_shape *shape, const int32_t *targets,
                                        struct sphgi_tile *tile, sphg_kernel kernel)
{
    const bool slope = shape->method == SPHG_KGC;
    WITH(three, g->dimension == 3,
         WITH(by_slope, slope,
              quadratic_of_pairs(g, shape, targets, tile, kernel, by_slope, three)));
}

#define BY_KERNEL    gather_quadratic
#define PARAMETERS   GATHER_PARAMETERS
#define ARGUMENTS    (gather, shape, targets, tile)
#define CALL(kernel) quadratic_by_method(gather, shape, targets, tile, kernel)
#include "by_kernel.inl.h"
