/* SPDX-License-Identifier: MIT */
/* Diffusion between the particles of a pair (theory.md, section 11): L_ij, then the sums of
 * k_ij L_ij (A_j - A_i). */

/* What the symmetric matrix m makes of the direction of x, x^T m x / r^2; of coincident particles
 * its mean over all directions. Never negative: rounding of what nearly vanishes is cut off. */
SPHGI_TEMPLATE vec along(const vec *m, const vec *x, int d)
{
    vec square = splat(R(0)), product = splat(R(0)), trace = splat(R(0));
    for (int a = 0; a < d; ++a) {
        square = plus(square, x[a], x[a]);
        trace += m[sphgi_pair_index(a, a, d)];
        product = plus(product, m[sphgi_pair_index(a, a, d)] * x[a], x[a]);
        for (int b = a + 1; b < d; ++b) {
            const vec mixed = m[sphgi_pair_index(a, b, d)] * x[a] * x[b];
            product += mixed + mixed;
        }
    }
    const mask apart = less(splat(R(0)), square);
    const vec value = select(apart, product / square, trace * splat(R(1) / R(d)));
    return select(less(value, splat(R(0))), splat(R(0)), value);
}

/* L = -s_ij e^T (E_i + unit weight_j C_j) e with the direction e of the pair; own NULL: without
 * E_i, table NULL: without C_j. add: to what L holds. */
SPHGI_TEMPLATE void pair_laplacian_as(const struct sphgi_tile *tile, const real *own,
                                      const void *const *table, double inverse_h, double unit,
                                      enum sphgi_weight kind, bool add, int d)
{
    const int n = d * (d + 1) / 2;
    const vec units = splat(R(inverse_h)), scale = splat(R(unit));
    vec ours[6];
    for (int c = 0; c < n; ++c)
        ours[c] = own ? load(own + c * SPHGI_WIDTH) : splat(R(0));
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec m[6], theirs[6], x[3];
        for (int a = 0; a < d; ++a) /* in units of H: squares stay normal numbers */
            x[a] = units * from(tile, (enum sphgi_array)(SPHGI_X + a), k);
        for (int c = 0; c < n; ++c)
            m[c] = ours[c];
        if (table) {
            const vec weight = scale * weight_of(tile, k, NULL, kind);
            folded_at(tile, k, table, n, theirs);
            for (int c = 0; c < n; ++c)
                m[c] = plus(m[c], weight, theirs[c]);
        }
        const vec s = from(tile, SPHGI_S, k), direction = along(m, x, d);
        real *at = array_of(tile->arrays, SPHGI_L) + k;
        const vec alone = -s * direction;
        store(at, add ? minus(load(at), s, direction) : alone);
    }
}

static void pair_laplacian(const struct sphgi_tile *tile, int32_t dimension, const void *own,
                           const void *const *table, double inverse_h, double unit,
                           enum sphgi_weight kind, bool add)
{
    WITH(three, dimension == 3,
         pair_laplacian_as(tile, own, table, inverse_h, unit, kind, add, three ? 3 : 2));
}

/* The same where C is 1: L = -s_ij factor each. each NULL: 1 */
static void pair_laplacian_plain(const struct sphgi_tile *tile, double factor, const void *each,
                                 bool add)
{
    vec by = splat(R(-factor));
    if (each)
        by *= load(each);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        real *at = array_of(tile->arrays, SPHGI_L) + k;
        const vec s = from(tile, SPHGI_S, k);
        const vec alone = by * s;
        store(at, add ? plus(load(at), by, s) : alone);
    }
}

/* 2 a b / (a + b), the same bits from both sides of a pair; 0 where both are. */
SPHGI_TEMPLATE vec harmonic_mean(vec a, vec b)
{
    const vec low = vmin(a, b), high = vmax(a, b), sum = a + b;
    return where(differ(sum, splat(R(0))), (low + low) * (high / sum));
}

SPHGI_TEMPLATE void diffusion_as(const struct sphgi_tile *tile, const real *rows,
                                 const real *coefficients, const real *own_coefficient,
                                 const real *at_target, void *sums, int32_t count)
{
    const vec here = coefficients ? load(own_coefficient) : splat(R(1));
    vec own[4], sum[4];
    for (int32_t c = 0; c < count; ++c)
        own[c] = load(at_target + c * SPHGI_WIDTH);
    clear(sum, count);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four row = gather_rows(rows, ids_at(tile, k));
        const vec value[4] = {row.x, row.y, row.z, row.w};
        vec pair = from(tile, SPHGI_L, k);
        if (coefficients)
            pair *= harmonic_mean(here, gather_rows(coefficients, ids_at(tile, k)).x);
        for (int32_t c = 0; c < count; ++c)
            sum[c] = plus(sum[c], value[c] - own[c], pair);
    }
    end_tile(tile, sum, count, sums);
}

SPHGI_TEMPLATE void diffusion_of(const struct sphgi_tile *tile, const void *rows,
                                 const void *coefficients, const void *own, const void *at_target,
                                 void *sums, int32_t count)
{
    if (coefficients)
        diffusion_as(tile, rows, coefficients, own, at_target, sums, count);
    else
        diffusion_as(tile, rows, NULL, NULL, at_target, sums, count);
}

static void sum_diffusion(const struct sphgi_tile *tile, const void *rows, int32_t count,
                          const void *coefficients, const void *own_coefficient,
                          const void *at_target, void *sums)
{
    switch (count) {
    case 1:
        diffusion_of(tile, rows, coefficients, own_coefficient, at_target, sums, 1);
        break;
    case 2:
        diffusion_of(tile, rows, coefficients, own_coefficient, at_target, sums, 2);
        break;
    case 3:
        diffusion_of(tile, rows, coefficients, own_coefficient, at_target, sums, 3);
        break;
    default:
        diffusion_of(tile, rows, coefficients, own_coefficient, at_target, sums, 4);
    }
}
