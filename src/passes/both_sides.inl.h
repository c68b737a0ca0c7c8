/* SPDX-License-Identifier: MIT */
/* Pairs whose two ends have radii of their own, where nothing but sums over both is wanted of them:
 * a value of the kernel with either radius, in one loop with the distances on open axes. The rows
 * of the sources hold H_j. Whatever else belongs to a source, V_j first of all, is multiplied into
 * what the sums read of it (folded.inl.h), once a particle. */

/* w(q) or w'(q) / q with q = r / H_j, which counts up to 1: all kernels end there. */
SPHGI_TEMPLATE vec seen_from_source(vec r, vec radius, sphg_kernel kernel, bool slope)
{
    const vec one = splat(R(1)), q = vmin(r / radius, one);
    const struct ratio at = {q, one - q};
    return slope ? kernel_d(kernel, at) : kernel_w(kernel, at);
}

/* s_ij without V_j. */
SPHGI_TEMPLATE vec seen_from_target(vec r, vec scale, vec inverse_h, sphg_kernel kernel, bool slope)
{
    const struct ratio own = ratio_of(r, inverse_h);
    return scale * (slope ? kernel_d(kernel, own) : kernel_w(kernel, own));
}

SPHGI_TEMPLATE vec own_scale(const struct sphgi_shape *shape, bool slope)
{
    return factor_scale(shape, slope ? SPHG_KGC : SPHG_RKPM);
}

/* masked: pairs are tested; of what neither radius reaches nothing enters a sum. */
SPHGI_TEMPLATE void both_of_pairs(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                  const int32_t *targets, struct sphgi_tile *tile,
                                  sphg_kernel kernel, bool slope, bool three, bool masked)
{
    const struct four own = target_rows(g, targets);
    const vec scale = own_scale(shape, slope), inverse_h = inverse_radius(shape);
    const vec reach = own.w * own.w;
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
        const struct four row = gather_rows(rows, ids);
        vec dx = own.x - row.x, dy = own.y - row.y, dz = own.z - row.z;
        vec square = plus(dx * dx, dy, dy);
        if (three)
            square = plus(square, dz, dz);
        const vec r = vsqrt(square);
        vec ours = seen_from_target(r, scale, inverse_h, kernel, slope);
        vec theirs = seen_from_source(r, row.w, kernel, slope);
        if (masked) {
            const mask inside = less(square_distance(dx, dy, dz), vmax(reach, row.w * row.w));
            keep_ids(inside, g->dummy, ids, kept);
            dx = where(inside, dx);
            dy = where(inside, dy);
            dz = where(inside, dz);
            ours = where(inside, ours);
            theirs = where(inside, theirs);
        }
        store(at + SPHGI_X * SPHGI_TILE, dx);
        store(at + SPHGI_Y * SPHGI_TILE, dy);
        if (three)
            store(at + SPHGI_Z * SPHGI_TILE, dz);
        store(at + SPHGI_S * SPHGI_TILE, ours);
        store(at + SPHGI_D * SPHGI_TILE, theirs);
    }
    if (masked) {
        tile->ids = tile->own_ids;
        tile->id_stride = LANES;
    }
}

/* The same of pairs that were gathered before: H_j stands where volumes do. */
SPHGI_TEMPLATE void both_of_tile(const struct sphgi_shape *shape, const struct sphgi_tile *tile,
                                 sphg_kernel kernel, bool slope)
{
    const vec scale = own_scale(shape, slope), inverse_h = inverse_radius(shape);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec r = from(tile, SPHGI_R, k), radius = from(tile, SPHGI_V, k);
        store(array_of(tile->arrays, SPHGI_S) + k,
              seen_from_target(r, scale, inverse_h, kernel, slope));
        store(array_of(tile->arrays, SPHGI_D) + k, seen_from_source(r, radius, kernel, slope));
    }
}

SPHGI_TEMPLATE void both_by_mask(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                 const int32_t *targets, struct sphgi_tile *tile,
                                 sphg_kernel kernel, bool slope, bool three)
{
    WITH(masked, g->masked, both_of_pairs(g, shape, targets, tile, kernel, slope, three, masked));
}

SPHGI_TEMPLATE void both_by_method(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                   const int32_t *targets, struct sphgi_tile *tile,
                                   sphg_kernel kernel)
{
    const bool slope = shape->method == SPHG_KGC;
    WITH(three, g->dimension == 3,
         WITH(by_slope, slope, both_by_mask(g, shape, targets, tile, kernel, by_slope, three)));
}

SPHGI_TEMPLATE void both_of_tile_by_method(const struct sphgi_shape *shape,
                                           const struct sphgi_tile *tile, sphg_kernel kernel)
{
    WITH(by_slope, shape->method == SPHG_KGC, both_of_tile(shape, tile, kernel, by_slope));
}

#define BY_KERNEL    gather_both
#define PARAMETERS   GATHER_PARAMETERS
#define ARGUMENTS    (gather, shape, targets, tile)
#define CALL(kernel) both_by_method(gather, shape, targets, tile, kernel)
#include "by_kernel.inl.h"

#define BY_KERNEL    weigh_both
#define PARAMETERS   (const struct sphgi_shape *shape, const struct sphgi_tile *tile)
#define ARGUMENTS    (shape, tile)
#define CALL(kernel) both_of_tile_by_method(shape, tile, kernel)
#include "by_kernel.inl.h"
