/* SPDX-License-Identifier: MIT */
/* The passes of limit_passes.h. Parameters: VECTOR_BYTES, LIMIT_SET, LIMIT_SET_NAME. */
#include "limit_passes.h"
#include "vector.inl.h"

/* Where pairs stand: component c of step k at first + k * step + c * pitch. */
struct pairs {
    const float *first;
    int32_t step, pitch, steps;
};

struct sums {
    vec xx, xy, xz, yy, yz, zz;
    vec ax, ay, az, bx, by, bz, cx, cy, cz;
};

INLINE vec weight_of(struct pairs pairs, const vec own[LIMIT_OWN], int32_t k, bool by_newton)
{
    const float *p = pairs.first + k * pairs.step;
    const vec x = own[0] - load(p), y = own[1] - load(p + pairs.pitch),
              z = own[2] - load(p + 2 * pairs.pitch);
    const vec q2 = x * x + (y * y + (z * z + 1e-12f)); /* the rest keeps the root off 0 */
    return spline_weight(q2, by_newton) * load(p + 3 * pairs.pitch);
}

INLINE void add_moments(struct sums *sums, vec x, vec y, vec z, vec gx, vec gy, vec gz)
{
    sums->xx += gx * x;
    sums->xy += gx * y;
    sums->xz += gx * z;
    sums->yy += gy * y;
    sums->yz += gy * z;
    sums->zz += gz * z;
}

INLINE void add_field(struct sums *sums, vec a, vec b, vec c, vec gx, vec gy, vec gz)
{
    sums->ax += a * gx;
    sums->ay += a * gy;
    sums->az += a * gz;
    sums->bx += b * gx;
    sums->by += b * gy;
    sums->bz += b * gz;
    sums->cx += c * gx;
    sums->cy += c * gy;
    sums->cz += c * gz;
}

/* g: the pair's weight, where it is known already. */
INLINE void add_pair(struct sums *sums, struct pairs pairs, const vec own[LIMIT_OWN], int32_t k,
                     vec g, enum limit_work work)
{
    const float *p = pairs.first + k * pairs.step;
    const vec x = own[0] - load(p), y = own[1] - load(p + pairs.pitch),
              z = own[2] - load(p + 2 * pairs.pitch);
    const vec gx = g * x, gy = g * y, gz = g * z;
    if (work != LIMIT_GRADIENT)
        add_moments(sums, x, y, z, gx, gy, gz);
    if (work != LIMIT_MATRICES)
        add_field(sums, own[3] - load(p + 4 * pairs.pitch), own[4] - load(p + 5 * pairs.pitch),
                  own[5] - load(p + 6 * pairs.pitch), gx, gy, gz);
}

INLINE struct sums sum_pairs(struct pairs pairs, const vec own[LIMIT_OWN], enum limit_work work,
                             bool by_newton)
{
    struct sums sums = {0};
    for (int32_t k = 0; k < pairs.steps; ++k)
        add_pair(&sums, pairs, own, k, weight_of(pairs, own, k, by_newton), work);
    return sums;
}

INLINE void store_weights(struct pairs pairs, const vec own[LIMIT_OWN], bool by_newton,
                          float *weights)
{
    for (int32_t k = 0; k < pairs.steps; ++k)
        store(weights + k * LANES, weight_of(pairs, own, k, by_newton));
}

/* Moments and field in loops of their own: 15 sums beside their factors are more than 16
 * registers hold. */
INLINE struct sums sum_weighted(struct pairs pairs, const vec own[LIMIT_OWN], enum limit_work work,
                                const float *weights)
{
    struct sums sums = {0};
    if (work != LIMIT_GRADIENT)
        for (int32_t k = 0; k < pairs.steps; ++k)
            add_pair(&sums, pairs, own, k, load(weights + k * LANES), LIMIT_MATRICES);
    if (work != LIMIT_MATRICES)
        for (int32_t k = 0; k < pairs.steps; ++k)
            add_pair(&sums, pairs, own, k, load(weights + k * LANES), LIMIT_GRADIENT);
    return sums;
}

INLINE void store_sums(float *out, const struct sums *sums, enum limit_work work)
{
    if (work != LIMIT_GRADIENT) {
        store(out + 0 * LANES, sums->xx);
        store(out + 1 * LANES, sums->xy);
        store(out + 2 * LANES, sums->xz);
        store(out + 3 * LANES, sums->yy);
        store(out + 4 * LANES, sums->yz);
        store(out + 5 * LANES, sums->zz);
    }
    if (work != LIMIT_MATRICES) {
        store(out + 6 * LANES, sums->ax);
        store(out + 7 * LANES, sums->ay);
        store(out + 8 * LANES, sums->az);
        store(out + 9 * LANES, sums->bx);
        store(out + 10 * LANES, sums->by);
        store(out + 11 * LANES, sums->bz);
        store(out + 12 * LANES, sums->cx);
        store(out + 13 * LANES, sums->cy);
        store(out + 14 * LANES, sums->cz);
    }
}

INLINE int first_sum(enum limit_work work)
{
    return work == LIMIT_GRADIENT ? 6 : 0;
}

INLINE int end_of_sums(enum limit_work work)
{
    return work == LIMIT_MATRICES ? 6 : LIMIT_SUMS;
}

/* Sums of a group of targets, one target in each lane. */
INLINE void fetch_sums(const float *stored, enum limit_work work, bool lanes_are_targets,
                       vec sums[LIMIT_SUMS])
{
    for (int k = first_sum(work); k < end_of_sums(work); ++k) {
        if (lanes_are_targets) {
            sums[k] = load(stored + k * LANES);
            continue;
        }
        vec parts[LANES];
        for (int target = 0; target < LANES; ++target)
            parts[target] = load(stored + (target * LIMIT_SUMS + k) * LANES);
        sums[k] = sum_lanes(parts);
    }
}

INLINE void finish(const struct limit_data *data, int32_t group, enum limit_work work,
                   bool lanes_are_targets)
{
    vec sums[LIMIT_SUMS], correction[6], jacobian[9];
    float *results = data->results + group * LIMIT_SUMS * LANES;
    fetch_sums(data->sums, work, lanes_are_targets, sums);
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

INLINE struct pairs pairs_of_group(const struct limit_data *data, int32_t slots, int32_t group)
{
    const int32_t step = LIMIT_COMPONENTS * LANES;
    return (struct pairs){data->by_lane + group * slots * step, step, LANES, slots};
}

INLINE struct pairs pairs_of_target(const struct limit_data *data, int32_t slots, int32_t target)
{
    return (struct pairs){data->by_target + target * LIMIT_COMPONENTS * slots, LANES, slots,
                          slots / LANES};
}

INLINE void load_own(const struct limit_data *data, bool lanes_are_targets, int32_t unit,
                     vec own[LIMIT_OWN])
{
    for (int k = 0; k < LIMIT_OWN; ++k)
        own[k] = lanes_are_targets ? load(data->own_by_lane + (unit * LIMIT_OWN + k) * LANES)
                                   : splat(data->own[unit * LIMIT_OWN + k]);
}

/* A unit is a group where lanes are targets, else a target. */
INLINE void run_group(const struct limit_data *data, int32_t slots, int32_t group,
                      enum limit_work work, struct limit_arrangement how, bool finished)
{
    const bool grouped = how.lanes_are_targets;
    const int32_t units = grouped ? 1 : LANES, first = grouped ? group : group * LANES;
    vec own[LIMIT_OWN];
    if (how.in_passes)
        for (int32_t u = 0; u < units; ++u) {
            load_own(data, grouped, first + u, own);
            const struct pairs pairs = grouped ? pairs_of_group(data, slots, first)
                                               : pairs_of_target(data, slots, first + u);
            store_weights(pairs, own, how.by_newton, data->weights + u * slots);
        }
    for (int32_t u = 0; u < units; ++u) {
        load_own(data, grouped, first + u, own);
        const struct pairs pairs =
            grouped ? pairs_of_group(data, slots, first) : pairs_of_target(data, slots, first + u);
        const struct sums sums = how.in_passes
                                     ? sum_weighted(pairs, own, work, data->weights + u * slots)
                                     : sum_pairs(pairs, own, work, how.by_newton);
        store_sums(data->sums + u * LIMIT_SUMS * LANES, &sums, work);
    }
    if (finished)
        finish(data, group, work, grouped);
}

/* The number of pairs is a constant where it is 32, the case of the paper: the loops unroll. */
INLINE void run_groups(const struct limit_data *data, enum limit_work work,
                       struct limit_arrangement how, bool finished, int32_t targets)
{
    for (int32_t done = 0; done < targets; done += LANES) {
        const int32_t group = done / LANES % (LIMIT_TARGETS / LANES);
        if (data->slots == 32)
            run_group(data, 32, group, work, how, finished);
        else
            run_group(data, data->slots, group, work, how, finished);
    }
}

/* What is constant here is constant in the loops. `finished` is not: it is asked once a group. */
#define ARRANGED(lanes_are_targets, by_newton, in_passes)                                          \
    run_groups(data, work, (struct limit_arrangement){lanes_are_targets, by_newton, in_passes},    \
               finished, targets)

INLINE void run_arranged(const struct limit_data *data, enum limit_work work, int arrangement,
                         bool finished, int32_t targets)
{
    switch (arrangement) {
    case 0:
        ARRANGED(false, false, false);
        return;
    case 1:
        ARRANGED(true, false, false);
        return;
    case 2:
        ARRANGED(false, true, false);
        return;
    case 3:
        ARRANGED(true, true, false);
        return;
    case 4:
        ARRANGED(false, false, true);
        return;
    case 5:
        ARRANGED(true, false, true);
        return;
    case 6:
        ARRANGED(false, true, true);
        return;
    default:
        ARRANGED(true, true, true);
    }
}

static void run(const struct limit_data *data, enum limit_work work, int arrangement, bool finished,
                int32_t targets)
{
    if (work == LIMIT_MATRICES)
        run_arranged(data, LIMIT_MATRICES, arrangement, finished, targets);
    else if (work == LIMIT_GRADIENT)
        run_arranged(data, LIMIT_GRADIENT, arrangement, finished, targets);
    else
        run_arranged(data, LIMIT_FUSED, arrangement, finished, targets);
}

const struct limit_set LIMIT_SET = {LIMIT_SET_NAME, LANES, run};
