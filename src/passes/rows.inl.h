/* SPDX-License-Identifier: MIT */
/* Rows: from the host's strided memory into 4 numbers a particle, and back. */

SPHGI_TEMPLATE real number_at(const char *at)
{
    return *(const real *)at;
}

/* `count` numbers that follow one another, 0 behind them. */
SPHGI_TEMPLATE void copy_row(real *row, const char *at, int32_t count)
{
    __builtin_memcpy(row, at, (size_t)count * sizeof(real));
    for (int32_t c = count; c < SPHGI_ROW; ++c)
        row[c] = R(0);
}

SPHGI_TEMPLATE void load_rows_as(const struct sphgi_columns *columns, const int32_t *order,
                                 int64_t begin, int64_t end, int32_t first, int32_t count,
                                 bool together, real *row)
{
    enum { AHEAD = 16 };
    const ptrdiff_t stride = columns->stride;
    const char *base = columns->at[first];
    for (int64_t k = begin; k < end; ++k, row += SPHGI_ROW) {
        const ptrdiff_t offset = (ptrdiff_t)(order ? order[k] : k) * stride;
        if (order && k + AHEAD < end)
            __builtin_prefetch(base + order[k + AHEAD] * stride);
        if (together) {
            copy_row(row, base + offset, count);
            continue;
        }
        for (int32_t c = 0; c < count; ++c)
            row[c] = number_at(columns->at[first + c] + offset);
        for (int32_t c = count; c < SPHGI_ROW; ++c)
            row[c] = R(0);
    }
}

static void load_rows(const struct sphgi_columns *columns, const int32_t *order, int64_t begin,
                      int64_t end, int32_t first, int32_t count, void *rows)
{
    if (!count)
        __builtin_memset(rows, 0, (size_t)(end - begin) * SPHGI_ROW * sizeof(real));
    else if (!columns->together)
        load_rows_as(columns, order, begin, end, first, count, false, rows);
    else if (count == 1)
        load_rows_as(columns, order, begin, end, first, 1, true, rows);
    else if (count == 2)
        load_rows_as(columns, order, begin, end, first, 2, true, rows);
    else if (count == 3)
        load_rows_as(columns, order, begin, end, first, 3, true, rows);
    else
        load_rows_as(columns, order, begin, end, first, 4, true, rows);
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
SPHGI_TEMPLATE bool put_volumes_as(const void *positions, const struct sphgi_columns *volume,
                                   double factor, const int32_t *order, int64_t begin,
                                   int64_t count, void *rows, bool volume_f64)
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
        to[3] = v * R(factor);
    }
    return valid;
}

static bool put_volumes_f32(const void *positions, const struct sphgi_columns *volume,
                            double factor, const int32_t *order, int64_t begin, int64_t count,
                            void *rows)
{
    return put_volumes_as(positions, volume, factor, order, begin, count, rows, false);
}

#if REAL_IS_F64
static bool put_volumes_f64(const void *positions, const struct sphgi_columns *volume,
                            double factor, const int32_t *order, int64_t begin, int64_t count,
                            void *rows)
{
    return put_volumes_as(positions, volume, factor, order, begin, count, rows, true);
}
#endif

/* The move along an axis, by way of the nearest image. */
SPHGI_TEMPLATE double move_of(real then, real now, double period, double half)
{
    const double move = (double)then - (double)now;
    return __builtin_fabs(move) > half ? __builtin_remainder(move, period) : move;
}

/* Largest |x - x'| of two sets of rows, rounded up; infinite if one is not finite. */
SPHGI_TEMPLATE double largest_move_as(const double *length, const real *a, const real *b,
                                      int64_t count, bool periodic)
{
    double largest = 0, half[3];
    for (int c = 0; c < 3; ++c)
        half[c] = length[c] > 0 ? length[c] / 2 : __builtin_inf();
    for (int64_t k = 0; k < count; ++k, a += SPHGI_ROW, b += SPHGI_ROW) {
        double square = 0;
        for (int c = 0; c < 3; ++c) {
            const double move =
                periodic ? move_of(a[c], b[c], length[c], half[c]) : (double)a[c] - (double)b[c];
            square += move * move;
        }
        if (!(square <= largest))
            largest = square - square == 0 ? square : __builtin_inf();
    }
    return __builtin_sqrt(largest) * (1 + 0x1p-50);
}

static double largest_move(const struct sphgi_periods *periods, const void *then, const void *now,
                           int64_t begin, int64_t end)
{
    const double *length = periods->length;
    const real *a = (const real *)then + SPHGI_ROW * begin;
    const real *b = (const real *)now + SPHGI_ROW * begin;
    if (length[0] > 0 || length[1] > 0 || length[2] > 0)
        return largest_move_as(length, a, b, end - begin, true);
    return largest_move_as(length, a, b, end - begin, false);
}

/* What belongs to targets: items of numbers that follow one another are moved four numbers
 * at a time; the last four of an item may overlap the ones before. */
SPHGI_TEMPLATE int32_t last_four(int32_t c, int32_t count)
{
    return c + 4 <= count ? c : count - 4;
}

/* Where the lanes of number k of an item stand. laid_out: in another order than numbers */
SPHGI_TEMPLATE ptrdiff_t lanes_of_number(const struct sphgi_columns *columns, int32_t k,
                                         bool laid_out)
{
    return (laid_out ? sphgi_component_at(columns, k) : k) * SPHGI_WIDTH;
}

SPHGI_TEMPLATE void put_four(const struct sphgi_columns *columns, struct four v, int32_t first,
                             real *to, bool laid_out)
{
    store(to + lanes_of_number(columns, first, laid_out), v.x);
    store(to + lanes_of_number(columns, first + 1, laid_out), v.y);
    store(to + lanes_of_number(columns, first + 2, laid_out), v.z);
    store(to + lanes_of_number(columns, first + 3, laid_out), v.w);
}

/* One vector of targets each. */
SPHGI_TEMPLATE void load_three(const char *base, ptrdiff_t stride, const int32_t *items, real *to)
{
    real rows[LANES * 4];
    const real *row[LANES];
    for (int32_t l = 0; l < LANES; ++l) { /* whole rows: what is stored in parts is read late */
        const real *at = (const real *)(base + items[l] * stride);
        row[l] = rows + 4 * l;
        *(quad *)(rows + 4 * l) = (quad){at[0], at[1], at[2], R(0)};
    }
    const struct four v = transpose(row);
    store(to, v.x);
    store(to + SPHGI_WIDTH, v.y);
    store(to + 2 * SPHGI_WIDTH, v.z);
}

SPHGI_TEMPLATE void load_together(const struct sphgi_columns *columns, const int32_t *items,
                                  real *to, bool laid_out)
{
    const int32_t count = laid_out ? sphgi_numbers_of(columns) : columns->count;
    if (count == 3)
        load_three(columns->at[0], columns->stride, items, to);
    for (int32_t c = 0; count > 3 && c < count; c += 4) {
        const real *row[LANES];
        const int32_t first = last_four(c, count);
        for (int32_t l = 0; l < LANES; ++l)
            row[l] = (const real *)(columns->at[0] + items[l] * columns->stride) + first;
        put_four(columns, transpose(row), first, to, laid_out);
    }
}

SPHGI_TEMPLATE void ask_for(const char *at, bool write)
{
    if (write)
        __builtin_prefetch(at, 1);
    else
        __builtin_prefetch(at, 0);
}

/* Of numbers that follow one another the first and, unless they are few, the last, which often
 * stands in another line of the cache. */
static void ask_for_lanes(int32_t width, const struct sphgi_columns *columns, const int32_t *items,
                          bool write)
{
    enum { FEW = 16 /* bytes */ };
    const bool together = columns->together || columns->layout;
    const int32_t count = together ? sphgi_min32(columns->count, 1) : columns->count;
    const ptrdiff_t last = (sphgi_numbers_of(columns) - 1) * (ptrdiff_t)sizeof(real);
    const bool both = together && last >= FEW;
    for (int32_t c = 0; c < count && columns->stride; ++c)
        for (int32_t l = 0; l < width; ++l) {
            const char *at = columns->at[c] + items[l] * columns->stride;
            ask_for(at, write);
            if (both)
                ask_for(at + last, write);
        }
    __asm__ volatile(""); /* GCC takes a function that only prefetches for one without effect */
}

static void load_lanes(int32_t width, const struct sphgi_columns *columns, const int32_t *items,
                       void *out)
{
    real *to = out;
    const int32_t count = columns->count;
    const bool together = columns->together || columns->layout == SPHG_COLUMN_MAJOR;
    if (columns->stride && together && count >= 3) {
        for (int32_t l = 0; l < width; l += LANES)
            if (columns->layout)
                load_together(columns, items + l, to + l, true);
            else
                load_together(columns, items + l, to + l, false);
        return;
    }
    for (int32_t c = 0; c < count; ++c)
        for (int32_t l = 0; l < width; ++l)
            to[c * SPHGI_WIDTH + l] = number_at(columns->at[c] + items[l] * columns->stride);
}

/* v[from[k]] in lane k */
SPHGI_TEMPLATE vec permuted(vec v, const int32_t *from)
{
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    return (vec)_mm512_permutexvar_ps(_mm512_loadu_si512(from), (__m512)v);
#elif VECTOR_BYTES == 32 && !REAL_IS_F64
    return (vec)_mm256_permutevar8x32_ps((__m256)v,
                                         _mm256_loadu_si256((const __m256i *)(const void *)from));
#else
    vec out;
    for (int32_t k = 0; k < LANES; ++k)
        out[k] = v[from[k]];
    return out;
#endif
}

/* Without a branch on `kept`, which nobody could foresee. */
static void pack_lanes(uint32_t kept, int32_t count, void *numbers)
{
    int32_t from[2 * LANES] = {0}, lanes = 0;
    real *row = numbers;
    for (int32_t l = 0; l < LANES; ++l) {
        from[lanes] = l;
        lanes += (int32_t)(kept >> l & 1);
    }
    for (int32_t c = 0; c < count; ++c, row += SPHGI_WIDTH)
        store(row, permuted(load(row), from));
}

SPHGI_TEMPLATE real *number_of(const struct sphgi_columns *columns, int32_t c, int32_t item)
{
    return (real *)(void *)(uintptr_t)(columns->at[c] + item * columns->stride);
}

SPHGI_TEMPLATE void store_rows(const struct sphgi_columns *columns, const int32_t *items,
                               int32_t targets, const real *from, int32_t first, int32_t numbers,
                               bool laid_out)
{
    quad rows[LANES];
    rows_of((struct four){load(from + lanes_of_number(columns, first, laid_out)),
                          load(from + lanes_of_number(columns, first + 1, laid_out)),
                          load(from + lanes_of_number(columns, first + 2, laid_out)),
                          load(from + lanes_of_number(columns, first + numbers - 1, laid_out))},
            rows);
    for (int32_t l = 0; l < LANES && l < targets; ++l) {
        real *to = number_of(columns, 0, items[l]) + first;
        if (numbers == 4)
            *(quad *)to = rows[l];
        else
            __builtin_memcpy(to, &rows[l], 3 * sizeof(real));
    }
}

SPHGI_TEMPLATE void store_together(const struct sphgi_columns *columns, const int32_t *items,
                                   int32_t targets, const real *from, bool laid_out)
{
    const int32_t numbers = laid_out ? sphgi_numbers_of(columns) : columns->count;
    if (numbers == 3)
        store_rows(columns, items, targets, from, 0, 3, laid_out);
    for (int32_t k = 0; numbers > 3 && k < numbers; k += 4)
        store_rows(columns, items, targets, from, last_four(k, numbers), 4, laid_out);
}

SPHGI_TEMPLATE void store_all(const struct sphgi_columns *columns, const int32_t *items,
                              int32_t targets, const real *from, bool laid_out)
{
    int32_t l = 0;
    for (; l + LANES <= targets; l += LANES)
        store_together(columns, items + l, LANES, from + l, laid_out);
    if (l < targets)
        store_together(columns, items + l, targets - l, from + l, laid_out);
}

static void store_lanes(int32_t targets, const struct sphgi_columns *columns, const int32_t *items,
                        const void *in, bool accumulate)
{
    const real *from = in;
    if (columns->layout && columns->count > 2 && !accumulate) {
        store_all(columns, items, targets, from, true);
        return;
    }
    if (columns->together && columns->count > 2 && !accumulate) {
        store_all(columns, items, targets, from, false);
        return;
    }
    for (int32_t l = 0; l < targets; ++l)
        for (int32_t k = 0; k < sphgi_numbers_of(columns); ++k) {
            real *to = columns->layout ? number_of(columns, 0, items[l]) + k
                                       : number_of(columns, k, items[l]);
            const real number = from[lanes_of_number(columns, k, columns->layout) + l];
            *to = accumulate ? *to + number : number;
        }
}

/* ---- Sums of several source sets ------------------------------------------------------------- */

SPHGI_TEMPLATE bool is_lane_zero(const real *lane, int32_t count)
{
    bool zero = true;
    for (int32_t c = 0; c < count; ++c)
        zero &= lane[c * SPHGI_WIDTH] == R(0);
    return zero;
}

static void put_away(int32_t targets, int32_t count, const void *lanes, const int32_t *items,
                     void *rows, int32_t stride, uint8_t *marks)
{
    const real *lane = lanes;
    for (int32_t l = 0; l < targets; ++l, ++lane) {
        if (is_lane_zero(lane, count))
            continue;
        real *row = (real *)rows + (ptrdiff_t)items[l] * stride;
        const bool more = marks[items[l]];
        for (int32_t c = 0; c < count; ++c)
            row[c] = more ? row[c] + lane[c * SPHGI_WIDTH] : lane[c * SPHGI_WIDTH];
        marks[items[l]] = 1;
    }
}

static void add_put_away(int32_t targets, int32_t count, const void *rows, int32_t stride,
                         const int32_t *items, const uint8_t *marks, void *lanes)
{
    for (int32_t l = 0; l < targets; ++l) {
        if (!marks[items[l]])
            continue;
        const real *row = (const real *)rows + (ptrdiff_t)items[l] * stride;
        real *lane = (real *)lanes + l;
        for (int32_t c = 0; c < count; ++c)
            lane[c * SPHGI_WIDTH] += row[c];
    }
}
