/* SPDX-License-Identifier: MIT */
/* From moments to corrections (theory.md, section 3), one target a lane. Healthy matrices are
 * inverted by LDL^T under a certificate; lanes that lack it are decomposed. */

/* How much of a direction is corrected. */
SPHGI_TEMPLATE dvec share_kept(dvec lambda, dvec eps)
{
    dvec t = (lambda - eps) / (3 * eps);
    t = dselect(t < 0, dsplat(0), t);
    t = dselect(t > 1, dsplat(1), t);
    return t * t * dminus(dsplat(3), dsplat(2), t);
}

/* What the threshold makes of one eigenvalue. low: what a dropped direction gets (linearised: 1,
 * "uncorrected"; classic: 0). */
SPHGI_TEMPLATE dvec filtered(dvec lambda, dvec eps, sphg_policy policy, double low, dmask *full,
                             dvec *kept)
{
    const dvec inverse = 1 / lambda;
    if (policy == SPHG_BLEND) {
        const dvec w = share_kept(lambda, eps);
        *full = lambda >= 4 * eps;
        *kept *= dselect(*full, dsplat(1), w);
        const dvec blended = dplus(w * inverse, 1 - w, dsplat(low));
        const dvec above = dselect(*full, inverse, blended);
        return dselect(lambda <= eps, dsplat(low), above);
    }
    *full = lambda > eps;
    *kept *= dselect(*full, dsplat(1), dsplat(0));
    return dselect(lambda <= eps, dsplat(policy == SPHG_TRUNCATE ? 0 : low), inverse);
}

struct corrected {
    dvec c[6], lambda_min, rank, kept;
};

/* What the threshold leaves of A = Q diag(l) Q^T. Where volumes span many orders, rounding of a
 * large trace makes the smallest eigenvalue negative; the smallest moment is then 0. */
SPHGI_TEMPLATE struct corrected correct(const struct sphgi_threshold *threshold, const dvec *m,
                                        const struct eigen *e, double low, bool three)
{
    const int d = three ? 3 : 2;
    const dvec trace = three ? m[0] + m[3] + m[5] : m[0] + m[2];
    const dvec floor = 16 * UNIT_ROUNDOFF * trace;
    const dvec given = dsplat(threshold->eps), eps = dselect(floor > given, floor, given);
    struct corrected out = {.lambda_min = e->l[0], .rank = dsplat(0), .kept = dsplat(1)};
    dvec f[3];
    dmask all = (dmask)dsplat(0) == 0;
    for (int k = 0; k < d; ++k) {
        dmask full;
        f[k] = filtered(e->l[k], eps, threshold->policy, low, &full, &out.kept);
        all &= full;
        out.rank += dselect(full, dsplat(1), dsplat(0));
        out.lambda_min = smaller(out.lambda_min, e->l[k]);
    }
    if (threshold->policy == SPHG_IDENTITY) {
        const dmask drop = out.lambda_min <= eps;
        for (int k = 0; k < d; ++k)
            f[k] = dselect(drop, dsplat(low), f[k]);
        out.rank = dselect(all, out.rank, dsplat(0));
    }
    out.lambda_min = dselect(out.lambda_min <= 0, dsplat(0), out.lambda_min);
    for (int a = 0, c = 0; a < d; ++a)
        for (int b = a; b < d; ++b, ++c) {
            const dvec *qa = e->q + 3 * a, *qb = e->q + 3 * b;
            out.c[c] = dplus(qa[0] * f[0] * qb[0], qa[1] * f[1], qb[1]);
            if (three)
                out.c[c] = dplus(out.c[c], qa[2] * f[2], qb[2]);
        }
    return out;
}

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

/* Inverse of the lanes of one vector, l the first of them; gives |A^-1|_F^2 where it is certain. */
SPHGI_TEMPLATE vec classic_inverse(const struct sphgi_threshold *threshold, const vec *m, int32_t l,
                                   vec *c, real *lambda_min, struct sphgi_verdict *verdict,
                                   bool three)
{
    const int numbers = three ? 6 : 3;
    vec square;
    const mask passed = certified_inverse(m, highest_touched(threshold), three, c, &square);
    const mask counts = first_lanes(verdict->count - l);
    const uint32_t open = bits_of(~passed & counts) << l, empty = verdict->empty;
    if (lambda_min)
        store(lambda_min + l, R(1) / vsqrt(square));
    verdict->decomposed |= open;
    if (__builtin_expect(open != 0, 0)) {
        real in[6 * SPHGI_WIDTH], out[6 * SPHGI_WIDTH];
        for (int k = 0; k < numbers; ++k) {
            store(in + k * SPHGI_WIDTH + l, m[k]);
            store(out + k * SPHGI_WIDTH + l, c[k]);
        }
        decompose_open(threshold, in, open, 0, out, lambda_min, verdict);
        for (int k = 0; k < numbers; ++k)
            c[k] = load(out + k * SPHGI_WIDTH + l);
        verdict->empty = empty; /* a target alone has a second moment of 0 and is not empty */
    }
    return where(passed & counts, square);
}

/* What stands between the two halves of a classic correction: S0 y first, then ... */
struct classic_places {
    int32_t inverse_moments, mean, inverse_sum;
};

SPHGI_TEMPLATE struct classic_places classic_places(bool three)
{
    return three ? (struct classic_places){4, 10, 13} : (struct classic_places){3, 6, 8};
}

/* y of theory.md section 4 from the sums of sum_classic. Everything is divided by S0 = sum w first,
 * so that only the last factor can leave the range of the type; a sum so small that its inverse
 * would overflow counts as none. */
SPHGI_TEMPLATE void classic_solution_as(const struct sphgi_threshold *threshold, double mu2,
                                        int32_t l, const real *sums, const real *self, real *out,
                                        real *lambda_min, struct sphgi_verdict *verdict,
                                        vec *largest, bool three)
{
    const int d = three ? 3 : 2;
    const real *wx = sums + SPHGI_WIDTH, *wxx = wx + d * SPHGI_WIDTH;
    const struct classic_places at = classic_places(three);
    const vec s0 = load(sums) + load(self);
    const mask some = at_most(splat(REAL_IS_F64 ? R(0x1p-1000) : R(0x1p-106)), s0);
    const vec inverse = where(some, R(1) / s0), inverse_mu2 = splat(R(1 / mu2));
    vec mean[3], y0 = splat(R(1)); /* xb = - sum w x / S0 */
    vec m[6], c[6];
    for (int a = 0; a < d; ++a)
        mean[a] = -(load(wx + a * SPHGI_WIDTH) * inverse);
    for (int a = 0; a < d; ++a)
        for (int b = a; b < d; ++b) {
            const int k = sphgi_pair_index(a, b, d);
            const vec second = load(wxx + k * SPHGI_WIDTH) * inverse;
            m[k] = minus(second, mean[a], mean[b]) * inverse_mu2;
        }
    *largest = vmax(classic_inverse(threshold, m, l, c, lambda_min, verdict, three), *largest);
    for (int k = 0; k < (three ? 6 : 3); ++k) {
        c[k] *= inverse_mu2;
        store(out + (at.inverse_moments + k) * SPHGI_WIDTH, c[k]);
    }
    for (int a = 0; a < d; ++a) {
        vec y = splat(R(0));
        for (int b = 0; b < d; ++b)
            y = minus(y, c[sphgi_pair_index(a, b, d)], mean[b]);
        y0 = minus(y0, mean[a], y);
        store(out + (1 + a) * SPHGI_WIDTH, y);
        store(out + (at.mean + a) * SPHGI_WIDTH, mean[a]);
    }
    store(out, y0);
    store(out + at.inverse_sum * SPHGI_WIDTH, inverse);
    verdict->empty |= bits_of(~some & first_lanes(verdict->count - l)) << l;
}

static void solve_classic(int32_t width, const struct sphgi_threshold *threshold, double mu2,
                          const void *sums, const void *self, void *solution, void *lambda_min,
                          struct sphgi_verdict *verdict)
{
    verdict->decomposed = verdict->empty = 0;
    vec largest = splat(R(0));
    for (int32_t l = 0; l < width; l += LANES) {
        const real *in = (const real *)sums + l, *weight = (const real *)self + l;
        real *out = (real *)solution + l;
        if (threshold->dimension == 3)
            classic_solution_as(threshold, mu2, l, in, weight, out, lambda_min, verdict, &largest,
                                true);
        else
            classic_solution_as(threshold, mu2, l, in, weight, out, lambda_min, verdict, &largest,
                                false);
    }
    verdict->largest_square = largest_of(largest);
}

/* y, and z_k = A^-1 r with r = e_k - B_k y, from the sums of sum_classic_slopes. */
SPHGI_TEMPLATE void classic_as(const real *sums, real *numbers, bool three)
{
    const int d = three ? 3 : 2, pairs = three ? 6 : 3;
    const struct classic_places at = classic_places(three);
    const real *dxx = sums + d * SPHGI_WIDTH;
    const vec inverse = load(numbers + at.inverse_sum * SPHGI_WIDTH);
    const mask some = less(splat(R(0)), inverse);
    vec c[6], mean[3];
    for (int k = 0; k < pairs; ++k)
        c[k] = load(numbers + (at.inverse_moments + k) * SPHGI_WIDTH);
    for (int a = 0; a < d; ++a)
        mean[a] = load(numbers + (at.mean + a) * SPHGI_WIDTH);
    for (int a = 0; a <= d; ++a)
        store(numbers + a * SPHGI_WIDTH, where(some, load(numbers + a * SPHGI_WIDTH) * inverse));
    for (int k = 0; k < d; ++k) {
        const vec r0 = -(load(sums + k * SPHGI_WIDTH) * inverse);
        vec r[3], z0 = r0;
        for (int a = 0; a < d; ++a) {
            const vec dka = load(dxx + sphgi_pair_index(k, a, d) * SPHGI_WIDTH);
            r[a] = minus(plus(splat(R(a == k)), dka, inverse), mean[a], r0);
        }
        real *z = numbers + (k + 1) * (d + 1) * SPHGI_WIDTH;
        for (int a = 0; a < d; ++a) {
            vec za = splat(R(0));
            for (int b = 0; b < d; ++b)
                za = plus(za, c[sphgi_pair_index(a, b, d)], r[b]);
            z0 = minus(z0, mean[a], za);
            store(z + (1 + a) * SPHGI_WIDTH, where(some, za * inverse));
        }
        store(z, where(some, z0 * inverse));
    }
}

static void finish_classic(int32_t width, int32_t dimension, const void *sums, void *coefficients)
{
    for (int32_t l = 0; l < width; l += LANES)
        if (dimension == 3)
            classic_as((const real *)sums + l, (real *)coefficients + l, true);
        else
            classic_as((const real *)sums + l, (real *)coefficients + l, false);
}
