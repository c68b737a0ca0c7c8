/* Divergences of vectors and tensors and squares of gradients, contracted pair by pair: as few sums
 * as results where nothing is to come. */

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

/* ---- Squares -------------------------------------------------------------------------------- */

SPHGI_TEMPLATE void squares_as(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                               const real *rows, const real *own, void *partial, bool three,
                               bool trace, bool wide)
{
    const int d = three ? 3 : 2, sums = trace ? 1 : d * (d + 1) / 2;
    for (int32_t p = 0; p < piece->parts; ++p) {
        struct listed list = first_listed(piece, p, wide);
        const vec off = splat(own[piece->lane[p]]);
        vec sum[6];
        for (int c = 0; c < sums; ++c)
            sum[c] = begin_sum(piece, p, partial, c);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1];
             k += LANES, list = after(list, LANES)) {
            const vec a = gather_rows(rows, list).x - off;
            vec g[3];
            vectors_at(piece, k, vectors, three, g);
            for (int b = 0; b < d; ++b)
                for (int c = b; c < (trace ? b + 1 : d); ++c)
                    sum[trace ? 0 : pair_index(b, c, d)] += a * g[b] * g[c];
        }
        for (int c = 0; c < sums; ++c)
            *partial_of(partial, c, piece->lane[p]) = sum[c];
    }
}

SPHGI_TEMPLATE void squares_ids(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                                const void *rows, const void *own, void *partial, bool three,
                                bool trace)
{
    if (piece->wide)
        squares_as(piece, vectors, rows, own, partial, three, trace, true);
    else
        squares_as(piece, vectors, rows, own, partial, three, trace, false);
}

SPHGI_TEMPLATE void squares_in(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                               int32_t sums, const void *rows, const void *own, void *partial,
                               bool three)
{
    if (sums > 1)
        squares_ids(piece, SPHGI_FACTORS, rows, own, partial, three, false);
    else if (vectors == SPHGI_FACTORS)
        squares_ids(piece, SPHGI_FACTORS, rows, own, partial, three, true);
    else
        squares_ids(piece, SPHGI_GRADIENTS, rows, own, partial, three, true);
}

static void sum_squares(const struct sphgi_piece *piece, int32_t dimension,
                        enum sphgi_vectors vectors, int32_t sums, const void *rows, const void *own,
                        void *partial)
{
    if (dimension == 3)
        squares_in(piece, vectors, sums, rows, own, partial, true);
    else
        squares_in(piece, vectors, sums, rows, own, partial, false);
}

/* sum_ab C_ab (C S)_ab */
SPHGI_TEMPLATE vec trace_between_as(const real *correction, const real *sums, int d)
{
    vec c[6], s[6], trace = splat(R(0));
    for (int k = 0; k < d * (d + 1) / 2; ++k) {
        c[k] = load(correction + k * SPHGI_WIDTH);
        s[k] = load(sums + k * SPHGI_WIDTH);
    }
    for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) {
            vec product = c[pair_index(a, 0, d)] * s[pair_index(0, b, d)];
            for (int k = 1; k < d; ++k)
                product += c[pair_index(a, k, d)] * s[pair_index(k, b, d)];
            trace += c[pair_index(a, b, d)] * product;
        }
    return trace;
}

static void trace_between(int32_t width, int32_t dimension, const void *correction,
                          const void *sums, void *trace)
{
    for (int32_t l = 0; l < width; l += LANES) {
        const real *c = (const real *)correction + l, *s = (const real *)sums + l;
        store((real *)trace + l,
              dimension == 3 ? trace_between_as(c, s, 3) : trace_between_as(c, s, 2));
    }
}
