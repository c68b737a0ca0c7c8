/* SPDX-License-Identifier: MIT */
/* Order 2 (theory.md, section 9) from moments to corrections, and from these to results: gradients
 * of pairs, gradients, Hessians and Laplacians of fields. */

SPHGI_TEMPLATE void note_directions(vec resolved, int32_t lanes, uint8_t *directions)
{
    const vec some = where(less(splat(R(0)), resolved), resolved + R(.5));
    const bit_pattern nearest = __builtin_convertvector(some, bit_pattern);
    if (lanes >= LANES)
        for (int l = 0; l < LANES; ++l)
            directions[l] = (uint8_t)nearest[l];
    else
        for (int l = 0; l < lanes; ++l)
            directions[l] = (uint8_t)nearest[l];
}

/* One vector of targets on its way. */
struct solving {
    struct block block;
    struct resolution found;
    vec f[PAIRS_MOST][PAIRS_MOST];
    mask positive;
};

SPHGI_TEMPLATE vec factor_at(const real *scale, int32_t l)
{
    if (scale)
        return load(scale + l);
    return splat(R(1));
}

/* Step by step for all vectors: what one waits for, another does. */
SPHGI_TEMPLATE void invert_quadratic_as(int32_t width, const struct sphgi_second *second,
                                        const real *sums, const real *scale, const real *kept,
                                        int32_t lanes, const struct sphgi_borrowing *borrowing,
                                        real *out, uint8_t *directions, bool borrows, bool three)
{
    struct solving all[SPHGI_WIDTH / LANES];
    for (int32_t l = 0; l < width; l += LANES) {
        struct solving *one = &all[l / LANES];
        const vec factor = factor_at(scale, l);
        if (borrows)
            look_for_lenders(borrowing, l, factor, &one->found);
        eliminate(second, sums + l, factor, &one->block, three);
    }
    for (struct solving *one = all; one < all + width / LANES; ++one)
        one->positive = inverse_by_columns(one->block.s, splat(R(0)), one->f, three);
    for (int32_t l = 0; l < width; l += LANES) {
        struct solving *one = &all[l / LANES];
        const vec share = load(kept + l);
        const vec resolved =
            resolve(second, &one->block, share, one->f, one->positive, &one->found, borrows, three);
        if (borrows)
            note_borrowing(second, sums + l, factor_at(scale, l), share, &one->block, &one->found,
                           one->f, l, borrowing, three);
        note_directions(resolved, lanes - l, directions + l);
    }
    for (int32_t l = 0; l < width; l += LANES) {
        struct solving *one = &all[l / LANES];
        const mask some = less(splat(R(0)), load(kept + l));
        join_blocks(second, &one->block, one->f, some, factor_at(scale, l), out + l,
                    borrows || second->whole, three);
    }
}

static void invert_quadratic(int32_t width, int32_t dimension, const struct sphgi_second *second,
                             const void *sums, const void *scale, const void *kept, int32_t lanes,
                             const struct sphgi_borrowing *borrowing, void *coefficients,
                             uint8_t *directions)
{
    WITH(three, dimension == 3,
         WITH(borrows, borrowing,
              invert_quadratic_as(width, second, sums, scale, kept, lanes,
                                  borrows ? borrowing : NULL, coefficients, directions, borrows,
                                  three)));
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* G_ij = w (P e + Q (e e^T)), e = -x, w = -s, the products of one axis halved. */
SPHGI_TEMPLATE void quadratic_gradients_as(const struct sphgi_tile *tile, const real *c, vec scale,
                                           bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    const real *cross = c + n * SPHGI_WIDTH;
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec x[3], g[3], p[PAIRS_MOST];
        offsets_at(tile, k, three, x);
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        pair_products(g, x, three, p);
        for (int a = 0; a < d; ++a) {
            vec sum = load(c + sphgi_pair_index(a, 0, d) * SPHGI_WIDTH) * g[0];
            for (int b = 1; b < d; ++b)
                sum = plus(sum, load(c + sphgi_pair_index(a, b, d) * SPHGI_WIDTH), g[b]);
            for (int m = 0; m < n; ++m)
                sum = minus(sum, load(cross + (a * n + m) * SPHGI_WIDTH),
                            (is_square(m, three) ? R(.5) : R(1)) * p[m]);
            store(array_of(tile->arrays, SPHGI_GX) + a * SPHGI_TILE + k, scale * sum);
        }
    }
}

static void quadratic_gradients(const struct sphgi_tile *tile, int32_t dimension,
                                const void *correction, double scale)
{
    WITH(three, dimension == 3, quadratic_gradients_as(tile, correction, splat(R(scale)), three));
}

/* T = P_j g + Q_j p, the products of one axis halved. Rows hold P and Q in units of the host, which
 * differ by the factor `between`. */
SPHGI_TEMPLATE void put_transposed(const struct sphgi_tile *tile, int32_t k,
                                   const void *const *rows, const vec *g, const vec *p,
                                   const vec *between, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3, streams = three ? 6 : 3;
    vec c[24];
    for (int s = 0; s < streams; ++s) {
        const struct four row = gather_rows(rows[s], ids_at(tile, k));
        c[4 * s] = row.x;
        c[4 * s + 1] = row.y;
        c[4 * s + 2] = row.z;
        c[4 * s + 3] = row.w;
    }
    for (int a = 0; a < d; ++a) {
        vec sum = splat(R(0));
        for (int m = 0; m < n; ++m)
            sum = plus(sum, c[n + a * n + m], (is_square(m, three) ? R(.5) : R(1)) * p[m]);
        sum *= *between;
        for (int b = 0; b < d; ++b)
            sum = plus(sum, c[sphgi_pair_index(a, b, d)], g[b]);
        store(array_of(tile->arrays, SPHGI_TX) + a * SPHGI_TILE + k, sum);
    }
}

/* Minus the gradient seen from j, times the weight: g is weight s x, and p weight s x x, since x
 * has the other sign there. */
SPHGI_TEMPLATE void transposed_quadratic_as(const struct sphgi_tile *tile, const void *const *rows,
                                            real between, const void *density,
                                            enum sphgi_weight kind, bool three)
{
    const int d = three ? 3 : 2;
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec weight = weight_of(tile, k, density, kind);
        vec x[3], g[3], p[PAIRS_MOST];
        offsets_at(tile, k, three, x);
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        for (int a = 0; a < d; ++a)
            g[a] *= weight;
        pair_products(g, x, three, p);
        const vec units = splat(between);
        put_transposed(tile, k, rows, g, p, &units, three);
    }
}

static void transposed_quadratic(const struct sphgi_tile *tile, int32_t dimension,
                                 const void *const *rows, double between, const void *density,
                                 enum sphgi_weight kind)
{
    WITH(three, dimension == 3,
         transposed_quadratic_as(tile, rows, R(between), density, kind, three));
}

/* The same where sources have radii of their own: s_ji with H_j, without V_i, and offsets in units
 * of it. The second to fourth numbers of `radii` are 1 / H_j, H_j, and what s_ji has besides the
 * kernel, times H / H_j; those of the dummy are 0. */
SPHGI_TEMPLATE void quadratic_other_as(const struct sphgi_shape *shape,
                                       const struct sphgi_tile *tile,
                                       const struct sphgi_other_side *of, sphg_kernel kernel,
                                       bool three)
{
    const int d = three ? 3 : 2;
    const bool slope = shape->method == SPHG_KGC;
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four radius = gather_rows(of->radii, ids_at(tile, k));
        const struct ratio at = ratio_of(from(tile, SPHGI_UR, k), radius.y);
        const vec value = slope ? kernel_d(kernel, at) : kernel_w(kernel, at);
        const vec s = weight_of(tile, k, of->density, of->weight) * radius.w * value;
        vec x[3], g[3], p[PAIRS_MOST];
        for (int a = 0; a < d; ++a) {
            x[a] = radius.y * from(tile, (enum sphgi_array)(SPHGI_UX + a), k);
            g[a] = s * x[a];
        }
        pair_products(g, x, three, p);
        put_transposed(tile, k, of->table, g, p, &radius.z, three);
    }
}

#define BY_KERNEL transposed_quadratic_other
#define PARAMETERS                                                                                 \
    (const struct sphgi_shape *shape, const struct sphgi_tile *tile,                               \
     const struct sphgi_other_side *of)
#define ARGUMENTS (shape, tile, of)
#define CALL(kernel)                                                                               \
    WITH(three, shape->dimension == 3, quadratic_other_as(shape, tile, of, kernel, three))
#include "by_kernel.inl.h"

/* ---- Results -------------------------------------------------------------------------------- */

/* (g, h) = [P Q; Q^T R] (b1, b2), b2 over x_a x_a halved. */
SPHGI_TEMPLATE void apply_quadratic_as(int32_t count, const real *c, const real *sums,
                                       const real *second, real scale, real *j, real *h,
                                       real *trace, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    const real *cross = c + n * SPHGI_WIDTH, *rest = cross + d * n * SPHGI_WIDTH;
    const vec once = splat(scale), twice = splat(scale * scale);
    for (int32_t i = 0; i < count; ++i) {
        vec b[3], e[PAIRS_MOST];
        for (int a = 0; a < d; ++a)
            b[a] = load(sums + (i * d + a) * SPHGI_WIDTH);
        for (int k = 0; k < n; ++k)
            e[k] = (is_square(k, three) ? R(.5) : R(1)) * load(second + (i * n + k) * SPHGI_WIDTH);
        for (int a = 0; a < d; ++a) {
            vec sum = load(c + sphgi_pair_index(a, 0, d) * SPHGI_WIDTH) * b[0];
            for (int p = 1; p < d; ++p)
                sum = plus(sum, load(c + sphgi_pair_index(a, p, d) * SPHGI_WIDTH), b[p]);
            for (int k = 0; k < n; ++k)
                sum = plus(sum, load(cross + (a * n + k) * SPHGI_WIDTH), e[k]);
            store(j + (i * d + a) * SPHGI_WIDTH, once * sum);
        }
        vec squares = splat(R(0));
        for (int k = 0; h && k < n; ++k) {
            vec sum = load(cross + k * SPHGI_WIDTH) * b[0];
            for (int a = 1; a < d; ++a)
                sum = plus(sum, load(cross + (a * n + k) * SPHGI_WIDTH), b[a]);
            for (int p = 0; p < n; ++p)
                sum = plus(sum, load(rest + sphgi_pair_index(k, p, n) * SPHGI_WIDTH), e[p]);
            sum = twice * sum;
            if (is_square(k, three))
                squares += sum;
            store(h + (i * n + k) * SPHGI_WIDTH, sum);
        }
        if (h)
            store(trace + i * SPHGI_WIDTH, squares);
    }
}

static void apply_quadratic(int32_t width, int32_t dimension, int32_t count,
                            const void *coefficients, const void *sums, const void *second,
                            double scale, void *jacobian, void *hessian, void *laplacian)
{
    for (int32_t l = 0; l < width; l += LANES) {
        const real *c = (const real *)coefficients + l;
        const real *one = (const real *)sums + l, *two = (const real *)second + l;
        real *j = (real *)jacobian + l, *h = hessian ? (real *)hessian + l : NULL;
        real *trace = (real *)laplacian + l;
        WITH(three, dimension == 3,
             apply_quadratic_as(count, c, one, two, R(scale), j, h, trace, three));
    }
}
