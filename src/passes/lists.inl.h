/* Lists of ids: side by side for the lanes of a tile, and what becomes of the host's numbers. */

/* ---- Side by side --------------------------------------------------------------------------- */

typedef uint16_t eight_ids __attribute__((vector_size(16), aligned(2), may_alias));
typedef uint32_t eight_wide_ids __attribute__((vector_size(32), aligned(4), may_alias));
#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 >= 8
enum { LANES_AT_ONCE = 8 };
#else
enum { LANES_AT_ONCE = LANES };
#endif
typedef uint16_t narrow_ids __attribute__((vector_size(2 * LANES_AT_ONCE), aligned(2), may_alias));
typedef uint32_t wide_ids __attribute__((vector_size(4 * LANES_AT_ONCE), aligned(4), may_alias));

/* Eight ids each of eight lists, turned. */
SPHGI_TEMPLATE void turn_ids(const eight_ids *a, eight_ids *out)
{
    eight_ids b[8], c[8];
    for (int k = 0; k < 4; ++k) { /* lists k, k + 4 */
        b[2 * k] = __builtin_shufflevector(a[k], a[k + 4], 0, 8, 1, 9, 2, 10, 3, 11);
        b[2 * k + 1] = __builtin_shufflevector(a[k], a[k + 4], 4, 12, 5, 13, 6, 14, 7, 15);
    }
    for (int k = 0; k < 2; ++k) /* lists k, k + 2, k + 4, k + 6 */
        for (int h = 0; h < 2; ++h) {
            const eight_ids x = b[2 * k + h], y = b[2 * (k + 2) + h];
            c[4 * k + 2 * h] = __builtin_shufflevector(x, y, 0, 8, 1, 9, 2, 10, 3, 11);
            c[4 * k + 2 * h + 1] = __builtin_shufflevector(x, y, 4, 12, 5, 13, 6, 14, 7, 15);
        }
    for (int h = 0; h < 4; ++h) {
        out[2 * h] = __builtin_shufflevector(c[h], c[4 + h], 0, 8, 1, 9, 2, 10, 3, 11);
        out[2 * h + 1] = __builtin_shufflevector(c[h], c[4 + h], 4, 12, 5, 13, 6, 14, 7, 15);
    }
}

/* Eight steps of eight lists from step k on; a list is padded to eight, behind that are dummies. */
SPHGI_TEMPLATE void take_eight(const uint16_t *const *lists, const int32_t *count, int32_t k,
                               eight_ids *out)
{
    static const eight_ids none = {0};
    eight_ids in[8];
    for (int32_t i = 0; i < 8; ++i)
        in[i] = *(k < count[i] ? (const eight_ids *)(lists[i] + k) : &none);
    turn_ids(in, out);
}

static void weave(const uint16_t *const *lists, const int32_t *count, int32_t lanes, int32_t steps,
                  uint16_t *to)
{
    if (lanes % 8) {
        for (int32_t l = 0; l < lanes; ++l)
            for (int32_t k = 0; k < steps; ++k)
                to[k * lanes + l] = k < count[l] ? lists[l][k] : 0;
        return;
    }
    for (int32_t k = 0; k < steps; k += 8)
        for (int32_t l = 0; l < lanes; l += 8) {
            eight_ids out[8];
            take_eight(lists + l, count + l, k, out);
            for (int32_t i = 0; i < 8 && k + i < steps; ++i)
                *(eight_ids *)(to + (k + i) * lanes + l) = out[i];
        }
}

/* A step of lists that stand side by side already. (GCC makes five instructions of what is one.) */
SPHGI_TEMPLATE void widen_step(const uint16_t *from, uint32_t *to)
{
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    _mm512_storeu_si512(to, _mm512_cvtepu16_epi32(_mm256_loadu_si256((const void *)from)));
#elif VECTOR_BYTES == 64 || (VECTOR_BYTES == 32 && !REAL_IS_F64)
    _mm256_storeu_si256((void *)to, _mm256_cvtepu16_epi32(_mm_loadu_si128((const void *)from)));
#else
    for (int32_t l = 0; l < LANES; l += LANES_AT_ONCE)
        *(wide_ids *)(to + l) = __builtin_convertvector(*(const narrow_ids *)(from + l), wide_ids);
#endif
}

/* They come from memory: those to come are asked for. */
SPHGI_TEMPLATE void widen(const uint16_t *from, ptrdiff_t stride, struct sphgi_tile *tile)
{
    enum { AHEAD = 64 }; /* steps */
    const int32_t steps = tile->steps;
    uint32_t *to = tile->ids;
    int32_t k = 0;
    for (; k + 4 <= steps; k += 4, from += 4 * stride, to += 4 * LANES) {
        __builtin_prefetch(from + AHEAD * stride);
        __builtin_prefetch(from + (AHEAD + 2) * stride);
        widen_step(from, to);
        widen_step(from + stride, to + LANES);
        widen_step(from + 2 * stride, to + 2 * LANES);
        widen_step(from + 3 * stride, to + 3 * LANES);
    }
    for (; k < steps; ++k, from += stride, to += LANES)
        widen_step(from, to);
}

#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 >= 8
/* Each padded to SPHGI_PAD; tile->ids has room for as many steps. */
SPHGI_TEMPLATE void interleave_padded(const struct sphgi_lane_lists *lists, int32_t begin,
                                      struct sphgi_tile *tile)
{
    for (int32_t k = 0; k < tile->steps; k += 8)
        for (int32_t l = 0; l < LANES; l += 8) {
            eight_ids out[8];
            take_eight((const uint16_t *const *)(lists->ids + l), lists->count + l, begin + k, out);
            for (int32_t i = 0; i < 8; ++i)
                *(eight_wide_ids *)(tile->ids + (k + i) * LANES + l) =
                    __builtin_convertvector(out[i], eight_wide_ids);
        }
}
#endif

SPHGI_TEMPLATE bool are_padded(const struct sphgi_lane_lists *lists)
{
    int32_t far = 0;
    for (int32_t l = 0; l < LANES; ++l)
        far |= lists->stride[l] - 1;
    return !far;
}

SPHGI_TEMPLATE void interleave_narrow(const struct sphgi_lane_lists *lists, int32_t begin,
                                      struct sphgi_tile *tile)
{
    for (int32_t l = 0; l < LANES; ++l) {
        const int32_t stride = lists->stride[l], left = lists->count[l] - begin;
        const int32_t count = left < tile->steps ? left : tile->steps;
        const uint16_t *ids = (const uint16_t *)lists->ids[l] + (ptrdiff_t)begin * stride;
        uint32_t *to = tile->ids + l;
        int32_t k = 0;
        for (; k + 4 <= count; k += 4, ids += 4 * stride, to += 4 * LANES) {
            to[0] = ids[0];
            to[LANES] = ids[stride];
            to[2 * LANES] = ids[2 * stride];
            to[3 * LANES] = ids[3 * stride];
        }
        for (; k < tile->steps; ++k, ids += stride, to += LANES)
            *to = k < count ? *ids : 0;
    }
}

#if VECTOR_BYTES == 16 && REAL_IS_F64
SPHGI_TEMPLATE void interleave_wide(const struct sphgi_lane_lists *lists, struct sphgi_tile *tile)
{
    for (int32_t l = 0; l < LANES; ++l)
        for (int32_t k = 0; k < tile->steps; ++k)
            tile->ids[k * LANES + l] =
                k < lists->count[l] ? ((const uint32_t *)lists->ids[l])[k] : lists->dummy;
}
#else
typedef uint32_t four_ids __attribute__((vector_size(16), aligned(4), may_alias));

/* Lists are padded to four with the dummy; tile->ids has room for as many steps. */
SPHGI_TEMPLATE void interleave_wide(const struct sphgi_lane_lists *lists, struct sphgi_tile *tile)
{
    const four_ids none = (four_ids){0} + lists->dummy;
    for (int32_t l = 0; l < LANES; l += 4)
        for (int32_t k = 0; k < tile->steps; k += 4) {
            four_ids a[4];
            for (int32_t i = 0; i < 4; ++i) {
                const four_ids *from = (const four_ids *)((const uint32_t *)lists->ids[l + i] + k);
                a[i] = *(k < lists->count[l + i] ? from : &none);
            }
            const four_ids ac = __builtin_shufflevector(a[0], a[2], 0, 4, 1, 5);
            const four_ids AC = __builtin_shufflevector(a[0], a[2], 2, 6, 3, 7);
            const four_ids bd = __builtin_shufflevector(a[1], a[3], 0, 4, 1, 5);
            const four_ids BD = __builtin_shufflevector(a[1], a[3], 2, 6, 3, 7);
            uint32_t *to = tile->ids + k * LANES + l;
            *(four_ids *)to = __builtin_shufflevector(ac, bd, 0, 4, 1, 5);
            *(four_ids *)(to + LANES) = __builtin_shufflevector(ac, bd, 2, 6, 3, 7);
            *(four_ids *)(to + 2 * LANES) = __builtin_shufflevector(AC, BD, 0, 4, 1, 5);
            *(four_ids *)(to + 3 * LANES) = __builtin_shufflevector(AC, BD, 2, 6, 3, 7);
        }
}
#endif

static void interleave(const struct sphgi_lane_lists *lists, int32_t begin, struct sphgi_tile *tile)
{
    if (lists->wide)
        interleave_wide(lists, tile);
    else if (lists->side_by_side)
        widen((const uint16_t *)lists->ids[0] + (ptrdiff_t)begin * lists->stride[0],
              lists->stride[0], tile);
#if VECTOR_BYTES / (1 + REAL_IS_F64) / 4 >= 8
    else if (are_padded(lists))
        interleave_padded(lists, begin, tile);
#endif
    else
        interleave_narrow(lists, begin, tile);
}

/* ---- The host's numbers --------------------------------------------------------------------- */

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
    const some_ids bad = (some_ids)(own.largest >= own.sources);
    uint64_t any[sizeof bad / 8], all = 0;
    __builtin_memcpy(any, &bad, sizeof any);
    for (size_t k = 0; k < sizeof bad / 8; ++k)
        all |= any[k];
    return all;
}
