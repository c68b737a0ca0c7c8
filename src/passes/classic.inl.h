/* SPDX-License-Identifier: MIT */
/* Classic MLS and RKPM: the full derivative of the interpolant (theory.md, section 4), with
 * xi_j = -x_ij / H, p_j = (1, xi_j). Weights: S = w, D = w'/r, both times V_j if `weighted`. */

/* Sums over products of the offsets, x = x_ij / H, s their weight: s (if `whole`), s x, s xx, the
 * upper triangle row by row. */
SPHGI_TEMPLATE void classic_products(vec s, const vec *x, vec *sum, bool whole, bool three)
{
    const int32_t d = three ? 3 : 2;
    int32_t at = 0;
    vec sx[3];
    if (whole)
        sum[at++] += s;
    for (int32_t a = 0; a < d; ++a) {
        sx[a] = s * x[a];
        sum[at++] += sx[a];
    }
    for (int32_t a = 0; a < d; ++a)
        for (int32_t b = a; b < d; ++b, ++at)
            sum[at] = plus(sum[at], sx[a], x[b]);
}

SPHGI_TEMPLATE void classic_moments_as(const struct sphgi_tile *tile, void *sums, bool weighted,
                                       bool three)
{
    const int32_t d = three ? 3 : 2, n = three ? 10 : 6;
    vec sum[10];
    clear(sum, n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec s = from(tile, SPHGI_S, k), x[3];
        if (weighted)
            s *= from(tile, SPHGI_V, k);
        for (int32_t a = 0; a < d; ++a)
            x[a] = from(tile, (enum sphgi_array)(SPHGI_X + a), k);
        classic_products(s, x, sum, true, three);
    }
    end_tile(tile, sum, n, sums);
}

/* w, w x, w xx */
static void sum_classic(const struct sphgi_tile *tile, int32_t dimension, bool weighted, void *sums)
{
    WITH(three, dimension == 3,
         WITH(by_volume, weighted, classic_moments_as(tile, sums, by_volume, three)));
}

/* p.y of a pair, or p.z_k */
SPHGI_TEMPLATE vec classic_polynomial(const vec *y, const vec *x, bool three)
{
    vec polynomial = y[0];
    for (int32_t a = 0; a < (three ? 3 : 2); ++a)
        polynomial = minus(polynomial, y[1 + a], x[a]);
    return polynomial;
}

SPHGI_TEMPLATE void classic_slopes_as(const struct sphgi_tile *tile, const real *solution,
                                      void *sums, bool weighted, bool three)
{
    const int32_t d = three ? 3 : 2, n = three ? 9 : 5;
    vec y[4], sum[9];
    for (int32_t k = 0; k <= d; ++k)
        y[k] = load(solution + k * SPHGI_WIDTH);
    clear(sum, n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec s = from(tile, SPHGI_D, k), x[3];
        if (weighted)
            s *= from(tile, SPHGI_V, k);
        for (int32_t a = 0; a < d; ++a)
            x[a] = from(tile, (enum sphgi_array)(SPHGI_X + a), k);
        classic_products(s * classic_polynomial(y, x, three), x, sum, false, three);
    }
    end_tile(tile, sum, n, sums);
}

/* s x, s xx with s = d S0 (p.y): B_k y is made of them. */
static void sum_classic_slopes(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                               const void *solution, void *sums)
{
    WITH(three, dimension == 3,
         WITH(by_volume, weighted, classic_slopes_as(tile, solution, sums, by_volume, three)));
}

/* G_ij = D x (p.y) + S (p.z_k) from the coefficients [y0 y | z_x0 z_x | ..], and PHI = S (p.y). */
SPHGI_TEMPLATE void classic_vector(const struct sphgi_tile *tile, int32_t k, const vec *c,
                                   bool weighted, bool three, vec *g, vec *phi)
{
    const int32_t d = three ? 3 : 2, width = d + 1;
    vec x[3], s = from(tile, SPHGI_S, k), slope = from(tile, SPHGI_D, k);
    for (int32_t a = 0; a < d; ++a)
        x[a] = from(tile, (enum sphgi_array)(SPHGI_X + a), k);
    if (weighted) {
        const vec v = from(tile, SPHGI_V, k);
        s *= v;
        slope *= v;
    }
    const vec y = classic_polynomial(c, x, three), slope_y = slope * y;
    for (int32_t a = 0; a < d; ++a)
        g[a] = plus(slope_y * x[a], s, classic_polynomial(c + (a + 1) * width, x, three));
    *phi = s * y;
}

SPHGI_TEMPLATE void classic_vectors_as(const struct sphgi_tile *tile, const real *coefficients,
                                       bool weighted, bool three)
{
    const int32_t d = three ? 3 : 2;
    vec c[16];
    for (int32_t k = 0; k < (d + 1) * (d + 1); ++k)
        c[k] = load(coefficients + k * SPHGI_WIDTH);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec g[3], phi;
        classic_vector(tile, k, c, weighted, three, g, &phi);
        real *at = array_of(tile->arrays, SPHGI_GX) + k;
        for (int32_t a = 0; a < d; ++a)
            store(at + a * SPHGI_TILE, g[a]);
        store(array_of(tile->arrays, SPHGI_PHI) + k, phi);
    }
}

static void classic_vectors(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                            const void *coefficients)
{
    WITH(three, dimension == 3,
         WITH(by_volume, weighted, classic_vectors_as(tile, coefficients, by_volume, three)));
}

/* sum_field over G_ij that nobody else needs. */
SPHGI_TEMPLATE void classic_field_as(const struct sphgi_tile *tile, const real *coefficients,
                                     const real *rows, const real *at_target, real *sums,
                                     int32_t count, bool weighted, bool three)
{
    const int32_t d = three ? 3 : 2;
    vec c[16], own[4], sum[12];
    for (int32_t k = 0; k < (d + 1) * (d + 1); ++k)
        c[k] = load(coefficients + k * SPHGI_WIDTH);
    for (int32_t a = 0; a < count; ++a)
        own[a] = load(at_target + a * SPHGI_WIDTH);
    clear(sum, count * d);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec g[3], phi;
        classic_vector(tile, k, c, weighted, three, g, &phi);
        const struct four row = gather_rows(rows, ids_at(tile, k));
        const vec at_source[4] = {row.x, row.y, row.z, row.w};
        for (int32_t a = 0; a < count; ++a)
            for (int32_t b = 0; b < d; ++b)
                sum[a * d + b] = plus(sum[a * d + b], at_source[a] - own[a], g[b]);
    }
    end_tile(tile, sum, count * d, sums);
}

SPHGI_TEMPLATE void classic_field_of(const struct sphgi_tile *tile, const void *coefficients,
                                     const void *rows, int32_t count, const void *at_target,
                                     void *sums, bool weighted, bool three)
{
    if (count == 1)
        classic_field_as(tile, coefficients, rows, at_target, sums, 1, weighted, three);
    else if (count == 2)
        classic_field_as(tile, coefficients, rows, at_target, sums, 2, weighted, three);
    else if (count == 3)
        classic_field_as(tile, coefficients, rows, at_target, sums, 3, weighted, three);
    else
        classic_field_as(tile, coefficients, rows, at_target, sums, 4, weighted, three);
}

static void sum_classic_field(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                              const void *coefficients, const void *rows, int32_t count,
                              const void *at_target, void *sums)
{
    WITH(
        three, dimension == 3,
        WITH(by_volume, weighted,
             classic_field_of(tile, coefficients, rows, count, at_target, sums, by_volume, three)));
}

/* T = - weight G_ji with j's coefficients in rows (y_j, z_x,j, ...: one row each): the offset seen
 * from j is +x_ij / H, its slope points the other way, and the volume in w is the target's. */
SPHGI_TEMPLATE void transposed_classic_as(const struct sphgi_tile *tile, const void *const rows[4],
                                          const struct sphgi_scales *scales,
                                          const real *target_volume, const void *density,
                                          enum sphgi_weight kind, bool three)
{
    const int32_t d = three ? 3 : 2;
    const vec y_unit = splat(R(scales->value)), z_unit = splat(R(scales->slope));
    const vec volume = target_volume ? load(target_volume) : splat(R(1));
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec weight = weight_of(tile, k, density, kind);
        const vec x[3] = {from(tile, SPHGI_X, k), from(tile, SPHGI_Y, k),
                          three ? from(tile, SPHGI_Z, k) : splat(R(0))};
        vec polynomial[4];
        for (int32_t m = 0; m <= d; ++m) {
            const struct four c = gather_rows(rows[m], ids_at(tile, k));
            polynomial[m] = plus(plus(c.x, c.y, x[0]), c.z, x[1]);
            if (three)
                polynomial[m] = plus(polynomial[m], c.w, x[2]);
        }
        /* Units meet the coefficients first: both may be far from 1, their quotient is not. */
        const vec slope = weight * from(tile, SPHGI_D, k) * (volume * (polynomial[0] / y_unit));
        const vec s = weight * from(tile, SPHGI_S, k);
        real *t = array_of(tile->arrays, SPHGI_TX) + k;
        for (int32_t a = 0; a < d; ++a)
            store(t + a * SPHGI_TILE,
                  minus(slope * x[a], s, volume * (polynomial[1 + a] / z_unit)));
    }
}

static void transposed_classic(const struct sphgi_tile *tile, int32_t dimension,
                               const void *const rows[4], const struct sphgi_scales *scales,
                               const void *target_volume, const void *density,
                               enum sphgi_weight kind)
{
    WITH(three, dimension == 3,
         transposed_classic_as(tile, rows, scales, target_volume, density, kind, three));
}
