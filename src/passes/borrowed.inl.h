/* SPDX-License-Identifier: MIT */
/* Borrowed curvature (theory.md, section 9): who may lend, what lenders sum up to, and what it
 * makes of a target that cannot resolve its own. One target a lane. */

/* Sums of c and of c h below this are none: their quotient would not be a number. */
#define NOBODY_LENDS (REAL_IS_F64 ? R(0x1p-1000) : R(0x1p-100))

SPHGI_TEMPLATE vec smooth_step(vec x, vec low, vec high)
{
    const vec part = vmin(vmax((x - low) / (high - low), splat(R(0))), splat(R(1)));
    return part * part * minus(splat(R(3)), splat(R(2)), part);
}

/* ---- Lenders --------------------------------------------------------------------------------- */

/* c of a target: 0 unless it is exact on quadratic fields, 1 where it is so beyond doubt. */
SPHGI_TEMPLATE vec confidence_of(const struct sphgi_second *second, const real *sums, vec factor,
                                 const struct block *b, const struct resolution *r, bool three)
{
    const int n = three ? 6 : 3;
    vec m[6], inverse[6], square;
    for (int k = 0; k < n; ++k)
        m[k] = factor * load(sums + k * SPHGI_WIDTH);
    const mask sound = certified_inverse(m, R(0), three, inverse, &square);
    const vec t = where(sound, R(1) / vsqrt(square)), given = splat(R(second->high));
    const vec floor = R(16 * UNIT_ROUNDOFF) * b->trace2;
    const vec linear = select(less(given, floor), floor, given);
    return smooth_step(r->t, R(4) * r->eps, R(16) * r->eps) *
           smooth_step(t, R(4) * linear, R(8) * linear);
}

/* Whether lenders could change the result: anything is shifted, dropped or in doubt. */
SPHGI_TEMPLATE mask could_borrow(const struct resolution *r, vec kept, vec confidence)
{
    const vec zero = splat(R(0)), one = splat(R(1));
    return less(zero, r->low) | less(zero, r->high) | ~at_most(one, kept) |
           ~at_most(one, confidence);
}

/* ---- Borrowers ------------------------------------------------------------------------------- */

/* Y = beta (F (low + high) + 1 - kept), as a triangle, and C M3: h = F (..) + Y hbar,
 * g = .. - C M3 Y hbar. */
SPHGI_TEMPLATE void weigh_lenders(const struct sphgi_second *second, const real *sums,
                                  const real *linear, vec f[PAIRS_MOST][PAIRS_MOST],
                                  const struct resolution *r, vec kept, real *prior,
                                  real *transport, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    const real *third = sums + n * SPHGI_WIDTH;
    const vec one = splat(R(1)), both = r->low + r->high, none = splat(R(0));
    const mask some = less(none, kept); /* else K, and the shifts by it, are no numbers */
    const vec rest = select(r->dropped | ~some, one, one - kept);
    for (int k = 0; k < n; ++k)
        for (int l = k; l < n; ++l)
            store(prior + sphgi_pair_index(k, l, n) * SPHGI_WIDTH,
                  r->beta * (where(some, both * f[k][l]) + (k == l ? rest : none)));
    vec m3[3][PAIRS_MOST];
    for (int a = 0; a < d; ++a) {
        for (int k = 0; k < n; ++k) {
            int p, q;
            axes_of(k, three, &p, &q);
            m3[a][k] = load(third + triple_index(a, p, q, d) * SPHGI_WIDTH);
        }
        whiten(second, R(1), m3[a], three);
    }
    for (int a = 0; a < d; ++a)
        for (int k = 0; k < n; ++k) {
            vec sum = load(linear + sphgi_pair_index(a, 0, d) * SPHGI_WIDTH) * m3[0][k];
            for (int c = 1; c < d; ++c)
                sum = plus(sum, load(linear + sphgi_pair_index(a, c, d) * SPHGI_WIDTH), m3[c][k]);
            store(transport + (a * n + k) * SPHGI_WIDTH, sum);
        }
}

/* How much of what lenders offer is taken; 0 where there are none. */
SPHGI_TEMPLATE vec taken(vec lent, vec factor, real low, real high)
{
    const mask some = less(splat(NOBODY_LENDS), lent);
    return where(some, smooth_step(factor * lent, splat(low), splat(high)));
}

/* Before the block is solved: r->beta. */
SPHGI_TEMPLATE void look_for_lenders(const struct sphgi_borrowing *borrowing, int32_t l, vec factor,
                                     struct resolution *r)
{
    r->beta = splat(R(0));
    if (borrowing->lent)
        r->beta = taken(load((const real *)borrowing->lent + l), factor, R(0), R(1. / 16));
}

/* From it on. */
SPHGI_TEMPLATE void note_borrowing(const struct sphgi_second *second, const real *sums, vec factor,
                                   vec kept, const struct block *b, const struct resolution *r,
                                   vec f[PAIRS_MOST][PAIRS_MOST], int32_t l,
                                   const struct sphgi_borrowing *borrowing, bool three)
{
    vec confidence = confidence_of(second, sums, factor, b, r, three);
    const unsigned open = bits_of(could_borrow(r, kept, confidence));
    for (int k = 0; k < LANES; ++k)
        borrowing->open[l + k] = (uint8_t)(open >> k & 1);
    if (borrowing->lent) {
        const vec lent = load((const real *)borrowing->lent + l);
        weigh_lenders(second, sums, (const real *)borrowing->linear + l, f, r, kept,
                      (real *)borrowing->prior + l, (real *)borrowing->transport + l, three);
        confidence =
            plus(confidence, splat(R(1)) - confidence, taken(lent, factor, R(1. / 16), R(1. / 4)));
    }
    store((real *)borrowing->confidence + l, confidence);
}

/* ---- Sums and results ------------------------------------------------------------------------ */

/* sum w times what sources lend: c, c hess A .. */
static void sum_lent(const struct sphgi_tile *tile, const void *rows, int32_t count, void *sums)
{
    vec sum[4];
    clear(sum, 4);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const struct four row = gather_rows(rows, ids_at(tile, k));
        const vec s = from(tile, SPHGI_S, k);
        sum[0] = minus(sum[0], row.x, s);
        sum[1] = minus(sum[1], row.y, s);
        sum[2] = minus(sum[2], row.z, s);
        sum[3] = minus(sum[3], row.w, s);
    }
    end_tile(tile, sum, count, sums);
}

/* From the basis in which a full neighbourhood has the unit matrix. */
SPHGI_TEMPLATE struct sphgi_second inverse_whitening(const struct sphgi_second *second, bool three)
{
    const int d = three ? 3 : 2;
    const double deviator = second->diagonal, whole = deviator + d * second->trace;
    return (struct sphgi_second){
        .off = 1 / second->off, .diagonal = 1 / deviator, .trace = (1 / whole - 1 / deviator) / d};
}

SPHGI_TEMPLATE void add_borrowed_as(int32_t count, const struct sphgi_second *second,
                                    const struct sphgi_borrowing *borrowing, int32_t l, real scale,
                                    real *j, real *h, real *trace, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    const struct sphgi_second back = inverse_whitening(second, three);
    const real *lent = (const real *)borrowing->lent + l;
    const real *prior = (const real *)borrowing->prior + l;
    const real *transport = (const real *)borrowing->transport + l;
    const vec den = load(lent);
    const mask some = less(splat(NOBODY_LENDS), den);
    const vec over = where(some, R(1) / den), unit = splat(R(1) / scale);
    for (int32_t i = 0; i < count; ++i) {
        vec mean[PAIRS_MOST], y[PAIRS_MOST], squares = splat(R(0));
        for (int k = 0; k < n; ++k)
            mean[k] = load(lent + (1 + i * n + k) * SPHGI_WIDTH) * over * unit * unit;
        whiten(&back, R(.5), mean, three);
        for (int k = 0; k < n; ++k) {
            y[k] = load(prior + sphgi_pair_index(k, 0, n) * SPHGI_WIDTH) * mean[0];
            for (int p = 1; p < n; ++p)
                y[k] = plus(y[k], load(prior + sphgi_pair_index(k, p, n) * SPHGI_WIDTH), mean[p]);
        }
        for (int a = 0; a < d; ++a) {
            real *to = j + (i * d + a) * SPHGI_WIDTH;
            vec sum = load(transport + a * n * SPHGI_WIDTH) * y[0];
            for (int k = 1; k < n; ++k)
                sum = plus(sum, load(transport + (a * n + k) * SPHGI_WIDTH), y[k]);
            store(to, select(some, minus(load(to), splat(scale), sum), load(to)));
        }
        whiten(second, R(2), y, three);
        for (int k = 0; k < n; ++k) {
            real *to = h + (i * n + k) * SPHGI_WIDTH;
            const vec own = load(to), more = plus(own, splat(scale * scale), y[k]);
            const vec sum = select(some, more, own);
            store(to, sum);
            if (is_square(k, three))
                squares += sum;
        }
        store(trace + i * SPHGI_WIDTH, squares);
    }
}

static void add_borrowed(int32_t width, int32_t dimension, int32_t count,
                         const struct sphgi_second *second, const struct sphgi_borrowing *borrowing,
                         double scale, void *jacobian, void *hessian, void *laplacian)
{
    for (int32_t l = 0; l < width; l += LANES) {
        real *j = (real *)jacobian + l, *h = (real *)hessian + l, *trace = (real *)laplacian + l;
        WITH(three, dimension == 3,
             add_borrowed_as(count, second, borrowing, l, R(scale), j, h, trace, three));
    }
}

/* c, and c times each number; who lends nothing has no numbers. */
static void lend(int32_t width, int32_t count, const void *confidence, const void *hessian,
                 void *out)
{
    for (int32_t l = 0; l < width; l += LANES) {
        const vec c = load((const real *)confidence + l);
        const mask some = less(splat(R(0)), c);
        store((real *)out + l, where(some, c));
        for (int32_t k = 0; k < count; ++k)
            store((real *)out + (k + 1) * SPHGI_WIDTH + l,
                  where(some, c * load((const real *)hessian + k * SPHGI_WIDTH + l)));
    }
}
