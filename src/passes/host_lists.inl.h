/* SPDX-License-Identifier: MIT */
/* The host's lists: their numbers become ids of rows that can be read, side by side for a tile. */

/* As many ids as an instruction takes, eight at most: where vectors are shorter than their type,
 * compilers compare number by number. */
typedef uint32_t some_ids
    __attribute__((vector_size(VECTOR_BYTES < 32 ? VECTOR_BYTES : 32), aligned(4), may_alias));
enum { SOME_IDS = (int)(sizeof(some_ids) / 4) };

/* *a becomes the larger, or the smaller, of both. */
SPHGI_TEMPLATE void raise_ids(some_ids *a, const some_ids *b)
{
#if defined(__AVX2__)
    *a = (some_ids)_mm256_max_epu32((__m256i)*a, (__m256i)*b);
#elif defined(__aarch64__)
    *a = (some_ids)vmaxq_u32((uint32x4_t)*a, (uint32x4_t)*b);
#else
    const some_ids first = (some_ids)(*a > *b);
    *a = (*a & first) | (*b & ~first);
#endif
}

SPHGI_TEMPLATE void lower_ids(some_ids *a, const some_ids *b)
{
#if defined(__AVX2__)
    *a = (some_ids)_mm256_min_epu32((__m256i)*a, (__m256i)*b);
#elif defined(__aarch64__)
    *a = (some_ids)vminq_u32((uint32x4_t)*a, (uint32x4_t)*b);
#else
    const some_ids first = (some_ids)(*a < *b);
    *a = (*a & first) | (*b & ~first);
#endif
}

struct cleaning {
    some_ids mask, sources, self, largest;
};

/* Eight of the host's numbers to ids of rows: what is no source, and `self`, becomes the dummy, the
 * row behind the last source. */
SPHGI_TEMPLATE void clean_eight(const int32_t *list, struct cleaning *how, uint32_t *out)
{
    for (int k = 0; k < 8; k += SOME_IDS) {
        some_ids number = *(const some_ids *)(list + k) & how->mask;
        raise_ids(&how->largest, &number);
        number |= (some_ids)(number == how->self);
        lower_ids(&number, &how->sources);
        *(some_ids *)(out + k) = number + number; /* SPHGI_ID_STEP */
    }
}

SPHGI_TEMPLATE bool is_any_beyond(const struct cleaning *how)
{
    const some_ids bad = (some_ids)(how->largest >= how->sources);
    uint64_t any[sizeof bad / 8], all = 0;
    __builtin_memcpy(any, &bad, sizeof any);
    for (size_t k = 0; k < sizeof bad / 8; ++k)
        all |= any[k];
    return all;
}

/* A list, padded with the dummy. True: there was a number that is no source. */
static bool clean_ids(const int32_t *list, int32_t count, const struct sphgi_cleaning *how,
                      uint32_t *out)
{
    const some_ids zero = {0};
    struct cleaning own = {zero + how->mask, zero + how->sources, zero + how->self, zero};
    if (count % SPHGI_PAD)
        for (int32_t k = count & -SPHGI_PAD, end = k + SPHGI_PAD; k < end; k += SOME_IDS)
            *(some_ids *)(out + k) = own.sources + own.sources;
    if (count >= 8) {
        for (int32_t k = 0; k + 8 <= count; k += 8)
            clean_eight(list + k, &own, out + k);
        /* the last eight: some of them once more */
        clean_eight(list + count - 8, &own, out + count - 8);
    } else if (count) {
        int32_t in[8];
        uint32_t clean[8];
        for (int l = 0; l < 8; ++l)
            in[l] = list[l < count ? l : 0];
        clean_eight(in, &own, clean);
        for (int32_t l = 0; l < count; ++l)
            out[l] = clean[l];
    }
    return is_any_beyond(&own);
}

/* ---- ... side by side ------------------------------------------------------------------------ */

typedef uint32_t lane_ids __attribute__((vector_size(4 * LANES), aligned(4), may_alias));

/* Four numbers of a list from step k on, of which its end may leave fewer; behind it nothing is
 * read. A list of none may be NULL.
 */
SPHGI_TEMPLATE four_ids four_at_end(const uint32_t *list, int32_t count, int32_t k)
{
    const int32_t left = count < k ? 0 : count < k + 4 ? count - k : 4;
#if defined(__AVX2__)
    static const int32_t there[] = {-1, -1, -1, -1, 0, 0, 0, 0};
    const __m128i kept = _mm_loadu_si128((const __m128i *)(const void *)(there + 4 - left));
    return (four_ids)_mm_maskload_epi32(left ? (const int *)list + k : there, kept);
#else
    four_ids some = {0};
    for (int32_t i = 0; i < left; ++i)
        some[i] = list[k + i];
    return some;
#endif
}

/* Four steps of all lanes. */
SPHGI_TEMPLATE void turn_hosts(const four_ids *list, lane_ids *step)
{
#if VECTOR_BYTES >= 32 && !REAL_IS_F64
#if VECTOR_BYTES == 64
#define FOUR(l)                                                                                    \
    (vec) _mm512_inserti64x4(                                                                      \
        _mm512_castsi256_si512(_mm256_set_m128i((__m128i)list[l + 4], (__m128i)list[l])),          \
        _mm256_set_m128i((__m128i)list[l + 12], (__m128i)list[l + 8]), 1)
#else
#define FOUR(l) (vec) _mm256_set_m128i((__m128i)list[l + 4], (__m128i)list[l])
#endif
    const struct four v = turned(FOUR(0), FOUR(1), FOUR(2), FOUR(3));
#undef FOUR
    step[0] = (lane_ids)v.x;
    step[1] = (lane_ids)v.y;
    step[2] = (lane_ids)v.z;
    step[3] = (lane_ids)v.w;
#else
    for (int i = 0; i < 4; ++i) {
        lane_ids one = {0};
        for (int l = 0; l < LANES; ++l)
            one[l] = list[l][i];
        step[i] = one;
    }
#endif
}

struct lane_cleaning {
    lane_ids mask, sources, self, largest, left;
};

/* A step's numbers become ids. */
SPHGI_TEMPLATE lane_ids clean_step(lane_ids number, int32_t k, struct lane_cleaning *how)
{
    number &= how->mask;
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    const __m512i sources = (__m512i)how->sources, v = (__m512i)number;
    const __mmask16 pairs = _mm512_cmpgt_epi32_mask((__m512i)how->left, _mm512_set1_epi32(k));
    const __mmask16 others = _mm512_mask_cmpneq_epi32_mask(pairs, v, (__m512i)how->self);
    how->largest =
        (lane_ids)_mm512_mask_max_epu32((__m512i)how->largest, pairs, (__m512i)how->largest, v);
    number = (lane_ids)_mm512_mask_min_epu32(sources, others, sources, v);
#else
    typedef int32_t lane_ints __attribute__((vector_size(4 * LANES)));
    const lane_ids pairs = (lane_ids)((lane_ints)how->left > (lane_ints){0} + k);
    const lane_ids seen = number & pairs;
    const lane_ids larger = (lane_ids)(seen > how->largest);
    how->largest = (seen & larger) | (how->largest & ~larger);
    const lane_ids valid =
        (lane_ids)(number < how->sources) & pairs & ~(lane_ids)(number == how->self);
    number = (number & valid) | (how->sources & ~valid);
#endif
    return number + number; /* SPHGI_ID_STEP */
}

SPHGI_TEMPLATE void clean_four(const four_ids *list, int32_t k, struct lane_cleaning *how,
                               uint32_t *to)
{
    lane_ids step[4] = {{0}};
    turn_hosts(list, step);
    for (int i = 0; i < 4; ++i)
        *(lane_ids *)(to + i * LANES) = clean_step(step[i], k + i, how);
}

static bool interleave_hosts(const struct sphgi_lane_lists *lists, const struct sphgi_cleaning *how,
                             const uint32_t *self, struct sphgi_tile *tile)
{
    const lane_ids zero = {0};
    struct lane_cleaning own = {zero + how->mask, zero + how->sources, *(const lane_ids *)self,
                                zero, *(const lane_ids *)(const void *)lists->count};
    uint32_t *to = tile->own_ids;
    int32_t shortest = tile->steps, k = 0;
    four_ids list[LANES];
    for (int l = 0; l < LANES; ++l)
        shortest = lists->count[l] < shortest ? lists->count[l] : shortest;
    for (; k + 4 <= shortest; k += 4, to += 4 * LANES) {
        for (int l = 0; l < LANES; ++l)
            list[l] = *(const four_ids *)(lists->ids[l] + k);
        clean_four(list, k, &own, to);
    }
    for (; k < tile->steps; k += 4, to += 4 * LANES) {
        for (int l = 0; l < LANES; ++l)
            list[l] = four_at_end(lists->ids[l], lists->count[l], k);
        clean_four(list, k, &own, to);
    }
    tile->ids = tile->own_ids;
    tile->id_stride = LANES;
    bool beyond = false;
    for (int l = 0; l < LANES; ++l)
        beyond |= own.largest[l] >= how->sources;
    return beyond;
}
