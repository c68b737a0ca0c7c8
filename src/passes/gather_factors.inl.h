/* SPDX-License-Identifier: MIT */
/* Pairs and their factors in one loop: what most sweeps do, and most of what they do. */

/* masked: each pair is tested. Of what is none nothing reaches a sum, whatever its rows hold; the
 * root and the kernel do not wait for the answer. */
SPHGI_TEMPLATE void factors_of_pairs(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                     const int32_t *targets, struct sphgi_tile *tile,
                                     sphg_kernel kernel, sphg_method method, bool three,
                                     bool volumes, bool masked)
{
    const struct four own = target_rows(g, targets);
    const vec scale = factor_scale(shape, method), inverse_h = inverse_radius(shape);
    const vec volume = splat(R(g->volume)), radius = splat(R(g->cutoff));
    const vec cutoff = square_of_cutoff(g, g->radii ? own.w : radius);
    const real *rows = g->rows;
    const uint32_t *ids = tile->ids;
    const int32_t steps = tile->steps;
    const ptrdiff_t stride = tile->id_stride;
    const ptrdiff_t ahead = ids == tile->own_ids ? 0 : AHEAD * stride;
    const uint32_t *to_come = ids_ahead(tile);
    const real *also = tile->also ? tile->also : rows;
    uint32_t *kept = tile->own_ids;
    real *at = tile->arrays;
    for (int32_t k = 0; k < steps; ++k, at += LANES, ids += stride, kept += LANES) {
        __builtin_prefetch(ids + ahead);
        if (!masked) {
            ask_for_rows(rows, also, to_come, tile->scattered);
            ask_for_more_rows(tile, to_come);
        }
        to_come += stride;
        struct four row = gather_rows(rows, ids);
        vec dx = own.x - row.x, dy = own.y - row.y, dz = own.z - row.z;
        vec square = plus(dx * dx, dy, dy);
        if (three)
            square = plus(square, dz, dz);
        vec s =
            factor_of(scale, inverse_h, vsqrt(square), volumes ? row.w : volume, kernel, method);
        if (masked) {
            const mask inside = less(square_distance(dx, dy, dz), cutoff);
            keep_ids(inside, g->dummy, ids, kept);
            dx = where(inside, dx);
            dy = where(inside, dy);
            dz = where(inside, dz);
            row.w = where(inside, row.w);
            s = where(inside, s);
        }
        store(at + SPHGI_X * SPHGI_TILE, dx);
        store(at + SPHGI_Y * SPHGI_TILE, dy);
        if (three)
            store(at + SPHGI_Z * SPHGI_TILE, dz);
        if (volumes)
            store(at + SPHGI_V * SPHGI_TILE, row.w);
        store(at + SPHGI_S * SPHGI_TILE, s);
    }
    if (masked) {
        tile->ids = tile->own_ids;
        tile->id_stride = LANES;
    }
}

SPHGI_TEMPLATE void factors_by_mask(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                    const int32_t *targets, struct sphgi_tile *tile,
                                    sphg_kernel kernel, sphg_method method, bool three,
                                    bool volumes)
{
    WITH(masked, g->masked,
         factors_of_pairs(g, shape, targets, tile, kernel, method, three, volumes, masked));
}

SPHGI_TEMPLATE void factors_by_shape(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                     const int32_t *targets, struct sphgi_tile *tile,
                                     sphg_kernel kernel, sphg_method method)
{
    WITH(three, g->dimension == 3,
         WITH(volumes, g->volumes,
              factors_by_mask(g, shape, targets, tile, kernel, method, three, volumes)));
}

SPHGI_TEMPLATE void factors_by_method(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                      const int32_t *targets, struct sphgi_tile *tile,
                                      sphg_kernel kernel)
{
    if (shape->method == SPHG_MLS)
        factors_by_shape(g, shape, targets, tile, kernel, SPHG_MLS);
    else if (shape->method == SPHG_RKPM)
        factors_by_shape(g, shape, targets, tile, kernel, SPHG_RKPM);
    else
        factors_by_shape(g, shape, targets, tile, kernel, SPHG_KGC);
}

#define BY_KERNEL    gather_factors
#define PARAMETERS   GATHER_PARAMETERS
#define ARGUMENTS    (gather, shape, targets, tile)
#define CALL(kernel) factors_by_method(gather, shape, targets, tile, kernel)
#include "by_kernel.inl.h"
