/* SPDX-License-Identifier: MIT */
#include "limit_pack.h"
#include "numbers.h"
#include <math.h>
#include <string.h>

static float *floats(int32_t count)
{
    return allocate_lines((size_t)count, sizeof(float));
}

/* Number k of an array [group][k][lane] with so many numbers a target. */
static float *number_of(const struct packed *packed, float *array, int32_t target, int32_t width,
                        int32_t k)
{
    const int32_t lanes = packed->lanes;
    return array + (target / lanes * width + k) * lanes + target % lanes;
}

/* position: x y z V, field: a b c, as the probe has them. */
static void set_pair(struct packed *packed, int32_t target, int32_t slot, const float position[4],
                     const float field[4])
{
    const float components[LIMIT_COMPONENTS] = {position[0], position[1], position[2], position[3],
                                                field[0],    field[1],    field[2]};
    for (int32_t k = 0; k < LIMIT_COMPONENTS; ++k)
        *number_of(packed, packed->data.pairs, target, LIMIT_COMPONENTS * packed->data.slots,
                   slot * LIMIT_COMPONENTS + k) = components[k];
}

/* Neighbours beyond the room are left out; those missing sit on the target, without volume. The
 * number packed is returned. */
static int32_t pack_target(struct packed *packed, const struct probe_arrays *arrays,
                           int32_t particle, int32_t target)
{
    const float *x = arrays->positions[particle], *field = arrays->fields[particle];
    const float nobody[4] = {x[0], x[1], x[2], 0};
    const int32_t *indices = arrays->indices + arrays->offsets[particle];
    const int64_t pairs = arrays->offsets[particle + 1] - arrays->offsets[particle];
    for (int32_t k = 0; k < 3; ++k) {
        *number_of(packed, packed->data.own, target, LIMIT_OWN, k) = x[k];
        *number_of(packed, packed->data.own, target, LIMIT_OWN, 3 + k) = field[k];
    }
    for (int32_t slot = 0; slot < packed->data.slots; ++slot)
        set_pair(packed, target, slot, slot < pairs ? arrays->positions[indices[slot]] : nobody,
                 slot < pairs ? arrays->fields[indices[slot]] : field);
    return pairs < packed->data.slots ? (int32_t)pairs : packed->data.slots;
}

/* ---- The reference --------------------------------------------------------------------------- */

static double weight(double q)
{
    if (q >= 1)
        return 0;
    return q < 0.5 ? 2 - 3 * q : (1 - q) * (1 - q) / q;
}

static void add_reference(const struct packed *packed, int32_t target, int32_t slot,
                          double moments[3][3])
{
    double p[LIMIT_COMPONENTS], x[3];
    for (int32_t k = 0; k < LIMIT_COMPONENTS; ++k)
        p[k] =
            (double)*number_of(packed, packed->data.pairs, target,
                               LIMIT_COMPONENTS * packed->data.slots, slot * LIMIT_COMPONENTS + k);
    for (int32_t k = 0; k < 3; ++k)
        x[k] = (double)*number_of(packed, packed->data.own, target, LIMIT_OWN, k) - p[k];
    const double g = weight(sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])) * p[3];
    for (int k = 0; k < 9; ++k)
        moments[k / 3][k % 3] += g * x[k / 3] * x[k % 3];
}

/* By cofactors, of which those of rows shifted by one and two carry their signs. */
static void invert(double a[3][3], double c[3][3])
{
    double determinant = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            c[k][i] = a[(i + 1) % 3][(k + 1) % 3] * a[(i + 2) % 3][(k + 2) % 3] -
                      a[(i + 1) % 3][(k + 2) % 3] * a[(i + 2) % 3][(k + 1) % 3];
    for (int k = 0; k < 3; ++k)
        determinant += a[0][k] * c[k][0];
    for (int k = 0; k < 9; ++k)
        c[k / 3][k % 3] /= determinant;
}

/* The field is linear, and J what it is whatever the pairs. */
static void make_reference(struct packed *packed, int32_t target)
{
    static const double gradient[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2};
    double moments[3][3] = {{0}}, c[3][3];
    double *next = packed->reference[target];
    for (int32_t slot = 0; slot < packed->data.slots; ++slot)
        add_reference(packed, target, slot, moments);
    invert(moments, c);
    for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b)
            *next++ = c[a][b];
    memcpy(next, gradient, sizeof gradient);
    for (int k = 0; k < 6; ++k)
        *number_of(packed, packed->data.corrections, target, 6, k) =
            (float)packed->reference[target][k];
}

/* ---- All of it ------------------------------------------------------------------------------- */

struct packed packed_create(const struct limit_set *set, const struct probe_arrays *arrays,
                            int32_t count)
{
    const double mean_pairs = (double)arrays->offsets[count] / count;
    const int32_t slots = (int32_t)ceil(mean_pairs / set->lanes) * set->lanes;
    struct packed packed = {
        .lanes = set->lanes,
        .kilobytes = 4e-3 * (LIMIT_TARGETS * LIMIT_COMPONENTS * slots + slots * set->lanes),
        .data = {.slots = slots,
                 .pairs = floats(LIMIT_TARGETS * LIMIT_COMPONENTS * slots),
                 .own = floats(LIMIT_TARGETS * LIMIT_OWN),
                 .corrections = floats(LIMIT_TARGETS * 6),
                 .weights = floats(slots * LIMIT_LANES_MOST),
                 .sums = floats(LIMIT_SUMS * LIMIT_LANES_MOST),
                 .results = floats(LIMIT_TARGETS * LIMIT_SUMS)}};
    int32_t particle = count / 2;
    for (int32_t target = 0; target < LIMIT_TARGETS; ++target, particle = (particle + 1) % count) {
        while ((double)(arrays->offsets[particle + 1] - arrays->offsets[particle]) < mean_pairs)
            particle = (particle + 1) % count; /* at a surface */
        packed.pairs += (double)pack_target(&packed, arrays, particle, target) / LIMIT_TARGETS;
        make_reference(&packed, target);
    }
    return packed;
}

static double relative_difference(const struct packed *packed, int32_t target, int first, int count)
{
    double difference = 0, size = 0;
    for (int k = first; k < first + count; ++k) {
        const double expected = packed->reference[target][k];
        const double d =
            (double)*number_of(packed, packed->data.results, target, LIMIT_SUMS, k) - expected;
        difference += d * d;
        size += expected * expected;
    }
    return sqrt(difference / size);
}

double packed_deviation(const struct packed *packed, enum limit_work work)
{
    double most = 0;
    for (int32_t target = 0; target < LIMIT_TARGETS; ++target) {
        if (work != LIMIT_GRADIENT)
            most = numbers_larger(most, relative_difference(packed, target, 0, 6));
        if (work != LIMIT_MATRICES)
            most = numbers_larger(most, relative_difference(packed, target, 6, 9));
    }
    return most;
}
