/* SPDX-License-Identifier: MIT */
/* The two halves of a classic correction (theory.md, section 4), one target a lane: y from the sums
 * of the first loop, z_k from those of the second. */

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
        WITH(three, threshold->dimension == 3,
             classic_solution_as(threshold, mu2, l, in, weight, out, lambda_min, verdict, &largest,
                                 three));
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
        WITH(three, dimension == 3,
             classic_as((const real *)sums + l, (real *)coefficients + l, three));
}
