/* SPDX-License-Identifier: MIT */
/* s_ij with the radius of j in place of i's: for the other half of what acts between particles that
 * have radii of their own. Rows hold H / H_j, H being the radius of the units. */

SPHGI_TEMPLATE void other_as(const struct sphgi_shape *shape, const struct sphgi_tile *tile,
                             const real *rows, sphg_kernel kernel, sphg_method method)
{
    const vec scale = factor_scale(shape, method), inverse_h = inverse_radius(shape);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec ratio = gather_rows(rows, ids_at(tile, k)).x, square = ratio * ratio;
        vec power = square; /* V / H^d to V / H_j^d */
        if (shape->dimension == 3)
            power *= ratio;
        if (method == SPHG_KGC)
            power *= square; /* W' / r */
        store(array_of(tile->arrays, SPHGI_S) + k,
              power * factor_of(scale, inverse_h * ratio, from(tile, SPHGI_R, k),
                                from(tile, SPHGI_V, k), kernel, method));
    }
}

SPHGI_TEMPLATE void other_by_method(const struct sphgi_shape *shape, const struct sphgi_tile *tile,
                                    const real *rows, sphg_kernel kernel)
{
    if (shape->method == SPHG_MLS)
        other_as(shape, tile, rows, kernel, SPHG_MLS);
    else if (shape->method == SPHG_RKPM)
        other_as(shape, tile, rows, kernel, SPHG_RKPM);
    else
        other_as(shape, tile, rows, kernel, SPHG_KGC);
}

#define BY_KERNEL shape_other
#define PARAMETERS                                                                                 \
    (const struct sphgi_shape *shape, const struct sphgi_tile *tile, const void *rows)
#define ARGUMENTS    (shape, tile, rows)
#define CALL(kernel) other_by_method(shape, tile, rows, kernel)
#include "by_kernel.inl.h"
