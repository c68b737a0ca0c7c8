/* Distances between particles: differences in the precision of the positions, periodic images, and
 * the neighbour predicate. */

struct wrap {
    vec period, inverse, half;
};

SPHGI_TEMPLATE struct wrap wrap_of(double period)
{
    const real length = R(period);
    const bool open = !(period > 0);
    return (struct wrap){splat(open ? R(0) : length), splat(open ? R(0) : R(1) / length),
                         splat(open ? (real)__builtin_inf() : length / 2)};
}

/* fl(fl(x_i - x_j) + kL) with the whole k that makes it smallest. Adding and subtracting
 * 1.5 2^(digits - 1) rounds to a whole number. */
SPHGI_TEMPLATE vec wrapped(vec difference, struct wrap w)
{
    const vec magic = splat(REAL_IS_F64 ? R(0x1.8p52) : R(0x1.8p23));
    const vec turns = (difference * w.inverse + magic) - magic;
    const vec near = difference - rounded(turns * w.period);
    const vec more =
        where(less(w.half, near), splat(R(1))) - where(less(near, -w.half), splat(R(1)));
    return difference - rounded((turns + more) * w.period);
}

struct wraps {
    struct wrap axis[3];
};

SPHGI_TEMPLATE struct wraps wraps_of(const double *period)
{
    return (struct wraps){{wrap_of(period[0]), wrap_of(period[1]), wrap_of(period[2])}};
}

/* r^2 as docs/theory.md section 1 defines it: every product and sum rounded on its own. */
SPHGI_TEMPLATE vec square_distance(vec dx, vec dy, vec dz)
{
    return rounded(rounded(dx * dx) + rounded(dy * dy)) + rounded(dz * dz);
}

SPHGI_TEMPLATE vec square_of(double length)
{
    return rounded(splat(R(length)) * splat(R(length)));
}

/* The first LANES ids, at out: pairs that are none are replaced by the dummy row, for a field that
 * is not finite must not enter through 0 * NaN. */
SPHGI_TEMPLATE void keep_ids(mask inside, struct listed list, void *out)
{
#if VECTOR_BYTES == 64 && REAL_IS_F64
    const __mmask8 keep = (__mmask8)inside;
    const __m256i dummy = _mm256_loadu_epi32(list.dummies);
    if (list.wide)
        _mm256_storeu_epi32(out, _mm256_mask_loadu_epi32(dummy, keep, list.ids));
    else
        _mm_storeu_epi16(out, _mm_maskz_loadu_epi16(keep, list.ids));
#elif VECTOR_BYTES == 64
    const __mmask16 keep = (__mmask16)inside;
    const __m512i dummy = _mm512_broadcast_i32x8(_mm256_loadu_epi32(list.dummies));
    if (list.wide)
        _mm512_storeu_epi32(out, _mm512_mask_loadu_epi32(dummy, keep, list.ids));
    else
        _mm256_storeu_epi16(out, _mm256_maskz_loadu_epi16(keep, list.ids));
#else
    typedef uint32_t wide_ids __attribute__((vector_size(4 * LANES), aligned(4), may_alias));
    typedef uint16_t narrow_ids __attribute__((vector_size(2 * LANES), aligned(2), may_alias));
    if (list.wide) {
        const wide_ids keep = __builtin_convertvector(inside, wide_ids);
        const wide_ids dummy = (wide_ids){0} + *(const uint32_t *)list.dummies;
        *(wide_ids *)out = (*(const wide_ids *)list.ids & keep) | (dummy & ~keep);
    } else {
        const narrow_ids keep = __builtin_convertvector(inside, narrow_ids);
        *(narrow_ids *)out = *(const narrow_ids *)list.ids & keep;
    }
#endif
}

/* The ids of part p. wide: what the piece says, known when a loop is compiled. */
SPHGI_TEMPLATE struct listed first_listed(const struct sphgi_piece *piece, int32_t p, bool wide)
{
    return (struct listed){piece->ids[p], piece->count[p], piece->dummies, wide};
}

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
