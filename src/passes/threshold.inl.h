/* SPDX-License-Identifier: MIT */
/* What the threshold makes of the eigenvalues of a moment matrix (theory.md, sections 3 and 9). */

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
