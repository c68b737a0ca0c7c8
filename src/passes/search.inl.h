/* Search: which staged sources are neighbours of a few targets that lie close together. Candidates
 * within reach of the targets' enclosing ball are packed once; each target then tests the packed
 * ones with the exact predicate. Testing first and packing in a second loop over the stored bits is
 * a fifth faster than both in one loop (docs/design.md). */

/* Moves the numbers (ids) of the set bits to the front; writes a whole vector. order: the positions
 * of the set bits of each byte, a byte each. */
#if defined(__AVX2__)
SPHGI_TEMPLATE __m128i byte_pairs(uint64_t order) /* b -> 2 b, 2 b + 1 */
{
    const __m128i twice = _mm_cvtsi64_si128((long long)(order + order));
    return _mm_unpacklo_epi8(twice, _mm_add_epi8(twice, _mm_set1_epi8(1)));
}
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, uint64_t order)
{
#if REAL_IS_F64
    const __m256i lanes = _mm256_cvtepu8_epi32(byte_pairs(order));
    store(to, (vec)_mm256_permutevar8x32_ps((__m256)v, lanes));
#else
    const __m256i lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)order));
    store(to, (vec)_mm256_permutevar8x32_ps((__m256)v, lanes));
#endif
}
SPHGI_TEMPLATE void pack_ids(uint16_t *to, const uint16_t *ids, unsigned bits, uint64_t order)
{
    (void)bits;
    const __m128i eight = _mm_loadu_si128((const __m128i *)(const void *)ids);
    _mm_storeu_si128((__m128i *)(void *)to, _mm_shuffle_epi8(eight, byte_pairs(order)));
}
#else
SPHGI_TEMPLATE void pack_numbers(real *to, vec v, uint64_t order)
{
    vec packed;
    for (int k = 0; k < LANES; ++k)
        packed[k] = v[order >> (8 * k) & (unsigned)(LANES - 1)];
    store(to, packed);
}
SPHGI_TEMPLATE void pack_ids(uint16_t *to, const uint16_t *ids, unsigned bits, uint64_t order)
{
    (void)order;
    for (int k = 0; k < SPHGI_PAD; ++k) { /* branch-free: a wrong one is overwritten */
        *to = ids[k];
        to += bits >> k & 1;
    }
}
#endif

struct candidates {
    real *x, *y, *z;
    uint16_t *ids;
    uint8_t *bits;
    int32_t run_begin[10];
    int32_t count; /* rounded up to SPHGI_PAD with NaN */
};

SPHGI_TEMPLATE struct candidates carve(const struct sphgi_find *find)
{
    int64_t most = 2 * SPHGI_PAD;
    for (int32_t k = 0; k < find->runs; ++k)
        most += find->run_length[k];
    most = (int64_t)sphgi_round_up((size_t)most, SPHGI_ALIGNMENT);
    struct candidates c = {.x = find->scratch};
    c.y = c.x + most;
    c.z = c.y + most;
    c.ids = (uint16_t *)(void *)(c.z + most);
    c.bits = (uint8_t *)(void *)(c.ids + most);
    return c;
}

struct ball {
    vec x, y, z, square; /* the centre, and the square of radius + reach, rounded up */
};

SPHGI_TEMPLATE struct ball enclosing_ball(const struct sphgi_find *find)
{
    const real *t = find->targets;
    real low[3], high[3], centre[3];
    for (int a = 0; a < 3; ++a)
        low[a] = high[a] = t[a];
    for (int32_t k = 1; k < find->target_count; ++k)
        for (int a = 0; a < 3; ++a) {
            const real x = t[SPHGI_ROW * k + a];
            low[a] = x < low[a] ? x : low[a];
            high[a] = x > high[a] ? x : high[a];
        }
    for (int a = 0; a < 3; ++a)
        centre[a] = low[a] / 2 + high[a] / 2;
    double largest = 0;
    for (int32_t k = 0; k < find->target_count; ++k) {
        double square = 0;
        for (int a = 0; a < 3; ++a) {
            const double d = (double)t[SPHGI_ROW * k + a] - (double)centre[a];
            square += d * d;
        }
        largest = square > largest ? square : largest;
    }
    /* Rounding of the predicate and of this bound: a few units in 2^-24, against 2^-16. */
    const double reach = (find->reach + __builtin_sqrt(largest)) * (1 + 0x1p-16) + find->slack;
    return (struct ball){splat(centre[0]), splat(centre[1]), splat(centre[2]),
                         splat(R(reach * reach))};
}

SPHGI_TEMPLATE vec distance_to(vec x, vec y, vec z, vec cx, vec cy, vec cz, const struct wraps *w,
                               bool periodic)
{
    vec dx = cx - x, dy = cy - y, dz = cz - z;
    if (periodic) {
        dx = wrapped(dx, w->axis[0]);
        dy = wrapped(dy, w->axis[1]);
        dz = wrapped(dz, w->axis[2]);
    }
    return square_distance(dx, dy, dz);
}

SPHGI_TEMPLATE void collect(const struct sphgi_find *find, struct candidates *c,
                            const struct wraps *w, bool periodic)
{
    const struct ball ball = enclosing_ball(find);
    const real *sx = find->x, *sy = find->y, *sz = find->z;
    uint16_t own[SPHGI_PAD];
    int32_t n = 0;
    for (int32_t run = 0; run < find->runs; ++run) {
        const int32_t end = find->run_begin[run] + find->run_length[run];
        c->run_begin[run] = n;
        for (int32_t k = find->run_begin[run]; k < end; k += LANES) {
            const vec x = load(sx + k), y = load(sy + k), z = load(sz + k);
            const vec square = distance_to(x, y, z, ball.x, ball.y, ball.z, w, periodic);
            unsigned bits = bits_of((mask)(square <= ball.square)); /* both may be infinite */
            bits &= end - k >= LANES ? (1u << LANES) - 1 : (1u << (end - k)) - 1;
            const uint64_t order = find->pack_order[bits];
            pack_numbers(c->x + n, x, order);
            pack_numbers(c->y + n, y, order);
            pack_numbers(c->z + n, z, order);
            for (int l = 0; l < SPHGI_PAD; ++l)
                own[l] = (uint16_t)(SPHGI_ID_STEP * (k + l));
            pack_ids(c->ids + n, own, bits, order);
            n += __builtin_popcount(bits);
        }
    }
    c->run_begin[find->runs] = n;
    c->count = (int32_t)sphgi_round_up((size_t)n, SPHGI_PAD);
    for (int32_t k = n; k < c->count; ++k) {
        c->x[k] = (real)__builtin_nan("");
        c->y[k] = c->z[k] = R(0);
        c->ids[k] = 0;
    }
}

/* Where a target itself stands among the packed candidates, or -1. It is in the run of its own
 * cell, and targets come in the order of their numbers. */
SPHGI_TEMPLATE int32_t own_candidate(const struct sphgi_find *find, const struct candidates *c,
                                     int32_t self)
{
    for (int32_t run = 0; self >= 0 && run < find->runs; ++run) {
        const int32_t offset = self / SPHGI_ID_STEP - find->run_begin[run];
        if (offset < 0 || offset >= find->run_length[run])
            continue;
        for (int32_t k = c->run_begin[run]; k < c->run_begin[run + 1]; ++k)
            if (c->ids[k] == self)
                return k;
    }
    return -1;
}

SPHGI_TEMPLATE int64_t find_as(const struct sphgi_find *find, uint16_t *ids, uint16_t *lengths,
                               bool periodic)
{
    const struct wraps w = wraps_of(find->period);
    const vec square_reach = square_of(find->reach);
    struct candidates c = carve(find);
    collect(find, &c, &w, periodic);
    uint16_t *out = ids;
    for (int32_t t = 0; t < find->target_count; ++t) {
        const real *row = (const real *)find->targets + SPHGI_ROW * t;
        const vec x = splat(row[0]), y = splat(row[1]), z = splat(row[2]);
        for (int32_t k = 0; k < c.count; k += SPHGI_PAD) {
            unsigned bits = 0;
            for (int32_t l = 0; l < SPHGI_PAD; l += LANES) {
                const vec square = distance_to(load(c.x + k + l), load(c.y + k + l),
                                               load(c.z + k + l), x, y, z, &w, periodic);
                bits |= bits_of(less(square, square_reach)) << l;
            }
            c.bits[k / SPHGI_PAD] = (uint8_t)bits;
        }
        const int32_t own = own_candidate(find, &c, find->self[t]);
        if (own >= 0)
            c.bits[own / SPHGI_PAD] &= (uint8_t) ~(1u << own % SPHGI_PAD);
        uint16_t *to = out;
        for (int32_t k = 0; k < c.count; k += SPHGI_PAD) {
            const unsigned bits = c.bits[k / SPHGI_PAD];
            pack_ids(to, c.ids + k, bits, find->pack_order[bits]);
            to += __builtin_popcount(bits);
        }
        __builtin_memset(to, 0, SPHGI_PAD * sizeof *to);
        lengths[t] = (uint16_t)(to - out);
        out += sphgi_round_up((size_t)(to - out), SPHGI_PAD);
    }
    return out - ids;
}

static int64_t find(const struct sphgi_find *find, uint16_t *ids, uint16_t *lengths)
{
    return find->periodic ? find_as(find, ids, lengths, true) : find_as(find, ids, lengths, false);
}
