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
 * hold as many as can be added while a loop forms its products anew. */
enum { KEEPS_PRODUCTS = SUMS_IN_REGISTERS < 15 };

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

/* Loops whose numbers are to be constants, lest sums and matrices stay in memory. */
#if defined(__clang__)
#define UNROLLED _Pragma("clang loop unroll(full)")
#else
#define UNROLLED _Pragma("GCC unroll 10")
#endif

/* Which axes make each product of two of them, which product of two and which axis each of three;
 * and which of four each of three makes with each axis: -1, another one does. */
static const int second_of_two[3][2] = {{0, 0}, {0, 1}, {1, 1}};
static const int third_of_two[4][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}};
static const int fourth_of_two[4][3] = {{0, 1}, {-1, -1}, {2, 3}, {-1, 4}};
static const int second_of_three[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
static const int third_of_three[10][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0},
                                          {5, 0}, {3, 1}, {3, 2}, {4, 2}, {5, 2}};
static const int fourth_of_three[10][3] = {{0, 1, 2},    {-1, -1, -1}, {-1, -1, -1}, {3, 6, 7},
                                           {4, -1, -1},  {5, 8, 9},    {-1, 10, 11}, {-1, -1, -1},
                                           {-1, 12, -1}, {-1, 13, 14}};

/* Those of second and third order that one loop sums, a bit each, with those of fourth order that
 * are made of the latter. */
struct some_moments {
    unsigned second, third;
};

/* Those of second order are what moments_as has. Products of three are rounded before they are
 * added, so that those of four take one multiplication more. */
SPHGI_TEMPLATE void some_moments_as(const struct sphgi_tile *tile, real *sums, bool three,
                                    struct some_moments some)
{
    const int d = three ? 3 : 2;
    const int32_t seconds = three ? 6 : 3, thirds = three ? 10 : 4, fourths = three ? 15 : 5;
    vec second[6], third[10], fourth[15];
    clear(second, seconds);
    clear(third, thirds);
    clear(fourth, fourths);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec x[3], g[3], p[6];
        offsets_at(tile, k, three, x);
        if (some.second) {
            vectors_at(tile, k, SPHGI_FACTORS, three, g);
            pair_products(g, x, three, p);
            keep_products(tile, k, three, p);
        } else {
            products_at(tile, k, three, p);
        }
        for (int c = 0; c < seconds; ++c) {
            const int *of = (three ? second_of_three : second_of_two)[c];
            if (some.second >> c & 1)
                second[c] = minus(second[c], g[of[0]], x[of[1]]);
        }
        UNROLLED
        for (int c = 0; c < thirds; ++c) {
            if (!(some.third >> c & 1))
                continue;
            const int *of = (three ? third_of_three : third_of_two)[c];
            const int *to = (three ? fourth_of_three : fourth_of_two)[c];
            const vec t = p[of[0]] * x[of[1]];
            third[c] += t;
            for (int a = 0; a < d; ++a)
                if (to[a] >= 0)
                    fourth[to[a]] = minus(fourth[to[a]], t, x[a]);
        }
    }
    for (int c = 0; c < seconds; ++c)
        if (some.second >> c & 1)
            end_tile(tile, second + c, 1, sums + c * SPHGI_WIDTH);
    sums += seconds * SPHGI_WIDTH;
    UNROLLED
    for (int c = 0; c < thirds; ++c) {
        if (!(some.third >> c & 1))
            continue;
        const int *to = (three ? fourth_of_three : fourth_of_two)[c];
        end_tile(tile, third + c, 1, sums + c * SPHGI_WIDTH);
        for (int a = 0; a < d; ++a)
            if (to[a] >= 0)
                end_tile(tile, fourth + to[a], 1, sums + (thirds + to[a]) * SPHGI_WIDTH);
    }
}

/* Those of third and fourth order in 3D. */
SPHGI_TEMPLATE void higher_moments_as(const struct sphgi_tile *tile, real *sums)
{
    some_moments_as(tile, sums, true, (struct some_moments){0, 0x03f});
    some_moments_as(tile, sums, true, (struct some_moments){0, 0x3c0});
}

/* In loops whose sums fit the registers beside what they are made of: of 32, first what holds x,
 * then the others. */
SPHGI_TEMPLATE void quadratic_moments_as(const struct sphgi_tile *tile, real *sums, bool three)
{
    if (three && KEEPS_PRODUCTS) {
        some_moments_as(tile, sums, three, (struct some_moments){0x3f, 0});
        some_moments_as(tile, sums, three, (struct some_moments){0, 0x017});
        some_moments_as(tile, sums, three, (struct some_moments){0, 0x028});
        some_moments_as(tile, sums, three, (struct some_moments){0, 0x3c0});
    } else if (three) {
        some_moments_as(tile, sums, three, (struct some_moments){0x07, 0x03f});
        some_moments_as(tile, sums, three, (struct some_moments){0x38, 0x3c0});
    } else if (KEEPS_PRODUCTS) {
        some_moments_as(tile, sums, three, (struct some_moments){0x7, 0});
        some_moments_as(tile, sums, three, (struct some_moments){0, 0xf});
    } else {
        some_moments_as(tile, sums, three, (struct some_moments){0x7, 0xf});
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
    const int32_t at_once = !KEEPS_PRODUCTS ? 3 : three ? 1 : 2;
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
