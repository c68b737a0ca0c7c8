/* SPDX-License-Identifier: MIT */
/* Writing records: of a source x y z, and the numbers of a field behind them (record_sums.inl.h
 * reads them). */

/* Past the caches, where far more is written than they hold. */
SPHGI_TEMPLATE void put_row(real *to, quad row, bool past)
{
#if defined(__x86_64__) && REAL_IS_F64
    if (past)
        _mm256_stream_pd(to, (__m256d)row);
    else
        *(quad *)to = row;
#elif defined(__x86_64__)
    if (past)
        _mm_stream_ps(to, (__m128)row);
    else
        *(quad *)to = row;
#else
    (void)past;
    *(quad *)to = row;
#endif
}

/* Coordinates and numbers that follow one another. */
SPHGI_TEMPLATE void put_record(const real *row, const char *numbers, int32_t axes, int32_t count,
                               bool past, real *record)
{
    real v[SPHGI_ROW * 3] = {R(0)};
    for (int32_t a = 0; a < axes; ++a)
        v[a] = row[a];
    for (int32_t c = 0; c < count; ++c)
        v[axes + c] = ((const real *)(const void *)numbers)[c];
    for (int32_t n = 0; n < sphgi_record_width(axes, count); n += SPHGI_ROW)
        put_row(record + n, (quad){v[n], v[n + 1], v[n + 2], v[n + 3]}, past);
}

SPHGI_TEMPLATE void put_records_as(const real *row, const struct sphgi_columns *columns,
                                   const int32_t *order, int64_t count, int32_t axes,
                                   int32_t numbers, bool past, real *record)
{
    enum { SOURCES_AHEAD = 16 };
    const ptrdiff_t stride = columns->stride;
    const char *base = columns->at[0];
    for (int64_t k = 0; k < count; ++k, row += SPHGI_ROW) {
        if (k + SOURCES_AHEAD < count)
            __builtin_prefetch(base + order[k + SOURCES_AHEAD] * stride);
        put_record(row, base + order[k] * stride, axes, numbers, past, record);
        record += sphgi_record_width(axes, numbers);
    }
}

/* In any layout; columns NULL: room is left for what they have. */
static void put_any_records(const real *row, const struct sphgi_columns *columns,
                            const int32_t *order, int64_t count, int32_t axes, int32_t width,
                            real *record)
{
    for (int64_t k = 0; k < count; ++k, row += SPHGI_ROW, record += width) {
        *(quad *)record = *(const quad *)row;
        for (int32_t c = 0; columns && c < columns->count; ++c)
            record[axes + c] = number_at(columns->at[c] + order[k] * columns->stride);
    }
}

SPHGI_TEMPLATE bool put_records_in(const void *rows, const struct sphgi_columns *columns,
                                   const int32_t *order, int64_t count, int32_t axes, bool past,
                                   void *records)
{
    if (!columns || !columns->together)
        return false;
    if (columns->count == 1)
        put_records_as(rows, columns, order, count, axes, 1, past, records);
    else if (columns->count == axes)
        put_records_as(rows, columns, order, count, axes, axes, past, records);
    else if (columns->count == 6 && axes != 2)
        put_records_as(rows, columns, order, count, axes, 6, past, records);
    else
        return false;
    return true;
}

static void put_records(const void *rows, const struct sphgi_columns *columns, const int32_t *order,
                        int64_t count, int32_t axes, int32_t width, bool past, void *records)
{
    bool done = false;
    if (axes == 3)
        WITH(beyond, past, done = put_records_in(rows, columns, order, count, 3, beyond, records));
    else if (axes == 2)
        done = put_records_in(rows, columns, order, count, 2, false, records);
    else
        done = put_records_in(rows, columns, order, count, 0, false, records);
    if (!done)
        put_any_records(rows, columns, order, count, axes, width, records);
#if defined(__x86_64__)
    _mm_sfence(); /* who reads them may be another thread */
#endif
}
