/* SPDX-License-Identifier: MIT */
/* The passes of limit_passes.h. Parameters: VECTOR_BYTES, LIMIT_SET, LIMIT_SET_NAME. */
#include "limit_passes.h"
#include "vector.inl.h"

/* The pairs of a group, step after step. */
struct pairs {
    const float *first;
    int32_t slots;
};

struct sums {
    vec xx, xy, xz, yy, yz, zz;
    vec ax, ay, az, bx, by, bz, cx, cy, cz;
};

INLINE vec component(struct pairs pairs, int32_t k, int c)
{
    return load(pairs.first + (k * LIMIT_COMPONENTS + c) * LANES);
}

INLINE vec weight_of(struct pairs pairs, const vec own[LIMIT_OWN], int32_t k, bool by_newton)
{
    const vec x = own[0] - component(pairs, k, 0), y = own[1] - component(pairs, k, 1),
              z = own[2] - component(pairs, k, 2);
    const vec q2 = x * x + (y * y + (z * z + 1e-12f)); /* the rest keeps the root off 0 */
    return spline_weight(q2, by_newton) * component(pairs, k, 3);
}

/* g: the pair's weight. */
INLINE void add_moments(struct sums *sums, struct pairs pairs, const vec own[LIMIT_OWN], int32_t k,
                        vec g)
{
    const vec x = own[0] - component(pairs, k, 0), y = own[1] - component(pairs, k, 1),
              z = own[2] - component(pairs, k, 2);
    const vec gx = g * x, gy = g * y, gz = g * z;
    sums->xx += gx * x, sums->xy += gx * y, sums->xz += gx * z;
    sums->yy += gy * y, sums->yz += gy * z, sums->zz += gz * z;
}

INLINE void add_field(struct sums *sums, struct pairs pairs, const vec own[LIMIT_OWN], int32_t k,
                      vec g)
{
    const vec gx = g * (own[0] - component(pairs, k, 0)),
              gy = g * (own[1] - component(pairs, k, 1)),
              gz = g * (own[2] - component(pairs, k, 2));
    const vec a = own[3] - component(pairs, k, 4), b = own[4] - component(pairs, k, 5),
              c = own[5] - component(pairs, k, 6);
    sums->ax += a * gx, sums->ay += a * gy, sums->az += a * gz;
    sums->bx += b * gx, sums->by += b * gy, sums->bz += b * gz;
    sums->cx += c * gx, sums->cy += c * gy, sums->cz += c * gz;
}

/* Moments and field in loops of their own: 15 sums beside their factors are more than 16
 * registers hold. */
INLINE struct sums sum_pairs(struct pairs pairs, const vec own[LIMIT_OWN], enum limit_work work,
                             bool by_newton, float *weights)
{
    struct sums sums = {0};
    for (int32_t k = 0; k < pairs.slots; ++k)
        store(weights + k * LANES, weight_of(pairs, own, k, by_newton));
    if (work != LIMIT_GRADIENT)
        for (int32_t k = 0; k < pairs.slots; ++k)
            add_moments(&sums, pairs, own, k, load(weights + k * LANES));
    if (work != LIMIT_MATRICES)
        for (int32_t k = 0; k < pairs.slots; ++k)
            add_field(&sums, pairs, own, k, load(weights + k * LANES));
    return sums;
}

INLINE void store_sums(float *out, const struct sums *sums, enum limit_work work)
{
    const vec all[LIMIT_SUMS] = {sums->xx, sums->xy, sums->xz, sums->yy, sums->yz,
                                 sums->zz, sums->ax, sums->ay, sums->az, sums->bx,
                                 sums->by, sums->bz, sums->cx, sums->cy, sums->cz};
    for (int k = work == LIMIT_GRADIENT ? 6 : 0; k < (work == LIMIT_MATRICES ? 6 : LIMIT_SUMS); ++k)
        store(out + k * LANES, all[k]);
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
    const struct pairs pairs = {data->pairs + group * slots * LIMIT_COMPONENTS * LANES, slots};
    vec own[LIMIT_OWN];
    for (int k = 0; k < LIMIT_OWN; ++k)
        own[k] = load(data->own + (group * LIMIT_OWN + k) * LANES);
    const struct sums sums = sum_pairs(pairs, own, work, by_newton, data->weights);
    store_sums(data->sums, &sums, work);
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

static void run(const struct limit_data *data, enum limit_work work, enum limit_root root,
                bool finished, int32_t targets)
{
    switch ((int)work * LIMIT_ROOTS + (int)root) {
    case LIMIT_MATRICES *LIMIT_ROOTS + LIMIT_SQUARE_ROOT:
        run_groups(data, LIMIT_MATRICES, false, finished, targets);
        break;
    case LIMIT_MATRICES *LIMIT_ROOTS + LIMIT_NEWTON:
        run_groups(data, LIMIT_MATRICES, true, finished, targets);
        break;
    case LIMIT_GRADIENT *LIMIT_ROOTS + LIMIT_SQUARE_ROOT:
        run_groups(data, LIMIT_GRADIENT, false, finished, targets);
        break;
    case LIMIT_GRADIENT *LIMIT_ROOTS + LIMIT_NEWTON:
        run_groups(data, LIMIT_GRADIENT, true, finished, targets);
        break;
    case LIMIT_FUSED *LIMIT_ROOTS + LIMIT_SQUARE_ROOT:
        run_groups(data, LIMIT_FUSED, false, finished, targets);
        break;
    default:
        run_groups(data, LIMIT_FUSED, true, finished, targets);
    }
}

const struct limit_set LIMIT_SET = {LIMIT_SET_NAME, LANES, run};
