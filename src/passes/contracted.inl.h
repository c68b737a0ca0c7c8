/* SPDX-License-Identifier: MIT */
/* Divergences of vectors and tensors and squares of gradients, contracted pair by pair: as few sums
 * as results where nothing is to come. */

/* Component (a, b) of a tensor among those that the shape holds. */
SPHGI_TEMPLATE int tensor_index(sphg_shape shape, int a, int b, int d)
{
    return shape == SPHG_SYM_TENSOR ? sphgi_pair_index(a, b, d) : a * d + b;
}

SPHGI_TEMPLATE int components_of(sphg_shape shape, int d)
{
    return shape == SPHG_VECTOR ? d : shape == SPHG_SYM_TENSOR ? d * (d + 1) / 2 : d * d;
}

/* A . b: of a vector a number, of a tensor one for each of its rows. Added to sum. */
SPHGI_TEMPLATE void add_contracted(sphg_shape shape, int d, const vec *a, const vec *b, vec *sum)
{
    for (int row = 0; row < (shape == SPHG_VECTOR ? 1 : d); ++row) {
        vec product = a[shape == SPHG_VECTOR ? 0 : tensor_index(shape, row, 0, d)] * b[0];
        for (int k = 1; k < d;
             ++k) { /* apart from the sum, which each pair would wait for d times */
            const vec component = a[shape == SPHG_VECTOR ? k : tensor_index(shape, row, k, d)];
            product = plus(product, component, b[k]);
        }
        sum[row] += product;
    }
}

/* A_j - A_i of the pairs from place k on. */
SPHGI_TEMPLATE void differences(const struct sphgi_tile *tile, int32_t k, const void *const *rows,
                                const vec *own, int count, vec *difference)
{
    for (int c = 0; c < count; c += SPHGI_ROW) {
        const struct four row = gather_rows(rows[c / SPHGI_ROW], ids_at(tile, k));
        const vec value[4] = {row.x, row.y, row.z, row.w};
        for (int n = 0; n < SPHGI_ROW && c + n < count; ++n)
            difference[c + n] = value[n] - own[c + n];
    }
}

SPHGI_TEMPLATE void divergence_as(const struct sphgi_tile *tile, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const real *at_target, void *sums, bool three)
{
    const int d = three ? 3 : 2, count = components_of(shape, d);
    const int results = shape == SPHG_VECTOR ? 1 : d;
    vec own[9];
    for (int c = 0; c < count; ++c)
        own[c] = load(at_target + c * SPHGI_WIDTH);
    vec sum[3];
    clear(sum, results);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec difference[9], g[3];
        differences(tile, k, rows, own, count, difference);
        vectors_at(tile, k, vectors, three, g);
        add_contracted(shape, d, difference, g, sum);
    }
    end_tile(tile, sum, results, sums);
}

SPHGI_TEMPLATE void divergence_of(const struct sphgi_tile *tile, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const void *at_target, void *sums, bool three)
{
    if (shape == SPHG_VECTOR)
        divergence_as(tile, SPHG_VECTOR, vectors, rows, at_target, sums, three);
    else if (shape == SPHG_SYM_TENSOR)
        divergence_as(tile, SPHG_SYM_TENSOR, vectors, rows, at_target, sums, three);
    else
        divergence_as(tile, SPHG_TENSOR, vectors, rows, at_target, sums, three);
}

SPHGI_TEMPLATE void divergence_in(const struct sphgi_tile *tile, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const void *at_target, void *sums, bool three)
{
    if (vectors == SPHGI_FACTORS)
        divergence_of(tile, shape, SPHGI_FACTORS, rows, at_target, sums, three);
    else
        divergence_of(tile, shape, SPHGI_TRANSPOSED, rows, at_target, sums, three);
}

static void sum_divergence(const struct sphgi_tile *tile, int32_t dimension, sphg_shape shape,
                           enum sphgi_vectors vectors, const void *const *rows,
                           const void *at_target, void *sums)
{
    WITH(three, dimension == 3, divergence_in(tile, shape, vectors, rows, at_target, sums, three));
}

/* ---- Squares -------------------------------------------------------------------------------- */

SPHGI_TEMPLATE void squares_as(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                               const real *rows, const real *own, void *sums, bool three,
                               bool trace)
{
    const int d = three ? 3 : 2, count = trace ? 1 : d * (d + 1) / 2;
    const vec off = load(own);
    vec sum[6];
    clear(sum, count);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec a = gather_rows(rows, ids_at(tile, k)).x - off;
        vec g[3];
        vectors_at(tile, k, vectors, three, g);
        vec square = g[0] * g[0];
        for (int b = 1; b < d; ++b)
            square = plus(square, g[b], g[b]);
        if (trace)
            sum[0] = plus(sum[0], a, square);
        for (int b = 0; b < d && !trace; ++b)
            for (int c = b; c < d; ++c)
                sum[sphgi_pair_index(b, c, d)] =
                    plus(sum[sphgi_pair_index(b, c, d)], a * g[b], g[c]);
    }
    end_tile(tile, sum, count, sums);
}

SPHGI_TEMPLATE void squares_in(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                               int32_t count, const void *rows, const void *own, void *sums,
                               bool three)
{
    if (count > 1)
        squares_as(tile, SPHGI_FACTORS, rows, own, sums, three, false);
    else if (vectors == SPHGI_FACTORS)
        squares_as(tile, SPHGI_FACTORS, rows, own, sums, three, true);
    else
        squares_as(tile, SPHGI_GRADIENTS, rows, own, sums, three, true);
}

static void sum_squares(const struct sphgi_tile *tile, int32_t dimension,
                        enum sphgi_vectors vectors, int32_t count, const void *rows,
                        const void *at_target, void *sums)
{
    WITH(three, dimension == 3, squares_in(tile, vectors, count, rows, at_target, sums, three));
}
