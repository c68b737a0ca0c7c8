/* SPDX-License-Identifier: MIT */
/* From sums and corrections to results. jacobian: [component][axis][target]. Loops over the vectors
 * of a group stand outermost: one vector's numbers fit the registers. */

/* J[a][b] = factor sum_c C[b][c] sums[a][c]; correction NULL: the sums are gradients already. */
SPHGI_TEMPLATE void apply_as(int32_t count, const real *correction, const real *sums, vec factor,
                             real *j, int32_t d)
{
    vec c[6];
    for (int32_t k = 0; correction && k < d * (d + 1) / 2; ++k)
        c[k] = load(correction + k * SPHGI_WIDTH);
    for (int32_t a = 0; a < count; ++a, sums += d * SPHGI_WIDTH, j += d * SPHGI_WIDTH) {
        vec b[3];
        for (int32_t k = 0; k < d; ++k)
            b[k] = load(sums + k * SPHGI_WIDTH);
        for (int32_t row = 0; row < d; ++row) {
            vec sum = b[row];
            if (correction) {
                sum = c[sphgi_pair_index(row, 0, d)] * b[0];
                for (int32_t k = 1; k < d; ++k)
                    sum = plus(sum, c[sphgi_pair_index(row, k, d)], b[k]);
            }
            store(j + row * SPHGI_WIDTH, factor * sum);
        }
    }
}

static void apply(int32_t width, int32_t dimension, int32_t count, const void *correction,
                  const void *sums, double scale, const void *each, void *jacobian)
{
    for (int32_t l = 0; l < width; l += LANES) {
        vec factor = splat(R(scale));
        if (each)
            factor *= load((const real *)each + l);
        const real *c = correction ? (const real *)correction + l : NULL;
        WITH(three, dimension == 3,
             apply_as(count, c, (const real *)sums + l, factor, (real *)jacobian + l,
                      three ? 3 : 2));
    }
}

/* G_ij = scale C_i g_ij for each pair of the tile. */
static void pair_gradients(const struct sphgi_tile *tile, int32_t dimension,
                           enum sphgi_vectors vectors, const void *correction, double scale)
{
    const int32_t d = dimension == 3 ? 3 : 2;
    const real *c = correction;
    const vec factor = splat(R(scale));
    vec matrix[3][3];
    for (int32_t a = 0; a < d; ++a)
        for (int32_t b = 0; b < d; ++b)
            matrix[a][b] =
                c ? load(c + sphgi_pair_index(a, b, d) * SPHGI_WIDTH) : splat(R(a == b ? 1 : 0));
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        real *g = array_of(tile->arrays, SPHGI_GX) + k;
        vec in[3];
        vectors_at(tile, k, vectors, d == 3, in);
        for (int32_t a = 0; a < d; ++a) {
            vec sum = matrix[a][0] * in[0];
            for (int32_t b = 1; b < d; ++b)
                sum = plus(sum, matrix[a][b], in[b]);
            store(g + a * SPHGI_TILE, factor * sum);
        }
    }
}

/* out[c] = factor each in[c]; each NULL: 1 */
static void scale_lanes(int32_t width, int32_t count, const void *in, double factor,
                        const void *each, void *out)
{
    for (int32_t l = 0; l < width; l += LANES) {
        vec by = splat(R(factor));
        if (each)
            by *= load((const real *)each + l);
        for (int32_t k = l; k < count * SPHGI_WIDTH; k += SPHGI_WIDTH)
            store((real *)out + k, by * load((const real *)in + k));
    }
}

static bool valid_volumes(int32_t width, const void *volumes)
{
    const vec zero = splat(R(0));
    mask valid = first_lanes(LANES);
    for (int32_t l = 0; l < width; l += LANES) {
        const vec v = load((const real *)volumes + l);
        valid &= at_most(zero, v) & ~differ(v - v, zero);
    }
    return bits_of(valid) == ALL;
}

/* out[c] = in[c] / divisor */
static void divide_lanes(int32_t width, int32_t count, const void *in, double divisor, void *out)
{
    const vec by = splat(R(divisor));
    for (int32_t l = 0; l < width; l += LANES)
        for (int32_t k = l; k < count * SPHGI_WIDTH; k += SPHGI_WIDTH)
            store((real *)out + k, load((const real *)in + k) / by);
}

static void fill(int32_t count, double value, void *out)
{
    for (int32_t k = 0; k < count; k += LANES)
        store((real *)out + k, splat(R(value)));
}

/* a / b, and 0 where b is 0 */
SPHGI_TEMPLATE vec ratio(vec a, vec b)
{
    return where(differ(b, splat(R(0))), a / b);
}

static void quotient(int32_t width, const void *a, const void *b, void *out)
{
    for (int32_t l = 0; l < width; l += LANES) {
        vec numerator = splat(R(1));
        if (a)
            numerator = load((const real *)a + l);
        store((real *)out + l, ratio(numerator, load((const real *)b + l)));
    }
}

/* J[a][b] += each a_a b_b; each NULL: 1 */
static void add_outer(int32_t width, int32_t dimension, int32_t count, const void *a, const void *b,
                      const void *each, void *jacobian)
{
    for (int32_t l = 0; l < width; l += LANES)
        for (int32_t i = 0; i < count; ++i) {
            vec factor = load((const real *)a + i * SPHGI_WIDTH + l);
            if (each)
                factor *= load((const real *)each + l);
            for (int32_t k = 0; k < dimension; ++k) {
                real *j = (real *)jacobian + (i * dimension + k) * SPHGI_WIDTH + l;
                store(j, plus(load(j), factor, load((const real *)b + k * SPHGI_WIDTH + l)));
            }
        }
}

/* divergence: vector sum_a J[a][a], tensors sum_b J[(a, b)][b] */
SPHGI_TEMPLATE void diverge(int32_t d, sphg_shape shape, const real *j, real *divergence)
{
    const int32_t rows = shape == SPHG_VECTOR ? 1 : d;
    for (int32_t a = 0; a < rows; ++a) {
        vec sum = splat(R(0));
        for (int32_t b = 0; b < d; ++b) {
            const int32_t c = shape == SPHG_VECTOR ? b : tensor_index(shape, a, b, d);
            sum += load(j + (c * d + b) * SPHGI_WIDTH);
        }
        store(divergence + a * SPHGI_WIDTH, sum);
    }
}

SPHGI_TEMPLATE void rotate_field(int32_t d, const real *j, real *curl)
{
    if (d == 2)
        store(curl, load(j + 2 * SPHGI_WIDTH) - load(j + SPHGI_WIDTH));
    for (int32_t a = 0; d == 3 && a < 3; ++a) {
        const int32_t b = (a + 1) % 3, c = (a + 2) % 3;
        store(curl + a * SPHGI_WIDTH,
              load(j + (c * 3 + b) * SPHGI_WIDTH) - load(j + (b * 3 + c) * SPHGI_WIDTH));
    }
}

/* out = sum a b of count numbers */
static void double_product(int32_t width, int32_t count, const void *a, const void *b, void *out)
{
    for (int32_t l = 0; l < width; l += LANES) {
        vec sum = load((const real *)a + l) * load((const real *)b + l);
        for (int32_t k = 1; k < count; ++k)
            sum = plus(sum, load((const real *)a + k * SPHGI_WIDTH + l),
                       load((const real *)b + k * SPHGI_WIDTH + l));
        store((real *)out + l, sum);
    }
}

/* Divergence, and curl of a vector. NULL: not wanted. */
static void contract(int32_t width, int32_t dimension, sphg_shape shape, const void *jacobian,
                     void *divergence, void *curl)
{
    for (int32_t l = 0; l < width; l += LANES) {
        if (divergence)
            diverge(dimension, shape, (const real *)jacobian + l, (real *)divergence + l);
        if (curl)
            rotate_field(dimension, (const real *)jacobian + l, (real *)curl + l);
    }
}
