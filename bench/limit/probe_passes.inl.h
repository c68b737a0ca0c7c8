/* SPDX-License-Identifier: MIT */
/* The passes of probe.h. Parameters: VECTOR_BYTES (16 or 32), PROBE_PASSES. */
#include "probe.h"
#include "vector.inl.h"

typedef float row __attribute__((vector_size(16), may_alias));

INLINE row load_row(const float *p)
{
    return *(const row *)p;
}

/* Row k of the vector's first half, and of its second. */
INLINE vec two_rows(const float (*rows)[4], const int32_t *indices, int k)
{
#if VECTOR_BYTES == 32
    return (vec)_mm256_set_m128((__m128)load_row(rows[indices[k + 4]]),
                                (__m128)load_row(rows[indices[k]]));
#else
    return load_row(rows[indices[k]]);
#endif
}

/* As many rows as lanes, turned into one vector a column. */
INLINE void load_columns(const float (*rows)[4], const int32_t *indices, vec columns[4])
{
    const vec a = two_rows(rows, indices, 0), b = two_rows(rows, indices, 1),
              c = two_rows(rows, indices, 2), d = two_rows(rows, indices, 3);
#if VECTOR_BYTES == 32
    const vec p = SHUFFLED(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
              q = SHUFFLED(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
              r = SHUFFLED(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
              s = SHUFFLED(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    columns[0] = SHUFFLED(p, r, 0, 1, 8, 9, 4, 5, 12, 13);
    columns[1] = SHUFFLED(p, r, 2, 3, 10, 11, 6, 7, 14, 15);
    columns[2] = SHUFFLED(q, s, 0, 1, 8, 9, 4, 5, 12, 13);
    columns[3] = SHUFFLED(q, s, 2, 3, 10, 11, 6, 7, 14, 15);
#else
    const vec p = SHUFFLED(a, b, 0, 4, 1, 5), q = SHUFFLED(a, b, 2, 6, 3, 7),
              r = SHUFFLED(c, d, 0, 4, 1, 5), s = SHUFFLED(c, d, 2, 6, 3, 7);
    columns[0] = SHUFFLED(p, r, 0, 1, 4, 5);
    columns[1] = SHUFFLED(p, r, 2, 3, 6, 7);
    columns[2] = SHUFFLED(q, s, 0, 1, 4, 5);
    columns[3] = SHUFFLED(q, s, 2, 3, 6, 7);
#endif
}

/* The lanes of v[k] summed into lane k, by halving: at each level a lane whose number has the
 * level's bit takes over from the second of two vectors, the others from the first. */
INLINE vec sum_lanes(const vec v[LANES])
{
#if VECTOR_BYTES == 32
    vec f[4];
    for (int k = 0; k < 4; ++k)
        f[k] = SHUFFLED(v[k], v[k + 4], 0, 1, 2, 3, 12, 13, 14, 15) +
               SHUFFLED(v[k], v[k + 4], 4, 5, 6, 7, 8, 9, 10, 11);
    vec g[2];
    for (int k = 0; k < 2; ++k)
        g[k] = SHUFFLED(f[k], f[k + 2], 0, 1, 10, 11, 4, 5, 14, 15) +
               SHUFFLED(f[k], f[k + 2], 2, 3, 8, 9, 6, 7, 12, 13);
    return SHUFFLED(g[0], g[1], 0, 9, 2, 11, 4, 13, 6, 15) +
           SHUFFLED(g[0], g[1], 1, 8, 3, 10, 5, 12, 7, 14);
#else
    vec g[2];
    for (int k = 0; k < 2; ++k)
        g[k] = SHUFFLED(v[k], v[k + 2], 0, 1, 6, 7) + SHUFFLED(v[k], v[k + 2], 2, 3, 4, 5);
    return SHUFFLED(g[0], g[1], 0, 5, 2, 7) + SHUFFLED(g[0], g[1], 1, 4, 3, 6);
#endif
}

/* x_ij and the weight of LANES pairs, of which the first `left` count. */
INLINE vec weigh(const struct probe *probe, const int32_t *indices, int64_t left, const vec own[3],
                 vec x[3])
{
    _Alignas(VECTOR_BYTES) static const int32_t numbers[PROBE_LANES_MOST] = {0, 1, 2, 3,
                                                                             4, 5, 6, 7};
    vec columns[4];
    load_columns((const float(*)[4])probe->positions, indices, columns);
    const mask lanes = *(const mask *)(const void *)numbers;
    const mask counts = lanes < (int32_t)(left < LANES ? left : LANES);
    for (int axis = 0; axis < 3; ++axis)
        x[axis] = own[axis] - columns[axis];
    const vec q2 = x[0] * x[0] + (x[1] * x[1] + (x[2] * x[2] + 1e-12f));
    return spline_weight(q2, 1) * (vec)(counts & (mask)columns[3]);
}

INLINE void sum_moments(const struct probe *probe, int32_t i, vec sums[6])
{
    const float *p = probe->positions[i];
    const vec own[3] = {splat(p[0]), splat(p[1]), splat(p[2])};
    const int64_t end = probe->lists.offsets[i + 1];
    vec xx = {0}, xy = {0}, xz = {0}, yy = {0}, yz = {0}, zz = {0};
    for (int64_t k = probe->lists.offsets[i]; k < end; k += LANES) {
        vec x[3];
        const vec g = weigh(probe, probe->lists.indices + k, end - k, own, x);
        const vec gx = g * x[0], gy = g * x[1], gz = g * x[2];
        xx += gx * x[0];
        xy += gx * x[1];
        xz += gx * x[2];
        yy += gy * x[1];
        yz += gy * x[2];
        zz += gz * x[2];
    }
    sums[0] = xx, sums[1] = xy, sums[2] = xz, sums[3] = yy, sums[4] = yz, sums[5] = zz;
}

static void run_matrices(const struct probe *probe, int32_t begin, int32_t end)
{
    const int32_t count = probe->count;
    for (int32_t first = begin; first < end; first += LANES) {
        vec parts[6][LANES], sums[6], correction[6];
        for (int lane = 0; lane < LANES; ++lane) {
            vec own_sums[6];
            sum_moments(probe, first + lane < count ? first + lane : count - 1, own_sums);
            for (int k = 0; k < 6; ++k)
                parts[k][lane] = own_sums[k];
        }
        for (int k = 0; k < 6; ++k)
            sums[k] = sum_lanes(parts[k]);
        invert_symmetric(sums, correction);
        for (int k = 0; k < 6; ++k)
            store(probe->corrections + (int64_t)first * 6 + k * LANES, correction[k]);
    }
}

INLINE void sum_field(const struct probe *probe, int32_t i, vec sums[9])
{
    const float *p = probe->positions[i], *f = probe->fields[i];
    const vec own[3] = {splat(p[0]), splat(p[1]), splat(p[2])},
              own_field[3] = {splat(f[0]), splat(f[1]), splat(f[2])};
    const int64_t end = probe->lists.offsets[i + 1];
    for (int k = 0; k < 9; ++k)
        sums[k] = (vec){0};
    for (int64_t k = probe->lists.offsets[i]; k < end; k += LANES) {
        vec x[3], field[4];
        const vec g = weigh(probe, probe->lists.indices + k, end - k, own, x);
        load_columns((const float(*)[4])probe->fields, probe->lists.indices + k, field);
        for (int a = 0; a < 3; ++a) {
            const vec weighted = g * (own_field[a] - field[a]);
            for (int b = 0; b < 3; ++b)
                sums[3 * a + b] += weighted * x[b];
        }
    }
}

static void run_gradient(const struct probe *probe, int32_t begin, int32_t end)
{
    const int32_t count = probe->count;
    for (int32_t first = begin; first < end; first += LANES) {
        vec parts[9][LANES], sums[9], correction[6], jacobian[9];
        for (int lane = 0; lane < LANES; ++lane) {
            vec own_sums[9];
            sum_field(probe, first + lane < count ? first + lane : count - 1, own_sums);
            for (int k = 0; k < 9; ++k)
                parts[k][lane] = own_sums[k];
        }
        for (int k = 0; k < 9; ++k)
            sums[k] = sum_lanes(parts[k]);
        for (int k = 0; k < 6; ++k)
            correction[k] = load(probe->corrections + (int64_t)first * 6 + k * LANES);
        apply_symmetric(sums, correction, jacobian);
        for (int k = 0; k < 9; ++k)
            store(probe->jacobians + (int64_t)first * 9 + k * LANES, jacobian[k]);
    }
}

probe_pass *const PROBE_PASSES[PROBE_WORKS] = {run_matrices, run_gradient};
