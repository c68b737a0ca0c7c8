/* SPDX-License-Identifier: MIT */
/* Two-sided forms of order 2: w_i A_i G_ij - w_j A_j G_ji, each G from the blocks of its own
 * target. */
#include "oracle_internal.h"
#include "oracle_second.h"

/* G_ij is the gradient of a field that is 1 at j, 0 elsewhere. */
static rough gradient_of(const oracle_scene *scene, const oracle_basis *of,
                         const oracle_point *point, const oracle_second *second,
                         const oracle_pair *pair, quad *g)
{
    const quad unit = oracle_weight_unit(point), weight = -pair->s * unit;
    const rough spread = pair->spread * (rough)unit;
    quad e[3], q[oracle_pairs], hessian[oracle_pairs];
    oracle_change change = {.first_size = 0};
    oracle_curved bounds = {.gradient_bound = 0};
    oracle_offsets_of(point, of, pair, e, q);
    for (int a = 0; a < of->d; ++a)
        change.first[a] = weight * e[a];
    for (int m = 0; m < of->n; ++m)
        change.second[m] = weight * q[m];
    change.first_size = spread * rough_norm(e, of->d);
    change.second_size = spread * rough_norm(q, of->n);
    oracle_curve_component(scene, of, point, second, &change, g, hessian, &bounds);
    return bounds.gradient_bound + pair->bound;
}

static oracle_pair seen_from_there(const oracle_scene *scene, const oracle_point *there,
                                   const oracle_pair *pair, int i)
{
    oracle_pair back = *pair;
    back.j = i;
    for (int k = 0; k < scene->scheme.dimension; ++k)
        back.x[k] = -pair->x[k];
    oracle_weigh(scene, there->support, scene->volume[i], &back);
    back.bound = oracle_gradient_of(scene, there, &back);
    return back;
}

oracle_curved oracle_apply_second_two_sided(oracle *reference, const oracle_field *field, int i)
{
    const oracle_scene *scene = oracle_scene_of(reference);
    const oracle_point *point = oracle_at(reference, i);
    const oracle_basis of = oracle_basis_of(scene);
    const int d = of.d, widths[] = {0, 1, d, of.n, d * d}, width = widths[field->shape];
    const double *own = field->at_sources + i * width;
    const oracle_second *second = oracle_second_at(reference, i);
    quad gradient[9][3] = {{0}};
    oracle_curved found = {.undecided = second->undecided, .touched = !second->full};
    for (int k = 0; k < point->pair_count; ++k) {
        oracle_pair pair = point->pairs[k];
        const oracle_point *there = oracle_at(reference, pair.j);
        oracle_pair back = seen_from_there(scene, there, &pair, i);
        const oracle_second *other = oracle_second_at(reference, pair.j);
        const double *away = field->at_sources + pair.j * width;
        quad here[3], back_there[3], weights[2] = {scene->volume[i], scene->volume[pair.j]};
        if (field->form == SPHG_SYMMETRIC) {
            const quad ratio = (quad)scene->density[pair.j] / scene->density[i];
            weights[1] = weights[1] / weights[0] / ratio;
            weights[0] = ratio;
        }
        const rough bounds[2] = {gradient_of(scene, &of, point, second, &pair, here),
                                 gradient_of(scene, &of, there, other, &back, back_there)};
        for (int c = 0; c < width; ++c) {
            for (int a = 0; a < d; ++a)
                gradient[c][a] +=
                    weights[0] * own[c] * here[a] - weights[1] * away[c] * back_there[a];
            found.gradient_bound += rough_abs(weights[0]) * fabsl(own[c]) * bounds[0] +
                                    rough_abs(weights[1]) * fabsl(away[c]) * bounds[1];
        }
        found.touched |= !other->full;
        found.undecided |= other->undecided;
    }
    oracle_contract_second(&of, field, gradient, &found);
    return found;
}
