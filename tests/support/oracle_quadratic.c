/* SPDX-License-Identifier: MIT */
#include "oracle_quadratic.h"
#include "oracle_internal.h"
#include "oracle_second.h"

/* ---- The fourth moment ----------------------------------------------------------------------- */

/* Legendre's polynomial of that degree, and its derivative. */
static quad legendre(int degree, quad x, quad *slope)
{
    quad before = 1, value = x;
    for (int n = 1; n < degree; ++n) {
        quad next = ((2 * n + 1) * x * value - n * before) / (n + 1);
        before = value;
        value = next;
    }
    *slope = degree * (x * value - before) / (x * x - 1);
    return value;
}

/* int_0^1 w(q) q^power dq. Kernels are polynomials between multiples of 1/6, of degree 11 at most.
 */
static quad integral(sphg_kernel kernel, int power)
{
    enum { nodes = 10, pieces = 6 };
    quad sum = 0;
    for (int k = 0; k < nodes; ++k) {
        quad x = cos(acos(-1.) * (k + .75) / (nodes + .5)), slope;
        for (int step = 0; step < 6; ++step) {
            quad value = legendre(nodes, x, &slope);
            x -= value / slope;
        }
        legendre(nodes, x, &slope);
        quad weight = 2 / ((1 - x * x) * slope * slope);
        for (int piece = 0; piece < pieces; ++piece) {
            quad q = (piece + (1 + x) / 2) / pieces, shape[3];
            oracle_shape_of(kernel, q, shape);
            sum += weight / (2 * pieces) * shape[0] * quad_power(q, power);
        }
    }
    return sum;
}

quad oracle_mu4(sphg_kernel kernel, int dimension)
{
    static quad known[SPHG_SPIKY + 1][2];
    const quad angle = dimension == 3 ? 4 * oracle_pi() / 15 : oracle_pi() / 4;
    quad *value = &known[kernel][dimension - 2];
    if (*value == 0)
        *value = oracle_sigma(kernel, dimension) * angle * integral(kernel, dimension + 3);
    return *value;
}

/* ---- The basis ------------------------------------------------------------------------------- */

oracle_basis oracle_basis_of(const oracle_scene *scene)
{
    const sphg_scheme *scheme = &scene->scheme;
    oracle_basis made = {.d = scheme->dimension};
    for (int a = 0; a < made.d; ++a)
        for (int b = a; b < made.d; ++b, ++made.n)
            made.a[made.n] = a, made.b[made.n] = b;
    quad mu2 = oracle_mu2(scheme->kernel, made.d);
    quad m4 = scheme->method == SPHG_KGC ? mu2 : oracle_mu4(scheme->kernel, made.d) / mu2;
    made.off = 1 / quad_sqrt(m4);
    made.deviator = 1 / quad_sqrt(2 * m4);
    made.trace = 1 / quad_sqrt((made.d + 2) * m4);
    return made;
}

/* Deviator and trace of a symmetric matrix, each by its own factor. */
void oracle_whitened(const oracle_basis *of, const quad *pairs, quad *q)
{
    quad mean = 0;
    for (int k = 0; k < of->n; ++k)
        mean += of->a[k] == of->b[k] ? pairs[k] : 0;
    mean /= of->d;
    for (int k = 0; k < of->n; ++k)
        q[k] = of->a[k] == of->b[k] ? of->deviator * (pairs[k] - mean) + of->trace * mean
                                    : of->off * pairs[k];
}

void oracle_offsets_of(const oracle_point *point, const oracle_basis *of, const oracle_pair *pair,
                       quad *e, quad *q)
{
    quad products[oracle_pairs];
    for (int a = 0; a < of->d; ++a)
        e[a] = -pair->x[a] / point->support;
    for (int k = 0; k < of->n; ++k)
        products[k] = e[of->a[k]] * e[of->b[k]];
    oracle_whitened(of, products, q);
}

quad oracle_weight_unit(const oracle_point *point)
{
    const quad h = point->support;
    return h * h / point->scale;
}

/* ---- Small matrices -------------------------------------------------------------------------- */

/* Gauss and Jordan with pivots; 0 where the matrix is singular to 100 bits. */
int oracle_inverse_of(int n, oracle_block given, quad shift, oracle_block inverse)
{
    oracle_block a;
    quad largest = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            a[i][j] = given[i][j] + (i == j ? shift : 0);
            inverse[i][j] = i == j;
            largest = quad_max(largest, quad_abs(a[i][j]));
        }
    for (int c = 0; c < n; ++c) {
        int pivot = c;
        for (int i = c + 1; i < n; ++i)
            pivot = quad_abs(a[i][c]) > quad_abs(a[pivot][c]) ? i : pivot;
        if (!(quad_abs(a[pivot][c]) > largest * 0x1p-100))
            return 0;
        for (int j = 0; j < n; ++j) {
            quad held = a[c][j];
            a[c][j] = a[pivot][j], a[pivot][j] = held;
            held = inverse[c][j];
            inverse[c][j] = inverse[pivot][j], inverse[pivot][j] = held;
        }
        const quad over = 1 / a[c][c];
        for (int j = 0; j < n; ++j)
            a[c][j] *= over, inverse[c][j] *= over;
        for (int i = 0; i < n; ++i) {
            const quad factor = i == c ? 0 : a[i][c];
            for (int j = 0; j < n; ++j) {
                a[i][j] -= factor * a[c][j];
                inverse[i][j] -= factor * inverse[c][j];
            }
        }
    }
    return 1;
}

quad oracle_norm_of(int n, oracle_block a)
{
    quad sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            sum += a[i][j] * a[i][j];
    return quad_sqrt(sum);
}

/* ---- Omega ----------------------------------------------------------------------------------- */

quad oracle_smooth(quad x, quad low, quad high, quad *slope)
{
    quad t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    *slope = 6 * t * (1 - t) / (high - low);
    return t * t * (3 - 2 * t);
}

static void keep(const oracle_scene *scene, const oracle_point *point, oracle_second *second)
{
    const oracle_filter *filter = &point->filter;
    quad blur = scene->unit * point->spread / point->scale;
    second->kept = 1;
    for (int k = 0; k < filter->n; ++k) {
        quad slope = 0, share = filter->lambda[k] > filter->eps;
        if (scene->scheme.policy == SPHG_BLEND)
            share = oracle_smooth(filter->lambda[k], filter->eps, 4 * filter->eps, &slope);
        second->kept *= share;
        if (share > 0) /* omega grows from 0 like a square: its change counts where it is small */
            second->change_of_kept +=
                slope / share + 8 * blur / (filter->eps * filter->eps * share);
    }
}

/* ---- One target ------------------------------------------------------------------------------ */

typedef struct moments {
    quad third[3][oracle_pairs];
    oracle_block fourth;
    rough second_spread, third_spread, fourth_spread;
    quad trace2, trace4;
} moments;

static moments sum_moments(const oracle_basis *of, const oracle_point *point)
{
    moments sums = {.trace2 = 0};
    const quad unit = oracle_weight_unit(point);
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        quad e[3], q[oracle_pairs], w = -pair->s * unit;
        const rough spread = pair->spread * (rough)unit;
        oracle_offsets_of(point, of, pair, e, q);
        for (int m = 0; m < of->n; ++m) {
            const quad weighed = w * q[m];
            for (int a = 0; a < of->d; ++a)
                sums.third[a][m] += weighed * e[a];
            for (int l = m; l < of->n; ++l)
                sums.fourth[m][l] += weighed * q[l];
        }
        const rough r = rough_norm(e, of->d), size = rough_norm(q, of->n);
        sums.second_spread += spread * r * r;
        sums.third_spread += spread * r * size;
        sums.fourth_spread += spread * size * size;
    }
    for (int a = 0; a < of->d; ++a)
        sums.trace2 += point->moment[a][a] / point->scale;
    for (int m = 0; m < of->n; ++m)
        sums.trace4 += sums.fourth[m][m];
    for (int m = 0; m < of->n; ++m)
        for (int l = 0; l < m; ++l)
            sums.fourth[m][l] = sums.fourth[l][m];
    return sums;
}

static void eliminate(const oracle_point *point, const oracle_basis *of, moments *sums,
                      oracle_second *second)
{
    const oracle_filter *filter = &point->filter;
    quad inverse[3][3] = {{0}}, square = 0, over[3];
    for (int k = 0; k < of->d; ++k)
        over[k] = 1 / filter->lambda[k];
    for (int a = 0; a < of->d; ++a)
        for (int b = 0; b < of->d; ++b) {
            for (int k = 0; k < of->d; ++k)
                inverse[a][b] += filter->axes[a][k] * filter->axes[b][k] * over[k];
            square += inverse[a][b] * inverse[a][b];
        }
    second->inverse_norm = quad_sqrt(square);
    square = 0;
    for (int a = 0; a < of->d; ++a)
        for (int m = 0; m < of->n; ++m) {
            for (int b = 0; b < of->d; ++b)
                second->k[a][m] += inverse[a][b] * sums->third[b][m];
            square += second->k[a][m] * second->k[a][m];
        }
    second->norm_k = quad_sqrt(square);
    for (int m = 0; m < of->n; ++m)
        for (int l = 0; l < of->n; ++l) {
            second->s[m][l] = sums->fourth[m][l];
            for (int a = 0; a < of->d; ++a)
                second->s[m][l] -= sums->third[a][m] * second->k[a][l];
        }
}

quad oracle_shift_at(sphg_policy policy, quad t, quad eps)
{
    quad slope;
    if (policy != SPHG_BLEND)
        return t > eps ? 0 : 4 * eps;
    return t >= 4 * eps ? 0 : 4 * eps * (1 - oracle_smooth(t, eps, 4 * eps, &slope));
}

void oracle_solve_second(const oracle_scene *scene, const oracle_point *point,
                         oracle_second *second)
{
    const oracle_basis of = oracle_basis_of(scene);
    const sphg_policy policy = scene->scheme.policy;
    moments sums = sum_moments(&of, point);
    *second = (oracle_second){.rank = point->rank, .undecided = point->undecided};
    for (int a = 0; a < of.d; ++a)
        for (int m = 0; m < of.n; ++m)
            second->m3[a][m] = sums.third[a][m];
    second->second = sums.second_spread, second->third = sums.third_spread;
    second->trace2 = sums.trace2;
    keep(scene, point, second);
    if (!(second->kept > 0))
        return;
    eliminate(point, &of, &sums, second);
    const quad threshold = scene->scheme.threshold > 0 ? scene->scheme.threshold : 1e-2;
    const quad k = second->norm_k;
    second->eps = quad_max(threshold / 10, 16 * scene->unit * (sums.trace4 + k * k * sums.trace2));
    second->size = sums.fourth_spread + 2 * k * sums.third_spread + k * k * sums.second_spread;
    oracle_block whole;
    const int solved = oracle_inverse_of(of.n, second->s, 0, whole);
    second->t = solved ? 1 / oracle_norm_of(of.n, whole) : 0;
    second->shift = oracle_shift_at(policy, second->t, second->eps);
    const int dropped = policy == SPHG_IDENTITY && second->shift > 0;
    if (!dropped && (second->shift > 0 || !solved))
        oracle_inverse_of(of.n, second->s, second->shift, second->f);
    second->left = dropped ? 0 : of.n;
    for (int m = 0; m < of.n; ++m) {
        for (int l = 0; l < of.n && solved && !(second->shift > 0); ++l)
            second->f[m][l] = whole[m][l];
        second->left -= second->shift * second->f[m][m];
        for (int l = 0; l < of.n; ++l)
            second->f[m][l] *= second->kept;
    }
    second->left *= second->kept;
    second->norm_f = oracle_norm_of(of.n, second->f);
    second->full = second->shift == 0 && point->rank == of.d;
    const int some = (int)(double)(second->left + (quad).5);
    if (second->full)
        second->rank += of.n;
    else if (point->rank == of.d)
        second->rank += some < of.n - 1 ? some : of.n - 1;
    const quad blur = 16 * scene->unit * second->size;
    const quad limit = policy == SPHG_BLEND ? 4 * second->eps : second->eps;
    second->undecided |= policy != SPHG_BLEND && quad_abs(second->t - limit) <= blur;
}

int oracle_second_rank_is_open(const oracle_scene *scene, const oracle_point *point,
                               const oracle_second *second)
{
    const quad blur = 32 * scene->unit * second->size;
    const quad part = second->left - (int)(double)second->left;
    return oracle_rank_is_open(scene, point) ||
           (second->kept > 0 && (quad_abs(second->t - 4 * second->eps) <= blur ||
                                 quad_abs(part - (quad).5) <= blur * second->norm_f * 9));
}

/* ---- Fields
 * --------------------------------------------------------------------------------------- */

oracle_change oracle_sum_changes(const oracle_basis *of, const oracle_point *point,
                                 const oracle_field *field, int i, int component, int width)
{
    const double *targets = field->at_targets ? field->at_targets : field->at_sources;
    oracle_change sums = {.first_size = 0};
    const quad unit = oracle_weight_unit(point);
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        quad e[3], q[oracle_pairs];
        quad difference =
            (quad)field->at_sources[pair->j * width + component] - targets[i * width + component];
        oracle_offsets_of(point, of, pair, e, q);
        const quad weighed = pair->s * unit * difference;
        for (int a = 0; a < of->d; ++a)
            sums.first[a] -= weighed * e[a];
        for (int m = 0; m < of->n; ++m)
            sums.second[m] -= weighed * q[m];
        const rough size = pair->spread * (rough)unit * rough_abs(difference);
        sums.first_size += size * rough_norm(e, of->d);
        sums.second_size += size * rough_norm(q, of->n);
    }
    return sums;
}

/* h, and how far it may be off over u; y = M2^-1 b1 */
static rough solve_curvature(const oracle_basis *of, const oracle_second *second,
                             const oracle_change *sums, rough y_norm, quad *h)
{
    quad right[oracle_pairs];
    for (int m = 0; m < of->n; ++m) {
        right[m] = sums->second[m];
        for (int a = 0; a < of->d; ++a)
            right[m] -= second->k[a][m] * sums->first[a];
    }
    for (int m = 0; m < of->n; ++m) {
        h[m] = 0;
        for (int l = 0; l < of->n; ++l)
            h[m] += second->f[m][l] * right[l];
    }
    const rough size = rough_norm(h, of->n), k = (rough)second->norm_k;
    const rough of_second = (rough)second->second;
    /* The shift follows t, twice as steeply. */
    const rough wrong =
        sums->second_size + k * sums->first_size + ((rough)second->third + k * of_second) * y_norm;
    return (rough)second->norm_f * (wrong + (second->shift > 0 ? 3 : 1) * (rough)second->size *
                                                size / (rough)second->kept) +
           (rough)second->change_of_kept * of_second * size;
}

rough oracle_slope_norm(const oracle_basis *of, const oracle_point *point,
                        const oracle_change *sums)
{
    rough square = 0; /* the axes are orthonormal */
    for (int k = 0; k < of->d; ++k) {
        rough along = 0;
        for (int b = 0; b < of->d; ++b)
            along += (rough)point->filter.axes[b][k] * (rough)sums->first[b];
        along /= (rough)point->filter.lambda[k];
        square += along * along;
    }
    return sqrtl(square);
}

void oracle_hessian_of(const oracle_basis *of, const quad *h, quad over, quad *hessian)
{
    quad matrix[oracle_pairs];
    oracle_whitened(of, h, matrix);
    for (int m = 0; m < of->n; ++m)
        hessian[m] = matrix[m] * (of->a[m] == of->b[m] ? 2 : 1) * over * over;
}

void oracle_curve_component(const oracle_scene *scene, const oracle_basis *of,
                            const oracle_point *point, const oracle_second *second,
                            const oracle_change *sums, quad *g, quad *hessian, oracle_curved *found)
{
    const quad over = 1 / (quad)point->support;
    quad h[oracle_pairs] = {0};
    rough h_off = 0;
    if (second->kept > 0)
        h_off = solve_curvature(of, second, sums, oracle_slope_norm(of, point, sums), h);
    oracle_hessian_of(of, h, over, hessian);
    for (int a = 0; a < of->d; ++a) {
        g[a] = 0;
        for (int b = 0; b < of->d; ++b)
            g[a] += point->correction[a][b] * sums->first[b];
        g[a] *= point->scale;
        for (int m = 0; m < of->n; ++m)
            g[a] -= second->k[a][m] * h[m];
        g[a] *= over;
    }
    /* What the linear part contributes comes with the field's other components. */
    const rough k = (rough)second->norm_k, per = (rough)over;
    const rough off = k * h_off + (rough)second->inverse_norm *
                                      ((rough)second->third + (rough)second->second * k) *
                                      rough_norm(h, of->n);
    found->gradient_bound += scene->unit * off * per;
    found->hessian_bound += scene->unit * h_off * per * per * 2 * (rough)of->off;
}

void oracle_contract_second(const oracle_basis *of, const oracle_field *field, quad gradient[9][3],
                            oracle_curved *found)
{
    const int d = of->d;
    if (field->shape == SPHG_SCALAR || field->shape == SPHG_VECTOR)
        for (int k = 0; k < (field->shape == SPHG_SCALAR ? d : d * d); ++k)
            found->gradient[k] = gradient[k / d][k % d];
    if (field->shape == SPHG_VECTOR && d == 2)
        found->curl[0] = gradient[1][0] - gradient[0][1];
    for (int a = 0; field->shape == SPHG_VECTOR && a < d; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        found->divergence[0] += gradient[a][a];
        if (d == 3)
            found->curl[a] = gradient[c][b] - gradient[b][c];
    }
    for (int a = 0; field->shape >= SPHG_SYM_TENSOR && a < d; ++a)
        for (int b = 0; b < d; ++b) {
            int component = a * d + b;
            for (int m = 0; field->shape == SPHG_SYM_TENSOR && m < of->n; ++m)
                if ((of->a[m] == a && of->b[m] == b) || (of->a[m] == b && of->b[m] == a))
                    component = m;
            found->divergence[a] += gradient[component][b];
        }
}

oracle_curved oracle_apply_second(oracle *reference, const oracle_field *field, int i)
{
    const oracle_scene *scene = oracle_scene_of(reference);
    const oracle_point *point = oracle_at(reference, i);
    const oracle_basis of = oracle_basis_of(scene);
    const int d = of.d, widths[] = {0, 1, d, of.n, d * d}, width = widths[field->shape];
    const oracle_second second = *oracle_second_at(reference, i);
    const oracle_result linear = oracle_apply(reference, field, i);
    oracle_curved found = {.undecided = second.undecided, .touched = !second.full};
    quad gradient[9][3], hessian[oracle_pairs];
    for (int c = 0; c < width; ++c) {
        const oracle_change sums = oracle_sum_changes(&of, point, field, i, c, width);
        oracle_curve_component(scene, &of, point, &second, &sums, gradient[c], hessian, &found);
        for (int m = 0; m < of.n; ++m) {
            if (field->shape < SPHG_SYM_TENSOR)
                found.hessian[c * of.n + m] = hessian[m];
            found.laplacian[c] += of.a[m] == of.b[m] ? hessian[m] : 0;
        }
    }
    found.gradient_bound += linear.bound;
    oracle_contract_second(&of, field, gradient, &found);
    return found;
}
