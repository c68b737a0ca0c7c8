/* SPDX-License-Identifier: MIT */
/* The classic methods' pairs of targets whose lists stand side by side, from ids to offsets and
 * weights of a tile and to moments in one loop. Each number is what the passes over a tile make of
 * it, rounded as there. */

/* What is summed beside: 10 or 6 sums, where these and the rest fit the registers. */
enum { MOMENTS_AS_READ = SUMS_IN_REGISTERS >= 10 };

/* What is known when a loop is compiled. */
struct classic_how {
    bool moments, weighted, three;
};

/* Offsets are in units of H: r is q. */
SPHGI_TEMPLATE struct ratio ratio_in_units(vec r)
{
    return (struct ratio){r, positive(splat(R(1)) - r)};
}

SPHGI_TEMPLATE void classic_pairs(const struct sphgi_gather *g, const struct sphgi_shape *shape,
                                  const int32_t *targets, const struct sphgi_tile *tile, real *sums,
                                  sphg_kernel kernel, struct classic_how how)
{
    const int32_t count = !how.moments ? 0 : how.three ? 10 : 6;
    const struct four target = target_rows(g, targets);
    const vec scale = splat(R(shape->value_scale)), unit = splat(R(g->unit));
    const vec volume = splat(R(g->volume));
    const mask in_rows = first_lanes(g->volumes ? LANES : 0);
    const uint32_t *ids = tile->ids, *to_come = ids_ahead(tile);
    const real *rows = g->rows, *also = tile->also ? tile->also : rows;
    const ptrdiff_t stride = tile->id_stride;
    real *at = tile->arrays;
    vec sum[10];
    clear(sum, count);
    for (int32_t k = 0; k < tile->steps; ++k, at += LANES, ids += stride) {
        __builtin_prefetch(ids + AHEAD * stride);
        ask_for_rows(rows, also, to_come, tile->scattered);
        to_come += stride;
        const struct four row = gather_rows(rows, ids);
        const vec dx = target.x - row.x, dy = target.y - row.y, dz = target.z - row.z;
        const vec plane = plus(dx * dx, dy, dy), square = how.three ? plus(plane, dz, dz) : plane;
        const vec x[3] = {dx * unit, dy * unit, dz * unit};
        const struct ratio ratio = ratio_in_units(vsqrt(square) * unit);
        vec s = scale * kernel_w(kernel, ratio), slope = scale * kernel_d(kernel, ratio);
        if (how.weighted) {
            const vec v = select(in_rows, row.w, volume);
            s *= v;
            slope *= v;
        }
        for (int32_t a = 0; a < (how.three ? 3 : 2); ++a)
            store(at + (SPHGI_X + a) * SPHGI_TILE, x[a]);
        store(at + SPHGI_S * SPHGI_TILE, s);
        store(at + SPHGI_D * SPHGI_TILE, slope);
        if (how.moments)
            classic_products(s, x, sum, true, how.three);
    }
    if (how.moments)
        end_chunk(tile, sum, count, sums);
}

#define BY_KERNEL classic_pairs_and_moments
#define PARAMETERS                                                                                 \
    (const struct sphgi_gather *gather, const struct sphgi_shape *shape, const int32_t *targets,   \
     bool weighted, const struct sphgi_tile *tile, real *sums)
#define ARGUMENTS (gather, shape, targets, weighted, tile, sums)
#define CALL(kernel)                                                                               \
    WITH(three, gather->dimension == 3,                                                            \
         WITH(by_volume, weighted,                                                                 \
              WITH(moments, MOMENTS_AS_READ && sums,                                               \
                   classic_pairs(gather, shape, targets, tile, sums, kernel,                       \
                                 (struct classic_how){moments, by_volume, three}))))
#include "by_kernel.inl.h"

static void begin_classic(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                          const int32_t *targets, bool weighted, struct sphgi_tile *tile,
                          void *sums)
{
    tile->weighed = true;
    classic_pairs_and_moments(gather, shape, targets, weighted, tile, sums);
    if (sums && !MOMENTS_AS_READ)
        WITH(three, gather->dimension == 3, classic_moments_as(tile, sums, false, three));
}
