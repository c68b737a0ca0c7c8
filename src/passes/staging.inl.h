/* SPDX-License-Identifier: MIT */
/* Coordinates of candidates, x, y and z apart: rows are turned once for all the cells that look at
 * them, and scanned vector by vector. */

struct three {
    vec x, y, z;
};

/* Of LANES rows that follow one another. */
SPHGI_TEMPLATE struct three coordinates_of(const real *rows)
{
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    const __m512i xy = _mm512_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25, 29);
    const __m512i z = _mm512_setr_epi32(2, 6, 10, 14, 18, 22, 26, 30, 2, 6, 10, 14, 18, 22, 26, 30);
    const __m512 a = _mm512_loadu_ps(rows), b = _mm512_loadu_ps(rows + 16);
    const __m512 c = _mm512_loadu_ps(rows + 32), d = _mm512_loadu_ps(rows + 48);
    const __m512 low = _mm512_permutex2var_ps(a, xy, b), high = _mm512_permutex2var_ps(c, xy, d);
    return (struct three){(vec)_mm512_shuffle_f32x4(low, high, 0x44),
                          (vec)_mm512_shuffle_f32x4(low, high, 0xee),
                          (vec)_mm512_shuffle_f32x4(_mm512_permutex2var_ps(a, z, b),
                                                    _mm512_permutex2var_ps(c, z, d), 0x44)};
#else
    const real *row[LANES];
    for (int l = 0; l < LANES; ++l)
        row[l] = rows + SPHGI_ROW * l;
    const struct four v = transpose(row);
    return (struct three){v.x, v.y, v.z};
#endif
}

static void stage(const struct sphgi_find *find, struct sphgi_runs *runs)
{
    real *x = find->staged, *y = x + find->staged_room, *z = y + find->staged_room;
    int32_t at = 0;
    for (int32_t run = 0; run < runs->count;
         ++run) /* the machine cannot know where the next begins */
        for (int32_t line = 0; line < 4; ++line)
            __builtin_prefetch((const real *)find->rows +
                               SPHGI_ROW * ((ptrdiff_t)runs->begin[run] + LANES / 4 * line));
    for (int32_t run = 0; run < runs->count; ++run) {
        const real *rows = (const real *)find->rows + SPHGI_ROW * (ptrdiff_t)runs->begin[run];
        const int32_t length = runs->length[run];
        runs->staged[run] = at;
        /* What is read beyond the end is overwritten. */
        for (int32_t k = 0; k < length; k += LANES) {
            const struct three v = coordinates_of(rows + SPHGI_ROW * (ptrdiff_t)k);
            store(x + at + k, v.x);
            store(y + at + k, v.y);
            store(z + at + k, v.z);
        }
        at += length;
    }
}

/* Of LANES candidates that follow one another. */
SPHGI_TEMPLATE struct three staged_at(const struct sphgi_find *find, int32_t at)
{
    const real *x = (const real *)find->staged + at;
    const ptrdiff_t room = find->staged_room;
    return (struct three){load(x), load(x + room), load(x + 2 * room)};
}

/* The vectors that cover some runs: where each stands among the staged, its first row, and which of
 * its lanes count. */
struct scan {
    int32_t *at, *row;
    uint16_t *lanes;
    int32_t count;
};

typedef int32_t scanned __attribute__((vector_size(4 * SPHGI_SCANNED), aligned(4), may_alias));
typedef uint16_t scanned_lanes
    __attribute__((vector_size(2 * SPHGI_SCANNED), aligned(2), may_alias));

/* Behind the last vector of a run something is written that the next run overwrites. */
SPHGI_TEMPLATE struct scan scan_of(const struct sphgi_find *find, const struct sphgi_runs *runs)
{
    const size_t most = (size_t)runs->candidates / LANES + (size_t)runs->count + SPHGI_SCANNED;
    const scanned first = {0, LANES, 2 * LANES, 3 * LANES};
    struct scan s = {.at = find->scan};
    s.row = s.at + most;
    s.lanes = (uint16_t *)(void *)(s.row + most);
    for (int32_t run = 0; run < runs->count; ++run) {
        const int32_t length = runs->length[run], vectors = (length + LANES - 1) / LANES;
        for (int32_t v = 0; v < vectors; v += SPHGI_SCANNED) {
            *(scanned *)(s.at + s.count + v) = first + (runs->staged[run] + v * LANES);
            *(scanned *)(s.row + s.count + v) = first + (runs->begin[run] + v * LANES);
            *(scanned_lanes *)(s.lanes + s.count + v) = (scanned_lanes){0} + (uint16_t)ALL;
        }
        s.count += vectors;
        if (vectors)
            s.lanes[s.count - 1] = (uint16_t)(ALL >> (vectors * LANES - length));
    }
    return s;
}

/* Of the lanes of the first `length` candidates that are left, those that come before a row. */
SPHGI_TEMPLATE int32_t lanes_before(const struct scan *s, int32_t length, int32_t row)
{
    int32_t count = 0;
    for (int32_t v = 0; v * LANES < length; ++v) {
        const int32_t before = sphgi_max32(0, sphgi_min32(LANES, row - s->row[v]));
        count += __builtin_popcount(s->lanes[v] & ((1u << before) - 1));
    }
    return count;
}
