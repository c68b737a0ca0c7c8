/* SPDX-License-Identifier: MIT */
/* G_ji of the classic methods where sources have radii of their own: the weights with H_j, and the
 * polynomials of offsets in units of it. Rows hold the coefficients of j, taken to these units and
 * times all that G_ji has of j besides, V_j and powers of H_j (tables_by_radius.c). */

/* T = - weight G_ji without V_i, in units of the plan's H. The dummy's 1 / H_j and
 * coefficients are 0. */
SPHGI_TEMPLATE void classic_other_as(const struct sphgi_tile *tile,
                                     const struct sphgi_other_side *of, sphg_kernel kernel,
                                     bool three, bool dense)
{
    const int32_t d = three ? 3 : 2;
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec unit = gather_rows(of->radii, ids_at(tile, k)).y;
        const struct ratio at = ratio_of(from(tile, SPHGI_UR, k), unit);
        vec x[3], polynomial[4];
        for (int32_t a = 0; a < d; ++a)
            x[a] = unit * from(tile, (enum sphgi_array)(SPHGI_UX + a), k);
        for (int32_t m = 0; m <= d; ++m) {
            const struct four c = gather_rows(of->table[m], ids_at(tile, k));
            polynomial[m] = plus(plus(c.x, c.y, x[0]), c.z, x[1]);
            if (three)
                polynomial[m] = plus(polynomial[m], c.w, x[2]);
        }
        vec s = kernel_w(kernel, at), slope = kernel_d(kernel, at);
        if (dense) {
            const vec weight = weight_of(tile, k, of->density, SPHGI_WEIGHT_PER_DENSITY);
            s *= weight;
            slope *= weight;
        }
        slope *= polynomial[0];
        real *t = array_of(tile->arrays, SPHGI_TX) + k;
        for (int32_t a = 0; a < d; ++a)
            store(t + a * SPHGI_TILE, minus(slope * x[a], s, polynomial[1 + a]));
    }
}

SPHGI_TEMPLATE void classic_other_of(const struct sphgi_tile *tile,
                                     const struct sphgi_other_side *of, sphg_kernel kernel,
                                     bool three)
{
    WITH(dense, of->density, classic_other_as(tile, of, kernel, three, dense));
}

#define BY_KERNEL transposed_classic_other
#define PARAMETERS                                                                                 \
    (const struct sphgi_shape *shape, const struct sphgi_tile *tile,                               \
     const struct sphgi_other_side *of)
#define ARGUMENTS    (shape, tile, of)
#define CALL(kernel) WITH(three, shape->dimension == 3, classic_other_of(tile, of, kernel, three))
#include "by_kernel.inl.h"

/* Rows times a number each, or two of them one after the other. */
static void scale_rows(int32_t count, const void *first, const void *second, void *rows)
{
    real *at = rows;
    for (int32_t k = 0; k < count; ++k, at += SPHGI_ROW) {
        quad row = *(const quad *)at;
        if (first)
            row *= ((const real *)first)[k];
        *(quad *)at = row * ((const real *)second)[k];
    }
}
