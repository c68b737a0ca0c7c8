/* SPDX-License-Identifier: MIT */
/* One target: neighbours, moments, corrections, G_ij. */
#include "oracle.h"
#include "oracle_internal.h"

/* ---- Neighbours ----------------------------------------------------------------------------- */

/* fl(fl(x_i - x_j) + k L) with the k that makes it smallest, in the precision of the positions. */
static double shifted(double difference, double period, int single)
{
    if (period <= 0)
        return difference;
    double k = -nearbyint(difference / period), best = INFINITY;
    for (double near = k - 1; near <= k + 1; ++near) {
        double candidate = single ? (double)((float)difference + (float)(near * period))
                                  : difference + near * period;
        best = fabs(candidate) < fabs(best) ? candidate : best;
    }
    return best;
}

static int is_inside(const double *difference, int dimension, double support, int single)
{
    const double *d = difference;
    if (single) {
        float x = (float)d[0], y = (float)d[1], z = dimension == 3 ? (float)d[2] : 0;
        float square = x * x, limit = (float)support * (float)support;
        square += y * y;
        square += z * z;
        return square < limit;
    }
    double square = d[0] * d[0];
    square += d[1] * d[1];
    square += dimension == 3 ? d[2] * d[2] : 0;
    return square < support * support;
}

/* The exact x_ij that belongs to the shift chosen in working precision. */
static quad exact_difference(double a, double b, double rounded, double period)
{
    quad exact = (quad)a - b;
    if (period > 0)
        exact += nearbyint((double)((rounded - exact) / period)) * (quad)period;
    return exact;
}

static int measure(const oracle_scene *scene, const double *x, double support, int j,
                   oracle_pair *pair)
{
    int d = scene->scheme.dimension, single = scene->single_positions;
    const double *other = scene->sources + j * d;
    double difference[3] = {0};
    for (int k = 0; k < d; ++k) {
        double plain = single ? (double)((float)x[k] - (float)other[k]) : x[k] - other[k];
        difference[k] = shifted(plain, scene->period[k], single);
    }
    if (!is_inside(difference, d, support, single))
        return 0;
    for (int k = 0; k < d; ++k)
        pair->x[k] = exact_difference(x[k], other[k], difference[k], scene->period[k]);
    pair->j = j;
    pair->r = quad_norm(pair->x, d);
    return 1;
}

/* Beyond H_i a pair has no weight for the target, but it may for the source. */
static double reach_of(const oracle_scene *scene, const oracle_point *point, int j)
{
    return scene->mutual ? fmax(point->support, scene->support[j]) : point->support;
}

/* As many pairs again: most targets have a few dozen, of however many sources. */
static int make_room(oracle_point *point, int room)
{
    const int more = room ? 2 * room : 64;
    oracle_pair *pairs = oracle_memory((size_t)more * sizeof *pairs);
    for (int k = 0; k < room; ++k)
        pairs[k] = point->pairs[k];
    point->pairs = pairs;
    return more;
}

/* A listed pair whose exact distance rounds up to H carries W = W' = 0 either way. */
static void find_pairs(const oracle_scene *scene, int i, oracle_point *point)
{
    const double *x = oracle_target(scene, i);
    int room = 0;
    for (int j = 0; j < scene->source_count; ++j) {
        oracle_pair pair = {0};
        if ((point->has_self && j == i) || !measure(scene, x, reach_of(scene, point, j), j, &pair))
            continue;
        if (point->pair_count == room)
            room = make_room(point, room);
        point->pairs[point->pair_count++] = pair;
    }
}

/* ---- Weights -------------------------------------------------------------------------------- */

/* |f| + r |f'| of W and of W'/r. Within a few roundings of the rim the first order is not enough:
 * there the values a little further in count. */
static void spread_weights(const oracle_scene *scene, double support, quad r,
                           const oracle_weights *at, rough *weight, rough *slope)
{
    const sphg_scheme *scheme = &scene->scheme;
    const rough distance = (rough)r, square = distance * distance;
    oracle_weights inner = *at;
    if (r > .99 * support)
        inner = oracle_weights_at(scheme->kernel, scheme->dimension, support,
                                  r * (1 - 4 * (quad)scene->unit));
    *weight = rough_max((rough)at->w + square * rough_abs(at->slope),
                        (rough)inner.w + square * rough_abs(inner.slope));
    *slope = rough_max(rough_abs(at->slope) + distance * rough_abs(at->slope_rate),
                       rough_abs(inner.slope) + distance * rough_abs(inner.slope_rate));
}

/* The weight of a pair under the volume of its source. */
void oracle_weigh(const oracle_scene *scene, double support, quad volume, oracle_pair *pair)
{
    const sphg_scheme *scheme = &scene->scheme;
    oracle_weights at = oracle_weights_at(scheme->kernel, scheme->dimension, support, pair->r);
    int has_volume = scheme->method != SPHG_MLS && scheme->method != SPHG_CMLS;
    const quad v = has_volume ? volume : 1;
    const rough times = (rough)v;
    rough weight_spread, slope_spread;
    spread_weights(scene, support, pair->r, &at, &weight_spread, &slope_spread);
    if (oracle_is_classic(scheme->method)) {
        pair->s = v * at.w;
        pair->slope = v * at.slope;
        pair->spread = times * weight_spread;
        pair->slope_spread = times * slope_spread;
    } else if (scheme->method == SPHG_MLS || scheme->method == SPHG_RKPM) {
        pair->s = -v * at.w;
        pair->spread = times * weight_spread;
    } else {
        pair->s = v * at.slope;
        pair->spread = times * slope_spread;
    }
}

static quad mean_volume(const oracle_scene *scene, const oracle_point *point)
{
    quad sum = 0, weights = 0;
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        sum += -pair->s * scene->volume[pair->j];
        weights += -pair->s;
    }
    return weights > 0 ? sum / weights : 1;
}

/* ---- Linearised ------------------------------------------------------------------------------ */

static quad reference_moment(const oracle_scene *scene, const oracle_point *point)
{
    const sphg_scheme *scheme = &scene->scheme;
    quad h = point->support;
    quad second = oracle_mu2(scheme->kernel, scheme->dimension) * h * h;
    if (scheme->method == SPHG_RKPM)
        return second;
    if (scheme->method != SPHG_MLS)
        return 1;
    return second /
           (point->volume < 0 ? mean_volume(scene, point) : point->volume); /* may be infinite */
}

static void sum_moments(int d, oracle_point *point)
{
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        point->spread += pair->spread * (rough)pair->r * (rough)pair->r;
        for (int a = 0; a < d; ++a) {
            const quad weighed = pair->s * pair->x[a];
            for (int b = a; b < d; ++b)
                point->moment[a][b] -= weighed * pair->x[b];
        }
    }
    for (int a = 0; a < d; ++a)
        for (int b = 0; b < a; ++b)
            point->moment[a][b] = point->moment[b][a];
}

/* eps_i = max(eps, 16 u tr Mhat). */
static quad threshold(const oracle_scene *scene, int d, oracle_matrix normalised)
{
    double eps = scene->scheme.threshold > 0 ? scene->scheme.threshold : 1e-2;
    quad trace = 0;
    for (int k = 0; k < d; ++k)
        trace += normalised[k][k];
    return quad_max(eps, 16 * scene->unit * trace);
}

static void filter_moments(const oracle_scene *scene, int below, oracle_point *point)
{
    int d = scene->scheme.dimension;
    oracle_matrix normalised = {{0}};
    for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b)
            normalised[a][b] = point->moment[a][b] / point->scale;
    quad eps = threshold(scene, d, normalised);
    quad blur = 8 * scene->unit * point->spread / point->scale;
    point->filter = oracle_filtered(d, normalised, scene->scheme.policy, eps, below, blur);
    point->rank = point->filter.rank;
    oracle_recompose(&point->filter, point->correction);
    for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b)
            point->correction[a][b] /= point->scale;
    for (int k = 0; k < d; ++k)
        if (scene->scheme.policy != SPHG_BLEND && quad_abs(point->filter.lambda[k] - eps) <= blur)
            point->undecided = 1;
}

static rough largest_divided(const oracle_filter *filter, int l)
{
    rough largest = 0;
    for (int k = 0; k < filter->n; ++k)
        largest = rough_max(largest, filter->divided[k][l]);
    return largest;
}

/* (T / m^2) sum_l max_k |f[lambda_k, lambda_l]| |b_l|, for b of `width` columns. */
rough oracle_filter_error(const oracle_point *point, int width, const rough *b)
{
    const rough scale = (rough)point->scale;
    rough sum = 0;
    int d = point->filter.n;
    for (int l = 0; l < d; ++l) {
        rough square = 0;
        for (int c = 0; c < width; ++c) {
            rough along = 0;
            for (int k = 0; k < d; ++k)
                along += (rough)point->filter.axes[k][l] * b[k * width + c];
            square += along * along;
        }
        sum += largest_divided(&point->filter, l) * sqrtl(square);
    }
    return sum * point->spread / (scale * scale);
}

static void solve_linearised(const oracle_scene *scene, oracle_point *point)
{
    int d = scene->scheme.dimension;
    sum_moments(d, point);
    point->scale = reference_moment(scene, point);
    filter_moments(scene, 1, point);
    if (scene->scheme.method == SPHG_PLAIN) {
        for (int a = 0; a < d; ++a)
            for (int b = 0; b < d; ++b)
                point->correction[a][b] = a == b;
        point->filter = (oracle_filter){.n = d, .f = {1, 1, 1}};
        point->rank = d;
        point->undecided = 0;
        point->spread = 0;
    }
    for (int k = 0; k < d; ++k) {
        const rough scale = (rough)point->scale;
        point->correction_norm =
            rough_max(point->correction_norm, rough_abs(point->filter.f[k]) / scale);
        const rough error = largest_divided(&point->filter, k) * point->spread / (scale * scale);
        point->correction_bound = rough_max(point->correction_bound, error);
    }
    point->correction_bound = scene->unit * (point->correction_bound + point->correction_norm);
}

/* ---- Classic --------------------------------------------------------------------------------- */

typedef struct classic_sums {
    oracle_matrix a, b[3];
    rough a_spread[oracle_rows]; /* the diagonal */
    quad first[oracle_rows];
} classic_sums;

static void basis_of(const oracle_scene *scene, const oracle_point *point, const oracle_pair *pair,
                     quad *p)
{
    p[0] = 1;
    for (int k = 0; k < scene->scheme.dimension; ++k)
        p[k + 1] = -pair->x[k] / point->support;
}

typedef quad cube[oracle_rows][oracle_rows][oracle_rows]; /* [a][b][c] of a <= b <= c */

static quad sorted(cube sums, int a, int b, int c)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? sums[c][low][high] : c < high ? sums[low][c][high] : sums[low][high][c];
}

/* B_k holds x_k = -H p_k+1: products of three p are summed once for all that have them. */
static void sum_classic(const oracle_scene *scene, const oracle_point *point, classic_sums *sums)
{
    int d = scene->scheme.dimension;
    cube slopes = {{{0}}};
    sums->a[0][0] = point->self_weight;
    sums->a_spread[0] = (rough)point->self_weight;
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        quad p[oracle_rows];
        basis_of(scene, point, pair, p);
        for (int a = 0; a <= d; ++a) {
            sums->a_spread[a] += pair->spread * (rough)p[a] * (rough)p[a];
            for (int b = a; b <= d; ++b) {
                const quad pp = a ? p[a] * p[b] : p[b], slope = pair->slope * pp;
                sums->a[a][b] += pair->s * pp;
                for (int c = b ? b : 1; c <= d; ++c)
                    slopes[a][b][c] += slope * p[c];
            }
        }
    }
    for (int a = 0; a <= d; ++a)
        for (int b = 0; b <= d; ++b) {
            sums->a[a][b] = sums->a[a < b ? a : b][a < b ? b : a];
            for (int c = 0; c < d; ++c)
                sums->b[c][a][b] = -point->support * sorted(slopes, a, b, c + 1);
        }
}

/* M_c = sum w (xi - xb)(xi - xb)^T about the centre xb, the target itself at 0. */
static void centre_moments(const oracle_scene *scene, oracle_point *point, const quad *centre)
{
    int d = scene->scheme.dimension;
    for (int k = -1; k < point->pair_count; ++k) {
        quad p[oracle_rows] = {1};
        quad w = k < 0 ? point->self_weight : point->pairs[k].s;
        rough spread = k < 0 ? (rough)w : point->pairs[k].spread, square = 0;
        if (k >= 0)
            basis_of(scene, point, &point->pairs[k], p);
        for (int a = 0; a < d; ++a) {
            square += (rough)p[a + 1] * (rough)p[a + 1];
            p[a + 1] -= centre[a];
            const quad weighed = w * p[a + 1];
            for (int b = 0; b <= a; ++b)
                point->moment[a][b] += weighed * p[b + 1];
        }
        point->spread += spread * square;
    }
    for (int a = 0; a < d; ++a)
        for (int b = a + 1; b < d; ++b)
            point->moment[a][b] = point->moment[b][a];
}

/* [ 1/S0 + xb.C xb , -(C xb)^T ; -C xb , C ] */
static void bordered_inverse(int d, const oracle_point *point, const quad *centre,
                             oracle_matrix inverse)
{
    quad image[3], product = 0;
    for (int a = 0; a < d; ++a) {
        image[a] = 0;
        for (int b = 0; b < d; ++b) {
            image[a] += point->correction[a][b] * centre[b];
            inverse[a + 1][b + 1] = point->correction[a][b];
        }
        product += image[a] * centre[a];
        inverse[0][a + 1] = inverse[a + 1][0] = -image[a];
    }
    inverse[0][0] = 1 / point->mass + product;
}

/* e_k / H - B_k y */
static void right_side(const oracle_scene *scene, const classic_sums *sums,
                       const oracle_point *point, int k, quad *right)
{
    int n = scene->scheme.dimension + 1;
    for (int a = 0; a < n; ++a) {
        right[a] = a == k + 1 ? 1 / (quad)point->support : 0;
        for (int b = 0; b < n; ++b)
            right[a] -= sums->b[k][a][b] * point->y[b];
    }
}

/* y = A^-1 e_0, z_k = A^-1 (e_k / H - B_k y). */
static void solve_coefficients(const oracle_scene *scene, oracle_matrix inverse,
                               const classic_sums *sums, oracle_point *point)
{
    int d = scene->scheme.dimension, n = d + 1;
    for (int a = 0; a < n; ++a)
        point->y[a] = inverse[a][0];
    for (int k = 0; k < d; ++k) {
        quad right[oracle_rows];
        right_side(scene, sums, point, k, right);
        for (int a = 0; a < n; ++a) {
            point->z[k][a] = 0;
            for (int b = 0; b < n; ++b)
                point->z[k][a] += inverse[a][b] * right[b];
        }
    }
}

/* What rounding of the sums B_k does to z, before anything cancels: |A^-1 e_k| / H and
 * sum |d_k w| |p.y| |A^-1 p|. */
static rough blur_of_slopes(const oracle_scene *scene, oracle_matrix inverse,
                            const oracle_point *point)
{
    int d = scene->scheme.dimension;
    rough unit_part = 0, sum = 0;
    for (int k = 1; k <= d; ++k)
        unit_part = rough_max(unit_part, rough_norm(inverse[k], d + 1));
    for (int n = 0; n < point->pair_count; ++n) {
        const oracle_pair *pair = &point->pairs[n];
        quad p[oracle_rows], value = 0;
        rough size = 0;
        basis_of(scene, point, pair, p);
        for (int a = 0; a <= d; ++a) {
            rough image = 0;
            value += p[a] * point->y[a];
            for (int b = 0; b <= d; ++b)
                image += (rough)inverse[a][b] * (rough)p[b];
            size = rough_max(size, fabsl(image));
        }
        sum += pair->slope_spread * (rough)pair->r * rough_abs(value) * size;
    }
    return sum + unit_part / (rough)point->support;
}

/* The largest |A^-1| |B_k|: what z_k answers to a change of y, however much of z_k itself cancels.
 */
static rough blur_of_y(int d, oracle_matrix inverse, const classic_sums *sums)
{
    rough largest = 0;
    for (int k = 0; k < d; ++k) {
        rough square = 0;
        for (int a = 0; a <= d; ++a) {
            const rough row = rough_norm(sums->b[k][a], d + 1);
            square += row * row;
        }
        largest = rough_max(largest, sqrtl(square));
    }
    return oracle_spectral_norm(d + 1, inverse) * largest;
}

/* Where the policy's f acts, its slope may be much steeper than that of 1 / lambda, as at the lower
 * end of blend, and the condition of A knows nothing of it: what a change of C does to y and z. */
static void add_blur_of_filter(const oracle_scene *scene, oracle_matrix inverse,
                               const classic_sums *sums, const quad *centre, oracle_point *point)
{
    int d = scene->scheme.dimension;
    rough steepest = 0, size = 0, largest = 0, border = 1 + rough_norm(centre, d);
    const rough scale = (rough)point->scale;
    for (int l = 0; l < d; ++l)
        steepest = rough_max(steepest, largest_divided(&point->filter, l));
    const rough change = steepest * point->spread / (scale * scale) * border * border;
    point->y_bound += change;
    for (int k = 0; k < d; ++k) {
        quad right[oracle_rows];
        right_side(scene, sums, point, k, right);
        largest = rough_max(largest, rough_norm(right, d + 1));
        for (int a = 0; a <= d; ++a)
            size = rough_max(size, rough_norm(sums->b[k][a], d + 1));
    }
    point->z_bound += change * (largest + oracle_spectral_norm(d + 1, inverse) * size);
}

/* tr A |A^-1| in the basis (1, xi / sqrt(mu2)). */
static rough balanced_condition(const oracle_scene *scene, oracle_matrix inverse,
                                const classic_sums *sums)
{
    int d = scene->scheme.dimension;
    const quad root = quad_sqrt(oracle_mu2(scene->scheme.kernel, d));
    rough trace = 0;
    oracle_matrix balanced;
    for (int a = 0; a <= d; ++a) {
        quad row = a ? root : 1;
        trace += sums->a_spread[a] / (rough)(row * row);
        for (int b = 0; b <= d; ++b)
            balanced[a][b] = inverse[a][b] * row * (b ? root : 1);
    }
    return trace * oracle_spectral_norm(d + 1, balanced);
}

static void solve_classic(const oracle_scene *scene, int i, oracle_point *point)
{
    int d = scene->scheme.dimension;
    classic_sums sums = {0};
    quad centre[3] = {0};
    oracle_matrix inverse = {{0}};
    if (point->has_self) {
        oracle_pair self = {.j = i};
        oracle_weigh(scene, point->support, scene->volume ? scene->volume[i] : 1, &self);
        point->self_weight = self.s;
    }
    sum_classic(scene, point, &sums);
    point->mass = sums.a[0][0];
    if (!(point->mass > 0))
        return;
    for (int k = 0; k < d; ++k)
        centre[k] = sums.a[0][k + 1] / point->mass;
    centre_moments(scene, point, centre);
    point->scale = point->mass * oracle_mu2(scene->scheme.kernel, d);
    filter_moments(scene, 0, point);
    bordered_inverse(d, point, centre, inverse);
    solve_coefficients(scene, inverse, &sums, point);
    point->condition = balanced_condition(scene, inverse, &sums);
    point->y_norm = rough_norm(point->y, d + 1);
    for (int k = 0; k < d; ++k) {
        point->z_norm = rough_max(point->z_norm, rough_norm(point->z[k], d + 1));
        point->self_gradient[k] = point->self_weight * point->z[k][0];
    }
    /* 1: the weight that y and z are multiplied with is as uncertain as those they come from. */
    point->y_bound = (1 + point->condition) * point->y_norm;
    point->z_bound = (1 + point->condition) * point->z_norm +
                     point->condition * blur_of_y(d, inverse, &sums) * point->y_norm +
                     blur_of_slopes(scene, inverse, point);
    if (point->rank < d)
        add_blur_of_filter(scene, inverse, &sums, centre, point);
    point->self_bound = scene->unit * (rough)point->self_weight * point->z_bound;
}

/* ---- G_ij ------------------------------------------------------------------------------------ */

static rough linearised_gradient(const oracle_scene *scene, const oracle_point *point,
                                 oracle_pair *pair)
{
    int d = scene->scheme.dimension;
    quad b[3];
    rough size[3];
    for (int a = 0; a < d; ++a) {
        b[a] = pair->s * pair->x[a];
        size[a] = (rough)b[a];
    }
    for (int a = 0; a < d; ++a) {
        pair->gradient[a] = 0;
        for (int c = 0; c < d; ++c)
            pair->gradient[a] += point->correction[a][c] * b[c];
    }
    return scene->unit * (point->correction_norm * pair->spread * (rough)pair->r +
                          oracle_filter_error(point, 1, size));
}

static rough classic_gradient(const oracle_scene *scene, const oracle_point *point,
                              oracle_pair *pair)
{
    int d = scene->scheme.dimension;
    quad p[oracle_rows], value = 0;
    basis_of(scene, point, pair, p);
    for (int a = 0; a <= d; ++a)
        value += p[a] * point->y[a];
    for (int k = 0; k < d; ++k) {
        quad slope = 0;
        for (int a = 0; a <= d; ++a)
            slope += p[a] * point->z[k][a];
        pair->gradient[k] = pair->slope * pair->x[k] * value + pair->s * slope;
    }
    return scene->unit * rough_norm(p, d + 1) *
           (pair->slope_spread * (rough)pair->r * point->y_bound + pair->spread * point->z_bound);
}

rough oracle_gradient_of(const oracle_scene *scene, const oracle_point *point, oracle_pair *pair)
{
    return oracle_is_classic(scene->scheme.method) ? classic_gradient(scene, point, pair)
                                                   : linearised_gradient(scene, point, pair);
}

void oracle_solve(const oracle_scene *scene, int i, oracle_point *point)
{
    point->has_self = scene->targets == NULL;
    const double *own = scene->target_volume;
    if (!own && point->has_self)
        own = scene->volume;
    point->volume = own ? own[i] : -1;
    point->support = scene->support ? scene->support[i] : scene->scheme.support_radius;
    find_pairs(scene, i, point);
    for (int k = 0; k < point->pair_count; ++k) {
        oracle_pair *pair = &point->pairs[k];
        oracle_weigh(scene, point->support, scene->volume ? scene->volume[pair->j] : 1, pair);
    }
    if (oracle_is_classic(scene->scheme.method))
        solve_classic(scene, i, point);
    else
        solve_linearised(scene, point);
    for (int k = 0; k < point->pair_count; ++k)
        point->pairs[k].bound = oracle_gradient_of(scene, point, &point->pairs[k]);
}

int oracle_rank_is_open(const oracle_scene *scene, const oracle_point *point)
{
    quad limit = scene->scheme.policy == SPHG_BLEND ? 4 * point->filter.eps : point->filter.eps;
    quad blur = 16 * scene->unit * point->spread / point->scale;
    for (int k = 0; k < scene->scheme.dimension; ++k)
        if (quad_abs(point->filter.lambda[k] - limit) <= blur)
            return 1;
    return 0;
}
