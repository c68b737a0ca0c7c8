/* SPDX-License-Identifier: MIT */
/* Weights of the pairs of a tile: from distances and V_j to what is summed. */

SPHGI_TEMPLATE real *array_of(void *arrays, enum sphgi_array array)
{
    return (real *)arrays + array * SPHGI_TILE;
}

/* s_ij / H (theory.md, section 2), divided by m_ref; MLS still lacks its V_i. */
SPHGI_TEMPLATE vec factor_of(vec scale, vec inverse_h, vec r, vec volume, sphg_kernel kernel,
                             sphg_method method)
{
    const struct ratio at = ratio_of(r, inverse_h);
    const vec value = method == SPHG_KGC ? kernel_d(kernel, at) : kernel_w(kernel, at);
    vec weight = scale;
    if (method != SPHG_MLS)
        weight *= volume;
    return weight * value;
}

SPHGI_TEMPLATE vec factor_scale(const struct sphgi_shape *shape, sphg_method method)
{
    const vec scale = shape->factor_lanes ? load(shape->factor_lanes) : splat(R(shape->w_scale));
    return method == SPHG_KGC ? scale : -scale;
}

SPHGI_TEMPLATE vec inverse_radius(const struct sphgi_shape *shape)
{
    return shape->inverse_lanes ? load(shape->inverse_lanes) : splat(R(shape->inverse_h));
}

SPHGI_TEMPLATE void factors_as(const struct sphgi_shape *shape, real *a, int32_t count,
                               sphg_kernel kernel, sphg_method method)
{
    const vec scale = factor_scale(shape, method), inverse_h = inverse_radius(shape);
    for (int32_t k = 0; k < count; k += LANES, a += LANES)
        store(a + SPHGI_S * SPHGI_TILE, factor_of(scale, inverse_h, load(a + SPHGI_R * SPHGI_TILE),
                                                  load(a + SPHGI_V * SPHGI_TILE), kernel, method));
}

/* S: w_j, D: w_j'/r, both without V_j. */
SPHGI_TEMPLATE void weights_as(const struct sphgi_shape *shape, real *a, int32_t count,
                               sphg_kernel kernel)
{
    const vec scale = splat(R(shape->value_scale)), inverse_h = inverse_radius(shape);
    for (int32_t k = 0; k < count; k += LANES, a += LANES) {
        const struct ratio at = ratio_of(load(a + SPHGI_R * SPHGI_TILE), inverse_h);
        store(a + SPHGI_S * SPHGI_TILE, scale * kernel_w(kernel, at));
        store(a + SPHGI_D * SPHGI_TILE, scale * kernel_d(kernel, at));
    }
}

SPHGI_TEMPLATE void factors_of(const struct sphgi_shape *shape, real *arrays, int32_t count,
                               sphg_kernel kernel)
{
    if (shape->method == SPHG_MLS)
        factors_as(shape, arrays, count, kernel, SPHG_MLS);
    else if (shape->method == SPHG_RKPM)
        factors_as(shape, arrays, count, kernel, SPHG_RKPM);
    else
        factors_as(shape, arrays, count, kernel, SPHG_KGC);
}

#define BY_KERNEL    shape_factors
#define PARAMETERS   (const struct sphgi_shape *shape, void *arrays, int32_t count)
#define ARGUMENTS    (shape, arrays, count)
#define CALL(kernel) factors_of(shape, arrays, count, kernel)
#include "by_kernel.inl.h"

#define BY_KERNEL    shape_weights
#define PARAMETERS   (const struct sphgi_shape *shape, void *arrays, int32_t count)
#define ARGUMENTS    (shape, arrays, count)
#define CALL(kernel) weights_as(shape, arrays, count, kernel)
#include "by_kernel.inl.h"

/* PHI = V_j W; needs shape_weights. */
static void shape_values(void *arrays, int32_t count)
{
    for (int32_t k = 0; k < count; k += LANES)
        store(array_of(arrays, SPHGI_PHI) + k,
              load(array_of(arrays, SPHGI_V) + k) * load(array_of(arrays, SPHGI_S) + k));
}
