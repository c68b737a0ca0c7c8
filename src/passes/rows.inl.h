/* Rows: from the host's strided memory into 4 numbers a particle, and back. */

SPHGI_TEMPLATE real number_at(const char *at)
{
    return *(const real *)at;
}

static void load_rows(const struct sphgi_columns *columns, const int32_t *order, int64_t begin,
                      int64_t end, int32_t first, int32_t count, void *rows)
{
    enum { AHEAD = 16 };
    const ptrdiff_t stride = columns->stride;
    real *row = rows;
    for (int64_t k = begin; k < end; ++k, row += SPHGI_ROW) {
        const ptrdiff_t offset = (order ? order[k] : k) * stride;
        if (order && count && k + AHEAD < end)
            __builtin_prefetch(columns->at[first] + order[k + AHEAD] * stride);
        for (int32_t c = 0; c < count; ++c)
            row[c] = number_at(columns->at[first + c] + offset);
        for (int32_t c = count; c < SPHGI_ROW; ++c)
            row[c] = R(0);
    }
}

/* Not finite: x - x is not 0. */
static int64_t first_not_finite(const struct sphgi_columns *columns, int64_t begin, int64_t end)
{
    for (int64_t k = begin; k < end; ++k) {
        real difference = R(0);
        for (int32_t c = 0; c < columns->count; ++c) {
            const real x = number_at(columns->at[c] + k * columns->stride);
            difference += x - x;
        }
        if (!(difference == R(0)))
            return k;
    }
    return -1;
}

/* The volume columns hold f32 or f64 fields beside the positions' own type. */
SPHGI_TEMPLATE bool stage_as(const void *positions, const struct sphgi_columns *volume,
                             const int32_t *order, int64_t begin, int64_t count, void *rows,
                             bool volume_f64)
{
    const real *from = (const real *)positions + SPHGI_ROW * begin;
    real *to = rows;
    bool valid = true;
    for (int64_t k = 0; k < count; ++k, from += SPHGI_ROW, to += SPHGI_ROW) {
        real v = R(0);
        if (volume->count) {
            const int64_t item = order ? order[begin + k] : begin + k;
            const char *at = volume->at[0] + item * volume->stride;
            v = volume_f64 ? R(*(const double *)(const void *)at)
                           : R(*(const float *)(const void *)at);
        }
        valid &= v >= R(0) && v - v == R(0);
        to[0] = from[0];
        to[1] = from[1];
        to[2] = from[2];
        to[3] = v;
    }
    return valid;
}

static bool stage_f32(const void *positions, const struct sphgi_columns *volume,
                      const int32_t *order, int64_t begin, int64_t count, void *rows)
{
    return stage_as(positions, volume, order, begin, count, rows, false);
}

#if REAL_IS_F64
static bool stage_f64(const void *positions, const struct sphgi_columns *volume,
                      const int32_t *order, int64_t begin, int64_t count, void *rows)
{
    return stage_as(positions, volume, order, begin, count, rows, true);
}
#endif

static void transpose_rows(const void *rows, int32_t count, void *x, void *y, void *z)
{
    const real *row = rows;
    real *to[3] = {x, y, z};
    for (int32_t k = 0; k < count; ++k, row += SPHGI_ROW)
        for (int a = 0; a < 3; ++a)
            to[a][k] = row[a];
}

/* Largest |x - x'| of two sets of rows, rounded up; NaN if one is. */
static double largest_move(const void *then, const void *now, int64_t begin, int64_t end)
{
    const real *a = (const real *)then + SPHGI_ROW * begin;
    const real *b = (const real *)now + SPHGI_ROW * begin;
    double largest = 0;
    for (int64_t k = begin; k < end; ++k, a += SPHGI_ROW, b += SPHGI_ROW) {
        double square = 0;
        for (int c = 0; c < 3; ++c) {
            const double difference = (double)a[c] - (double)b[c];
            square += difference * difference;
        }
        largest = square > largest ? square : largest;
    }
    return __builtin_sqrt(largest) * (1 + 0x1p-50);
}

/* One target a lane: LANES items. */
static void load_lanes(const struct sphgi_columns *columns, const int32_t *items, void *out)
{
    real *to = out;
    for (int32_t c = 0; columns->stride == 0 && c < columns->count; ++c)
        store(to + c * LANES, splat(number_at(columns->at[c])));
    for (int32_t l = 0; columns->stride != 0 && l < LANES; ++l) {
        const ptrdiff_t offset = items[l] * columns->stride;
        for (int32_t c = 0; c < columns->count; ++c)
            to[c * LANES + l] = number_at(columns->at[c] + offset);
    }
}

static void store_lanes(const struct sphgi_columns *columns, const int32_t *items, int32_t lanes,
                        const void *in, bool accumulate)
{
    const real *from = in;
    for (int32_t l = 0; l < lanes; ++l) {
        const ptrdiff_t offset = items[l] * columns->stride;
        for (int32_t c = 0; c < columns->count; ++c) {
            real *to = (real *)(void *)(uintptr_t)(columns->at[c] + offset);
            *to = accumulate ? *to + from[c * LANES + l] : from[c * LANES + l];
        }
    }
}
