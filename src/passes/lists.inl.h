/* SPDX-License-Identifier: MIT */
/* Lists of ids, laid side by side for the lanes of a tile. */

typedef uint32_t four_ids __attribute__((vector_size(16), aligned(4), may_alias));

SPHGI_TEMPLATE const uint32_t *four_from(const uint32_t *list, int32_t count, int32_t k,
                                         const four_ids *none)
{
    return k < count ? list + k : (const uint32_t *)none;
}

/* Four steps of four lists from step k on. count NULL: all lists have them. */
SPHGI_TEMPLATE void turn_four(const uint32_t *const *lists, const int32_t *count, int32_t k,
                              const four_ids *none, ptrdiff_t stride, uint32_t *to)
{
    four_ids a[4];
    for (int32_t i = 0; i < 4; ++i)
        a[i] = *(const four_ids *)(count ? four_from(lists[i], count[i], k, none) : lists[i] + k);
    const four_ids ac = SHUFFLED_BY(four_ids, a[0], a[2], 0, 4, 1, 5);
    const four_ids AC = SHUFFLED_BY(four_ids, a[0], a[2], 2, 6, 3, 7);
    const four_ids bd = SHUFFLED_BY(four_ids, a[1], a[3], 0, 4, 1, 5);
    const four_ids BD = SHUFFLED_BY(four_ids, a[1], a[3], 2, 6, 3, 7);
    *(four_ids *)to = SHUFFLED_BY(four_ids, ac, bd, 0, 4, 1, 5);
    *(four_ids *)(to + stride) = SHUFFLED_BY(four_ids, ac, bd, 2, 6, 3, 7);
    *(four_ids *)(to + 2 * stride) = SHUFFLED_BY(four_ids, AC, BD, 0, 4, 1, 5);
    *(four_ids *)(to + 3 * stride) = SHUFFLED_BY(four_ids, AC, BD, 2, 6, 3, 7);
}

#if VECTOR_BYTES >= 32 && !REAL_IS_F64
/* Ids are as long as numbers, and travel like rows of four: no arithmetic touches them. */
SPHGI_TEMPLATE void turn_lanes(const uint32_t *const *lists, const int32_t *count, int32_t k,
                               const four_ids *none, ptrdiff_t stride, uint32_t *to)
{
    const real *row[LANES];
    for (int32_t l = 0; l < LANES; ++l)
        row[l] = (const real *)(const void *)(count ? four_from(lists[l], count[l], k, none)
                                                    : lists[l] + k);
    const struct four v = transpose(row);
    real *out = (real *)(void *)to;
    store(out, v.x);
    store(out + stride, v.y);
    store(out + 2 * stride, v.z);
    store(out + 3 * stride, v.w);
}
enum { TURNED = LANES };
#else
enum { TURNED = 4 };
#define turn_lanes turn_four
#endif

/* Lists that all reach as far as the longest, padding counted, many steps at a time. */
#if VECTOR_BYTES == 64 && !REAL_IS_F64
SPHGI_TEMPLATE void turn_pairs(const __m512i *a, __m512i *b, int apart)
{
    for (int i = 0; i < SPHGI_GROUP; ++i)
        if (!(i & apart)) {
            b[i] = apart == 1 ? _mm512_unpacklo_epi32(a[i], a[i + 1])
                              : _mm512_unpacklo_epi64(a[i], a[i + 2]);
            b[i + apart] = apart == 1 ? _mm512_unpackhi_epi32(a[i], a[i + 1])
                                      : _mm512_unpackhi_epi64(a[i], a[i + 2]);
        }
}

static void weave_padded(const uint32_t *const *lists, int32_t steps, uint32_t *to)
{
    for (int32_t k = 0; k < steps; k += 16) {
        __m512i a[SPHGI_GROUP], b[SPHGI_GROUP];
        for (int l = 0; l < SPHGI_GROUP; ++l)
            a[l] = _mm512_loadu_si512(lists[l] + k);
        turn_pairs(a, b, 1);
        turn_pairs(b, a, 2);
        /* a[4 f + s]: of lists 4 f .. 4 f + 3, a quarter each of steps s', s' + 4, ... */
        for (int s = 0; s < 4; ++s, to += SPHGI_GROUP) {
            const int of[4] = {0, 2, 1, 3};
            const __m512i *q = a + of[s];
            const __m512i low = _mm512_shuffle_i32x4(q[0], q[4], 0x88);
            const __m512i low_odd = _mm512_shuffle_i32x4(q[0], q[4], 0xdd);
            const __m512i high = _mm512_shuffle_i32x4(q[8], q[12], 0x88);
            const __m512i high_odd = _mm512_shuffle_i32x4(q[8], q[12], 0xdd);
            _mm512_storeu_si512(to, _mm512_shuffle_i32x4(low, high, 0x88));
            _mm512_storeu_si512(to + 4 * SPHGI_GROUP,
                                _mm512_shuffle_i32x4(low_odd, high_odd, 0x88));
            _mm512_storeu_si512(to + 8 * SPHGI_GROUP, _mm512_shuffle_i32x4(low, high, 0xdd));
            _mm512_storeu_si512(to + 12 * SPHGI_GROUP,
                                _mm512_shuffle_i32x4(low_odd, high_odd, 0xdd));
        }
        to += 12 * SPHGI_GROUP;
    }
}
#else
static void weave_padded(const uint32_t *const *lists, int32_t steps, uint32_t *to)
{
    for (int32_t k = 0; k < steps; k += 4, to += 4 * SPHGI_GROUP)
        for (int32_t l = 0; l < SPHGI_GROUP; l += TURNED)
            turn_lanes(lists + l, NULL, k, NULL, SPHGI_GROUP, to + l);
}
#endif

static void weave(const uint32_t *const *lists, const int32_t *count, int32_t steps, int32_t padded,
                  uint32_t dummy, uint32_t *to)
{
    const four_ids none = (four_ids){0} + dummy;
    int32_t shortest = count[0];
    for (int32_t l = 1; l < SPHGI_GROUP; ++l)
        shortest = sphgi_min32(shortest, count[l]);
    if (((steps + 15) & -16) <= shortest + padded) { /* nothing else is read, either */
        weave_padded(lists, steps, to);
        return;
    }
    for (int32_t k = 0; k < steps; k += 4, to += 4 * SPHGI_GROUP)
        for (int32_t l = 0; l < SPHGI_GROUP; l += TURNED)
            turn_lanes(lists + l, count + l, k, &none, SPHGI_GROUP, to + l);
}

static void pick_lists(const uint32_t *ids, uint32_t active, int32_t steps, int32_t lane,
                       uint32_t *to)
{
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    static const int32_t numbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const __m512i picked =
        _mm512_maskz_compress_epi32((__mmask16)active, _mm512_loadu_si512(numbers));
    const __mmask16 there = (__mmask16)(((1u << __builtin_popcount(active)) - 1) << lane);
    const __m512i from = _mm512_maskz_expand_epi32(there, picked);
    for (int32_t k = 0; k < steps; ++k) /* a line of the cache each */
        _mm512_mask_storeu_epi32(
            to + k * SPHGI_GROUP, there,
            _mm512_permutexvar_epi32(from, _mm512_loadu_si512(ids + k * SPHGI_GROUP)));
#else
    for (uint32_t left = active; left; left &= left - 1, ++lane) {
        const uint32_t *list = ids + __builtin_ctz(left);
        for (int32_t k = 0; k < steps; ++k)
            to[k * SPHGI_GROUP + lane] = list[k * SPHGI_GROUP];
    }
#endif
}

SPHGI_TEMPLATE bool follow_one_another(const struct sphgi_lane_lists *lists)
{
    int32_t far = 0;
    for (int32_t l = 0; l < LANES; ++l)
        far |= lists->stride[l] - 1;
    return !far;
}

SPHGI_TEMPLATE void interleave_padded(const struct sphgi_lane_lists *lists, int32_t begin,
                                      uint32_t dummy, struct sphgi_tile *tile)
{
    const four_ids none = (four_ids){0} + dummy;
    uint32_t *to = tile->own_ids;
    for (int32_t k = 0; k < tile->steps; k += 4, to += 4 * LANES) {
#if VECTOR_BYTES == 16 && REAL_IS_F64
        for (int32_t l = 0; l < LANES; ++l)
            for (int32_t i = 0; i < 4; ++i)
                to[i * LANES + l] =
                    begin + k < lists->count[l] ? lists->ids[l][begin + k + i] : none[0];
#else
        for (int32_t l = 0; l < LANES; l += TURNED)
            turn_lanes(lists->ids + l, lists->count + l, begin + k, &none, LANES, to + l);
#endif
    }
}

SPHGI_TEMPLATE void interleave_apart(const struct sphgi_lane_lists *lists, int32_t begin,
                                     uint32_t dummy, struct sphgi_tile *tile)
{
    for (int32_t l = 0; l < LANES; ++l) {
        const ptrdiff_t stride = lists->stride[l];
        const int32_t left = lists->count[l] - begin;
        const int32_t count = left < tile->steps ? left : tile->steps;
        const uint32_t *ids = lists->ids[l] + begin * stride;
        uint32_t *to = tile->own_ids + l;
        int32_t k = 0;
        for (; k + 4 <= count; k += 4, ids += 4 * stride, to += 4 * LANES) {
            to[0] = ids[0];
            to[LANES] = ids[stride];
            to[2 * LANES] = ids[2 * stride];
            to[3 * LANES] = ids[3 * stride];
        }
        for (; k < count; ++k, ids += stride, to += LANES)
            *to = *ids;
        for (; k < tile->steps; ++k, to += LANES)
            *to = dummy;
    }
}

static void interleave(const struct sphgi_lane_lists *lists, int32_t begin, uint32_t dummy,
                       struct sphgi_tile *tile)
{
    tile->ids = tile->own_ids;
    tile->id_stride = LANES;
    if (lists->side_by_side) {
        tile->ids = lists->ids[0] + (ptrdiff_t)begin * lists->stride[0];
        tile->id_stride = lists->stride[0];
    } else if (follow_one_another(lists)) {
        interleave_padded(lists, begin, dummy, tile);
    } else {
        interleave_apart(lists, begin, dummy, tile);
    }
}
