/* SPDX-License-Identifier: MIT */
/* From moments to corrections (theory.md, section 3), one target a lane. Healthy matrices are
 * inverted by LDL^T under a certificate; lanes that lack it are decomposed. */

/* |c|_F^2 */
SPHGI_TEMPLATE vec square_norm(const vec *c, bool three)
{
    if (!three)
        return plus(plus(c[0] * c[0], c[2], c[2]), splat(R(2)), c[1] * c[1]);
    const vec diagonal = plus(plus(c[0] * c[0], c[3], c[3]), c[5], c[5]);
    return plus(diagonal, splat(R(2)), plus(plus(c[1] * c[1], c[2], c[2]), c[4], c[4]));
}

/* LDL^T inverse of one symmetric matrix a lane; gives the lanes that pass the certificate
 * |A^-1|_F (eps_hi + 80 u tr A) < 1, pivots > 0: there every eigenvalue exceeds eps_hi for sure,
 * so that the threshold would not have touched it. Both sides are squared; an inverse so small that
 * its square is inexact does not pass. Written so that NaN fails. */
SPHGI_TEMPLATE mask certified_inverse(const vec *m, real eps_high, bool three, vec *c, vec *square)
{
    const vec zero = splat(R(0));
    vec trace;
    mask pivots;
    if (three) {
        const vec i0 = R(1) / m[0], l1 = m[1] * i0, l2 = m[2] * i0;
        const vec d1 = minus(m[3], l1, m[1]), i1 = R(1) / d1;
        const vec t = minus(m[4], l1, m[2]), l3 = t * i1;
        const vec d2 = minus(minus(m[5], l2, m[2]), l3, t), i2 = R(1) / d2;
        const vec k2 = plus(-l2, l1, l3);
        pivots = less(zero, m[0]) & less(zero, d1) & less(zero, d2);
        trace = m[0] + m[3] + m[5];
        c[5] = i2;
        c[4] = -l3 * i2;
        c[3] = minus(i1, l3, c[4]);
        c[2] = k2 * i2;
        c[1] = minus(-l1 * i1, l3, c[2]);
        c[0] = plus(plus(i0, l1 * l1, i1), k2, c[2]);
    } else {
        const vec i0 = R(1) / m[0], l1 = m[1] * i0, d1 = minus(m[2], l1, m[1]), i1 = R(1) / d1;
        pivots = less(zero, m[0]) & less(zero, d1);
        trace = m[0] + m[2];
        c[2] = i1;
        c[1] = -l1 * i1;
        c[0] = minus(i0, l1, c[1]);
    }
    *square = square_norm(c, three);
    const vec bound = plus(splat(eps_high), splat(R(80 * UNIT_ROUNDOFF)), trace);
    const mask exact = less(splat(REAL_IS_F64 ? R(0x1p-800) : R(0x1p-80)), *square);
    return pivots & exact & less(*square * (bound * bound), splat(R(1)));
}

SPHGI_TEMPLATE double largest_of(vec v)
{
    real largest = v[0];
    for (int l = 1; l < LANES; ++l)
        largest = v[l] > largest ? v[l] : largest;
    return (double)largest;
}

/* Whether those numbers of a lane that `which` has a bit for are all 0. */
SPHGI_TEMPLATE bool are_zero(const real *m, int lane, unsigned which)
{
    bool zero = true;
    for (int k = 0; which >> k; ++k)
        zero &= !(which >> k & 1) || m[k * SPHGI_WIDTH + lane] == R(0);
    return zero;
}

/* A lane of zeros, a target without neighbours, has nothing to decompose: every direction is
 * dropped. */
SPHGI_TEMPLATE void keep_empty(const struct sphgi_threshold *threshold, int lane, double low,
                               real *c, real *lambda_min, struct sphgi_verdict *verdict, bool three)
{
    for (int k = 0; k < (three ? 6 : 3); ++k) {
        const bool diagonal = three ? k == 0 || k == 3 || k == 5 : k != 1;
        c[k * SPHGI_WIDTH + lane] = R(diagonal && threshold->policy != SPHG_TRUNCATE ? low : 0);
    }
    verdict->rank[lane] = 0;
    verdict->lambda_min[lane] = 0;
    if (lambda_min)
        lambda_min[lane] = R(0);
    if (verdict->kept)
        ((real *)verdict->kept)[lane] = R(0);
}

/* Matrices that are decomposed together: numbers, then lambda_min, rank and what is kept,
 * [number][matrix]. */
struct packed {
    int count;
    int lane[SPHGI_WIDTH];
    real m[6 * SPHGI_WIDTH], done[9 * SPHGI_WIDTH];
};

/* The lanes of `open` that have something to decompose. */
SPHGI_TEMPLATE void pack_open(const struct sphgi_threshold *threshold, const real *m, uint32_t open,
                              double low, real *c, real *lambda_min, struct sphgi_verdict *verdict,
                              bool three, struct packed *packed)
{
    const int numbers = three ? 6 : 3;
    packed->count = 0;
    for (; open; open &= open - 1) {
        const int lane = __builtin_ctz(open);
        const bool empty = are_zero(m, lane, three ? 1 | 1 << 3 | 1 << 5 : 1 | 1 << 2);
        verdict->empty |= (uint32_t)empty << lane;
        if (empty && are_zero(m, lane, (1u << numbers) - 1)) {
            keep_empty(threshold, lane, low, c, lambda_min, verdict, three);
            continue;
        }
        for (int k = 0; k < numbers; ++k)
            packed->m[k * SPHGI_WIDTH + packed->count] = m[k * SPHGI_WIDTH + lane];
        packed->lane[packed->count++] = lane;
    }
    for (int s = packed->count; packed->count && s % (ABREAST * DLANES); ++s)
        for (int k = 0; k < numbers; ++k) /* any matrix that is there fills a vector */
            packed->m[k * SPHGI_WIDTH + s] = packed->m[k * SPHGI_WIDTH];
}

SPHGI_TEMPLATE void unpack(const struct packed *packed, int numbers, real *c, real *lambda_min,
                           struct sphgi_verdict *verdict)
{
    for (int s = 0; s < packed->count; ++s) {
        const int lane = packed->lane[s];
        const real *done = packed->done + s;
        for (int k = 0; k < numbers; ++k)
            c[k * SPHGI_WIDTH + lane] = done[k * SPHGI_WIDTH];
        verdict->lambda_min[lane] = (double)done[6 * SPHGI_WIDTH];
        verdict->rank[lane] = (uint8_t)done[7 * SPHGI_WIDTH];
        if (lambda_min)
            lambda_min[lane] = done[6 * SPHGI_WIDTH];
        if (verdict->kept)
            ((real *)verdict->kept)[lane] = done[8 * SPHGI_WIDTH];
    }
}

/* Decomposes the lanes of `open`, each for itself, whatever stands beside it: those of 0 are empty,
 * moments that are not finite give NaN and rank 0. m, c: [number][SPHGI_WIDTH], normalised. */
SPHGI_TEMPLATE void decompose_as(const struct sphgi_threshold *threshold, const real *m,
                                 uint32_t open, double low, real *c, real *lambda_min,
                                 struct sphgi_verdict *verdict, bool three)
{
    const int numbers = three ? 6 : 3;
    struct packed packed;
    pack_open(threshold, m, open, low, c, lambda_min, verdict, three, &packed);
    for (int s = 0; s < packed.count; s += ABREAST * DLANES) {
        dvec wide[ABREAST][6];
        struct eigen eigen[ABREAST];
        for (int v = 0; v < ABREAST; ++v)
            for (int k = 0; k < numbers; ++k)
                wide[v][k] = widened(packed.m + k * SPHGI_WIDTH + s + v * DLANES);
        decompose(wide, three, eigen);
        for (int v = 0; v < ABREAST; ++v) {
            const struct corrected done = correct(threshold, wide[v], &eigen[v], low, three);
            real *to = packed.done + s + v * DLANES;
            for (int k = 0; k < numbers; ++k)
                narrowed(to + k * SPHGI_WIDTH, done.c[k]);
            narrowed(to + 6 * SPHGI_WIDTH, done.lambda_min);
            narrowed(to + 7 * SPHGI_WIDTH, done.rank);
            narrowed(to + 8 * SPHGI_WIDTH, done.kept);
        }
    }
    unpack(&packed, numbers, c, lambda_min, verdict);
}

static __attribute__((noinline)) void decompose_open(const struct sphgi_threshold *threshold,
                                                     const real *m, uint32_t open, double low,
                                                     real *c, real *lambda_min,
                                                     struct sphgi_verdict *verdict)
{
    WITH(three, threshold->dimension == 3,
         decompose_as(threshold, m, open, low, c, lambda_min, verdict, three));
}

SPHGI_TEMPLATE real highest_touched(const struct sphgi_threshold *threshold)
{
    return R((threshold->policy == SPHG_BLEND ? 4 : 1) * threshold->eps);
}

SPHGI_TEMPLATE vec scaled_moment(const struct sphgi_threshold *threshold, const real *moment,
                                 const real *scale, int32_t l)
{
    const real *each = threshold->unit_lanes;
    vec m = (each ? load(each + l) : splat(R(threshold->unit))) * load(moment + l);
    if (scale)
        m *= load(scale + l);
    return m;
}

/* The lanes that lack the certificate: their moments once more, and their corrections anew. */
static void decompose_lanes(int32_t width, const struct sphgi_threshold *threshold,
                            const void *moments, const void *scales, void *corrections,
                            void *lambda_min, struct sphgi_verdict *verdict)
{
    const real *scale = scales;
    real *correction = corrections;
    const int numbers = threshold->dimension == 3 ? 6 : 3;
    real m[6 * SPHGI_WIDTH], c[6 * SPHGI_WIDTH];
    for (int k = 0; k < numbers * SPHGI_WIDTH; k += SPHGI_WIDTH)
        for (int32_t l = 0; l < width; l += LANES)
            store(m + k + l, scaled_moment(threshold, (const real *)moments + k, scale, l));
    decompose_open(threshold, m, verdict->decomposed, 1, c, lambda_min, verdict);
    for (uint32_t open = verdict->decomposed; open; open &= open - 1)
        for (int k = 0, l = __builtin_ctz(open); k < numbers; ++k)
            correction[k * SPHGI_WIDTH + l] = (scale ? scale[l] : R(1)) * c[k * SPHGI_WIDTH + l];
}

SPHGI_TEMPLATE void invert_as(int32_t width, const struct sphgi_threshold *threshold,
                              const real *moments, const real *scale, real *correction,
                              real *lambda_min, struct sphgi_verdict *verdict, bool three)
{
    const int numbers = three ? 6 : 3;
    const real eps_high = highest_touched(threshold);
    vec largest = splat(R(0));
    for (int32_t l = 0; l < width; l += LANES) {
        vec m[6], c[6], square;
        for (int k = 0; k < numbers; ++k)
            m[k] = scaled_moment(threshold, moments + k * SPHGI_WIDTH, scale, l);
        const mask passed = certified_inverse(m, eps_high, three, c, &square);
        const mask counts = first_lanes(verdict->count - l);
        verdict->decomposed |= bits_of(~passed & counts) << l;
        largest = vmax(where(passed & counts, square), largest);
        vec factor = splat(R(1));
        if (scale)
            factor = load(scale + l);
        for (int k = 0; k < numbers; ++k)
            store(correction + k * SPHGI_WIDTH + l, factor * c[k]);
        if (lambda_min)
            store(lambda_min + l, R(1) / vsqrt(square));
    }
    verdict->largest_square = largest_of(largest);
}

static void invert(int32_t width, const struct sphgi_threshold *threshold, const void *moments,
                   const void *scale, void *correction, void *lambda_min,
                   struct sphgi_verdict *verdict)
{
    verdict->decomposed = verdict->empty = 0;
    if (threshold->dimension == 3 && !scale)
        invert_as(width, threshold, moments, NULL, correction, lambda_min, verdict, true);
    else if (threshold->dimension == 3)
        invert_as(width, threshold, moments, scale, correction, lambda_min, verdict, true);
    else
        invert_as(width, threshold, moments, scale, correction, lambda_min, verdict, false);
}
