/* From sums and corrections to results, one target a lane. jacobian: [component][axis][lane]. */

/* J[a][b] = scale sum_c C[b][c] sums[a][c]; correction NULL: the sums are gradients already. */
SPHGI_TEMPLATE void apply_as(int32_t count, const real *c, const real *sums, vec factor, real *j,
                             int32_t d)
{
    for (int32_t a = 0; a < count; ++a, sums += d * LANES, j += d * LANES) {
        vec b[3];
        for (int32_t k = 0; k < d; ++k)
            b[k] = load(sums + k * LANES);
        for (int32_t row = 0; row < d; ++row) {
            vec sum = b[row];
            if (c) {
                sum = load(c + pair_index(row, 0, d) * LANES) * b[0];
                for (int32_t k = 1; k < d; ++k)
                    sum += load(c + pair_index(row, k, d) * LANES) * b[k];
            }
            store(j + row * LANES, factor * sum);
        }
    }
}

static void apply(int32_t dimension, int32_t count, const void *correction, const void *sums,
                  double scale, void *jacobian)
{
    if (dimension == 3)
        apply_as(count, correction, sums, splat(R(scale)), jacobian, 3);
    else
        apply_as(count, correction, sums, splat(R(scale)), jacobian, 2);
}

/* G_ij = scale C_i g_ij for each pair of the piece. */
static void pair_gradients(const struct sphgi_piece *piece, int32_t dimension,
                           enum sphgi_vectors vectors, const void *correction, double scale)
{
    const int32_t d = dimension;
    const real *c = correction;
    const vec factor = splat(R(scale));
    for (int32_t p = 0; p < piece->parts; ++p) {
        vec matrix[3][3];
        for (int32_t a = 0; a < d; ++a)
            for (int32_t b = 0; b < d; ++b)
                matrix[a][b] =
                    splat(c ? c[pair_index(a, b, d) * LANES + piece->lane[p]] : R(a == b));
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1]; k += LANES) {
            real *g = array_of(piece->arrays, SPHGI_GX) + k;
            vec in[3];
            vectors_at(piece, k, vectors, d == 3, in);
            for (int32_t a = 0; a < d; ++a) {
                vec sum = matrix[a][0] * in[0];
                for (int32_t b = 1; b < d; ++b)
                    sum += matrix[a][b] * in[b];
                store(g + a * SPHGI_PIECE, factor * sum);
            }
        }
    }
}

/* out[c] = factor per_lane in[c]; per_lane NULL: 1 */
static void scale_lanes(int32_t count, const void *in, double factor, const void *per_lane,
                        void *out)
{
    vec each = splat(R(factor));
    if (per_lane)
        each *= load(per_lane);
    for (int32_t c = 0; c < count; ++c)
        store((real *)out + c * LANES, each * load((const real *)in + c * LANES));
}

/* All lanes >= 0 and finite. */
static bool valid_volumes(const void *volumes)
{
    const vec v = load(volumes), zero = splat(R(0));
    return bits_of((mask)(v >= zero) & (mask)(v - v == zero)) == (1u << LANES) - 1;
}

/* out[c] = in[c] / divisor */
static void divide_lanes(int32_t count, const void *in, double divisor, void *out)
{
    for (int32_t c = 0; c < count; ++c)
        store((real *)out + c * LANES, load((const real *)in + c * LANES) / splat(R(divisor)));
}

static void fill(int32_t count, double value, void *out)
{
    for (int32_t k = 0; k < count; k += LANES)
        store((real *)out + k, splat(R(value)));
}

static void quotient(const void *a, const void *b, void *out)
{
    vec numerator = splat(R(1));
    if (a)
        numerator = load(a);
    const vec denominator = load(b);
    store(out, where(denominator != splat(R(0)), numerator / denominator));
}

/* J[a][b] += per_lane a_a b_b; per_lane NULL: 1 */
static void add_outer(int32_t dimension, int32_t count, const void *a, const void *b,
                      const void *per_lane, void *jacobian)
{
    const vec each = per_lane ? load(per_lane) : splat(R(1));
    for (int32_t i = 0; i < count; ++i)
        for (int32_t k = 0; k < dimension; ++k) {
            real *j = (real *)jacobian + (i * dimension + k) * LANES;
            store(j, load(j) + each * load((const real *)a + i * LANES) *
                                   load((const real *)b + k * LANES));
        }
}

/* Component (a, b) of a tensor among those that the shape holds. */
SPHGI_TEMPLATE int tensor_index(sphg_shape shape, int a, int b, int d)
{
    return shape == SPHG_SYM_TENSOR ? pair_index(a, b, d) : a * d + b;
}

/* divergence: vector sum_a J[a][a], tensors sum_b J[(a, b)][b]; curl of a vector. NULL: not
 * wanted. */
static void contract(int32_t dimension, sphg_shape shape, const void *jacobian, void *divergence,
                     void *curl)
{
    const int32_t d = dimension;
    const real *j = jacobian;
    real *div = divergence, *rot = curl;
    if (div) {
        const int32_t rows = shape == SPHG_VECTOR ? 1 : d;
        for (int32_t a = 0; a < rows; ++a) {
            vec sum = splat(R(0));
            for (int32_t b = 0; b < d; ++b) {
                const int32_t c = shape == SPHG_VECTOR ? b : tensor_index(shape, a, b, d);
                sum += load(j + (c * d + b) * LANES);
            }
            store(div + a * LANES, sum);
        }
    }
    if (rot && d == 2)
        store(rot, load(j + 2 * LANES) - load(j + LANES));
    for (int32_t a = 0; rot && d == 3 && a < 3; ++a) {
        const int32_t b = (a + 1) % 3, c = (a + 2) % 3;
        store(rot + a * LANES, load(j + (c * 3 + b) * LANES) - load(j + (b * 3 + c) * LANES));
    }
}
