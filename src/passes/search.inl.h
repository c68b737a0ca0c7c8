/* Search: which staged sources are neighbours of a few targets that lie close together. Candidates
 * within reach of the targets' bounding box are packed once; each target then tests the packed ones
 * with the exact predicate. Testing first and packing in a second loop over the stored bits is a
 * fifth faster than both in one loop (docs/design.md). */

/* Coordinates of rows; whole vectors are read and written. */
static void transpose_rows(const void *rows, int32_t count, void *x, void *y, void *z)
{
    const real *from = rows;
    real *to[3] = {x, y, z};
    for (int32_t k = 0; k < count; k += LANES) {
        const real *row[LANES];
        for (int l = 0; l < LANES; ++l)
            row[l] = from + SPHGI_ROW * (ptrdiff_t)(k + l);
        const struct four four = transpose(row);
        store(to[0] + k, four.x);
        store(to[1] + k, four.y);
        store(to[2] + k, four.z);
    }
}

/* ---- Packing -------------------------------------------------------------------------------- */

/* Each of these moves what belongs to the set bits of LANES to the front, and writes a whole
 * vector. A packing is made of the bits: pack_numbers moves numbers, number_ids makes the ids of
 * staged numbers, of which `first` holds the first one's. pack_tested moves TESTED ids, and returns
 * where the next ones go. */
enum { TESTED = 2 * SPHGI_PAD }; /* candidates that are tested at a time */

#if defined(__AVX512F__)
typedef __mmask16 packing;
typedef __m512i id_base; /* the ids of LANES numbers; the rest goes on */
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    (void)find;
    return (__mmask16)bits_of(lanes);
}
SPHGI_TEMPLATE id_base ids_from(int32_t number)
{
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return SPHGI_ID_STEP * _mm512_add_epi32(lanes, _mm512_set1_epi32(number));
}
SPHGI_TEMPLATE id_base ids_after(id_base first, int32_t numbers)
{
    return _mm512_add_epi32(first, _mm512_set1_epi32(SPHGI_ID_STEP * numbers));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing lanes)
{
#if REAL_IS_F64
    store(to, (vec)_mm512_maskz_compress_pd((__mmask8)lanes, (__m512d)v));
#else
    store(to, (vec)_mm512_maskz_compress_ps(lanes, (__m512)v));
#endif
}
SPHGI_TEMPLATE void write_ids(uint16_t *to, __m512i ids)
{
    _mm256_storeu_si256((__m256i *)(void *)to, _mm512_cvtepi32_epi16(ids));
}
SPHGI_TEMPLATE void number_ids(uint16_t *to, id_base first, packing lanes)
{
    write_ids(to, _mm512_maskz_compress_epi32(lanes, first));
}
SPHGI_TEMPLATE uint16_t *pack_tested(const struct sphgi_find *find, uint16_t *to,
                                     const uint16_t *ids, uint16_t bits)
{
    (void)find;
    const __m256i narrow = _mm256_loadu_si256((const __m256i *)(const void *)ids);
    write_ids(to, _mm512_maskz_compress_epi32(bits, _mm512_cvtepu16_epi32(narrow)));
    return to + __builtin_popcount(bits);
}
#elif defined(__aarch64__)
typedef uint8x16_t packing;  /* where the bytes of a vector come from */
typedef bit_pattern id_base; /* the ids of LANES numbers */
/* The table is for items of two bytes: a lane is as many of them. */
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
#if REAL_IS_F64
    const uint64_t items = vaddvq_u64((uint64x2_t)(lanes & (mask){15, 240}));
#else
    const uint32_t items = vaddvq_u32((uint32x4_t)(lanes & (mask){3, 12, 48, 192}));
#endif
    return vld1q_u8(find->pack_bytes[items]);
}
SPHGI_TEMPLATE id_base ids_from(int32_t number)
{
    return SPHGI_ID_STEP * (lane_numbers() + (lane_int)number);
}
SPHGI_TEMPLATE id_base ids_after(id_base first, int32_t numbers)
{
    return first + (lane_int)(SPHGI_ID_STEP * numbers);
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing moved)
{
    store(to, (vec)vqtbl1q_u8((uint8x16_t)v, moved));
}
SPHGI_TEMPLATE void number_ids(uint16_t *to, id_base first, packing moved)
{
    const uint8x16_t ids = vqtbl1q_u8((uint8x16_t)first, moved);
#if REAL_IS_F64
    vst1q_lane_u16(to, (uint16x8_t)ids, 0);
    vst1q_lane_u16(to + 1, (uint16x8_t)ids, 4);
#else
    vst1_u16(to, vmovn_u32((uint32x4_t)ids));
#endif
}
SPHGI_TEMPLATE uint16_t *pack_tested(const struct sphgi_find *find, uint16_t *to,
                                     const uint16_t *ids, uint16_t bits)
{
    const uint8x8_t count = vcnt_u8((uint8x8_t)vdup_n_u16(bits));
    const uint8x16_t low = vld1q_u8(find->pack_bytes[bits & 255]);
    const uint8x16_t high = vld1q_u8(find->pack_bytes[bits >> SPHGI_PAD]);
    vst1q_u8((uint8_t *)to, vqtbl1q_u8((uint8x16_t)vld1q_u16(ids), low));
    to += vget_lane_u8(count, 0);
    vst1q_u8((uint8_t *)to, vqtbl1q_u8((uint8x16_t)vld1q_u16(ids + SPHGI_PAD), high));
    return to + vget_lane_u8(count, 1);
}
#else
typedef uint64_t packing; /* the positions of the set bits, a byte each */
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return find->pack_order[bits_of(lanes)];
}
#if defined(__AVX2__)
typedef __m128i id_base;
SPHGI_TEMPLATE id_base ids_from(int32_t number)
{
    return _mm_set1_epi16((short)(SPHGI_ID_STEP * number));
}
SPHGI_TEMPLATE id_base ids_after(id_base first, int32_t numbers)
{
    return _mm_add_epi16(first, ids_from(numbers));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing order)
{
#if REAL_IS_F64
    const __m256i pairs = _mm256_cvtepu8_epi64(_mm_cvtsi64_si128((long long)(order + order)));
    const __m256i halves = _mm256_or_si256(pairs, _mm256_slli_epi64(pairs, 32));
    const __m256i lanes = _mm256_add_epi32(halves, _mm256_set1_epi64x((long long)1 << 32));
#else
    const __m256i lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)order));
#endif
    store(to, (vec)_mm256_permutevar8x32_ps((__m256)v, lanes));
}
SPHGI_TEMPLATE void number_ids(uint16_t *to, id_base first, packing order)
{
    const __m128i places = _mm_cvtepu8_epi16(_mm_cvtsi64_si128((long long)order));
    _mm_storeu_si128((__m128i *)(void *)to, _mm_add_epi16(first, _mm_add_epi16(places, places)));
}
SPHGI_TEMPLATE uint16_t *pack_ids(const struct sphgi_find *find, uint16_t *to, const uint16_t *ids,
                                  unsigned bits)
{
    const __m128i eight = _mm_loadu_si128((const __m128i *)(const void *)ids);
    const __m128i order = _mm_load_si128((const __m128i *)(const void *)find->pack_bytes[bits]);
    _mm_storeu_si128((__m128i *)(void *)to, _mm_shuffle_epi8(eight, order));
    return to + __builtin_popcount(bits);
}
#else
typedef int32_t id_base;
SPHGI_TEMPLATE id_base ids_from(int32_t number)
{
    return SPHGI_ID_STEP * number;
}
SPHGI_TEMPLATE id_base ids_after(id_base first, int32_t numbers)
{
    return first + ids_from(numbers);
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing order)
{
    for (int k = 0; k < LANES; ++k)
        to[k] = v[order >> (8 * k) & (unsigned)(LANES - 1)];
}
SPHGI_TEMPLATE void number_ids(uint16_t *to, id_base first, packing order)
{
    for (int k = 0; k < LANES; ++k)
        to[k] = (uint16_t)(first + SPHGI_ID_STEP * (int32_t)(order >> (8 * k) & 255));
}
SPHGI_TEMPLATE uint16_t *pack_ids(const struct sphgi_find *find, uint16_t *to, const uint16_t *ids,
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
SPHGI_TEMPLATE uint16_t *pack_tested(const struct sphgi_find *find, uint16_t *to,
                                     const uint16_t *ids, uint16_t bits)
{
    to = pack_ids(find, to, ids, bits & 255);
    return pack_ids(find, to, ids + SPHGI_PAD, bits >> SPHGI_PAD);
}
#endif

/* ---- Candidates ----------------------------------------------------------------------------- */

/* The packed candidates of a few targets. If these are sources, they come first. */
struct candidates {
    real *x, *y, *z;
    uint16_t *ids;
    uint16_t *bits; /* of the target in hand, one number for TESTED candidates */
    int32_t count;  /* rounded up to TESTED with NaN */
};

SPHGI_TEMPLATE struct candidates carve(void *scratch, int32_t most)
{
    const size_t room = sphgi_round_up((size_t)most + 2 * TESTED, SPHGI_ALIGNMENT);
    struct candidates c = {.x = scratch};
    c.y = c.x + room;
    c.z = c.y + room;
    c.ids = (uint16_t *)(void *)(c.z + room);
    c.bits = c.ids + room;
    return c;
}

struct box {
    vec low[3], high[3], middle[3], half[3];
    vec square_reach; /* rounded up */
};

/* Margins: rounding of the predicate, of distances to the box and of the box itself is relative, a
 * few units in 2^-24, against 2^-16 here; between periodic images it is absolute: the slack. */
SPHGI_TEMPLATE struct box bounding_box(const struct sphgi_find *find, const real *targets,
                                       int32_t count)
{
    struct box box;
    for (int a = 0; a < 3; ++a) {
        real low = targets[a], high = low;
        for (int32_t k = 1; k < count; ++k) {
            const real x = targets[SPHGI_ROW * k + a];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        const real middle = low / 2 + high / 2;
        const real below = middle - low, above = high - middle;
        box.low[a] = splat(low);
        box.high[a] = splat(high);
        box.middle[a] = splat(middle);
        box.half[a] = splat((below > above ? below : above) * R(1 + 0x1p-20));
    }
    const double reach = find->reach * (1 + 0x1p-16) + 2 * find->slack;
    box.square_reach = splat(R(reach * reach));
    return box;
}

/* Which of LANES sources lie within reach of the box, and perhaps a few beyond it. */
SPHGI_TEMPLATE mask near_box(const struct box *box, const vec *at, const struct wraps *w,
                             bool periodic)
{
    vec square = {0};
    for (int a = 0; a < 3; ++a) {
        vec d;
        if (periodic) { /* in this order, for infinity - infinity must give 0 */
            d = wrapped(box->middle[a] - at[a], w->axis[a]);
            d = vmax(vabs(d) - box->half[a], (vec){0});
        } else
            d = at[a] - vmin(vmax(at[a], box->low[a]), box->high[a]);
        square += d * d;
    }
    return at_most(square, box->square_reach); /* both may be infinite */
}

/* Packs the sources [begin, end) behind the n candidates there are; returns their new number. */
SPHGI_TEMPLATE int32_t collect_run(const struct sphgi_find *find, const struct candidates *c,
                                   const struct box *box, int32_t begin, int32_t end, int32_t n,
                                   const struct wraps *w, bool periodic)
{
    const real *x = find->x, *y = find->y, *z = find->z;
    mask near = {0};
    int32_t k = begin;
    id_base first = ids_from(begin);
    for (; k < end; k += LANES) {
        const vec at[3] = {load(x + k), load(y + k), load(z + k)};
        near = near_box(box, at, w, periodic);
        const packing moved = packing_of(find, near);
        pack_numbers(c->x + n, at[0], moved);
        pack_numbers(c->y + n, at[1], moved);
        pack_numbers(c->z + n, at[2], moved);
        number_ids(c->ids + n, first, moved);
        first = ids_after(first, LANES);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE struct candidates collect(const struct sphgi_find *find,
                                         const struct sphgi_runs *runs, const struct box *box,
                                         int32_t self, const struct wraps *w, bool periodic)
{
    struct candidates c = carve(find->scratch, runs->candidates);
    const int32_t cut = self < 0 ? runs->begin[0] : self; /* the first run goes from here ... */
    int32_t n = 0;
    for (int32_t run = 0; run <= runs->count; ++run) {
        const bool rest = run == runs->count; /* ... and up to here it comes last */
        const int32_t begin = rest ? runs->begin[0] : run ? runs->begin[run] : cut;
        const int32_t end = rest ? cut : runs->begin[run] + runs->length[run];
        n = collect_run(find, &c, box, begin, end, n, w, periodic);
    }
    c.count = (int32_t)sphgi_round_up((size_t)n, TESTED);
    const vec none = splat((real)__builtin_nan("")); /* in x alone would do, but for valgrind */
    for (int l = 0; l < TESTED; l += LANES) {
        store(c.x + n + l, none);
        store(c.y + n + l, none);
        store(c.z + n + l, none);
    }
    return c;
}

/* ---- Neighbours ----------------------------------------------------------------------------- */

/* A bit for each of TESTED candidates. */
SPHGI_TEMPLATE uint16_t bits_of_tested(const mask *m)
{
#if defined(__aarch64__)
    /* bytes of 0 or 255, each of which keeps its bit; then neighbours are added, three times */
    const uint8x16_t bit = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    uint32x4_t wide[4];
    for (int k = 0; k < 4; ++k)
#if REAL_IS_F64
        wide[k] = vuzp1q_u32((uint32x4_t)m[2 * k], (uint32x4_t)m[2 * k + 1]);
#else
        wide[k] = (uint32x4_t)m[k];
#endif
    const uint16x8_t low = vuzp1q_u16((uint16x8_t)wide[0], (uint16x8_t)wide[1]);
    const uint16x8_t high = vuzp1q_u16((uint16x8_t)wide[2], (uint16x8_t)wide[3]);
    uint8x16_t bits = vandq_u8(vuzp1q_u8((uint8x16_t)low, (uint8x16_t)high), bit);
    for (int k = 0; k < 3; ++k)
        bits = vpaddq_u8(bits, bits);
    return vgetq_lane_u16((uint16x8_t)bits, 0);
#else
    unsigned bits = 0;
    for (int l = 0; l < TESTED; l += LANES)
        bits |= bits_of(m[l / LANES]) << l;
    return (uint16_t)bits;
#endif
}

/* Which of TESTED candidates from k on are neighbours. */
SPHGI_TEMPLATE uint16_t bits_within(const struct candidates *c, int32_t k, const vec *x,
                                    vec square_reach, const struct wraps *w, bool periodic)
{
    mask within[TESTED / LANES];
    for (int l = 0; l < TESTED; l += LANES) {
        vec dx = x[0] - load(c->x + k + l);
        vec dy = x[1] - load(c->y + k + l);
        vec dz = x[2] - load(c->z + k + l);
        if (periodic) {
            dx = wrapped(dx, w->axis[0]);
            dy = wrapped(dy, w->axis[1]);
            dz = wrapped(dz, w->axis[2]);
        }
        within[l / LANES] = less(square_distance(dx, dy, dz), square_reach);
    }
    return bits_of_tested(within);
}

SPHGI_TEMPLATE void test(const struct candidates *c, const vec *x, vec square_reach,
                         const struct wraps *w, bool periodic)
{
    uint16_t *bits = c->bits;
    for (int32_t k = 0; k < c->count; k += TESTED)
        *bits++ = bits_within(c, k, x, square_reach, w, periodic);
}

SPHGI_TEMPLATE uint16_t *pack(const struct sphgi_find *find, const struct candidates *c,
                              uint16_t *to)
{
    for (int32_t k = 0; k < c->count; k += TESTED)
        to = pack_tested(find, to, c->ids + k, c->bits[k / TESTED]);
    __builtin_memset(to, 0, SPHGI_PAD * sizeof *to);
    return to;
}

SPHGI_TEMPLATE int64_t find_as(const struct sphgi_find *find, const struct sphgi_runs *runs,
                               const real *targets, int32_t count, int32_t self, uint16_t *ids,
                               uint16_t *lengths, bool periodic)
{
    const struct wraps w = wraps_of(find->period);
    const vec square_reach = square_of(find->reach);
    const struct box box = bounding_box(find, targets, count);
    const struct candidates c = collect(find, runs, &box, self, &w, periodic);
    uint16_t *out = ids;
    for (int32_t t = 0; t < count; ++t, targets += SPHGI_ROW) {
        const vec x[3] = {splat(targets[0]), splat(targets[1]), splat(targets[2])};
        test(&c, x, square_reach, &w, periodic);
        if (self >= 0)
            c.bits[t / TESTED] &= (uint16_t) ~(1u << t % TESTED);
        const uint16_t *end = pack(find, &c, out);
        lengths[t] = (uint16_t)(end - out);
        out += sphgi_round_up((size_t)(end - out), SPHGI_PAD);
    }
    return out - ids;
}

static int64_t find(const struct sphgi_find *find, const struct sphgi_runs *runs,
                    const void *targets, int32_t count, int32_t self, uint16_t *ids,
                    uint16_t *lengths)
{
    return find->periodic ? find_as(find, runs, targets, count, self, ids, lengths, true)
                          : find_as(find, runs, targets, count, self, ids, lengths, false);
}
