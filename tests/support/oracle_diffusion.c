/* SPDX-License-Identifier: MIT */
/* L_ij as its definition has it: gradients of both ends along the pair. Values: weights times what
 * stands at the sources. */
#include "oracle_diffusion.h"
#include "oracle_internal.h"

static int width_of(sphg_shape shape, int d)
{
    const int widths[] = {0, 1, d, d * (d + 1) / 2, d * d};
    return widths[shape];
}

/* -V G . x / r^2 of one end. Between coincident particles there is no direction: the mean of all.
 */
static quad share(int d, quad volume, quad unit, const oracle_point *point, const oracle_pair *pair,
                  quad *bound)
{
    quad along = 0, trace = 0;
    for (int k = 0; k < d; ++k) {
        along += pair->gradient[k] * pair->x[k];
        trace += point->correction[k][k];
    }
    if (pair->r > 0) {
        *bound = volume * pair->bound / pair->r;
        return -volume * along / (pair->r * pair->r);
    }
    *bound = volume * quad_abs(pair->s) * (point->correction_bound + 4 * unit * quad_abs(trace));
    return -volume * pair->s * trace / d;
}

static quad mean_of(const double *coefficient, int i, int j)
{
    if (!coefficient)
        return 1;
    const quad a = coefficient[i], b = coefficient[j];
    return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

oracle_flow oracle_diffuse(oracle *reference, const oracle_field *field, const double *coefficient,
                           int i)
{
    const oracle_scene *scene = oracle_scene_of(reference);
    const oracle_point *point = oracle_at(reference, i);
    const int d = scene->scheme.dimension, width = width_of(field->shape, d);
    oracle_flow flow = {.touched = point->rank < d, .undecided = point->undecided};
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        const oracle_point *there = oracle_at(reference, pair->j);
        oracle_pair back = *pair;
        quad bounds[2], size = 0;
        for (int a = 0; a < d; ++a)
            back.x[a] = -pair->x[a];
        oracle_weigh(scene, there->support, scene->volume[i], &back);
        back.bound = oracle_gradient_of(scene, there, &back);
        const quad here = share(d, scene->volume[i], scene->unit, point, pair, &bounds[0]);
        const quad between =
            here + share(d, scene->volume[pair->j], scene->unit, there, &back, &bounds[1]);
        const quad mean = mean_of(coefficient, i, pair->j);
        flow.least = k == 0 || between < flow.least ? between : flow.least;
        for (int c = 0; c < width; ++c) {
            const quad change = (quad)field->at_sources[pair->j * width + c] -
                                (quad)field->at_sources[i * width + c];
            flow.sum[c] += mean * between * change;
            size += change * change;
        }
        flow.bound += mean * (bounds[0] + bounds[1] + 4 * (quad)scene->unit * quad_abs(between)) *
                      quad_sqrt(size);
        flow.touched |= there->rank < d;
        flow.undecided |= there->undecided;
    }
    return flow;
}

/* ---- Values ---------------------------------------------------------------------------------- */

typedef struct sums {
    quad weight, weight_bound, value[9], value_bound;
} sums;

static void add_weighted(const oracle_scene *scene, const oracle_field *field, quad volume,
                         quad support, quad r, int j, const double *own, sums *to)
{
    const int d = scene->scheme.dimension, width = width_of(field->shape, d);
    const oracle_weights at = oracle_weights_at(scene->scheme.kernel, d, support, r);
    const quad bound = quad_abs(volume) * (3 * at.w + r * r * quad_abs(at.slope));
    quad size = 0;
    for (int c = 0; c < width; ++c) {
        const quad value = (quad)field->at_sources[j * width + c] - (own ? (quad)own[c] : 0);
        to->value[c] += volume * at.w * value;
        size += value * value;
    }
    to->weight += volume * at.w;
    to->weight_bound += bound;
    to->value_bound += bound * quad_sqrt(size);
}

oracle_mean oracle_value(oracle *reference, const oracle_field *field, const double *volume,
                         int shepard, int i)
{
    const oracle_scene *scene = oracle_scene_of(reference);
    const oracle_point *point = oracle_at(reference, i);
    const double *volumes = volume ? volume : scene->volume;
    const int d = scene->scheme.dimension, width = width_of(field->shape, d);
    const double *own = field->form == SPHG_DIFFERENCE ? field->at_sources + i * width : NULL;
    sums all = {.weight = 0};
    for (int k = 0; k < point->pair_count; ++k) {
        const oracle_pair *pair = &point->pairs[k];
        if (pair->r < point->support) /* W_i, whatever the list has */
            add_weighted(scene, field, volumes[pair->j], point->support, pair->r, pair->j, own,
                         &all);
    }
    if (!own)
        add_weighted(scene, field, volumes[i], point->support, 0, i, NULL, &all);
    oracle_mean mean = {.bound = scene->unit * all.value_bound};
    quad size = 0;
    for (int c = 0; c < width; ++c) {
        mean.value[c] = shepard ? all.value[c] / all.weight : all.value[c];
        size += mean.value[c] * mean.value[c];
    }
    if (shepard)
        mean.bound =
            (mean.bound + scene->unit * all.weight_bound * quad_sqrt(size)) / quad_abs(all.weight);
    return mean;
}
