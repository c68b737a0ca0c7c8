/* SPDX-License-Identifier: MIT */
/* Items of vectors that belong to set bits, moved to the front. */

/* Each of these moves what belongs to the set bits of LANES to the front, and writes a whole
 * vector. A packing is made of a mask or its bits: pack_numbers moves numbers, number_ids makes the
 * ids of LANES rows, of which `first` is the first one's; pack_ids_of_lanes moves LANES ids.
 * pack_tested moves TESTED ids, and returns where the next ones go. */
enum { TESTED = 2 * SPHGI_PAD }; /* candidates that are tested at a time */

#if defined(__AVX512F__)
typedef __mmask16 packing;
/* What is packed into. Instructions that pack wait for what their register held before, even if
 * they clear it (Zen 5: five cycles instead of one): one that was just cleared is no such wait. The
 * compiler must not know that it is. */
SPHGI_TEMPLATE __m512i cleared(void)
{
    __m512i zero = _mm512_setzero_si512();
    __asm__("" : "+v"(zero));
    return zero;
}
SPHGI_TEMPLATE packing packing_of_bits(const struct sphgi_find *find, unsigned bits)
{
    (void)find;
    return (__mmask16)bits;
}
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return packing_of_bits(find, bits_of(lanes));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing lanes)
{
#if REAL_IS_F64
    store(to, (vec)_mm512_mask_compress_pd((__m512d)cleared(), (__mmask8)lanes, (__m512d)v));
#else
    store(to, (vec)_mm512_mask_compress_ps((__m512)cleared(), lanes, (__m512)v));
#endif
}
SPHGI_TEMPLATE void number_ids(uint32_t *to, uint32_t first, packing lanes)
{
    const __m512i numbers = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i ids = _mm512_add_epi32(_mm512_set1_epi32((int)first), SPHGI_ID_STEP * numbers);
    _mm512_storeu_si512(to, _mm512_mask_compress_epi32(cleared(), lanes, ids));
}
SPHGI_TEMPLATE void pack_ids_of_lanes(uint32_t *to, const uint32_t *ids, packing lanes)
{
#if REAL_IS_F64
    const __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)ids);
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_maskz_compress_epi32((__mmask8)lanes, eight));
#else
    _mm512_storeu_si512(to, _mm512_mask_compress_epi32(cleared(), lanes, _mm512_loadu_si512(ids)));
#endif
}
SPHGI_TEMPLATE uint32_t *pack_tested(const struct sphgi_find *find, uint32_t *to,
                                     const uint32_t *ids, unsigned bits)
{
    (void)find;
    _mm512_storeu_si512(
        to, _mm512_mask_compress_epi32(cleared(), (__mmask16)bits, _mm512_loadu_si512(ids)));
    return to + __builtin_popcount(bits);
}
#elif defined(__aarch64__)
typedef uint8x16_t packing; /* where the bytes of a vector come from */
/* The table is for items of two bytes: a lane is as many of them. */
SPHGI_TEMPLATE packing packing_of_bits(const struct sphgi_find *find, unsigned bits)
{
#if REAL_IS_F64
    static const uint8_t items[4] = {0, 15, 240, 255};
#else
    static const uint8_t items[16] = {0,   3,   12,  15,  48,  51,  60,  63,
                                      192, 195, 204, 207, 240, 243, 252, 255};
#endif
    return vld1q_u8(find->pack_bytes[items[bits]]);
}
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
#if REAL_IS_F64
    const uint64_t items = vaddvq_u64((uint64x2_t)(lanes & (mask){15, 240}));
#else
    const uint32_t items = vaddvq_u32((uint32x4_t)(lanes & (mask){3, 12, 48, 192}));
#endif
    return vld1q_u8(find->pack_bytes[items]);
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing moved)
{
    store(to, (vec)vqtbl1q_u8((uint8x16_t)v, moved));
}
SPHGI_TEMPLATE void number_ids(uint32_t *to, uint32_t first, packing moved)
{
    const bit_pattern ids = (lane_int)first + SPHGI_ID_STEP * lane_numbers();
    const uint32x4_t packed = (uint32x4_t)vqtbl1q_u8((uint8x16_t)ids, moved);
#if REAL_IS_F64
    to[0] = vgetq_lane_u32(packed, 0);
    to[1] = vgetq_lane_u32(packed, 2);
#else
    vst1q_u32(to, packed);
#endif
}
SPHGI_TEMPLATE void pack_ids_of_lanes(uint32_t *to, const uint32_t *ids, packing moved)
{
#if REAL_IS_F64
    const uint64x2_t wide = vmovl_u32(vld1_u32(ids));
    vst1_u32(to, vmovn_u64((uint64x2_t)vqtbl1q_u8((uint8x16_t)wide, moved)));
#else
    vst1q_u32(to, (uint32x4_t)vqtbl1q_u8((uint8x16_t)vld1q_u32(ids), moved));
#endif
}
SPHGI_TEMPLATE uint32_t *pack_tested(const struct sphgi_find *find, uint32_t *to,
                                     const uint32_t *ids, unsigned bits)
{
    static const uint8_t items[16] = {0,   3,   12,  15,  48,  51,  60,  63,
                                      192, 195, 204, 207, 240, 243, 252, 255};
    for (int k = 0; k < TESTED; k += 4, ids += 4, bits >>= 4) {
        const uint8x16_t moved = vld1q_u8(find->pack_bytes[items[bits & 15]]);
        vst1q_u32(to, (uint32x4_t)vqtbl1q_u8((uint8x16_t)vld1q_u32(ids), moved));
        to += __builtin_popcount(bits & 15u);
    }
    return to;
}
#elif defined(__AVX2__)
typedef __m256i packing; /* where the lanes of four bytes come from */
SPHGI_TEMPLATE __m256i lanes_of(uint64_t order)
{
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)order));
}
SPHGI_TEMPLATE packing packing_of_bits(const struct sphgi_find *find, unsigned bits)
{
    return lanes_of(find->pack_order[bits]);
}
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return packing_of_bits(find, bits_of(lanes));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing order)
{
#if REAL_IS_F64
    const __m256i wide = _mm256_cvtepu32_epi64(_mm256_castsi256_si128(order));
    const __m256i pairs = _mm256_add_epi64(wide, wide);
    const __m256i halves = _mm256_or_si256(pairs, _mm256_slli_epi64(pairs, 32));
    order = _mm256_add_epi32(halves, _mm256_set1_epi64x((long long)1 << 32));
#endif
    store(to, (vec)_mm256_permutevar8x32_ps((__m256)v, order));
}
SPHGI_TEMPLATE void number_ids(uint32_t *to, uint32_t first, packing order)
{
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_add_epi32(_mm256_set1_epi32((int)first),
                                                                _mm256_add_epi32(order, order)));
}
SPHGI_TEMPLATE void pack_ids_of_lanes(uint32_t *to, const uint32_t *ids, packing order)
{
    const __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)ids);
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_permutevar8x32_epi32(eight, order));
}
SPHGI_TEMPLATE uint32_t *pack_ids(const struct sphgi_find *find, uint32_t *to, const uint32_t *ids,
                                  unsigned bits)
{
    const __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)ids);
    _mm256_storeu_si256((__m256i *)(void *)to,
                        _mm256_permutevar8x32_epi32(eight, lanes_of(find->pack_order[bits])));
    return to + __builtin_popcount(bits);
}
#else
typedef uint64_t packing; /* the positions of the set bits, a byte each */
SPHGI_TEMPLATE packing packing_of_bits(const struct sphgi_find *find, unsigned bits)
{
    return find->pack_order[bits];
}
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return packing_of_bits(find, bits_of(lanes));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing order)
{
    for (int k = 0; k < LANES; ++k)
        to[k] = v[order >> (8 * k) & (unsigned)(LANES - 1)];
}
SPHGI_TEMPLATE void number_ids(uint32_t *to, uint32_t first, packing order)
{
    for (int k = 0; k < LANES; ++k)
        to[k] = first + SPHGI_ID_STEP * (uint32_t)(order >> (8 * k) & 255);
}
SPHGI_TEMPLATE void pack_ids_of_lanes(uint32_t *to, const uint32_t *ids, packing order)
{
    uint32_t moved[LANES];
    for (int k = 0; k < LANES; ++k)
        moved[k] = ids[order >> (8 * k) & (unsigned)(LANES - 1)];
    for (int k = 0; k < LANES; ++k)
        to[k] = moved[k];
}
SPHGI_TEMPLATE uint32_t *pack_ids(const struct sphgi_find *find, uint32_t *to, const uint32_t *ids,
                                  unsigned bits)
{
    (void)find;
    for (int k = 0; k < SPHGI_PAD; ++k) { /* branch-free: a wrong one is overwritten */
        *to = ids[k];
        to += bits >> k & 1;
    }
    return to;
}
#endif
#if !defined(__AVX512F__) && !defined(__aarch64__)
SPHGI_TEMPLATE uint32_t *pack_tested(const struct sphgi_find *find, uint32_t *to,
                                     const uint32_t *ids, unsigned bits)
{
    to = pack_ids(find, to, ids, bits & 255);
    return pack_ids(find, to, ids + SPHGI_PAD, bits >> SPHGI_PAD);
}
#endif
