/* SPDX-License-Identifier: MIT */
/* The passes of limit_passes.h. Parameters: VECTOR_BYTES, LIMIT_SET, LIMIT_SET_NAME. */
#include "limit_passes.h"
#include "vector.inl.h"

/* Components of a pair, and what its offset, weight and field of a target's own come to. */
INLINE const float *pair_of(const float *pairs, int32_t k)
{
    return pairs + k * LIMIT_COMPONENTS * LANES;
}

INLINE vec away(const vec own[LIMIT_OWN], const float *pair, int c)
{
    return own[c] - load(pair + (c < 3 ? c : c + 1) * LANES); /* the volume stands between */
}

INLINE vec weight_of(const float *pair, const vec own[LIMIT_OWN], bool by_newton)
{
    const vec x = away(own, pair, 0), y = away(own, pair, 1), z = away(own, pair, 2);
    const vec q2 = x * x + (y * y + (z * z + 1e-12f)); /* the rest keeps the root off 0 */
    return spline_weight(q2, by_newton) * load(pair + 3 * LANES);
}

/* g: the pair's weight. */
INLINE void add_moments(vec sums[6], const float *pair, const vec own[LIMIT_OWN], vec g)
{
    const vec x[3] = {away(own, pair, 0), away(own, pair, 1), away(own, pair, 2)};
    for (int a = 0, k = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b, ++k)
            sums[k] += g * x[a] * x[b];
}

INLINE void add_field(vec sums[9], const float *pair, const vec own[LIMIT_OWN], vec g)
{
    for (int b = 0; b < 3; ++b) {
        const vec weighted = g * away(own, pair, b);
        for (int a = 0; a < 3; ++a)
            sums[3 * a + b] += away(own, pair, 3 + a) * weighted;
    }
}

/* Moments and field in loops of their own: 15 sums beside their factors are more than 16
 * registers hold. */
INLINE void sum_pairs(const struct limit_data *data, const float *pairs, int32_t slots,
                      const vec own[LIMIT_OWN], enum limit_work work, bool by_newton)
{
    vec moments[6] = {{0}}, field[9] = {{0}};
    for (int32_t k = 0; k < slots; ++k)
        store(data->weights + k * LANES, weight_of(pair_of(pairs, k), own, by_newton));
    for (int32_t k = 0; work != LIMIT_GRADIENT && k < slots; ++k)
        add_moments(moments, pair_of(pairs, k), own, load(data->weights + k * LANES));
    for (int32_t k = 0; work != LIMIT_MATRICES && k < slots; ++k)
        add_field(field, pair_of(pairs, k), own, load(data->weights + k * LANES));
    for (int k = 0; work != LIMIT_GRADIENT && k < 6; ++k)
        store(data->sums + k * LANES, moments[k]);
    for (int k = 0; work != LIMIT_MATRICES && k < 9; ++k)
        store(data->sums + (6 + k) * LANES, field[k]);
}

INLINE void finish(const struct limit_data *data, int32_t group, enum limit_work work)
{
    vec sums[LIMIT_SUMS], correction[6], jacobian[9];
    float *results = data->results + group * LIMIT_SUMS * LANES;
    for (int k = 0; k < LIMIT_SUMS; ++k)
        sums[k] = load(data->sums + k * LANES);
    if (work != LIMIT_GRADIENT) {
        invert_symmetric(sums, correction);
        for (int k = 0; k < 6; ++k)
            store(results + k * LANES, correction[k]);
    } else {
        for (int k = 0; k < 6; ++k)
            correction[k] = load(data->corrections + (group * 6 + k) * LANES);
    }
    if (work == LIMIT_MATRICES)
        return;
    apply_symmetric(sums + 6, correction, jacobian);
    for (int k = 0; k < 9; ++k)
        store(results + (6 + k) * LANES, jacobian[k]);
}

INLINE void run_group(const struct limit_data *data, int32_t slots, int32_t group,
                      enum limit_work work, bool by_newton, bool finished)
{
    vec own[LIMIT_OWN];
    for (int k = 0; k < LIMIT_OWN; ++k)
        own[k] = load(data->own + (group * LIMIT_OWN + k) * LANES);
    sum_pairs(data, data->pairs + group * slots * LIMIT_COMPONENTS * LANES, slots, own, work,
              by_newton);
    if (finished)
        finish(data, group, work);
}

/* The number of pairs is a constant where it is 32, the case of the paper: the loops unroll. What
 * the caller passes as constants is constant in the loops, too. */
INLINE void run_groups(const struct limit_data *data, enum limit_work work, bool by_newton,
                       bool finished, int32_t targets)
{
    for (int32_t done = 0; done < targets; done += LANES) {
        const int32_t group = done / LANES % (LIMIT_TARGETS / LANES);
        if (data->slots == 32)
            run_group(data, 32, group, work, by_newton, finished);
        else
            run_group(data, data->slots, group, work, by_newton, finished);
    }
}

INLINE void run_by(const struct limit_data *data, enum limit_work work, enum limit_root root,
                   bool finished, int32_t targets)
{
    if (root == LIMIT_NEWTON)
        run_groups(data, work, true, finished, targets);
    else
        run_groups(data, work, false, finished, targets);
}

static void run(const struct limit_data *data, enum limit_work work, enum limit_root root,
                bool finished, int32_t targets)
{
    if (work == LIMIT_MATRICES)
        run_by(data, LIMIT_MATRICES, root, finished, targets);
    else if (work == LIMIT_GRADIENT)
        run_by(data, LIMIT_GRADIENT, root, finished, targets);
    else
        run_by(data, LIMIT_FUSED, root, finished, targets);
}

const struct limit_set LIMIT_SET = {LIMIT_SET_NAME, LANES, run};
