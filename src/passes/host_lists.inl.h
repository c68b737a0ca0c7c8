/* SPDX-License-Identifier: MIT */
/* The host's lists: their numbers become ids of rows that can be read, side by side for a tile. */

/* ---- A list ---------------------------------------------------------------------------------- */

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

SPHGI_TEMPLATE some_ids all_ids(uint32_t number)
{
    return (some_ids){0} + number;
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

/* `count` numbers; up to `steps` the dummy follows. There is room for multiples of SPHGI_PAD. */
SPHGI_TEMPLATE void clean_list(const int32_t *list, int32_t count, int32_t steps,
                               struct cleaning *how, uint32_t *out)
{
    for (int32_t k = count & -SPHGI_PAD; k < steps; k += SOME_IDS)
        *(some_ids *)(out + k) = how->sources + how->sources;
    if (count >= 8) {
        for (int32_t k = 0; k + 8 <= count; k += 8)
            clean_eight(list + k, how, out + k);
        /* the last eight: some of them once more */
        clean_eight(list + count - 8, how, out + count - 8);
    } else if (count) {
        int32_t in[8];
        uint32_t clean[8];
        for (int l = 0; l < 8; ++l)
            in[l] = list[l < count ? l : 0];
        clean_eight(in, how, clean);
        for (int32_t l = 0; l < count; ++l)
            out[l] = clean[l];
    }
}

SPHGI_TEMPLATE struct cleaning cleaning_by(const struct sphgi_cleaning *how)
{
    return (struct cleaning){all_ids(how->mask), all_ids(how->sources), all_ids(how->self),
                             all_ids(0)};
}

static bool clean_ids(const int32_t *list, int32_t count, const struct sphgi_cleaning *how,
                      uint32_t *out)
{
    struct cleaning own = cleaning_by(how);
    clean_list(list, count, (count + SPHGI_PAD - 1) & -SPHGI_PAD, &own, out);
    return is_any_beyond(&own);
}

/* ---- Lists of a tile ------------------------------------------------------------------------- */

/* What a slot is filled by. */
#if defined(__AVX512F__)
struct slot_cleaning {
    __m512i mask, sources, self, largest;
};

SPHGI_TEMPLATE struct slot_cleaning slot_cleaning_by(const struct sphgi_cleaning *how)
{
    return (struct slot_cleaning){_mm512_set1_epi32((int)how->mask),
                                  _mm512_set1_epi32((int)how->sources),
                                  _mm512_set1_epi32((int)how->self), _mm512_setzero_si512()};
}

SPHGI_TEMPLATE void leave_out(struct slot_cleaning *how, int32_t self)
{
    how->self = _mm512_set1_epi32(self);
}

SPHGI_TEMPLATE void clean_sixteen(const int32_t *list, __mmask16 there, struct slot_cleaning *how,
                                  uint32_t *out)
{
    const __m512i number = _mm512_and_si512(_mm512_maskz_loadu_epi32(there, list), how->mask);
    const __mmask16 others = _mm512_mask_cmpneq_epi32_mask(there, number, how->self);
    const __m512i row = _mm512_mask_min_epu32(how->sources, others, how->sources, number);
    how->largest = _mm512_max_epu32(how->largest, number);
    _mm512_storeu_si512(out, _mm512_add_epi32(row, row)); /* SPHGI_ID_STEP */
}

/* Behind a list's end nothing is read. Loads under a mask do not tell the machine what will be read
 * next: somebody must have asked for it. */
SPHGI_TEMPLATE void fill_slot(const int32_t *list, int32_t count, int32_t steps,
                              struct slot_cleaning *how, uint32_t *slot)
{
    static const int32_t numbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const __m512i first = _mm512_loadu_si512(numbers), sixteen = _mm512_set1_epi32(16);
    __m512i left = _mm512_sub_epi32(_mm512_set1_epi32(count), first);
    for (int32_t k = 0; k < steps; k += 16) {
        clean_sixteen(list + k, _mm512_cmpgt_epi32_mask(left, _mm512_setzero_si512()), how,
                      slot + k);
        left = _mm512_sub_epi32(left, sixteen);
    }
}

SPHGI_TEMPLATE bool is_any_bad(const struct slot_cleaning *how)
{
    return _mm512_cmpge_epu32_mask(how->largest, how->sources);
}
#else
struct slot_cleaning {
    struct cleaning own;
};

SPHGI_TEMPLATE struct slot_cleaning slot_cleaning_by(const struct sphgi_cleaning *how)
{
    return (struct slot_cleaning){cleaning_by(how)};
}

SPHGI_TEMPLATE void leave_out(struct slot_cleaning *how, int32_t self)
{
    how->own.self = all_ids((uint32_t)self);
}

SPHGI_TEMPLATE void fill_slot(const int32_t *list, int32_t count, int32_t steps,
                              struct slot_cleaning *how, uint32_t *slot)
{
    clean_list(list, count, steps, &how->own, slot);
}

SPHGI_TEMPLATE bool is_any_bad(const struct slot_cleaning *how)
{
    return is_any_beyond(&how->own);
}
#endif

/* The numbers of each lane, from `begin` on, become ids in a slot of its own, as many for all. */
static bool fill_slots(const struct sphgi_lane_lists *lists, int32_t begin,
                       const struct sphgi_slots *slots, int32_t steps)
{
    struct slot_cleaning own = slot_cleaning_by(&slots->how);
    const uintptr_t ahead = (uintptr_t)slots->ahead_begin * sizeof(uint32_t);
    for (int l = 0; l < LANES; ++l) {
        uint32_t *slot = slots->ids + l * SPHGI_CHUNK;
        const int32_t left = lists->count[l] - begin;
        const int32_t count = left < 0 ? 0 : left < steps ? left : steps;
        if (slots->targets)
            leave_out(&own, slots->targets[l]);
        fill_slot((const int32_t *)(const void *)(count ? lists->ids[l] + begin : slot), count,
                  steps, &own, slot);
        if (slots->ahead)
            sphgi_ask_for_numbers((uintptr_t)slots->ahead[l] + ahead, slots->ahead_count);
    }
    return is_any_bad(&own);
}

/* Four steps of all slots. */
SPHGI_TEMPLATE void turn_slots(const uint32_t *slots, uint32_t *to)
{
#if VECTOR_BYTES == 16 && REAL_IS_F64
    for (int l = 0; l < LANES; ++l)
        for (int i = 0; i < 4; ++i)
            to[i * LANES + l] = slots[l * SPHGI_CHUNK + i];
#else
    for (int l = 0; l < LANES; l += TURNED) {
        const uint32_t *list[TURNED];
        for (int i = 0; i < TURNED; ++i)
            list[i] = slots + (l + i) * SPHGI_CHUNK;
        turn_lanes(list, NULL, 0, NULL, LANES, to + l);
    }
#endif
}

static bool interleave_hosts(const struct sphgi_lane_lists *lists, int32_t begin,
                             const struct sphgi_slots *slots, struct sphgi_tile *tile)
{
    const bool beyond = fill_slots(lists, begin, slots, tile->steps);
    for (int32_t k = 0; k < tile->steps; k += 4)
        turn_slots(slots->ids + k, tile->own_ids + k * LANES);
    tile->ids = tile->own_ids;
    tile->id_stride = LANES;
    return beyond;
}
