/* Sums over the pairs of a piece, kept as one vector per sum and target. */

SPHGI_TEMPLATE vec *partial_of(void *partial, int32_t sum, int32_t lane)
{
    return (vec *)partial + sum * LANES + lane;
}

/* What a sum of part p goes on from. */
SPHGI_TEMPLATE vec begin_sum(const struct sphgi_piece *piece, int32_t p, void *partial, int32_t sum)
{
    return piece->fresh[p] ? splat(R(0)) : *partial_of(partial, sum, piece->lane[p]);
}

/* Index of x_a x_b in an upper triangle. */
SPHGI_TEMPLATE int pair_index(int a, int b, int d)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * d - low * (low - 1) / 2 + high - low;
}

SPHGI_TEMPLATE vec from(const struct sphgi_piece *piece, enum sphgi_array array, int32_t k)
{
    return load((const real *)piece->arrays + array * SPHGI_PIECE + k);
}

/* The vectors of pairs [k, k + LANES), of pair k's part. */
SPHGI_TEMPLATE void vectors_at(const struct sphgi_piece *piece, int32_t k,
                               enum sphgi_vectors vectors, bool three, vec *g)
{
    for (int32_t a = 0; a < (three ? 3 : 2); ++a)
        if (vectors == SPHGI_FACTORS)
            g[a] = from(piece, SPHGI_S, k) * from(piece, (enum sphgi_array)(SPHGI_X + a), k);
        else if (vectors == SPHGI_GRADIENTS)
            g[a] = from(piece, (enum sphgi_array)(SPHGI_GX + a), k);
        else
            g[a] = from(piece, (enum sphgi_array)(SPHGI_TX + a), k);
}

/* M_i = - sum s_ij x_ij x_ij^T    theory.md section 2 */
SPHGI_TEMPLATE void moments_as(const struct sphgi_piece *piece, void *partial, bool three)
{
    for (int32_t p = 0; p < piece->parts; ++p) {
        const int32_t lane = piece->lane[p], n = three ? 6 : 3;
        vec m[6];
        for (int32_t c = 0; c < n; ++c)
            m[c] = begin_sum(piece, p, partial, c);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1]; k += LANES) {
            const vec x = from(piece, SPHGI_X, k), y = from(piece, SPHGI_Y, k);
            const vec s = from(piece, SPHGI_S, k), gx = s * x, gy = s * y;
            m[0] -= gx * x;
            m[1] -= gx * y;
            if (three) {
                const vec z = from(piece, SPHGI_Z, k), gz = s * z;
                m[2] -= gx * z;
                m[3] -= gy * y;
                m[4] -= gy * z;
                m[5] -= gz * z;
            } else {
                m[2] -= gy * y;
            }
        }
        for (int32_t c = 0; c < n; ++c)
            *partial_of(partial, c, lane) = m[c];
    }
}

static void sum_moments(const struct sphgi_piece *piece, int32_t dimension, void *partial)
{
    if (dimension == 3)
        moments_as(piece, partial, true);
    else
        moments_as(piece, partial, false);
}

/* sum (A_j - A_i) g, A_i at_target[c][lane], for `count` components of one row; partial in the
 * order [component][axis]. */
SPHGI_TEMPLATE void field_as(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                             const real *rows, const real *at_target, void *partial, int32_t count,
                             bool three, bool wide)
{
    const int32_t d = three ? 3 : 2;
    for (int32_t p = 0; p < piece->parts; ++p) {
        const int32_t lane = piece->lane[p], begin = piece->begin[p];
        struct listed list = first_listed(piece, p, wide);
        vec sum[12], a[4];
        for (int32_t c = 0; c < count; ++c)
            a[c] = splat(at_target[c * SPHGI_WIDTH + lane]);
        for (int32_t c = 0; c < count * d; ++c)
            sum[c] = begin_sum(piece, p, partial, c);
        for (int32_t k = begin; k < piece->begin[p + 1]; k += LANES, list = after(list, LANES)) {
            const struct four row = gather_rows(rows, list);
            const vec value[4] = {row.x, row.y, row.z, row.w};
            vec g[3];
            vectors_at(piece, k, vectors, three, g);
            for (int32_t c = 0; c < count; ++c) {
                const vec difference = value[c] - a[c];
                for (int32_t b = 0; b < d; ++b)
                    sum[c * d + b] += difference * g[b];
            }
        }
        for (int32_t c = 0; c < count * d; ++c)
            *partial_of(partial, c, lane) = sum[c];
    }
}

SPHGI_TEMPLATE void field_ids(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                              const void *rows, int32_t count, const void *at_target, void *partial,
                              bool three)
{
    if (piece->wide)
        field_as(piece, vectors, rows, at_target, partial, count, three, true);
    else
        field_as(piece, vectors, rows, at_target, partial, count, three, false);
}

SPHGI_TEMPLATE void field_of(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                             const void *rows, int32_t count, const void *at_target, void *partial,
                             bool three)
{
    switch (count) {
    case 1:
        field_ids(piece, vectors, rows, 1, at_target, partial, three);
        break;
    case 2:
        field_ids(piece, vectors, rows, 2, at_target, partial, three);
        break;
    case 3:
        field_ids(piece, vectors, rows, 3, at_target, partial, three);
        break;
    default:
        field_ids(piece, vectors, rows, 4, at_target, partial, three);
    }
}

SPHGI_TEMPLATE void field_in(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                             const void *rows, int32_t count, const void *at_target, void *partial,
                             bool three)
{
    if (vectors == SPHGI_FACTORS)
        field_of(piece, SPHGI_FACTORS, rows, count, at_target, partial, three);
    else /* G or T: which of them is no question inside the loop */
        field_of(piece, vectors, rows, count, at_target, partial, three);
}

static void sum_field(const struct sphgi_piece *piece, int32_t dimension,
                      enum sphgi_vectors vectors, const void *rows, int32_t count,
                      const void *at_target, void *partial)
{
    if (dimension == 3)
        field_in(piece, vectors, rows, count, at_target, partial, true);
    else
        field_in(piece, vectors, rows, count, at_target, partial, false);
}

/* sum (A_j - at_target) PHI_j */
SPHGI_TEMPLATE void value_as(const struct sphgi_piece *piece, const real *rows, int32_t count,
                             const real *at_target, void *partial, bool wide)
{
    for (int32_t p = 0; p < piece->parts; ++p) {
        struct listed list = first_listed(piece, p, wide);
        vec sum[4], a[4];
        for (int32_t c = 0; c < 4; ++c) {
            sum[c] = c < count ? begin_sum(piece, p, partial, c) : splat(R(0));
            a[c] = c < count ? splat(at_target[c * SPHGI_WIDTH + piece->lane[p]]) : splat(R(0));
        }
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1];
             k += LANES, list = after(list, LANES)) {
            const struct four row = gather_rows(rows, list);
            const vec phi = from(piece, SPHGI_PHI, k);
            sum[0] += (row.x - a[0]) * phi;
            sum[1] += (row.y - a[1]) * phi;
            sum[2] += (row.z - a[2]) * phi;
            sum[3] += (row.w - a[3]) * phi;
        }
        for (int32_t c = 0; c < count; ++c)
            *partial_of(partial, c, piece->lane[p]) = sum[c];
    }
}

static void sum_value(const struct sphgi_piece *piece, const void *rows, int32_t count,
                      const void *at_target, void *partial)
{
    if (piece->wide)
        value_as(piece, rows, count, at_target, partial, true);
    else
        value_as(piece, rows, count, at_target, partial, false);
}

/* sum g, or sum rho_j g with the density in the first number of the rows */
SPHGI_TEMPLATE void vectors_as(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                               const real *rows, void *partial, bool three, bool dense, bool wide)
{
    const int32_t d = three ? 3 : 2;
    for (int32_t p = 0; p < piece->parts; ++p) {
        struct listed list = first_listed(piece, p, wide);
        vec sum[3];
        for (int32_t c = 0; c < d; ++c)
            sum[c] = begin_sum(piece, p, partial, c);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1];
             k += LANES, list = after(list, LANES)) {
            const vec density = dense ? gather_rows(rows, list).x : splat(R(1));
            vec g[3];
            vectors_at(piece, k, vectors, three, g);
            for (int32_t c = 0; c < d; ++c)
                sum[c] += density * g[c];
        }
        for (int32_t c = 0; c < d; ++c)
            *partial_of(partial, c, piece->lane[p]) = sum[c];
    }
}

SPHGI_TEMPLATE void vectors_in(const struct sphgi_piece *piece, enum sphgi_vectors vectors,
                               const real *rows, void *partial, bool three)
{
    if (!rows)
        vectors_as(piece, vectors, NULL, partial, three, false, false);
    else if (piece->wide)
        vectors_as(piece, vectors, rows, partial, three, true, true);
    else
        vectors_as(piece, vectors, rows, partial, three, true, false);
}

static void sum_vectors(const struct sphgi_piece *piece, int32_t dimension,
                        enum sphgi_vectors vectors, const void *rows, void *partial)
{
    if (dimension == 3)
        vectors_in(piece, vectors, rows, partial, true);
    else
        vectors_in(piece, vectors, rows, partial, false);
}

/* sum V_j W and sum W: their quotient is the mean volume */
static void sum_volume(const struct sphgi_piece *piece, void *partial)
{
    for (int32_t p = 0; p < piece->parts; ++p) {
        vec weighted = begin_sum(piece, p, partial, 0), plain = begin_sum(piece, p, partial, 1);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1]; k += LANES) {
            weighted += from(piece, SPHGI_PHI, k);
            plain += from(piece, SPHGI_S, k);
        }
        *partial_of(partial, 0, piece->lane[p]) = weighted;
        *partial_of(partial, 1, piece->lane[p]) = plain;
    }
}

static void clear_partial(void *partial, int32_t sums, int32_t lane)
{
    for (int32_t c = 0; c < sums; ++c)
        *partial_of(partial, c, lane) = splat(R(0));
}

static void reduce(const void *partial, int32_t sums, void *reduced)
{
    const vec *in = partial;
    for (int32_t c = 0; c < sums; ++c)
        store((real *)reduced + c * SPHGI_WIDTH, sum_across(in + c * LANES));
}

/* What the terms of the sources are multiplied with. */
SPHGI_TEMPLATE vec weight_of(const struct sphgi_piece *piece, struct listed list, int32_t k,
                             const void *density, enum sphgi_weight kind)
{
    vec weight = splat(R(1));
    if (kind == SPHGI_WEIGHT_V || kind == SPHGI_WEIGHT_V_PER_DENSITY)
        weight = from(piece, SPHGI_V, k);
    if (kind == SPHGI_WEIGHT_PER_DENSITY || kind == SPHGI_WEIGHT_V_PER_DENSITY) {
        const vec rho = gather_rows(density, list).x;
        /* the dummy row's density is 0, its weight must be, too */
        weight = where(differ(rho, splat(R(0))), weight / rho);
    }
    return weight;
}

/* Minus the gradient seen from j, times the weight: T = weight C_j s_ij x_ij. plain: C_j = 1 */
SPHGI_TEMPLATE void transposed_as(const struct sphgi_piece *piece, const void *const rows[4],
                                  const void *density, enum sphgi_weight kind, bool three,
                                  bool plain, bool wide)
{
    for (int32_t p = 0; p < piece->parts; ++p) {
        struct listed list = first_listed(piece, p, wide);
        for (int32_t k = piece->begin[p]; k < piece->begin[p + 1];
             k += LANES, list = after(list, LANES)) {
            const vec weight = weight_of(piece, list, k, density, kind);
            const vec s = weight * from(piece, SPHGI_S, k);
            const vec gx = s * from(piece, SPHGI_X, k), gy = s * from(piece, SPHGI_Y, k);
            vec gz = splat(R(0));
            if (three)
                gz = s * from(piece, SPHGI_Z, k);
            vec t[3] = {gx, gy, gz};
            if (!plain) {
                const struct four c = gather_rows(rows[0], list);
                t[0] = c.x * gx + c.y * gy;
                t[1] = c.y * gx + (three ? c.w : c.z) * gy;
                if (three) {
                    const struct four e = gather_rows(rows[1], list);
                    t[0] += c.z * gz;
                    t[1] += e.x * gz;
                    t[2] = c.z * gx + e.x * gy + e.y * gz;
                }
            }
            for (int a = 0; a < (three ? 3 : 2); ++a)
                store(array_of(piece->arrays, SPHGI_TX) + a * SPHGI_PIECE + k, t[a]);
        }
    }
}

SPHGI_TEMPLATE void transposed_in(const struct sphgi_piece *piece, const void *const rows[4],
                                  const void *density, enum sphgi_weight kind, bool three)
{
    if (!rows[0] && piece->wide)
        transposed_as(piece, rows, density, kind, three, true, true);
    else if (!rows[0])
        transposed_as(piece, rows, density, kind, three, true, false);
    else if (piece->wide)
        transposed_as(piece, rows, density, kind, three, false, true);
    else
        transposed_as(piece, rows, density, kind, three, false, false);
}

static void transposed(const struct sphgi_piece *piece, int32_t dimension,
                       const void *const rows[4], const void *density, enum sphgi_weight kind)
{
    if (dimension == 3)
        transposed_in(piece, rows, density, kind, true);
    else
        transposed_in(piece, rows, density, kind, false);
}
