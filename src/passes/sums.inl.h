/* SPDX-License-Identifier: MIT */
/* Sums over the pairs of a tile, each lane's for itself. */

/* ---- The end of a tile ---------------------------------------------------------------------- */

/* a becomes a + b, rounded; returns what the rounding took (Knuth's two-sum). */
SPHGI_TEMPLATE vec two_sum(vec *a, vec b)
{
    const vec sum = *a + b, other = sum - *a;
    const vec lost = (*a - (sum - other)) + (b - other);
    *a = sum;
    return lost;
}

/* A list of n pairs is rounded like one of a chunk, for any n: a few chunks are added as they are,
 * the rounding of more is carried along. */
SPHGI_TEMPLATE void add_chunk(const struct sphgi_tile *tile, int32_t number, vec v, real *sum)
{
    real *carry = sum + tile->section;
    if (number == 0) {
        store(sum, v);
        if (tile->carries)
            store(carry, splat(R(-0.0)));
    } else if (number < SPHGI_PLAIN_CHUNKS) {
        store(sum, load(sum) + v);
    } else {
        vec total = load(sum);
        store(carry, load(carry) + two_sum(&total, v));
        store(sum, total);
    }
}

/* What the chunk that a tile holds of each list comes to, `count` sums. */
SPHGI_TEMPLATE void end_tile(const struct sphgi_tile *tile, const vec *v, int32_t count, void *sums)
{
    real *sum = sums;
    for (int32_t c = 0; c < count; ++c, sum += SPHGI_WIDTH)
        if (tile->spread)
            store(sum + 2 * tile->section, v[c]);
        else
            add_chunk(tile, tile->chunk, v[c], sum);
}

SPHGI_TEMPLATE void clear(vec *v, int32_t count)
{
    for (int32_t c = 0; c < count; ++c)
        v[c] = splat(R(0));
}

SPHGI_TEMPLATE int32_t places_of(const struct sphgi_tile *tile)
{
    return tile->steps * LANES;
}

/* The ids of the step that stands at place k. */
SPHGI_TEMPLATE const uint32_t *ids_at(const struct sphgi_tile *tile, int32_t k)
{
    return tile->ids + k / LANES * tile->id_stride;
}

/* To the first lane's sums, in the order of the list. */
static void join_lanes(const struct sphgi_tile *tile, int32_t chunks, int32_t count, void *sums)
{
    real *sum = sums;
    for (int32_t c = 0; c < count; ++c, sum += SPHGI_WIDTH)
        for (int32_t k = 0; k < chunks; ++k)
            add_chunk(tile, tile->chunk + k, splat(sum[2 * tile->section + k]), sum);
}

static void settle(const struct sphgi_tile *tile, int32_t count, void *sums)
{
    real *sum = sums;
    for (int32_t c = 0; c < count; ++c, sum += SPHGI_WIDTH)
        store(sum, load(sum) + load(sum + tile->section));
}

/* ---- What stands in the arrays -------------------------------------------------------------- */

SPHGI_TEMPLATE vec from(const struct sphgi_tile *tile, enum sphgi_array array, int32_t k)
{
    return load((const real *)tile->arrays + array * SPHGI_TILE + k);
}

/* The vectors of the pairs from place k on. */
SPHGI_TEMPLATE void vectors_at(const struct sphgi_tile *tile, int32_t k, enum sphgi_vectors vectors,
                               bool three, vec *g)
{
    for (int32_t a = 0; a < (three ? 3 : 2); ++a)
        if (vectors == SPHGI_FACTORS)
            g[a] = from(tile, SPHGI_S, k) * from(tile, (enum sphgi_array)(SPHGI_X + a), k);
        else if (vectors == SPHGI_GRADIENTS)
            g[a] = from(tile, (enum sphgi_array)(SPHGI_GX + a), k);
        else
            g[a] = from(tile, (enum sphgi_array)(SPHGI_TX + a), k);
}

/* ---- Sums ----------------------------------------------------------------------------------- */

/* M_i = - sum s_ij x_ij x_ij^T    theory.md section 2 */
SPHGI_TEMPLATE void moments_as(const struct sphgi_tile *tile, void *sums, bool three)
{
    const int32_t n = three ? 6 : 3;
    vec m[6];
    clear(m, n);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec x = from(tile, SPHGI_X, k), y = from(tile, SPHGI_Y, k);
        const vec s = from(tile, SPHGI_S, k), gx = s * x, gy = s * y;
        m[0] = minus(m[0], gx, x);
        m[1] = minus(m[1], gx, y);
        if (three) {
            const vec z = from(tile, SPHGI_Z, k), gz = s * z;
            m[2] = minus(m[2], gx, z);
            m[3] = minus(m[3], gy, y);
            m[4] = minus(m[4], gy, z);
            m[5] = minus(m[5], gz, z);
        } else {
            m[2] = minus(m[2], gy, y);
        }
    }
    end_tile(tile, m, n, sums);
}

static void sum_moments(const struct sphgi_tile *tile, int32_t dimension, void *sums)
{
    WITH(three, dimension == 3, moments_as(tile, sums, three));
}

/* sum (A_j - A_i) g, A_i at_target[c][lane], for `count` components of one row; sums in the order
 * [component][axis]. */
SPHGI_TEMPLATE void field_as(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                             const real *rows, const real *at_target, void *sums, int32_t count,
                             bool three)
{
    const int32_t d = three ? 3 : 2;
    vec own[4];
    for (int32_t c = 0; c < count; ++c)
        own[c] = load(at_target + c * SPHGI_WIDTH);
    vec sum[12];
    clear(sum, count * d);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four row = gather_rows(rows, ids_at(tile, k));
        vec difference[4] = {row.x, row.y, row.z, row.w}, g[3];
        for (int32_t c = 0; c < count; ++c)
            difference[c] -= own[c];
        vectors_at(tile, k, vectors, three, g);
        for (int32_t c = 0; c < count; ++c)
            for (int32_t b = 0; b < d; ++b)
                sum[c * d + b] = plus(sum[c * d + b], difference[c], g[b]);
    }
    end_tile(tile, sum, count * d, sums);
}

SPHGI_TEMPLATE void field_of(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                             const void *rows, int32_t count, const void *at_target, void *sums,
                             bool three)
{
    switch (count) {
    case 1:
        field_as(tile, vectors, rows, at_target, sums, 1, three);
        break;
    case 2:
        field_as(tile, vectors, rows, at_target, sums, 2, three);
        break;
    case 3:
        field_as(tile, vectors, rows, at_target, sums, 3, three);
        break;
    default:
        field_as(tile, vectors, rows, at_target, sums, 4, three);
    }
}

SPHGI_TEMPLATE void field_in(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                             const void *rows, int32_t count, const void *at_target, void *sums,
                             bool three)
{
    if (vectors == SPHGI_FACTORS)
        field_of(tile, SPHGI_FACTORS, rows, count, at_target, sums, three);
    else /* G or T: which of them is no question inside the loop */
        field_of(tile, vectors, rows, count, at_target, sums, three);
}

static void sum_field(const struct sphgi_tile *tile, int32_t dimension, enum sphgi_vectors vectors,
                      const void *rows, int32_t count, const void *at_target, void *sums)
{
    WITH(three, dimension == 3, field_in(tile, vectors, rows, count, at_target, sums, three));
}

/* sum (A_j - at_target) PHI_j */
static void sum_value(const struct sphgi_tile *tile, const void *rows, int32_t count,
                      const void *at_target, void *sums)
{
    vec own[4];
    clear(own, 4);
    for (int32_t c = 0; c < count; ++c)
        own[c] = load((const real *)at_target + c * SPHGI_WIDTH);
    vec sum[4];
    clear(sum, 4);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four row = gather_rows(rows, ids_at(tile, k));
        const vec phi = from(tile, SPHGI_PHI, k);
        sum[0] = plus(sum[0], row.x - own[0], phi);
        sum[1] = plus(sum[1], row.y - own[1], phi);
        sum[2] = plus(sum[2], row.z - own[2], phi);
        sum[3] = plus(sum[3], row.w - own[3], phi);
    }
    end_tile(tile, sum, count, sums);
}

/* sum + rho_j g, or sum + g */
SPHGI_TEMPLATE vec plus_vector(vec sum, vec g, const vec *density)
{
    if (density)
        return plus(sum, *density, g);
    return sum + g;
}

/* sum g, or sum rho_j g with the density in the first number of the rows */
SPHGI_TEMPLATE void vectors_as(const struct sphgi_tile *tile, enum sphgi_vectors vectors,
                               const real *rows, void *sums, bool three, bool dense)
{
    const int32_t d = three ? 3 : 2;
    vec sum[3];
    clear(sum, d);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        vec density, g[3];
        if (dense)
            density = gather_rows(rows, ids_at(tile, k)).x;
        vectors_at(tile, k, vectors, three, g);
        for (int32_t c = 0; c < d; ++c)
            sum[c] = plus_vector(sum[c], g[c], dense ? &density : NULL);
    }
    end_tile(tile, sum, d, sums);
}

static void sum_vectors(const struct sphgi_tile *tile, int32_t dimension,
                        enum sphgi_vectors vectors, const void *rows, void *sums)
{
    WITH(three, dimension == 3,
         WITH(from_rows, rows, vectors_as(tile, vectors, rows, sums, three, from_rows)));
}

/* sum V_j W and sum W: their quotient is the mean volume */
static void sum_volume(const struct sphgi_tile *tile, void *sums)
{
    vec sum[2];
    clear(sum, 2);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        sum[0] += from(tile, SPHGI_PHI, k);
        sum[1] += from(tile, SPHGI_S, k);
    }
    end_tile(tile, sum, 2, sums);
}

/* ---- The other side ------------------------------------------------------------------------- */

/* What the terms of the sources are multiplied with. */
SPHGI_TEMPLATE vec weight_of(const struct sphgi_tile *tile, int32_t k, const void *density,
                             enum sphgi_weight kind)
{
    vec weight = splat(R(1));
    if (kind == SPHGI_WEIGHT_V || kind == SPHGI_WEIGHT_V_PER_DENSITY)
        weight = from(tile, SPHGI_V, k);
    if (kind == SPHGI_WEIGHT_PER_DENSITY || kind == SPHGI_WEIGHT_V_PER_DENSITY) {
        const vec rho = gather_rows(density, ids_at(tile, k)).x;
        /* the dummy row's density is 0, its weight must be, too */
        weight = where(differ(rho, splat(R(0))), weight / rho);
    }
    return weight;
}

/* Minus the gradient seen from j, times the weight: T = weight C_j s_ij x_ij. plain: C_j = 1 */
SPHGI_TEMPLATE void transposed_as(const struct sphgi_tile *tile, const void *const rows[4],
                                  const void *density, enum sphgi_weight kind, bool three,
                                  bool plain)
{
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec weight = weight_of(tile, k, density, kind);
        const vec s = weight * from(tile, SPHGI_S, k);
        const vec gx = s * from(tile, SPHGI_X, k), gy = s * from(tile, SPHGI_Y, k);
        vec gz = splat(R(0));
        if (three)
            gz = s * from(tile, SPHGI_Z, k);
        vec t[3] = {gx, gy, gz};
        if (!plain) {
            const struct four c = gather_rows(rows[0], ids_at(tile, k));
            t[0] = plus(c.x * gx, c.y, gy);
            t[1] = plus(c.y * gx, three ? c.w : c.z, gy);
            if (three) {
                const struct four e = gather_rows(rows[1], ids_at(tile, k));
                t[0] = plus(t[0], c.z, gz);
                t[1] = plus(t[1], e.x, gz);
                t[2] = plus(plus(c.z * gx, e.x, gy), e.y, gz);
            }
        }
        for (int a = 0; a < (three ? 3 : 2); ++a)
            store(array_of(tile->arrays, SPHGI_TX) + a * SPHGI_TILE + k, t[a]);
    }
}

static void transposed(const struct sphgi_tile *tile, int32_t dimension, const void *const rows[4],
                       const void *density, enum sphgi_weight kind)
{
    WITH(three, dimension == 3,
         WITH(plain, !rows[0], transposed_as(tile, rows, density, kind, three, plain)));
}

static void scale_pairs(const struct sphgi_tile *tile, enum sphgi_array first, int32_t count,
                        const void *each)
{
    const vec by = load(each);
    for (int32_t c = 0; c < count; ++c) {
        real *at = array_of(tile->arrays, (enum sphgi_array)((int32_t)first + c));
        for (int32_t k = 0; k < places_of(tile); k += LANES)
            store(at + k, by * load(at + k));
    }
}
