/* SPDX-License-Identifier: MIT */
/* The second block of order 2 (theory.md, section 9): from moments of second, third and fourth
 * order to the correction. One target a lane. */

enum { PAIRS_MOST = 6 };

/* Index of the product of two pairs among the sums of fourth order. */
SPHGI_TEMPLATE int fourth_index(int k, int l, bool three)
{
    static const int of_three[6][6] = {{0, 1, 2, 3, 4, 5},    {1, 3, 4, 6, 7, 8},
                                       {2, 4, 5, 7, 8, 9},    {3, 6, 7, 10, 11, 12},
                                       {4, 7, 8, 11, 12, 13}, {5, 8, 9, 12, 13, 14}};
    return three ? of_three[k][l] : k + l;
}

/* The axes of pair number k. */
SPHGI_TEMPLATE void axes_of(int k, bool three, int *a, int *b)
{
    static const int of_three[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
    static const int of_two[3][2] = {{0, 0}, {0, 1}, {1, 1}};
    *a = three ? of_three[k][0] : of_two[k][0];
    *b = three ? of_three[k][1] : of_two[k][1];
}

SPHGI_TEMPLATE bool is_square(int k, bool three)
{
    int a, b;
    axes_of(k, three, &a, &b);
    return a == b;
}

/* v, numbers of the pairs x_a x_b, in the basis in which a full neighbourhood has the unit matrix.
 * squares: what those of x_a x_a are multiplied with before. */
SPHGI_TEMPLATE void whiten(const struct sphgi_second *second, real squares, vec *v, bool three)
{
    const int n = three ? 6 : 3;
    const vec off = splat(R(second->off)), diagonal = splat(R(second->diagonal) * squares);
    vec trace = splat(R(0));
    for (int k = 0; k < n; ++k)
        if (is_square(k, three))
            trace += v[k];
    trace *= splat(R(second->trace) * squares);
    for (int k = 0; k < n; ++k)
        if (is_square(k, three))
            v[k] = plus(trace, diagonal, v[k]);
        else
            v[k] *= off;
}

/* ---- Symmetric matrices of the pairs: [k][l], the lower half counts -------------------------- */

/* A = L D L^T, solved for one unit vector after the other: only so the bound of the certificate
 * holds (theory.md, section 9). Gives the lanes whose pivots are all positive. */
SPHGI_TEMPLATE mask inverse_by_columns(vec a[PAIRS_MOST][PAIRS_MOST], vec shift,
                                       vec x[PAIRS_MOST][PAIRS_MOST], bool three)
{
    const int n = three ? 6 : 3;
    vec l[PAIRS_MOST][PAIRS_MOST], pivot[PAIRS_MOST], inverse[PAIRS_MOST];
    mask positive = first_lanes(LANES);
    for (int j = 0; j < n; ++j) {
        pivot[j] = a[j][j] + shift;
        for (int k = 0; k < j; ++k)
            pivot[j] = minus(pivot[j], l[j][k] * l[j][k], pivot[k]);
        positive &= less(splat(R(0)), pivot[j]);
        inverse[j] = R(1) / pivot[j];
        for (int i = j + 1; i < n; ++i) {
            vec t = a[i][j];
            for (int k = 0; k < j; ++k)
                t = minus(t, l[i][k] * l[j][k], pivot[k]);
            l[i][j] = t * inverse[j];
        }
    }
    for (int c = 0; c < n; ++c) {
        vec y[PAIRS_MOST];
        y[c] = splat(R(1));
        for (int i = c + 1; i < n; ++i) {
            y[i] = -l[i][c];
            for (int k = c + 1; k < i; ++k)
                y[i] = minus(y[i], l[i][k], y[k]);
        }
        for (int i = n - 1; i >= c; --i) {
            vec t = y[i] * inverse[i];
            for (int k = i + 1; k < n; ++k)
                t = minus(t, l[k][i], x[k][c]);
            x[i][c] = t;
        }
    }
    return positive;
}

SPHGI_TEMPLATE vec trace_of(vec a[PAIRS_MOST][PAIRS_MOST], int n)
{
    vec sum = a[0][0];
    for (int k = 1; k < n; ++k)
        sum += a[k][k];
    return sum;
}

SPHGI_TEMPLATE vec frobenius_square(vec a[PAIRS_MOST][PAIRS_MOST], int n)
{
    vec diagonal = splat(R(0)), off = splat(R(0));
    for (int k = 0; k < n; ++k) {
        diagonal = plus(diagonal, a[k][k], a[k][k]);
        for (int l = 0; l < k; ++l)
            off = plus(off, a[k][l], a[k][l]);
    }
    return plus(diagonal, splat(R(2)), off);
}

/* ---- One vector of targets ------------------------------------------------------------------- */

struct block {
    vec k[3][PAIRS_MOST];          /* K = M2^-1 M3 */
    vec s[PAIRS_MOST][PAIRS_MOST]; /* S = M4 - M3^T K */
    vec trace2, trace4;
};

/* M2 K = M3 by L D L^T. Not by the inverse: K multiplies sums as large as M2, and where volumes are
 * uneven only the residual of a solution is as small as they need it. */
SPHGI_TEMPLATE void solve_for_pairs(const vec *m2, vec m3[3][PAIRS_MOST], vec k[3][PAIRS_MOST],
                                    bool three)
{
    const int n = three ? 6 : 3;
    const vec i0 = R(1) / m2[0], l1 = m2[1] * i0, none = splat(R(0));
    const vec d1 = minus(m2[three ? 3 : 2], l1, m2[1]), i1 = R(1) / d1;
    vec l2 = none, l3 = none, i2 = none;
    if (three) {
        const vec t = minus(m2[4], l1, m2[2]);
        l2 = m2[2] * i0;
        l3 = t * i1;
        i2 = R(1) / minus(minus(m2[5], l2, m2[2]), l3, t);
    }
    for (int c = 0; c < n; ++c) {
        const vec y0 = m3[0][c], y1 = minus(m3[1][c], l1, y0);
        k[0][c] = y0 * i0;
        k[1][c] = y1 * i1;
        if (three) {
            k[2][c] = minus(minus(m3[2][c], l2, y0), l3, y1) * i2;
            k[1][c] = minus(k[1][c], l3, k[2][c]);
        }
        k[0][c] = minus(k[0][c], l1, k[1][c]);
        if (three)
            k[0][c] = minus(k[0][c], l2, k[2][c]);
    }
}

/* Index of x_a x_b x_c among the moments of third order. */
SPHGI_TEMPLATE int triple_index(int a, int b, int c, int d)
{
    static const int three[27] = {0, 1, 2, 1, 3, 4, 2, 4, 5, 1, 3, 4, 3, 6,
                                  7, 4, 7, 8, 2, 4, 5, 4, 7, 8, 5, 8, 9};
    return d == 3 ? three[9 * a + 3 * b + c] : a + b + c;
}

SPHGI_TEMPLATE void eliminate(const struct sphgi_second *second, const real *sums, vec factor,
                              struct block *b, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    const real *third = sums + n * SPHGI_WIDTH, *fourth = third + (three ? 10 : 4) * SPHGI_WIDTH;
    vec m2[6], m3[3][PAIRS_MOST];
    for (int k = 0; k < n; ++k)
        m2[k] = factor * load(sums + k * SPHGI_WIDTH);
    b->trace2 = three ? m2[0] + m2[3] + m2[5] : m2[0] + m2[2];
    for (int a = 0; a < d; ++a) {
        for (int k = 0; k < n; ++k) {
            int p, q;
            axes_of(k, three, &p, &q);
            m3[a][k] = factor * load(third + triple_index(a, p, q, d) * SPHGI_WIDTH);
        }
        whiten(second, R(1), m3[a], three);
    }
    vec m4[15], s[PAIRS_MOST][PAIRS_MOST];
    for (int k = 0; k < (three ? 15 : 5); ++k)
        m4[k] = factor * load(fourth + k * SPHGI_WIDTH);
    UNROLLED
    for (int k = 0; k < n; ++k) {
        UNROLLED
        for (int l = 0; l < n; ++l)
            s[k][l] = m4[fourth_index(k, l, three)];
        whiten(second, R(1), s[k], three);
    }
    UNROLLED
    for (int l = 0; l < n; ++l) {
        vec column[PAIRS_MOST];
        UNROLLED
        for (int k = 0; k < n; ++k)
            column[k] = s[k][l];
        whiten(second, R(1), column, three);
        UNROLLED
        for (int k = l; k < n; ++k)
            b->s[k][l] = column[k];
    }
    b->trace4 = trace_of(b->s, n);
    solve_for_pairs(m2, m3, b->k, three);
    for (int k = 0; k < n; ++k)
        for (int l = 0; l <= k; ++l)
            for (int a = 0; a < d; ++a)
                b->s[k][l] = minus(b->s[k][l], m3[a][k], b->k[a][l]);
}

/* The shift s: 0 from t = 4 eps_q on, 4 eps_q up to t = eps_q; other policies know no between. */
SPHGI_TEMPLATE vec shift_of(const struct sphgi_second *second, vec t, vec eps)
{
    const vec zero = splat(R(0)), one = splat(R(1));
    if (second->policy != SPHG_BLEND)
        return select(less(eps, t), zero, R(4) * eps);
    const vec part = vmin(vmax((t - eps) / (R(3) * eps), zero), one);
    const vec rest = minus(one, part * part, minus(splat(R(3)), splat(R(2)), part));
    return R(4) * eps * where(less(t, R(4) * eps), rest);
}

/* How far the curvature of a target is resolved. */
struct resolution {
    vec t, eps, low;     /* t; eps_q with its floor; the shift by that */
    vec beta, high;      /* of what may be borrowed; 0 where nobody asks */
    vec left;            /* tr F S */
    mask whole, dropped; /* no shift; F is 0 by policy */
};

SPHGI_TEMPLATE void measure(const struct sphgi_second *second, const struct block *b,
                            vec inverse[PAIRS_MOST][PAIRS_MOST], mask positive,
                            struct resolution *r, bool three)
{
    const int n = three ? 6 : 3;
    const vec zero = splat(R(0)), given = splat(R(second->eps));
    vec norm = zero;
    for (int a = 0; a < (three ? 3 : 2); ++a)
        for (int k = 0; k < n; ++k)
            norm = plus(norm, b->k[a][k], b->k[a][k]);
    const vec floor = R(16 * UNIT_ROUNDOFF) * plus(b->trace4, norm, b->trace2);
    r->eps = select(less(given, floor), floor, given);
    const vec square = frobenius_square(inverse, n);
    r->t = where(positive & less(zero, square), R(1) / vsqrt(square));
    r->low = shift_of(second, r->t, r->eps);
    r->dropped = second->policy == SPHG_IDENTITY ? less(zero, r->low) : first_lanes(0);
}

/* F where the shift is not 0: in few vectors, so that it stands apart. */
SPHGI_TEMPLATE void shift_block(struct block *b, vec shift, mask whole,
                                vec f[PAIRS_MOST][PAIRS_MOST], struct resolution *r, bool three)
{
    const int n = three ? 6 : 3;
    vec shifted[PAIRS_MOST][PAIRS_MOST];
    mask sound = inverse_by_columns(b->s, shift, shifted, three);
    sound &= ~r->dropped;
    for (int k = 0; k < n; ++k)
        for (int l = 0; l <= k; ++l)
            f[k][l] = select(whole, f[k][l], where(sound, shifted[k][l]));
    const vec lost = minus(splat(R(n)), shift, trace_of(shifted, n));
    r->left = select(whole, r->left, where(sound, lost));
}

/* What is resolved of the curvature: F, from the inverse of S, and how many directions that comes
 * to. positive: the lanes whose pivots were. borrows: r->beta is given, and the shift grows with
 * it. */
SPHGI_TEMPLATE vec resolve(const struct sphgi_second *second, struct block *b, vec kept,
                           vec f[PAIRS_MOST][PAIRS_MOST], mask positive, struct resolution *r,
                           bool borrows, bool three)
{
    const int n = three ? 6 : 3;
    const vec zero = splat(R(0));
    measure(second, b, f, positive, r, three);
    vec shift = r->low;
    if (borrows) {
        const vec given = splat(R(second->high));
        r->high = shift_of(second, r->t, select(less(given, r->eps), r->eps, given));
        shift = plus(shift, r->beta, r->high);
    }
    const mask whole = at_most(shift, zero), part = less(kept, splat(R(1)));
    r->left = splat(R(n)); /* tr F S / kept = n - s tr (S + s)^-1 */
    if (bits_of(~whole) & ALL)
        shift_block(b, shift, whole, f, r, three);
    if (bits_of(part) & ALL) { /* else it is 1 */
        const mask some = less(zero, kept);
        for (int k = 0; k < n; ++k)
            for (int l = 0; l <= k; ++l)
                f[k][l] = where(some, kept * f[k][l]);
    }
    for (int k = 0; k < n; ++k)
        for (int l = 0; l < k; ++l)
            f[l][k] = f[k][l];
    return select(whole & ~part, splat(R(n)), vmin(kept * r->left, splat(R(n - 1))));
}

/* R = F, in the basis of derivatives. */
SPHGI_TEMPLATE void put_rest(const struct sphgi_second *second, vec f[PAIRS_MOST][PAIRS_MOST],
                             vec factor, real *rest, bool three)
{
    const int n = three ? 6 : 3;
    for (int k = 0; k < n; ++k)
        whiten(second, R(2), f[k], three);
    for (int l = 0; l < n; ++l) {
        vec column[PAIRS_MOST];
        for (int k = 0; k < n; ++k)
            column[k] = f[k][l];
        whiten(second, R(2), column, three);
        for (int k = 0; k <= l; ++k)
            store(rest + sphgi_pair_index(k, l, n) * SPHGI_WIDTH, factor * column[k]);
    }
}

/* P = C + K F K^T, Q = -K F and, if whole, R = F: the inverse of all moments. */
SPHGI_TEMPLATE void join_blocks(const struct sphgi_second *second, const struct block *b,
                                vec f[PAIRS_MOST][PAIRS_MOST], mask some, vec factor, real *out,
                                bool whole, bool three)
{
    const int d = three ? 3 : 2, n = three ? 6 : 3;
    real *cross = out + n * SPHGI_WIDTH, *rest = cross + d * n * SPHGI_WIDTH;
    vec q[3][PAIRS_MOST];
    for (int a = 0; a < d; ++a)
        for (int k = 0; k < n; ++k) {
            vec sum = b->k[a][0] * f[0][k];
            for (int l = 1; l < n; ++l)
                sum = plus(sum, b->k[a][l], f[l][k]);
            q[a][k] = where(some, -sum);
        }
    for (int a = 0; a < d; ++a)
        for (int c = a; c < d; ++c) {
            real *p = out + sphgi_pair_index(a, c, d) * SPHGI_WIDTH;
            vec sum = splat(R(0));
            for (int k = 0; k < n; ++k)
                sum = plus(sum, q[a][k], b->k[c][k]);
            store(p, minus(load(p), factor, where(some, sum)));
        }
    for (int a = 0; a < d; ++a) {
        whiten(second, R(2), q[a], three);
        for (int k = 0; k < n; ++k)
            store(cross + (a * n + k) * SPHGI_WIDTH, factor * q[a][k]);
    }
    if (whole)
        put_rest(second, f, factor, rest, three);
}
