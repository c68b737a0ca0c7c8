/* SPDX-License-Identifier: MIT */
/* Sums of order 2 (theory.md, section 9). Offsets x = x_ij / H, so that xi / H = -x and the weight
 * is -s. Index of x_a x_b: sphgi_pair_index. Sums of third and fourth order hold each product once,
 * in the order of the alphabet. */

/* The products x_a x_b, times first[a] instead of x_a. */
SPHGI_TEMPLATE void pair_products(const vec *first, const vec *x, bool three, vec *products)
{
    const int d = three ? 3 : 2;
    for (int a = 0; a < d; ++a)
        for (int b = a; b < d; ++b)
            products[sphgi_pair_index(a, b, d)] = first[a] * x[b];
}

SPHGI_TEMPLATE void offsets_at(const struct sphgi_tile *tile, int32_t k, bool three, vec *x)
{
    for (int a = 0; a < (three ? 3 : 2); ++a)
        x[a] = from(tile, (enum sphgi_array)(SPHGI_X + a), k);
}

/* Sixteen registers hold few sums beside products, so that these stay in arrays for other loops; 32
 * hold as many as can be added while one loop forms them. */
enum { KEEPS_PRODUCTS = VECTOR_BYTES < 64 };

/* s_ij x_a x_b */
SPHGI_TEMPLATE void products_at(const struct sphgi_tile *tile, int32_t k, bool three, vec *products)
{
    vec x[3], g[3];
    for (int c = 0; KEEPS_PRODUCTS && c < (three ? 6 : 3); ++c)
        products[c] = from(tile, (enum sphgi_array)(SPHGI_P + c), k);
    if (KEEPS_PRODUCTS)
        return;
    offsets_at(tile, k, three, x);
    vectors_at(tile, k, SPHGI_FACTORS, three, g);
    pair_products(g, x, three, products);
}

SPHGI_TEMPLATE void keep_products(const struct sphgi_tile *tile, int32_t k, bool three,
                                  const vec *products)
{
    for (int c = 0; KEEPS_PRODUCTS && c < (three ? 6 : 3); ++c)
        store(array_of(tile->arrays, (enum sphgi_array)(SPHGI_P + c)) + k, products[c]);
}

SPHGI_TEMPLATE void products_as(const struct sphgi_tile *tile, bool three)
{
    for (int32_t k = 0; KEEPS_PRODUCTS && k < places_of(tile); k += LANES) {
        vec x[3], g[3], p[6];
        offsets_at(tile, k, three, x);
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        pair_products(g, x, three, p);
        keep_products(tile, k, three, p);
    }
}

static void shape_products(const struct sphgi_tile *tile, int32_t dimension)
{
    WITH(three, dimension == 3, products_as(tile, three));
}

/* The sums of third order, from these products. */
SPHGI_TEMPLATE void add_triples(vec *sum, const vec *p, const vec *x, bool three)
{
    for (int c = 0; c < (three ? 6 : 3); ++c)
        sum[c] = plus(sum[c], p[c], x[0]);
    if (three) {
        sum[6] = plus(sum[6], p[3], x[1]);
        sum[7] = plus(sum[7], p[3], x[2]);
        sum[8] = plus(sum[8], p[4], x[2]);
        sum[9] = plus(sum[9], p[5], x[2]);
    } else {
        sum[3] = plus(sum[3], p[2], x[1]);
    }
}

SPHGI_TEMPLATE void third_moments_as(const struct sphgi_tile *tile, real *sums, bool three)
{
    const int32_t n = three ? 10 : 4;
    vec sum[10];
    clear(sum, n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec x[3], p[6];
        offsets_at(tile, k, three, x);
        products_at(tile, k, three, p);
        add_triples(sum, p, x, three);
    }
    end_tile(tile, sum, n, sums);
}

/* Those of second order, as moments_as has them, with the products; and if there is room for them
 * those of third. */
SPHGI_TEMPLATE void first_moments_as(const struct sphgi_tile *tile, real *sums, bool third,
                                     bool three)
{
    const int d = three ? 3 : 2;
    const int32_t n = three ? 6 : 3, all = third ? n + (three ? 10 : 4) : n;
    vec sum[16];
    clear(sum, all);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec x[3], g[3], p[6];
        offsets_at(tile, k, three, x);
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        pair_products(g, x, three, p);
        keep_products(tile, k, three, p);
        for (int a = 0; a < d; ++a)
            for (int c = a; c < d; ++c) {
                const int m = sphgi_pair_index(a, c, d);
                sum[m] = minus(sum[m], g[a], x[c]);
            }
        if (third)
            add_triples(sum + n, p, x, three);
    }
    end_tile(tile, sum, all, sums);
}

/* Which two pairs make each product of four. */
static const int fourth_of_two[5][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}};
static const int fourth_of_three[15][2] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4},
                                           {0, 5}, {1, 3}, {1, 4}, {1, 5}, {2, 5},
                                           {3, 3}, {3, 4}, {3, 5}, {4, 5}, {5, 5}};

SPHGI_TEMPLATE void fourth_moments_as(const struct sphgi_tile *tile, real *sums, bool three,
                                      int first, int count)
{
    vec sum[15];
    clear(sum, count);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec x[3], weighted[6], plain[6];
        offsets_at(tile, k, three, x);
        products_at(tile, k, three, weighted);
        pair_products(x, x, three, plain);
        for (int c = 0; c < count; ++c) {
            const int *of = three ? fourth_of_three[first + c] : fourth_of_two[first + c];
            sum[c] = minus(sum[c], weighted[of[0]], plain[of[1]]);
        }
    }
    end_tile(tile, sum, count, sums + first * SPHGI_WIDTH);
}

SPHGI_TEMPLATE void quadratic_moments_as(const struct sphgi_tile *tile, real *sums, bool three)
{
    const int d = three ? 3 : 2, pairs = three ? 6 : 3, triples = three ? 10 : 4;
    real *third = sums + pairs * SPHGI_WIDTH, *fourth = third + triples * SPHGI_WIDTH;
    if (KEEPS_PRODUCTS) {
        first_moments_as(tile, sums, false, three);
        third_moments_as(tile, third, three);
    } else {
        first_moments_as(tile, sums, true, three);
    }
    if (d == 2 || VECTOR_BYTES == 64) {
        fourth_moments_as(tile, fourth, three, 0, three ? 15 : 5);
    } else { /* 15 sums do not fit sixteen registers beside what they are made of */
        fourth_moments_as(tile, fourth, three, 0, 8);
        fourth_moments_as(tile, fourth, three, 8, 7);
    }
}

static void sum_quadratic_moments(const struct sphgi_tile *tile, int32_t dimension, void *sums)
{
    WITH(three, dimension == 3, quadratic_moments_as(tile, sums, three));
}

/* What sum G_ij is made of: sums of s x, and of -s x x behind them, times the density of the source
 * if there are rows of it. */
SPHGI_TEMPLATE void quadratic_vectors_as(const struct sphgi_tile *tile, const real *rows,
                                         real *sums, bool three)
{
    const int32_t d = three ? 3 : 2, n = three ? 6 : 3;
    vec sum[9];
    clear(sum, d + n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec density = rows ? gather_rows(rows, ids_at(tile, k)).x : splat(R(1));
        vec g[3], p[6];
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        products_at(tile, k, three, p);
        for (int32_t a = 0; a < d; ++a)
            sum[a] = plus(sum[a], density, g[a]);
        for (int32_t b = 0; b < n; ++b)
            sum[d + b] = minus(sum[d + b], density, p[b]);
    }
    end_tile(tile, sum, d + n, sums);
}

static void sum_quadratic_vectors(const struct sphgi_tile *tile, int32_t dimension,
                                  const void *rows, void *sums)
{
    WITH(three, dimension == 3, quadratic_vectors_as(tile, rows, sums, three));
}

/* ---- Fields --------------------------------------------------------------------------------- */

/* First sums, as field_as has them; the differences stay in arrays that no other sum needs then. */
SPHGI_TEMPLATE void first_sums_as(const struct sphgi_tile *tile, const real *rows,
                                  const real *at_target, void *sums, int32_t count, bool three)
{
    const int32_t d = three ? 3 : 2;
    vec own[4], sum[12];
    for (int32_t c = 0; c < count; ++c)
        own[c] = load(at_target + c * SPHGI_WIDTH);
    clear(sum, count * d);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four row = gather_rows(rows, ids_at(tile, k));
        const vec value[4] = {row.x, row.y, row.z, row.w};
        real *kept = array_of(tile->arrays, SPHGI_GX) + k;
        vec g[3];
        vectors_at(tile, k, SPHGI_FACTORS, three, g);
        for (int32_t c = 0; c < count; ++c) {
            const vec difference = value[c] - own[c];
            store(kept + c * SPHGI_TILE, difference);
            for (int32_t b = 0; b < d; ++b)
                sum[c * d + b] = plus(sum[c * d + b], difference, g[b]);
        }
    }
    end_tile(tile, sum, count * d, sums);
}

SPHGI_TEMPLATE void second_sums_as(const struct sphgi_tile *tile, int32_t first, int32_t count,
                                   real *sums, bool three)
{
    const int32_t n = three ? 6 : 3;
    vec sum[24];
    clear(sum, count * n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec p[6];
        products_at(tile, k, three, p);
        vec difference[3];
        for (int32_t c = 0; c < count; ++c)
            difference[c] = from(tile, (enum sphgi_array)(SPHGI_GX + first + c), k);
        for (int32_t b = 0; b < n; ++b)
            for (int32_t c = 0; c < count; ++c)
                sum[c * n + b] = minus(sum[c * n + b], difference[c], p[b]);
    }
    end_tile(tile, sum, count * n, sums + first * n * SPHGI_WIDTH);
}

SPHGI_TEMPLATE void quadratic_field_as(const struct sphgi_tile *tile, const void *rows,
                                       int32_t count, const void *at_target, void *sums,
                                       real *second, bool three)
{
    const int32_t at_once = VECTOR_BYTES == 64 ? 3 : three ? 1 : 2;
    first_sums_as(tile, rows, at_target, sums, count, three);
    for (int32_t c = 0; c < count; c += at_once)
        second_sums_as(tile, c, count - c < at_once ? count - c : at_once, second, three);
}

SPHGI_TEMPLATE void quadratic_field_of(const struct sphgi_tile *tile, const void *rows,
                                       int32_t count, const void *at_target, void *sums,
                                       void *second, bool three)
{
    switch (count) {
    case 1:
        quadratic_field_as(tile, rows, 1, at_target, sums, second, three);
        break;
    case 2:
        quadratic_field_as(tile, rows, 2, at_target, sums, second, three);
        break;
    case 3:
        quadratic_field_as(tile, rows, 3, at_target, sums, second, three);
        break;
    default:
        quadratic_field_as(tile, rows, 4, at_target, sums, second, three);
    }
}

static void sum_quadratic_field(const struct sphgi_tile *tile, int32_t dimension, const void *rows,
                                int32_t count, const void *at_target, void *sums, void *second)
{
    WITH(three, dimension == 3,
         quadratic_field_of(tile, rows, count, at_target, sums, second, three));
}
