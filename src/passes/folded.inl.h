/* SPDX-License-Identifier: MIT */
/* Adjoint and symmetric sums whose terms of the sources, weight_j C_j A_j, are multiplied out once
 * a particle (theory.md, section 5): first that, then the sums over them. */

/* What the terms of sources are multiplied with; no density, no weight. */
static void source_weights(int32_t width, enum sphgi_weight kind, const void *volume,
                           const void *density, void *weights)
{
    const bool volumes = kind == SPHGI_WEIGHT_V || kind == SPHGI_WEIGHT_V_PER_DENSITY;
    const bool per_density = kind == SPHGI_WEIGHT_PER_DENSITY || kind == SPHGI_WEIGHT_V_PER_DENSITY;
    for (int32_t l = 0; l < width; l += LANES) {
        vec weight = volumes ? load((const real *)volume + l) : splat(R(1));
        if (per_density) {
            const vec rho = load((const real *)density + l);
            weight = where(differ(rho, splat(R(0))), weight / rho);
        }
        store((real *)weights + l, weight);
    }
}

/* b_j and, if dense, o_j behind it, of the pairs from place k on. */
SPHGI_TEMPLATE void folded_at(const struct sphgi_tile *tile, int32_t k, const void *const *rows,
                              int count, vec *b)
{
    for (int n = 0; n < count; n += SPHGI_ROW) {
        const struct four row = gather_rows(rows[n / SPHGI_ROW], ids_at(tile, k));
        const vec value[4] = {row.x, row.y, row.z, row.w};
        for (int c = 0; c < SPHGI_ROW && n + c < count; ++c)
            b[n + c] = value[c];
    }
}

/* sum s_ij b_j x_ij, and sum s_ij x_ij or sum o_j s_ij x_ij. The first of pairs with two radii:
 * with the factors of the source's. */
SPHGI_TEMPLATE void folded_as(const struct sphgi_tile *tile, enum sphgi_fold fold, bool dense,
                              bool both, const void *const *rows, void *sums, void *vectors, int d)
{
    const int results = fold == SPHGI_FOLDED_VECTOR ? 1 : d;
    const int numbers = fold == SPHGI_FOLDED_NUMBER      ? 1
                        : fold == SPHGI_FOLDED_VECTOR    ? d
                        : fold == SPHGI_FOLDED_SYMMETRIC ? d * (d + 1) / 2
                                                         : d * d;
    vec sum[3], own[3];
    clear(sum, results);
    clear(own, d);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec b[10], g[3], h[3];
        folded_at(tile, k, rows, numbers + (dense ? 1 : 0), b);
        vectors_at(tile, k, SPHGI_FACTORS, d == 3, g);
        for (int a = 0; a < d; ++a)
            if (both)
                h[a] = from(tile, SPHGI_D, k) * from(tile, (enum sphgi_array)(SPHGI_X + a), k);
            else
                h[a] = g[a];
        if (fold == SPHGI_FOLDED_NUMBER)
            for (int a = 0; a < d; ++a)
                sum[a] = plus(sum[a], b[0], h[a]);
        else
            add_contracted(fold == SPHGI_FOLDED_VECTOR      ? SPHG_VECTOR
                           : fold == SPHGI_FOLDED_SYMMETRIC ? SPHG_SYM_TENSOR
                                                            : SPHG_TENSOR,
                           d, b, h, sum);
        for (int a = 0; a < d; ++a)
            own[a] = plus_vector(own[a], g[a], dense ? &b[numbers] : NULL);
    }
    end_tile(tile, sum, results, sums);
    if (vectors)
        end_tile(tile, own, d, vectors);
}

SPHGI_TEMPLATE void folded_in(const struct sphgi_tile *tile, enum sphgi_fold fold, bool dense,
                              bool both, const void *const *rows, void *sums, void *vectors, int d)
{
    if (fold == SPHGI_FOLDED_NUMBER)
        folded_as(tile, SPHGI_FOLDED_NUMBER, dense, both, rows, sums, vectors, d);
    else if (fold == SPHGI_FOLDED_VECTOR)
        folded_as(tile, SPHGI_FOLDED_VECTOR, dense, both, rows, sums, vectors, d);
    else if (fold == SPHGI_FOLDED_SYMMETRIC)
        folded_as(tile, SPHGI_FOLDED_SYMMETRIC, dense, both, rows, sums, vectors, d);
    else
        folded_as(tile, SPHGI_FOLDED_MATRIX, dense, both, rows, sums, vectors, d);
}

SPHGI_TEMPLATE void folded_by(const struct sphgi_tile *tile, enum sphgi_fold fold, bool dense,
                              enum sphgi_array factors, const void *const *rows, void *sums,
                              void *vectors, int d)
{
    /* Where sources have radii of their own, `vectors` are what others carry. */
    WITH(both, factors == SPHGI_D,
         WITH(carries, dense,
              folded_in(tile, fold, carries, both, rows, sums, both && !carries ? NULL : vectors,
                        d)));
}

static void sum_folded(const struct sphgi_tile *tile, int32_t dimension, enum sphgi_fold fold,
                       bool dense, enum sphgi_array factors, const void *const *rows, void *sums,
                       void *vectors)
{
    WITH(three, dimension == 3,
         folded_by(tile, fold, dense, factors, rows, sums, vectors, three ? 3 : 2));
}
