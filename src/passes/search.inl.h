/* SPDX-License-Identifier: MIT */
/* Search: which sources are neighbours of a few targets that lie close together. Candidates
 * within reach of the targets' bounding box are packed once; each target then tests the packed ones
 * with the exact predicate. Testing first and packing in a second loop over the stored bits is a
 * fifth faster than both in one loop (docs/design.md). */

/* ---- Coordinates ----------------------------------------------------------------------------- */

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

/* ---- Packing -------------------------------------------------------------------------------- */

/* Each of these moves what belongs to the set bits of LANES to the front, and writes a whole
 * vector. A packing is made of the bits: pack_numbers moves numbers, number_ids makes the ids of
 * LANES rows, of which `first` is the first one's; pack_ids_of_lanes moves LANES ids. pack_tested
 * moves TESTED ids, and returns where the next ones go. */
enum { TESTED = 2 * SPHGI_PAD }; /* candidates that are tested at a time */

#if defined(__AVX512F__)
typedef __mmask16 packing;
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    (void)find;
    return (__mmask16)bits_of(lanes);
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, packing lanes)
{
#if REAL_IS_F64
    store(to, (vec)_mm512_maskz_compress_pd((__mmask8)lanes, (__m512d)v));
#else
    store(to, (vec)_mm512_maskz_compress_ps(lanes, (__m512)v));
#endif
}
SPHGI_TEMPLATE void number_ids(uint32_t *to, uint32_t first, packing lanes)
{
    const __m512i numbers = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i ids = _mm512_add_epi32(_mm512_set1_epi32((int)first), SPHGI_ID_STEP * numbers);
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(lanes, ids));
}
SPHGI_TEMPLATE void pack_ids_of_lanes(uint32_t *to, const uint32_t *ids, packing lanes)
{
#if REAL_IS_F64
    const __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)ids);
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_maskz_compress_epi32((__mmask8)lanes, eight));
#else
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(lanes, _mm512_loadu_si512(ids)));
#endif
}
SPHGI_TEMPLATE uint32_t *pack_tested(const struct sphgi_find *find, uint32_t *to,
                                     const uint32_t *ids, unsigned bits)
{
    (void)find;
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)bits, _mm512_loadu_si512(ids)));
    return to + __builtin_popcount(bits);
}
#elif defined(__aarch64__)
typedef uint8x16_t packing; /* where the bytes of a vector come from */
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
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return lanes_of(find->pack_order[bits_of(lanes)]);
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
SPHGI_TEMPLATE packing packing_of(const struct sphgi_find *find, mask lanes)
{
    return find->pack_order[bits_of(lanes)];
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

/* ---- Candidates ----------------------------------------------------------------------------- */

/* The packed candidates of some targets. If these are sources, they follow one another from `self`
 * on. */
struct candidates {
    real *x, *y, *z;
    real *squares; /* of their radii, where these count; or NULL */
    uint32_t *ids;
    uint16_t *bits; /* of the targets in hand, one number for TESTED candidates */
    int32_t count;  /* rounded up to TESTED with NaN */
    int32_t self;
};

enum { FEW = 4 /* targets that are tested together */ };

SPHGI_TEMPLATE struct candidates carve(void *scratch, int32_t most, bool squares)
{
    const size_t room = sphgi_round_up((size_t)most + 2 * TESTED, SPHGI_ALIGNMENT);
    struct candidates c = {.x = scratch};
    c.y = c.x + room;
    c.z = c.y + room;
    c.squares = squares ? c.z + room : NULL;
    c.ids = (uint32_t *)(void *)(c.z + (squares ? 2 : 1) * room);
    c.bits = (uint16_t *)(void *)(c.ids + room);
    return c;
}

typedef lane_int quad_bits
    __attribute__((vector_size(4 * sizeof(real)), aligned(__alignof__(real)), may_alias));

struct box {
    vec low[3], high[3], middle[3], half[3];
    vec square_reach; /* rounded up */
    real radius;      /* the largest of the targets, where they have their own */
};

/* Margins: rounding of the predicate, of distances to the box and of the box itself is relative, a
 * few units in 2^-24, against 2^-16 here; between periodic images it is absolute: the slack. */
/* *a becomes the smaller, or the larger, of both. */
SPHGI_TEMPLATE void lower_quad(quad *a, const quad *b)
{
    const quad_bits first = (quad_bits)(*a < *b);
    *a = (quad)((first & (quad_bits)*a) | (~first & (quad_bits)*b));
}

SPHGI_TEMPLATE void raise_quad(quad *a, const quad *b)
{
    const quad_bits first = (quad_bits)(*a > *b);
    *a = (quad)((first & (quad_bits)*a) | (~first & (quad_bits)*b));
}

SPHGI_TEMPLATE struct box bounding_box(const struct sphgi_find *find, const real *targets,
                                       int32_t count)
{
    quad low = *(const quad *)targets, high = low;
    for (int32_t k = 1; k < count; ++k) {
        const quad *row = (const quad *)(targets + SPHGI_ROW * k);
        lower_quad(&low, row);
        raise_quad(&high, row);
    }
    const quad middle = low / 2 + high / 2;
    const quad above = high - middle;
    quad half = middle - low;
    raise_quad(&half, &above);
    half *= R(1 + 0x1p-20);
    struct box box;
    for (int a = 0; a < 3; ++a) {
        box.low[a] = splat(low[a]);
        box.high[a] = splat(high[a]);
        box.middle[a] = splat(middle[a]);
        box.half[a] = splat(half[a]);
    }
    box.radius = high[3];
    const double reach = find->reach * (1 + 0x1p-16) + 2 * find->slack;
    box.square_reach = splat(R(reach * reach));
    return box;
}

/* Which of LANES sources lie within reach of the box, and perhaps a few beyond it. */
SPHGI_TEMPLATE mask within_reach(const struct box *box, const struct three *coordinates,
                                 vec square_reach, const struct wraps *w, bool periodic)
{
    const vec at[3] = {coordinates->x, coordinates->y, coordinates->z};
    vec square = {0};
    for (int a = 0; a < 3; ++a) {
        vec d;
        if (periodic) { /* in this order, for infinity - infinity must give 0 */
            d = wrapped(box->middle[a] - at[a], w->axis[a]);
            d = vmax(vabs(d) - box->half[a], (vec){0});
        } else
            d = at[a] - vmin(vmax(at[a], box->low[a]), box->high[a]);
        square = plus(square, d, d);
    }
    return at_most(square, square_reach); /* both may be infinite */
}

SPHGI_TEMPLATE mask near_box(const struct box *box, const struct three *coordinates,
                             const struct wraps *w, bool periodic)
{
    return within_reach(box, coordinates, box->square_reach, w, periodic);
}

/* Packs the sources [begin, end) behind the n candidates there are; returns their new number. */
SPHGI_TEMPLATE int32_t collect_run(const struct sphgi_find *find, const struct candidates *c,
                                   const struct box *box, int32_t begin, int32_t end, int32_t n,
                                   const struct wraps *w, bool periodic)
{
    const real *rows = (const real *)find->rows + SPHGI_ROW * (ptrdiff_t)begin;
    mask near = {0};
    int32_t k = begin;
    for (; k < end; k += LANES, rows += SPHGI_ROW * LANES) {
        const struct three at = coordinates_of(rows);
        near = near_box(box, &at, w, periodic);
        const packing moved = packing_of(find, near);
        pack_numbers(c->x + n, at.x, moved);
        pack_numbers(c->y + n, at.y, moved);
        pack_numbers(c->z + n, at.z, moved);
        number_ids(c->ids + n, SPHGI_ID_STEP * (uint32_t)k, moved);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE struct candidates collect(const struct sphgi_find *find,
                                         const struct sphgi_runs *runs, const struct box *box,
                                         int32_t self, const struct wraps *w, bool periodic)
{
    struct candidates c = carve(find->scratch, runs->candidates, false);
    int32_t n = 0;
    c.self = -1;
    for (int32_t run = 0; run < runs->count; ++run) {
        int32_t begin = runs->begin[run];
        const int32_t end = begin + runs->length[run];
        if (!run && self >= 0) { /* in two parts, to see where the targets stand */
            n = collect_run(find, &c, box, begin, self, n, w, periodic);
            c.self = n;
            begin = self;
        }
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

/* A target among the candidates. square: of the radius that counts */
struct seeker {
    vec x[3], square;
};

SPHGI_TEMPLATE struct seeker seeker_of(const real *row, vec square)
{
    return (struct seeker){{splat(row[0]), splat(row[1]), splat(row[2])}, square};
}

/* Which of TESTED candidates from k on are neighbours of a target. */
SPHGI_TEMPLATE uint16_t bits_within(const struct candidates *c, int32_t k,
                                    const struct seeker *target, const struct wraps *w,
                                    bool periodic, bool mutual)
{
    mask within[TESTED / LANES];
    for (int l = 0; l < TESTED; l += LANES) {
        vec dx = target->x[0] - load(c->x + k + l);
        vec dy = target->x[1] - load(c->y + k + l);
        vec dz = target->x[2] - load(c->z + k + l);
        if (periodic) {
            dx = wrapped(dx, w->axis[0]);
            dy = wrapped(dy, w->axis[1]);
            dz = wrapped(dz, w->axis[2]);
        }
        const vec square = mutual ? vmax(target->square, load(c->squares + k + l)) : target->square;
        within[l / LANES] = less(square_distance(dx, dy, dz), square);
    }
    return bits_of_tested(within);
}

/* Tests and packs are loops of their own, over `many` targets at a time: a candidate is loaded once
 * for all of them, and so is the end of the loop foreseen. */
SPHGI_TEMPLATE void test_few(const struct candidates *c, const struct seeker *targets,
                             const struct wraps *w, bool periodic, bool mutual, int32_t many)
{
    const int32_t stride = c->count / TESTED;
    uint16_t *bits = c->bits;
    for (int32_t k = 0; k < c->count; k += TESTED, ++bits) {
        unsigned own[FEW];
        for (int32_t t = 0; t < many; ++t)
            own[t] = bits_within(c, k, &targets[t], w, periodic, mutual);
        for (int32_t t = 0; t < many; ++t)
            bits[t * stride] = (uint16_t)own[t];
    }
}

typedef uint32_t padding __attribute__((vector_size(4 * SPHGI_PAD), aligned(4), may_alias));

/* No target is its own neighbour. */
SPHGI_TEMPLATE void leave_out_selves(const struct candidates *c, int32_t first, int32_t many)
{
    const int32_t stride = c->count / TESTED;
    for (int32_t t = 0; t < many; ++t) {
        const int32_t at = c->self + first + t;
        c->bits[t * stride + at / TESTED] &= (uint16_t) ~(1u << at % TESTED);
    }
}

SPHGI_TEMPLATE void pack_few(const struct sphgi_find *find, const struct candidates *c,
                             uint32_t *const *lists, int32_t *lengths, int32_t many)
{
    const int32_t stride = c->count / TESTED;
    uint32_t *to[FEW];
    for (int32_t t = 0; t < many; ++t)
        to[t] = lists[t];
    for (int32_t k = 0; k < stride; ++k)
        for (int32_t t = 0; t < many; ++t)
            to[t] = pack_tested(find, to[t], c->ids + k * TESTED, c->bits[t * stride + k]);
    for (int32_t t = 0; t < many; ++t) {
        *(padding *)to[t] = (padding){0} + find->dummy;
        lengths[t] = (int32_t)(to[t] - lists[t]);
    }
}

/* The lists of `many` of the targets, of which `first` come before these. */
SPHGI_TEMPLATE void find_few(const struct sphgi_find *find, const struct candidates *c,
                             const struct seeker *targets, const struct wraps *w,
                             uint32_t *const *lists, int32_t *lengths, int32_t first, bool periodic,
                             bool mutual, int32_t many)
{
    test_few(c, targets, w, periodic, mutual, many);
    if (c->self >= 0)
        leave_out_selves(c, first, many);
    pack_few(find, c, lists + first, lengths + first, many);
}

/* Squares of the radii that count, rounded like those of distances. */
SPHGI_TEMPLATE vec square_of_radius(vec radius, vec stretch)
{
    const vec reach = radius * stretch;
    return reach * reach;
}

/* radii: targets have their own, in the 4th number of their rows. */
SPHGI_TEMPLATE void find_among(const struct sphgi_find *find, const struct candidates *c,
                               const real *targets, int32_t count, const struct wraps *w,
                               uint32_t *const *lists, int32_t *lengths, bool periodic, bool radii,
                               bool mutual)
{
    const vec square = square_of(find->reach), stretch = splat(R(find->stretch));
    for (int32_t t = 0, many; t < count; t += many, targets += many * SPHGI_ROW) {
        struct seeker few[FEW];
        many = count - t < FEW ? count - t : FEW;
        for (int32_t k = 0; k < many; ++k) {
            const real *row = targets + k * SPHGI_ROW;
            few[k] = seeker_of(row, radii ? square_of_radius(splat(row[3]), stretch) : square);
        }
        if (many == 4)
            find_few(find, c, few, w, lists, lengths, t, periodic, mutual, 4);
        else if (many == 3)
            find_few(find, c, few, w, lists, lengths, t, periodic, mutual, 3);
        else if (many == 2)
            find_few(find, c, few, w, lists, lengths, t, periodic, mutual, 2);
        else
            find_few(find, c, few, w, lists, lengths, t, periodic, mutual, 1);
    }
}

SPHGI_TEMPLATE void find_as(const struct sphgi_find *find, const struct sphgi_runs *runs,
                            const real *targets, int32_t count, int32_t self,
                            uint32_t *const *lists, int32_t *lengths, bool periodic)
{
    const struct wraps w = wraps_of(find->period);
    const struct box box = bounding_box(find, targets, count);
    const struct candidates c = collect(find, runs, &box, self, &w, periodic);
    find_among(find, &c, targets, count, &w, lists, lengths, periodic, false, false);
}

static void find(const struct sphgi_find *find, const struct sphgi_runs *runs, const void *targets,
                 int32_t count, int32_t self, uint32_t *const *lists, int32_t *lengths)
{
    if (find->periodic)
        find_as(find, runs, targets, count, self, lists, lengths, true);
    else
        find_as(find, runs, targets, count, self, lists, lengths, false);
}
