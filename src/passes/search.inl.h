/* SPDX-License-Identifier: MIT */
/* Search: which sources are neighbours of a few targets that lie close together. Candidates
 * within reach of the targets' bounding box are packed once; each target then tests the packed ones
 * with the exact predicate. Either is done in two loops, the first of which tests and the second
 * packs by the bits that were stored: loops without a branch are faster than one with both
 * (docs/design.md). */

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

enum {
    FEW = 4, /* targets that are tested together */
    /* Candidates of a cell, in 2D or of thin clouds, of which nobody asks whether they lie near the
     * box: long vectors test them all in as little time. */
    FEW_CANDIDATES = LANES >= 8 ? 40 : 0
};

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
#if defined(__SSE2__) && !REAL_IS_F64
SPHGI_TEMPLATE void lower_quad(quad *a, const quad *b)
{
    *a = (quad)_mm_min_ps((__m128)*a, (__m128)*b);
}
SPHGI_TEMPLATE void raise_quad(quad *a, const quad *b)
{
    *a = (quad)_mm_max_ps((__m128)*a, (__m128)*b);
}
#else
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
#endif

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

/* The places of LANES candidates behind the n that there are. */
SPHGI_TEMPLATE void pack_places(const struct candidates *c, int32_t n, const struct three *at,
                                packing moved)
{
    pack_numbers(c->x + n, at->x, moved);
    pack_numbers(c->y + n, at->y, moved);
    pack_numbers(c->z + n, at->z, moved);
}

/* Behind the last candidate: as many as are tested at a time, that are none. */
SPHGI_TEMPLATE void pad_candidates(const struct candidates *c, int32_t n)
{
    const vec none = splat((real)__builtin_nan("")); /* in x alone would do, but for valgrind */
    for (int l = 0; l < TESTED; l += LANES) {
        store(c->x + n + l, none);
        store(c->y + n + l, none);
        store(c->z + n + l, none);
        if (c->squares)
            store(c->squares + n + l, splat(R(0)));
    }
}

/* Which of the vectors' lanes lie near the box. */
SPHGI_TEMPLATE void scan_box(const struct sphgi_find *find, const struct scan *scan,
                             const struct box *box, const struct wraps *w, bool periodic)
{
    for (int32_t v = 0; v < scan->count; ++v) {
        const struct three at = staged_at(find, scan->at[v]);
        scan->lanes[v] &= (uint16_t)bits_of(near_box(box, &at, w, periodic));
    }
}

SPHGI_TEMPLATE struct candidates collect(const struct sphgi_find *find,
                                         const struct sphgi_runs *runs, const struct box *box,
                                         int32_t self, const struct wraps *w, bool periodic)
{
    const struct candidates c = carve(find->scratch, runs->candidates, false);
    const struct scan scan = scan_of(find, runs);
    int32_t n = 0;
    if (runs->candidates > FEW_CANDIDATES)
        scan_box(find, &scan, box, w, periodic);
    for (int32_t v = 0; v < scan.count; ++v) {
        const struct three at = staged_at(find, scan.at[v]);
        const packing moved = packing_of_bits(find, scan.lanes[v]);
        pack_places(&c, n, &at, moved);
        number_ids(c.ids + n, SPHGI_ID_STEP * (uint32_t)scan.row[v], moved);
        n += __builtin_popcount(scan.lanes[v]);
    }
    pad_candidates(&c, n);
    struct candidates all = c;
    all.count = (int32_t)sphgi_round_up((size_t)n, TESTED);
    all.self = self < 0 ? -1 : lanes_before(&scan, runs->length[0], self);
    return all;
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

typedef uint32_t padding __attribute__((vector_size(VECTOR_BYTES), aligned(4), may_alias));
enum { PADDING = VECTOR_BYTES / 4 };

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
        for (int32_t k = 0; k < SPHGI_FIND_PAD; k += PADDING)
            *(padding *)(to[t] + k) = (padding){0} + find->dummy;
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
    WITH(periodic, find->periodic,
         find_as(find, runs, targets, count, self, lists, lengths, periodic));
}
