/* SPDX-License-Identifier: MIT */
#include "oracle_borrowed.h"
#include "oracle_internal.h"
#include "oracle_second.h"

static quad threshold_of(const oracle_scene *scene)
{
    return scene->scheme.threshold > 0 ? scene->scheme.threshold : 1e-2;
}

static quad high_of(const oracle_scene *scene, const oracle_second *second)
{
    return quad_max(threshold_of(scene), second->eps);
}

/* ---- Lenders --------------------------------------------------------------------------------- */

oracle_offer oracle_offer_of(const oracle_scene *scene, const oracle_point *point,
                             const oracle_second *second)
{
    oracle_offer offer = {.open = 1, .sure = !second->undecided && !point->undecided};
    if (!(second->kept > 0))
        return offer;
    const quad linear = quad_max(threshold_of(scene), 16 * scene->unit * second->trace2);
    const quad high = high_of(scene, second), t = 1 / second->inverse_norm;
    quad steep, steep_linear;
    const quad second_order = oracle_smooth(second->t, 4 * second->eps, 16 * second->eps, &steep);
    const quad flat = oracle_smooth(t, 4 * linear, 8 * linear, &steep_linear);
    const quad off = scene->unit * second->size, off_linear = scene->unit * second->second;
    offer.confidence = second_order * flat;
    /* A slope that vanishes grows with what moves it. */
    offer.blur = (steep + 2 * off / (second->eps * second->eps)) * off +
                 (steep_linear + 2 * off_linear / (linear * linear)) * off_linear +
                 8 * scene->unit * offer.confidence;
    const quad limit = scene->scheme.policy == SPHG_BLEND ? 4 * high : high;
    offer.open = second->t < limit || second->shift > 0 || second->kept < 1 || t < 8 * linear ||
                 second->t < 16 * second->eps;
    offer.sure = offer.sure && quad_abs(second->t - limit) > 16 * off &&
                 quad_abs(t - 8 * linear) > 16 * off_linear &&
                 quad_abs(second->t - 16 * second->eps) > 16 * off &&
                 (second->kept == 1 || 1 - second->kept > 1e-4);
    return offer;
}

/* ---- What is lent ---------------------------------------------------------------------------- */

typedef struct loan {
    quad sum, off;                                   /* sum w c */
    quad mean[oracle_pairs], mean_off[oracle_pairs]; /* of H^2 hess A, and how far it may be off */
} loan;

static loan loan_of(const oracle_point *point, int n, int component, const double *lent, int width)
{
    const quad unit = oracle_weight_unit(point), h = point->support;
    loan made = {.sum = 0};
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        const double *of = lent + (size_t)pair->j * (size_t)width,
                     *hessian = of + 1 + component * n;
        made.sum -= pair->s * unit * of[0];
        made.off += pair->spread * unit * of[0];
        for (int m = 0; m < n; ++m) {
            made.mean[m] -= pair->s * unit * hessian[m] * h * h;
            made.mean_off[m] += pair->spread * unit * quad_abs(hessian[m]) * h * h;
        }
    }
    for (int m = 0; m < n && made.sum > 0; ++m) {
        made.mean[m] /= made.sum;
        made.mean_off[m] = (made.mean_off[m] + quad_abs(made.mean[m]) * made.off) / made.sum;
    }
    return made;
}

quad oracle_confidence_lent(const oracle_point *point, quad own, const double *lent, int width)
{
    quad slope;
    const loan made = loan_of(point, 0, 0, lent, width);
    return own + (1 - own) * oracle_smooth(made.sum, (quad).0625, (quad).25, &slope);
}

/* From second derivatives to the basis of the moments. */
static void unwhitened(const oracle_basis *of, const quad *hessian, quad *h)
{
    quad mean = 0;
    for (int m = 0; m < of->n; ++m)
        mean += of->a[m] == of->b[m] ? hessian[m] / 2 / of->d : 0;
    for (int m = 0; m < of->n; ++m)
        h[m] = of->a[m] == of->b[m] ? (hessian[m] / 2 - mean) / of->deviator + mean / of->trace
                                    : hessian[m] / of->off;
}

/* ---- Borrowers ------------------------------------------------------------------------------- */

typedef struct borrower {
    quad beta, beta_off; /* over u */
    quad both, high;     /* low + high */
    quad rest;           /* 1 - omega, or 1 where everything was dropped */
    oracle_block f;
    quad norm_f, transport[3][oracle_pairs], norm_transport, transport_off;
} borrower;

static borrower borrower_of(const oracle_scene *scene, const oracle_basis *of,
                            const oracle_point *point, oracle_second *second, const loan *made)
{
    const sphg_policy policy = scene->scheme.policy;
    borrower b = {.rest = 1 - second->kept};
    quad slope, square = 0, c_square = 0;
    b.beta = oracle_smooth(made->sum, 0, (quad).0625, &slope);
    b.beta_off = (slope + 1) * made->off;
    for (int a = 0; a < of->d; ++a)
        for (int m = 0; m < of->n; ++m) {
            for (int c = 0; c < of->d; ++c)
                b.transport[a][m] += point->correction[a][c] * point->scale * second->m3[c][m];
            square += b.transport[a][m] * b.transport[a][m];
        }
    b.norm_transport = quad_sqrt(square);
    for (int a = 0; a < of->d; ++a)
        for (int c = 0; c < of->d; ++c)
            c_square += point->correction[a][c] * point->correction[a][c];
    quad third = 0;
    for (int a = 0; a < of->d; ++a)
        for (int m = 0; m < of->n; ++m)
            third += second->m3[a][m] * second->m3[a][m];
    b.transport_off = point->scale * (quad_sqrt(c_square) * second->third +
                                      point->correction_bound * quad_sqrt(third));
    if (!(second->kept > 0))
        return b;
    b.high = oracle_shift_at(policy, second->t, high_of(scene, second));
    b.both = second->shift + b.high;
    if (policy == SPHG_IDENTITY && second->shift > 0) {
        b.rest = 1;
        return b;
    }
    oracle_inverse_of(of->n, second->s, second->shift + b.beta * b.high, b.f);
    for (int m = 0; m < of->n; ++m)
        for (int l = 0; l < of->n; ++l)
            b.f[m][l] *= second->kept;
    b.norm_f = oracle_norm_of(of->n, b.f);
    return b;
}

typedef struct curvature {
    quad own[oracle_pairs], borrowed[oracle_pairs], own_off, borrowed_off; /* off over u */
} curvature;

static curvature curve(const oracle_basis *of, const oracle_second *second, const borrower *b,
                       const oracle_change *sums, const loan *made, quad y_norm)
{
    curvature h = {.own_off = 0};
    quad right[oracle_pairs], mean[oracle_pairs], blurred[oracle_pairs];
    unwhitened(of, made->mean, mean);
    unwhitened(of, made->mean_off, blurred);
    for (int m = 0; m < of->n; ++m) {
        right[m] = sums->second[m];
        for (int a = 0; a < of->d; ++a)
            right[m] -= second->k[a][m] * sums->first[a];
    }
    for (int m = 0; m < of->n; ++m) {
        h.borrowed[m] = b->beta * b->rest * mean[m];
        for (int l = 0; l < of->n; ++l) {
            h.own[m] += b->f[m][l] * right[l];
            h.borrowed[m] += b->beta * b->f[m][l] * b->both * mean[l];
        }
    }
    const quad k = second->norm_k, own = quad_norm(h.own, of->n), lent = quad_norm(mean, of->n);
    const quad kept = second->kept > 0 ? second->kept : 1;
    const quad wrong =
        sums->second_size + k * sums->first_size + (second->third + k * second->second) * y_norm;
    /* Both shifts follow t, twice as steeply, and the higher one follows beta. */
    const quad shaken = second->size * (b->both > 0 ? 5 : 1) + b->high * b->beta_off;
    const quad share = b->both * b->norm_f + b->rest;
    h.own_off =
        b->norm_f * (wrong + shaken * own / kept) + second->change_of_kept * second->second * own;
    h.borrowed_off = b->beta * (share * quad_norm(blurred, of->n) +
                                b->norm_f * shaken * (1 + b->both * b->norm_f / kept) * lent +
                                second->change_of_kept * second->second * (share + 1) * lent) +
                     b->beta_off * share * lent;
    return h;
}

static void borrow_component(const oracle_scene *scene, const oracle_basis *of,
                             const oracle_point *point, oracle_second *second,
                             const oracle_change *sums, const loan *made, quad *g, quad *hessian,
                             oracle_curved *found)
{
    const quad over = 1 / (quad)point->support;
    const borrower b = borrower_of(scene, of, point, second, made);
    const quad slope = second->kept > 0 ? oracle_slope_norm(of, point, sums) : 0;
    const curvature h = curve(of, second, &b, sums, made, slope);
    quad all[oracle_pairs];
    for (int m = 0; m < of->n; ++m)
        all[m] = h.own[m] + h.borrowed[m];
    oracle_hessian_of(of, all, over, hessian);
    for (int a = 0; a < of->d; ++a) {
        g[a] = 0;
        for (int c = 0; c < of->d; ++c)
            g[a] += point->correction[a][c] * point->scale * sums->first[c];
        for (int m = 0; m < of->n; ++m)
            g[a] -= second->k[a][m] * h.own[m] + b.transport[a][m] * h.borrowed[m];
        g[a] *= over;
    }
    const quad off = second->norm_k * h.own_off +
                     second->inverse_norm * (second->third + second->second * second->norm_k) *
                         quad_norm(h.own, of->n) +
                     b.norm_transport * h.borrowed_off +
                     b.transport_off * quad_norm(h.borrowed, of->n);
    const quad off_twice = (h.own_off + h.borrowed_off) * over * over * 2 * of->off;
    found->gradient_bound += scene->unit * (rough)(off * over);
    found->hessian_bound += scene->unit * (rough)off_twice;
}

oracle_curved oracle_apply_borrowed(oracle *reference, const oracle_field *field,
                                    const double *lent, int i)
{
    const oracle_scene *scene = oracle_scene_of(reference);
    const oracle_point *point = oracle_at(reference, i);
    const oracle_basis of = oracle_basis_of(scene);
    const int d = of.d, widths[] = {0, 1, d, of.n, d * d}, width = widths[field->shape];
    oracle_second second = *oracle_second_at(reference, i);
    oracle_curved found = {.undecided = second.undecided || point->undecided,
                           .touched = !second.full};
    quad gradient[9][3], hessian[oracle_pairs];
    for (int c = 0; c < width; ++c) {
        const oracle_change sums = oracle_sum_changes(&of, point, field, i, c, width);
        const loan made = loan_of(point, of.n, c, lent, 1 + width * of.n);
        borrow_component(scene, &of, point, &second, &sums, &made, gradient[c], hessian, &found);
        for (int m = 0; m < of.n; ++m) {
            if (field->shape < SPHG_SYM_TENSOR)
                found.hessian[c * of.n + m] = hessian[m];
            found.laplacian[c] += of.a[m] == of.b[m] ? hessian[m] : 0;
        }
    }
    found.gradient_bound += oracle_apply(reference, field, i).bound;
    oracle_contract_second(&of, field, gradient, &found);
    return found;
}
