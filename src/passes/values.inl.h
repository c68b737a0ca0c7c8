/* SPDX-License-Identifier: MIT */
/* Sums of values with weights V_j W: volumes of a field's own, and the sum of the weights. */

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
