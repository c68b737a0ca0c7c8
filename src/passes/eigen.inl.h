/* SPDX-License-Identifier: MIT */
/* Eigenvalues and eigenvectors of symmetric matrices, one matrix a lane, in double: cyclic Jacobi.
 * No closed form: Cardano's loses all digits exactly on near-identity matrices, the common case.
 *
 * A matrix is turned as if it were alone: what its lane does depends on that lane only, and the
 * sweeps end when no lane has anything left to do. Two vectors of matrices are turned side by side
 * where one cannot fill the waits for square roots and divisions. */

#define DLANES  ((int)(VECTOR_BYTES / 8))
#define ABREAST (VECTOR_BYTES == 64 ? 1 : 2) /* vectors */

/* None of 6e6 matrices, random, near the identity, graded, clustered, of whole numbers and of rank
 * one, took more than four; three leave 6e-5 of the largest entry. */
enum { SWEEPS_MOST = 6 };

/* Below this the off-diagonal of a matrix whose largest entry is in [1, 2) is rounding. */
static const double negligible = 0x1p-54;

typedef double dvec __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef int64_t dmask __attribute__((vector_size(VECTOR_BYTES), may_alias));

SPHGI_TEMPLATE dvec dsplat(double x)
{
    return x - (dvec){0};
}

SPHGI_TEMPLATE dvec dselect(dmask m, dvec a, dvec b)
{
    return (dvec)((m & (dmask)a) | (~m & (dmask)b));
}

SPHGI_TEMPLATE dvec dwhere(dmask m, dvec a) /* a where m, else 0 */
{
    return (dvec)(m & (dmask)a);
}

SPHGI_TEMPLATE dvec dsqrt(dvec v)
{
#if defined(__SSE2__)
    return (dvec)VECTOR_OP(sqrt_pd)((VECTOR_TYPE(d))v);
#else
    for (int k = 0; k < DLANES; ++k)
        v[k] = __builtin_sqrt(v[k]);
    return v;
#endif
}

#if REAL_IS_F64
#define dplus  plus
#define dminus minus
#elif !FUSES
SPHGI_TEMPLATE dvec dplus(dvec sum, dvec a, dvec b) /* plus, in double */
{
    return sum + a * b;
}
SPHGI_TEMPLATE dvec dminus(dvec sum, dvec a, dvec b)
{
    return sum - a * b;
}
#elif defined(__FMA__)
SPHGI_TEMPLATE dvec dplus(dvec sum, dvec a, dvec b)
{
    return (dvec)VECTOR_OP(fmadd_pd)((VECTOR_TYPE(d))a, (VECTOR_TYPE(d))b, (VECTOR_TYPE(d))sum);
}
SPHGI_TEMPLATE dvec dminus(dvec sum, dvec a, dvec b)
{
    return (dvec)VECTOR_OP(fnmadd_pd)((VECTOR_TYPE(d))a, (VECTOR_TYPE(d))b, (VECTOR_TYPE(d))sum);
}
#elif defined(__aarch64__)
SPHGI_TEMPLATE dvec dplus(dvec sum, dvec a, dvec b)
{
    return (dvec)vfmaq_f64((float64x2_t)sum, (float64x2_t)a, (float64x2_t)b);
}
SPHGI_TEMPLATE dvec dminus(dvec sum, dvec a, dvec b)
{
    return (dvec)vfmsq_f64((float64x2_t)sum, (float64x2_t)a, (float64x2_t)b);
}
#else
SPHGI_TEMPLATE dvec dplus(dvec sum, dvec a, dvec b)
{
    return (dvec){__builtin_fma(a[0], b[0], sum[0]), __builtin_fma(a[1], b[1], sum[1])};
}
SPHGI_TEMPLATE dvec dminus(dvec sum, dvec a, dvec b)
{
    return dplus(sum, -a, b);
}
#endif

SPHGI_TEMPLATE dvec dabs(dvec v)
{
    return (dvec)((dmask)v & ~(dmask)dsplat(-0.0));
}

SPHGI_TEMPLATE dvec larger(dvec a, dvec b)
{
    return dselect(a < b, b, a);
}

SPHGI_TEMPLATE dvec smaller(dvec a, dvec b)
{
    return dselect(b < a, b, a);
}

SPHGI_TEMPLATE bool in_any_lane(dmask m)
{
#if defined(__AVX512DQ__)
    return _mm512_movepi64_mask((__m512i)m) != 0;
#elif defined(__SSE2__)
    return VECTOR_OP(movemask_pd)((VECTOR_TYPE(d))m) != 0;
#else
    int64_t any = 0;
    for (int k = 0; k < DLANES; ++k)
        any |= m[k];
    return any != 0;
#endif
}

/* A power of two. */
SPHGI_TEMPLATE dvec power_of_two(dmask exponent)
{
    return (dvec)((exponent + 1023) << 52);
}

/* The exponent of a positive number that is neither denormal nor infinite. */
SPHGI_TEMPLATE dmask exponent_of(dvec v)
{
    return ((dmask)v >> 52) - 1023;
}

/* A = Q diag(l) Q^T; q[3 row + column]. In 2D the third row and column stay out of it. */
struct eigen {
    dvec l[3], q[9];
};

/* A matrix on its way: a = xx yy zz, off = yz xz xy, so that off[k] stands across from a[k]. */
struct turning {
    dvec a[3], off[3], q[9];
    dvec unit[2]; /* their product times a is A: one alone may leave the range */
    dvec poison;  /* 0, or NaN if an entry is not finite */
};

/* Annihilates off[o], between p and r. With d = a_rr - a_pp, b = 2 a_pr, h = |d| + |(d, b)| and
 * g = |(h, b)|: sin = b / g, tan of half the angle = b / (h + g), of the sign of d. Rotating by
 * these two, a rounding costs sin^2 u of the columns' length; by cos = h / g always u. */
SPHGI_TEMPLATE void turn(struct turning *m, int p, int r, int o, bool three)
{
    const dmask open = dabs(m->off[o]) > negligible;
    const dvec d = m->a[r] - m->a[p], b = m->off[o] + m->off[o];
    const dvec h = dabs(d) + dsqrt(dplus(d * d, b, b)), g = dsqrt(dplus(h * h, b, b));
    const dmask sign = (dmask)d & (dmask)dsplat(-0.0);
    const dvec s = dwhere(open, (dvec)((dmask)(b / g) ^ sign));
    const dvec half = dwhere(open, (dvec)((dmask)(b / (h + g)) ^ sign));
    const dvec step = dminus(dminus(b, s * half, b), s, d);
    m->a[p] = dminus(m->a[p], s, step);
    m->a[r] = dplus(m->a[r], s, step);
    m->off[o] = dsplat(0);
    if (three) {
        const dvec to_p = m->off[r], to_r = m->off[p];
        m->off[r] = dminus(to_p, s, dplus(to_r, half, to_p));
        m->off[p] = dplus(to_r, s, dminus(to_p, half, to_r));
    }
    for (int k = 0; k < (three ? 3 : 2); ++k) {
        const dvec kp = m->q[3 * k + p], kr = m->q[3 * k + r];
        m->q[3 * k + p] = dminus(kp, s, dplus(kr, half, kp));
        m->q[3 * k + r] = dplus(kr, s, dminus(kp, half, kr));
    }
}

/* Powers of two bring the largest entry into [1, 2). */
SPHGI_TEMPLATE struct turning begin_turning(const dvec *m, bool three)
{
    struct turning out = {.poison = dsplat(0)};
    dvec largest = dsplat(0), lift = dsplat(1);
    for (int k = 0; k < (three ? 6 : 3); ++k)
        largest = larger(largest, dabs(m[k]));
    if (REAL_IS_F64) {
        lift = dselect(largest < 0x1p-500, dsplat(0x1p500), lift);
        lift = dselect(largest > 0x1p500, dsplat(0x1p-500), lift);
        largest *= lift;
    }
    const dmask exponent = (dmask)dwhere(largest > 0, (dvec)exponent_of(largest));
    const dvec scale = power_of_two(-exponent);
    dvec a[6];
    for (int k = 0; k < (three ? 6 : 3); ++k) {
        a[k] = m[k] * lift * scale;
        out.poison = dplus(out.poison, dsplat(0), a[k]);
    }
    out.a[0] = a[0];
    out.a[1] = three ? a[3] : a[2];
    out.a[2] = three ? a[5] : dsplat(0);
    out.off[0] = three ? a[4] : dsplat(0);
    out.off[1] = three ? a[2] : dsplat(0);
    out.off[2] = a[1];
    out.unit[0] = power_of_two(exponent);
    out.unit[1] = 1 / lift;
    for (int k = 0; k < 9; ++k)
        out.q[k] = dsplat(k % 4 == 0);
    return out;
}

SPHGI_TEMPLATE bool is_open(const struct turning *m)
{
    const dvec off = larger(larger(dabs(m->off[0]), dabs(m->off[1])), dabs(m->off[2]));
    return in_any_lane(off > negligible);
}

SPHGI_TEMPLATE struct eigen end_turning(const struct turning *m)
{
    struct eigen e;
    for (int k = 0; k < 3; ++k)
        e.l[k] = dplus(m->poison, m->a[k] * m->unit[0], m->unit[1]);
    for (int k = 0; k < 9; ++k)
        e.q[k] = m->q[k] + m->poison;
    return e;
}

/* m: [vector][number] */
SPHGI_TEMPLATE void decompose(dvec m[ABREAST][6], bool three, struct eigen *e)
{
    struct turning turning[ABREAST];
    bool open = false;
    for (int v = 0; v < ABREAST; ++v) {
        turning[v] = begin_turning(m[v], three);
        open |= is_open(&turning[v]);
    }
    for (int sweep = 0; open && sweep < SWEEPS_MOST; ++sweep) {
        for (int v = 0; v < ABREAST; ++v)
            turn(&turning[v], 0, 1, 2, three);
        for (int v = 0; three && v < ABREAST; ++v)
            turn(&turning[v], 0, 2, 1, true);
        for (int v = 0; three && v < ABREAST; ++v)
            turn(&turning[v], 1, 2, 0, true);
        open = false;
        for (int v = 0; v < ABREAST; ++v)
            open |= is_open(&turning[v]);
    }
    for (int v = 0; v < ABREAST; ++v)
        e[v] = end_turning(&turning[v]);
}

/* Where first < second, that exchange turns det Q over. */
SPHGI_TEMPLATE void exchange(struct eigen *e, int first, int second, int d, dvec *determinant)
{
    const dmask rises = e->l[first] < e->l[second];
    const dvec held = e->l[first];
    e->l[first] = dselect(rises, e->l[second], held);
    e->l[second] = dselect(rises, held, e->l[second]);
    for (int k = 0; k < d; ++k) {
        const dvec x = e->q[3 * k + first], y = e->q[3 * k + second];
        e->q[3 * k + first] = dselect(rises, y, x);
        e->q[3 * k + second] = dselect(rises, x, y);
    }
    *determinant = dselect(rises, -*determinant, *determinant);
}

/* Descending, and det Q = 1. */
SPHGI_TEMPLATE void sort_eigen(struct eigen *e, int d)
{
    dvec determinant = dsplat(1);
    exchange(e, 0, 1, d, &determinant);
    if (d == 3) {
        exchange(e, 1, 2, d, &determinant);
        exchange(e, 0, 1, d, &determinant);
    }
    for (int k = 0; k < d; ++k)
        e->q[3 * k + d - 1] *= determinant;
}

typedef real some_reals
    __attribute__((vector_size(DLANES * sizeof(real)), aligned(__alignof__(real)), may_alias));

SPHGI_TEMPLATE dvec widened(const real *from)
{
    return __builtin_convertvector(*(const some_reals *)from, dvec);
}

SPHGI_TEMPLATE void narrowed(real *to, dvec v)
{
    *(some_reals *)to = __builtin_convertvector(v, some_reals);
}

SPHGI_TEMPLATE void eigen_as(int32_t width, const real *matrices, real *values, real *vectors,
                             bool three)
{
    const int d = three ? 3 : 2;
    for (int32_t l = 0; l < width; l += ABREAST * DLANES) {
        dvec m[ABREAST][6];
        struct eigen e[ABREAST];
        for (int v = 0; v < ABREAST; ++v)
            for (int c = 0; c < (three ? 6 : 3); ++c)
                m[v][c] = widened(matrices + c * SPHGI_WIDTH + l + v * DLANES);
        decompose(m, three, e);
        for (int v = 0; v < ABREAST; ++v) {
            const int32_t at = l + v * DLANES;
            sort_eigen(&e[v], d);
            for (int a = 0; a < d; ++a)
                narrowed(values + a * SPHGI_WIDTH + at, e[v].l[a]);
            for (int a = 0; a < d; ++a)
                for (int b = 0; b < d; ++b)
                    narrowed(vectors + (a * d + b) * SPHGI_WIDTH + at, e[v].q[3 * a + b]);
        }
    }
}

/* Values descending; vectors [row][column][matrix]. */
static void eigen_lanes(int32_t width, int32_t dimension, const void *matrices, void *values,
                        void *vectors)
{
    WITH(three, dimension == 3, eigen_as(width, matrices, values, vectors, three));
}
