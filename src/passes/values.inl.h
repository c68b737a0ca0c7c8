/* SPDX-License-Identifier: MIT */
/* Sums of values with weights V_j W: volumes of a field's own, and the sum of the weights. */
#include <float.h>

/* W, which s_ij would take the place of, goes where it stays. */
static void keep_kernel(void *arrays, int32_t count)
{
    for (int32_t k = 0; k < count; k += LANES)
        store(array_of(arrays, SPHGI_W) + k, load(array_of(arrays, SPHGI_S) + k));
}

/* PHI = V_j W with volumes that stand in rows, times unit and each; each NULL: 1 */
static void values_of_volumes(const struct sphgi_tile *tile, const void *rows, double unit,
                              const void *each)
{
    const vec scale = splat(R(unit));
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec phi = scale * gather_rows(rows, ids_at(tile, k)).x * from(tile, SPHGI_W, k);
        if (each)
            phi *= load(each);
        store(array_of(tile->arrays, SPHGI_PHI) + k, phi);
    }
}

/* sum PHI */
static void sum_weights(const struct sphgi_tile *tile, void *sums)
{
    vec sum = splat(R(0));
    for (int32_t k = 0; k < places_of(tile); k += LANES)
        sum += from(tile, SPHGI_PHI, k);
    end_tile(tile, &sum, 1, sums);
}

/* Values over the sum of their weights; where that is 0, 0. The inverse of a sum below the normal
 * numbers may be too large for the type: there both are raised first. */
static void means(int32_t width, int32_t count, const void *weights, void *values)
{
    const vec least = splat(R(sizeof(real) == sizeof(float) ? FLT_MIN : DBL_MIN));
    for (int32_t l = 0; l < width; l += LANES) {
        const vec weight = load((const real *)weights + l);
        const vec raised = select(less(vabs(weight), least), splat(R(0x1p64)), splat(R(1)));
        const vec inverse = where(differ(weight, splat(R(0))), splat(R(1)) / (weight * raised));
        for (int32_t k = 0; k < count; ++k) {
            real *value = (real *)values + k * SPHGI_WIDTH + l;
            store(value, load(value) * raised * inverse);
        }
    }
}
