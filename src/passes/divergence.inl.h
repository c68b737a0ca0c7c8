/* Divergences of vectors and tensors, contracted pair by pair: no more sums than results. */

/* Component (a, b) of a tensor among those that the shape holds. */
SPHGI_TEMPLATE int tensor_index(sphg_shape shape, int a, int b, int d)
{
    return shape == SPHG_SYM_TENSOR ? pair_index(a, b, d) : a * d + b;
}

SPHGI_TEMPLATE int components_of(sphg_shape shape, int d)
{
    return shape == SPHG_VECTOR ? d : shape == SPHG_SYM_TENSOR ? d * (d + 1) / 2 : d * d;
}

/* A . b: of a vector a number, of a tensor one for each of its rows. Added to sum. */
SPHGI_TEMPLATE void add_contracted(sphg_shape shape, int d, const vec *a, const vec *b, vec *sum)
{
    for (int row = 0; row < (shape == SPHG_VECTOR ? 1 : d); ++row)
        for (int k = 0; k < d; ++k)
            sum[row] += a[shape == SPHG_VECTOR ? k : tensor_index(shape, row, k, d)] * b[k];
}

/* A_j - A_i of the pairs that the list begins with. */
SPHGI_TEMPLATE void differences(const void *const *rows, struct listed list, const vec *own,
                                int count, vec *difference)
{
    for (int c = 0; c < count; c += SPHGI_ROW) {
        const struct four row = gather_rows(rows[c / SPHGI_ROW], list);
        const vec value[4] = {row.x, row.y, row.z, row.w};
        for (int k = 0; k < SPHGI_ROW && c + k < count; ++k)
            difference[c + k] = value[k] - own[c + k];
    }
}

SPHGI_TEMPLATE void divergence_as(const struct sphgi_piece *piece, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const real *at_target, void *partial, bool three, bool wide)
{
    const int d = three ? 3 : 2, count = components_of(shape, d);
    const int results = shape == SPHG_VECTOR ? 1 : d;
    for (int32_t p = 0; p < piece->parts; ++p) {
        const int32_t lane = piece->lane[p];
        struct listed list = first_listed(piece, p, wide);
        vec own[9], sum[3];
        for (int c = 0; c < count; ++c)
            own[c] = splat(at_target[c * SPHGI_WIDTH + lane]);
        for (int r = 0; r < results; ++r)
            sum[r] = begin_sum(piece, p, partial, r);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1];
             k += LANES, list = after(list, LANES)) {
            vec difference[9], g[3];
            differences(rows, list, own, count, difference);
            vectors_at(piece, k, vectors, three, g);
            add_contracted(shape, d, difference, g, sum);
        }
        for (int r = 0; r < results; ++r)
            *partial_of(partial, r, lane) = sum[r];
    }
}

SPHGI_TEMPLATE void divergence_ids(const struct sphgi_piece *piece, sphg_shape shape,
                                   enum sphgi_vectors vectors, const void *const *rows,
                                   const void *at_target, void *partial, bool three)
{
    if (piece->wide)
        divergence_as(piece, shape, vectors, rows, at_target, partial, three, true);
    else
        divergence_as(piece, shape, vectors, rows, at_target, partial, three, false);
}

SPHGI_TEMPLATE void divergence_of(const struct sphgi_piece *piece, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const void *at_target, void *partial, bool three)
{
    if (shape == SPHG_VECTOR)
        divergence_ids(piece, SPHG_VECTOR, vectors, rows, at_target, partial, three);
    else if (shape == SPHG_SYM_TENSOR)
        divergence_ids(piece, SPHG_SYM_TENSOR, vectors, rows, at_target, partial, three);
    else
        divergence_ids(piece, SPHG_TENSOR, vectors, rows, at_target, partial, three);
}

SPHGI_TEMPLATE void divergence_in(const struct sphgi_piece *piece, sphg_shape shape,
                                  enum sphgi_vectors vectors, const void *const *rows,
                                  const void *at_target, void *partial, bool three)
{
    if (vectors == SPHGI_FACTORS)
        divergence_of(piece, shape, SPHGI_FACTORS, rows, at_target, partial, three);
    else
        divergence_of(piece, shape, SPHGI_TRANSPOSED, rows, at_target, partial, three);
}

static void sum_divergence(const struct sphgi_piece *piece, int32_t dimension, sphg_shape shape,
                           enum sphgi_vectors vectors, const void *const *rows,
                           const void *at_target, void *partial)
{
    if (dimension == 3)
        divergence_in(piece, shape, vectors, rows, at_target, partial, true);
    else
        divergence_in(piece, shape, vectors, rows, at_target, partial, false);
}

/* What add_outer is to a gradient. */
SPHGI_TEMPLATE void add_product_as(int32_t l, int d, sphg_shape shape, const real *a, const real *b,
                                   const real *each, real *divergence)
{
    const int count = components_of(shape, d), results = shape == SPHG_VECTOR ? 1 : d;
    const vec factor = each ? load(each + l) : splat(R(1));
    vec tensor[9], vector[3], sum[3];
    for (int c = 0; c < count; ++c)
        tensor[c] = load(a + c * SPHGI_WIDTH + l);
    for (int k = 0; k < d; ++k)
        vector[k] = factor * load(b + k * SPHGI_WIDTH + l);
    for (int r = 0; r < results; ++r)
        sum[r] = load(divergence + r * SPHGI_WIDTH + l);
    add_contracted(shape, d, tensor, vector, sum);
    for (int r = 0; r < results; ++r)
        store(divergence + r * SPHGI_WIDTH + l, sum[r]);
}

static void add_product(int32_t width, int32_t dimension, sphg_shape shape, const void *a,
                        const void *b, const void *each, void *divergence)
{
    for (int32_t l = 0; l < width; l += LANES)
        add_product_as(l, dimension, shape, a, b, each, divergence);
}
