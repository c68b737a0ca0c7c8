/* SPDX-License-Identifier: MIT */
/* From sums to the forms that have two sides (theory.md, section 5) and to squares (section 6), a
 * formula each. */

/* ---- Adjoint and symmetric ------------------------------------------------------------------ */

/* Of a vector of targets: f_i = all (others S_i + own A_i G_i), with S_i the sums over the sources'
 * terms and G_i = C_i sum s_ij x_ij.
 *   adjoint      f_i = V_i A_i G_i + S_i, or V_i (A_i G_i + S_i) where the terms hold V_i
 *   symmetric    f_i = A_i G_i / rho_i + rho_i S_i / V_i, or rho_i S_i where the terms hold V_i
 * all also takes the result from units of H to lengths. */
struct sides {
    vec others, own, all;
};

SPHGI_TEMPLATE struct sides sides_at(const struct sphgi_two_sided *of, int32_t l)
{
    const vec one = splat(R(1));
    struct sides at = {one, one, splat(R(of->factor))};
    if (of->density) {
        const vec rho = load((const real *)of->density + l);
        at.own = ratio(one, rho);
        at.others = rho;
        if (!of->holds_volume)
            at.others = ratio(rho, load((const real *)of->volume + l));
    } else if (of->holds_volume) {
        at.all *= load((const real *)of->volume + l);
    } else {
        at.own = load((const real *)of->volume + l);
    }
    return at;
}

/* others S_i. The unit comes first: its product with a density need not be a number of f32. */
SPHGI_TEMPLATE vec side_of_others(const struct sphgi_two_sided *of, const struct sides *at,
                                  const real *sum)
{
    return at->others * (splat(R(of->unit)) * load(sum));
}

/* f[c][k] of A_c G_k */
static void two_sided_gradient(int32_t width, int32_t dimension, int32_t count,
                               const struct sphgi_two_sided *of, const void *a,
                               const void *own_gradient, const void *sums, void *gradient)
{
    for (int32_t l = 0; l < width; l += LANES) {
        const struct sides at = sides_at(of, l);
        for (int32_t c = 0; c < count; ++c) {
            const vec own = at.own * load((const real *)a + c * SPHGI_WIDTH + l);
            for (int32_t k = 0; k < dimension; ++k) {
                const vec g = load((const real *)own_gradient + k * SPHGI_WIDTH + l);
                const int32_t n = (c * dimension + k) * SPHGI_WIDTH + l;
                const vec others = side_of_others(of, &at, (const real *)sums + n);
                store((real *)gradient + n, at.all * plus(others, own, g));
            }
        }
    }
}

/* f[r] of A . G, of a tensor row by row */
SPHGI_TEMPLATE void two_sided_divergence_as(int32_t l, sphg_shape shape,
                                            const struct sphgi_two_sided *of, const real *a,
                                            const real *own_gradient, const real *sums,
                                            real *divergence, bool three)
{
    const int d = three ? 3 : 2;
    const int count = components_of(shape, d), results = shape == SPHG_VECTOR ? 1 : d;
    const struct sides at = sides_at(of, l);
    vec tensor[9], g[3], sum[3];
    for (int c = 0; c < count; ++c)
        tensor[c] = load(a + c * SPHGI_WIDTH + l);
    for (int k = 0; k < d; ++k)
        g[k] = at.own * load(own_gradient + k * SPHGI_WIDTH + l);
    for (int r = 0; r < results; ++r)
        sum[r] = side_of_others(of, &at, sums + r * SPHGI_WIDTH + l);
    add_contracted(shape, d, tensor, g, sum);
    for (int r = 0; r < results; ++r)
        store(divergence + r * SPHGI_WIDTH + l, at.all * sum[r]);
}

static void two_sided_divergence(int32_t width, int32_t dimension, sphg_shape shape,
                                 const struct sphgi_two_sided *of, const void *a,
                                 const void *own_gradient, const void *sums, void *divergence)
{
    for (int32_t l = 0; l < width; l += LANES)
        WITH(three, dimension == 3,
             two_sided_divergence_as(l, shape, of, a, own_gradient, sums, divergence, three));
}

/* ---- Squares -------------------------------------------------------------------------------- */

/* tr(C S C) = sum_ab C_ab (C S)_ab */
SPHGI_TEMPLATE vec trace_between_as(const real *correction, const real *sums, int d)
{
    vec c[6], s[6], trace = splat(R(0));
    for (int k = 0; k < d * (d + 1) / 2; ++k) {
        c[k] = load(correction + k * SPHGI_WIDTH);
        s[k] = load(sums + k * SPHGI_WIDTH);
    }
    for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) {
            vec product = c[sphgi_pair_index(a, 0, d)] * s[sphgi_pair_index(0, b, d)];
            for (int k = 1; k < d; ++k)
                product = plus(product, c[sphgi_pair_index(a, k, d)], s[sphgi_pair_index(k, b, d)]);
            trace = plus(trace, c[sphgi_pair_index(a, b, d)], product);
        }
    return trace;
}

/* sum A_j |G_ij|^2: S, or tr(C_i S C_i), in units of H; and A_i |G_ii|^2 */
SPHGI_TEMPLATE vec square_as(int32_t l, const struct sphgi_square *of, const real *sums, bool three)
{
    const int d = three ? 3 : 2;
    vec factor = splat(R(of->factor)), sum = load(sums + l);
    if (of->each)
        factor *= load((const real *)of->each + l);
    if (of->correction)
        sum = trace_between_as((const real *)of->correction + l, sums + l, d);
    sum *= factor;
    if (of->self) {
        const vec value = load((const real *)of->value + l);
        vec g[3], weighted[3];
        for (int k = 0; k < d; ++k) {
            g[k] = load((const real *)of->self + k * SPHGI_WIDTH + l);
            weighted[k] = value * g[k];
        }
        add_contracted(SPHG_VECTOR, d, g, weighted, &sum);
    }
    return sum;
}

static void square(int32_t width, int32_t dimension, const struct sphgi_square *of,
                   const void *sums, void *out)
{
    for (int32_t l = 0; l < width; l += LANES)
        WITH(three, dimension == 3, store((real *)out + l, square_as(l, of, sums, three)));
}
