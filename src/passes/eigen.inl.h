/* Eigenvalues and eigenvectors of symmetric matrices, one matrix a lane, in double: cyclic Jacobi
 * with a fixed number of sweeps. Four leave |off-diagonal| / |A| <= 6e-16, the fifth is margin
 * (measured over 4e6 random, graded and clustered matrices; three leave 2e-5). No closed form:
 * Cardano's loses all digits exactly on near-identity matrices, the common case. */

enum { SWEEPS = 5 };

#define DLANES ((int)(VECTOR_BYTES / 8))
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

SPHGI_TEMPLATE dvec dabs(dvec v)
{
    return (dvec)((dmask)v & ~(dmask)dsplat(-0.0));
}

/* A = Q diag(l) Q^T; q[3 row + column]. In 2D the third row and column stay out of it. */
struct eigen {
    dvec l[3], q[9];
};

/* Annihilates a[p][q]; o is the third index. a: the upper triangle as a full symmetric 3 x 3. */
SPHGI_TEMPLATE void rotate(dvec a[3][3], dvec q[9], int p, int r, int o, int n)
{
    const dvec apr = a[p][r];
    const dvec theta = 0.5 * (a[r][r] - a[p][p]) / apr;
    const dvec root = dabs(theta) + dsqrt(theta * theta + 1);
    const dvec sign = dselect(theta < 0, dsplat(-1), dsplat(1));
    const dvec t = dselect(apr == 0, dsplat(0), sign / root);
    const dvec c = 1 / dsqrt(t * t + 1), s = t * c, tau = s / (1 + c);
    a[p][p] -= t * apr;
    a[r][r] += t * apr;
    a[p][r] = a[r][p] = dsplat(0);
    if (n == 3) {
        const dvec aop = a[o][p], aor = a[o][r];
        a[o][p] = a[p][o] = aop - s * (aor + tau * aop);
        a[o][r] = a[r][o] = aor + s * (aop - tau * aor);
    }
    for (int k = 0; k < n; ++k) {
        const dvec kp = q[3 * k + p], kr = q[3 * k + r];
        q[3 * k + p] = kp - s * (kr + tau * kp);
        q[3 * k + r] = kr + s * (kp - tau * kr);
    }
}

SPHGI_TEMPLATE struct eigen decompose(const dvec *m, bool three)
{
    struct eigen e;
    const dvec zero = dsplat(0);
    dvec a[3][3] = {{m[0], m[1], three ? m[2] : zero},
                    {m[1], three ? m[3] : m[2], three ? m[4] : zero},
                    {three ? m[2] : zero, three ? m[4] : zero, three ? m[5] : zero}};
    for (int k = 0; k < 9; ++k)
        e.q[k] = dsplat(k % 4 == 0);
    for (int sweep = 0; sweep < (three ? SWEEPS : 1); ++sweep) {
        rotate(a, e.q, 0, 1, 2, three ? 3 : 2);
        if (three) {
            rotate(a, e.q, 0, 2, 1, 3);
            rotate(a, e.q, 1, 2, 0, 3);
        }
    }
    for (int k = 0; k < 3; ++k)
        e.l[k] = a[k][k];
    return e;
}

SPHGI_TEMPLATE dvec widened(const real *from)
{
    dvec v;
    for (int k = 0; k < DLANES; ++k)
        v[k] = (double)from[k];
    return v;
}

SPHGI_TEMPLATE void narrowed(real *to, dvec v)
{
    for (int k = 0; k < DLANES; ++k)
        to[k] = (real)v[k];
}

/* Vectors [row][column][matrix]. Neither sorted nor scaled. */
static void eigen_lanes(int32_t width, int32_t dimension, const void *matrices, void *values,
                        void *vectors)
{
    const bool three = dimension == 3;
    const int32_t d = dimension, numbers = d * (d + 1) / 2;
    for (int32_t l = 0; l < width; l += DLANES) {
        dvec m[6];
        for (int32_t c = 0; c < numbers; ++c)
            m[c] = widened((const real *)matrices + c * SPHGI_WIDTH + l);
        const struct eigen e = three ? decompose(m, true) : decompose(m, false);
        for (int32_t a = 0; a < d; ++a) {
            narrowed((real *)values + a * SPHGI_WIDTH + l, e.l[a]);
            for (int32_t b = 0; b < d; ++b)
                narrowed((real *)vectors + (a * d + b) * SPHGI_WIDTH + l, e.q[3 * a + b]);
        }
    }
}
