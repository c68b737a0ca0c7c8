/* SPDX-License-Identifier: MIT */
/* Sums over pairs: every form, contracted to every operator, with its bound. */
#include "oracle.h"
#include "oracle_internal.h"
#include "oracle_quadratic.h"

struct oracle {
    oracle_scene scene;
    int point_count;
    oracle_point *points;
    oracle_second *seconds; /* order 2 */
    char *solved, *solved_second;
};

oracle *oracle_of(const oracle_scene *scene)
{
    oracle *reference = oracle_memory(sizeof *reference);
    reference->scene = *scene;
    reference->point_count = scene->targets ? scene->target_count : scene->source_count;
    size_t count = (size_t)reference->point_count;
    reference->points = oracle_memory(count * sizeof *reference->points);
    reference->solved = oracle_memory(count);
    reference->seconds = oracle_memory(count * sizeof *reference->seconds);
    reference->solved_second = oracle_memory(count);
    return reference;
}

const oracle_scene *oracle_scene_of(const oracle *reference)
{
    return &reference->scene;
}

const oracle_point *oracle_at(oracle *reference, int i)
{
    if (!reference->solved[i])
        oracle_solve(&reference->scene, i, &reference->points[i]);
    reference->solved[i] = 1;
    return &reference->points[i];
}

const oracle_second *oracle_second_at(oracle *reference, int i)
{
    if (!reference->solved_second[i])
        oracle_solve_second(&reference->scene, oracle_at(reference, i), &reference->seconds[i]);
    reference->solved_second[i] = 1;
    return &reference->seconds[i];
}

/* ---- Items and operators -------------------------------------------------------------------- */

/* An item as its full components: 1, d or d x d. */
typedef struct item {
    int count;
    quad a[9];
} item;

static int width_of(sphg_shape shape, int d)
{
    const int widths[] = {
        [SPHG_SCALAR] = 1,
        [SPHG_VECTOR] = d,
        [SPHG_SYM_TENSOR] = d * (d + 1) / 2,
        [SPHG_TENSOR] = d * d,
    };
    return widths[shape];
}

static item read_item(int d, sphg_shape shape, const double *numbers, int i)
{
    const double *first = numbers + i * width_of(shape, d);
    item full = {0};
    if (shape == SPHG_SYM_TENSOR) {
        full.count = d * d;
        for (int a = 0, k = 0; a < d; ++a)
            for (int b = a; b < d; ++b, ++k)
                full.a[a * d + b] = full.a[b * d + a] = first[k];
        return full;
    }
    full.count = width_of(shape, d);
    for (int k = 0; k < full.count; ++k)
        full.a[k] = first[k];
    return full;
}

static item scaled(quad weight, const item *of)
{
    item product = {.count = of->count};
    for (int k = 0; k < product.count; ++k)
        product.a[k] = weight * of->a[k];
    return product;
}

static void add_curl(int d, const quad *a, const quad *g, quad *curl)
{
    if (d == 2) {
        curl[0] += g[0] * a[1] - g[1] * a[0];
        return;
    }
    for (int k = 0; k < 3; ++k)
        curl[k] += g[(k + 1) % 3] * a[(k + 2) % 3] - g[(k + 2) % 3] * a[(k + 1) % 3];
}

/* A G, A . G and G x A, as far as the shape has them. */
static void contract(int d, sphg_shape shape, const item *a, const quad *g, oracle_result *result)
{
    int rows = shape == SPHG_SCALAR ? 1 : d;
    if (shape == SPHG_SCALAR || shape == SPHG_VECTOR)
        for (int k = 0; k < rows * d; ++k)
            result->gradient[k] += a->a[k / d] * g[k % d];
    if (shape == SPHG_VECTOR) {
        for (int k = 0; k < d; ++k)
            result->divergence[0] += a->a[k] * g[k];
        add_curl(d, a->a, g, result->curl);
    } else if (shape != SPHG_SCALAR) {
        for (int k = 0; k < d * d; ++k)
            result->divergence[k / d] += a->a[k] * g[k % d];
    }
}

/* ---- One-sided forms: sum of (A_j - A_i) G_ij or A_j G_ij ------------------------------------ */

static void add_self(const oracle_scene *scene, const oracle_field *field, int i,
                     const oracle_point *point, oracle_result *result)
{
    int d = scene->scheme.dimension;
    if (!point->has_self || !oracle_is_classic(scene->scheme.method))
        return;
    item own = read_item(d, field->shape, field->at_sources, i);
    contract(d, field->shape, &own, point->self_gradient, result);
    result->bound += rough_norm(own.a, own.count) * point->self_bound;
}

static void one_sided(const oracle_scene *scene, const oracle_field *field, int i,
                      const oracle_point *point, oracle_result *result)
{
    int d = scene->scheme.dimension, width = 0;
    const double *targets = field->at_targets ? field->at_targets : field->at_sources;
    const int differs = field->form == SPHG_DIFFERENCE;
    rough b[27] = {0};
    item own = {.count = 0};
    if (differs)
        own = read_item(d, field->shape, targets, i);
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        item change = read_item(d, field->shape, field->at_sources, pair->j);
        width = change.count;
        for (int c = 0; differs && c < width; ++c)
            change.a[c] -= own.a[c];
        const rough size = rough_norm(change.a, width);
        contract(d, field->shape, &change, pair->gradient, result);
        if (oracle_is_classic(scene->scheme.method))
            result->bound += size * pair->bound;
        else
            result->bound +=
                scene->unit * point->correction_norm * pair->spread * (rough)pair->r * size;
        for (int c = 0; c < d * width; ++c)
            b[c] += (rough)pair->s * (rough)pair->x[c / width] * (rough)change.a[c % width];
    }
    if (!oracle_is_classic(scene->scheme.method))
        result->bound += scene->unit * oracle_filter_error(point, width, b);
    else if (!differs)
        add_self(scene, field, i, point, result);
    result->touched = point->rank < d;
    result->undecided = point->undecided;
}

/* ---- Two-sided forms: w_i A_i G_ij - w_j A_j G_ji -------------------------------------------- */

typedef struct side_weights {
    quad own, other;
} side_weights;

static side_weights two_weights(const oracle_scene *scene, sphg_form form, int i, int j)
{
    quad vi = scene->volume[i], vj = scene->volume[j];
    side_weights weights = {vi, vj};
    if (form == SPHG_SYMMETRIC) {
        quad ratio = (quad)scene->density[j] / scene->density[i];
        weights.own = ratio;
        weights.other = vj / vi / ratio;
    }
    return weights;
}

static oracle_pair seen_from(const oracle_scene *scene, const oracle_point *other,
                             const oracle_pair *pair, int i)
{
    oracle_pair back = *pair;
    back.j = i;
    for (int k = 0; k < scene->scheme.dimension; ++k)
        back.x[k] = -pair->x[k];
    oracle_weigh(scene, other->support, scene->volume[i], &back);
    back.bound = oracle_gradient_of(scene, other, &back);
    return back;
}

static void two_sided(oracle *reference, const oracle_field *field, int i, oracle_result *result)
{
    const oracle_scene *scene = &reference->scene;
    const oracle_point *point = oracle_at(reference, i);
    int d = scene->scheme.dimension;
    item own = read_item(d, field->shape, field->at_sources, i);
    result->touched = point->rank < d;
    result->undecided = point->undecided;
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        const oracle_point *there = oracle_at(reference, pair->j);
        oracle_pair back = seen_from(scene, there, pair, i);
        item other = read_item(d, field->shape, field->at_sources, pair->j);
        side_weights weights = two_weights(scene, field->form, i, pair->j);
        item here = scaled(weights.own, &own);
        item away = scaled(-weights.other, &other);
        contract(d, field->shape, &here, pair->gradient, result);
        contract(d, field->shape, &away, back.gradient, result);
        result->bound += rough_norm(here.a, here.count) * pair->bound +
                         rough_norm(away.a, away.count) * back.bound;
        result->touched |= there->rank < d;
        result->undecided |= there->undecided;
    }
}

/* ---- Value ---------------------------------------------------------------------------------- */

static quad interpolation_weight(const oracle_scene *scene, const oracle_point *point,
                                 const oracle_pair *pair, rough *bound)
{
    const sphg_scheme *scheme = &scene->scheme;
    int d = scheme->dimension;
    if (oracle_is_classic(scheme->method)) {
        quad sum = point->y[0];
        rough square = 1;
        for (int k = 0; k < d; ++k) {
            quad xi = -pair->x[k] / point->support;
            sum += point->y[k + 1] * xi;
            square += (rough)xi * (rough)xi;
        }
        *bound = pair->spread * sqrtl(square) * (rough)point->y_bound;
        return pair->s * sum;
    }
    oracle_weights at = oracle_weights_at(scheme->kernel, d, point->support, pair->r);
    *bound = scene->volume[pair->j] *
             (2 * (rough)at.w + (rough)pair->r * (rough)pair->r * rough_abs(at.slope));
    return scene->volume[pair->j] * at.w;
}

static void add_value(const oracle_scene *scene, const oracle_field *field, const oracle_pair *pair,
                      const oracle_point *point, oracle_result *result)
{
    int d = scene->scheme.dimension, width = width_of(field->shape, d);
    const double *a = field->at_sources + pair->j * width;
    rough bound, square = 0;
    const quad weight = interpolation_weight(scene, point, pair, &bound);
    for (int c = 0; c < width; ++c) {
        result->value[c] += weight * a[c];
        square += (rough)a[c] * a[c];
    }
    result->value_bound += scene->unit * bound * sqrtl(square);
}

static void sum_values(const oracle_scene *scene, const oracle_field *field, int i,
                       const oracle_point *point, oracle_result *result)
{
    for (int k = 0; k < point->pair_count; ++k)
        add_value(scene, field, &point->pairs[k], point, result);
    if (!point->has_self)
        return;
    oracle_pair self = {.j = i, .s = point->self_weight, .spread = (rough)point->self_weight};
    add_value(scene, field, &self, point, result);
}

/* ---- Squares of gradients ------------------------------------------------------------------- */

static void add_square(const oracle_scene *scene, quad a, const quad *gradient, rough size,
                       rough bound, oracle_result *result)
{
    for (int k = 0; k < scene->scheme.dimension; ++k)
        result->square += a * gradient[k] * gradient[k];
    result->square_bound += rough_abs(a) * bound * (2 * size + bound);
}

/* size: of what C_i is multiplied with, however much of it C_i takes away. The second order counts:
 * a G_ij of terms that cancel may be smaller than its own bound. */
static void sum_squares(const oracle_scene *scene, const oracle_field *field, int i,
                        const oracle_point *point, oracle_result *result)
{
    const int d = scene->scheme.dimension, classic = oracle_is_classic(scene->scheme.method);
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        add_square(scene, field->at_sources[pair->j], pair->gradient,
                   classic ? rough_norm(pair->gradient, d)
                           : point->correction_norm * rough_abs(pair->s) * (rough)pair->r,
                   pair->bound, result);
    }
    if (point->has_self && classic)
        add_square(scene, field->at_sources[i], point->self_gradient,
                   rough_norm(point->self_gradient, d), point->self_bound, result);
}

oracle_result oracle_apply(oracle *reference, const oracle_field *field, int i)
{
    oracle_result result = {.touched = 0};
    const oracle_point *point = oracle_at(reference, i);
    if (field->form == SPHG_DIFFERENCE || field->form == SPHG_DIRECT)
        one_sided(&reference->scene, field, i, point, &result);
    else
        two_sided(reference, field, i, &result);
    if (field->form == SPHG_DIRECT &&
        (reference->scene.volume || oracle_is_classic(reference->scene.scheme.method)))
        sum_values(&reference->scene, field, i, point, &result);
    if (field->form == SPHG_DIRECT && field->shape == SPHG_SCALAR)
        sum_squares(&reference->scene, field, i, point, &result);
    return result;
}

double oracle_ratio(int width, const double *found, const quad *exact, quad bound)
{
    quad square = 0;
    for (int k = 0; k < width; ++k) {
        quad error = (quad)found[k] - exact[k];
        square += error * error;
    }
    if (square == 0)
        return 0;
    /* Norms of errors near the rim of f64's range still have their squares in quad. */
    return square != square ? NAN : (double)(quad_sqrt(square) / bound);
}
