/* SPDX-License-Identifier: MIT */
#include "limit_pack.h"
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

static float *pair_number(const struct packed *packed, int32_t target, int32_t slot, int32_t k)
{
    return number_of(packed, packed->data.pairs, target, LIMIT_COMPONENTS * packed->data.slots,
                     slot * LIMIT_COMPONENTS + k);
}

/* Neighbours beyond the room are left out; those missing sit on the target, without volume. The
 * number packed is returned. */
static int32_t pack_target(struct packed *packed, const struct probe *probe, int32_t particle,
                           int32_t target)
{
    const float *x = probe->positions[particle], *field = probe->fields[particle];
    const float nobody[4] = {x[0], x[1], x[2], 0};
    const int64_t *offsets = probe->lists.offsets + particle;
    const int64_t pairs = offsets[1] - offsets[0];
    for (int32_t k = 0; k < 3; ++k) {
        *number_of(packed, packed->data.own, target, LIMIT_OWN, k) = x[k];
        *number_of(packed, packed->data.own, target, LIMIT_OWN, 3 + k) = field[k];
    }
    for (int32_t slot = 0; slot < packed->data.slots; ++slot) {
        const int32_t j = slot < pairs ? probe->lists.indices[offsets[0] + slot] : particle;
        const float *position = slot < pairs ? probe->positions[j] : nobody;
        for (int32_t k = 0; k < LIMIT_COMPONENTS; ++k) /* x y z V a b c */
            *pair_number(packed, target, slot, k) = k < 4 ? position[k] : probe->fields[j][k - 4];
    }
    return pairs < packed->data.slots ? (int32_t)pairs : packed->data.slots;
}

/* ---- The reference --------------------------------------------------------------------------- */

static void add_moments(const struct packed *packed, int32_t target, int32_t slot, double m[3][3])
{
    double x[3];
    for (int32_t k = 0; k < 3; ++k)
        x[k] = (double)*number_of(packed, packed->data.own, target, LIMIT_OWN, k) -
               (double)*pair_number(packed, target, slot, k);
    const double q = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double weight = q >= 1 ? 0 : q < 0.5 ? 2 - 3 * q : (1 - q) * (1 - q) / q;
    for (int k = 0; k < 9; ++k)
        m[k / 3][k % 3] +=
            weight * (double)*pair_number(packed, target, slot, 3) * x[k / 3] * x[k % 3];
}

/* By cofactors, of which those of rows shifted by one and two carry their signs. */
static double cofactor(double a[3][3], int i, int k)
{
    return a[(i + 1) % 3][(k + 1) % 3] * a[(i + 2) % 3][(k + 2) % 3] -
           a[(i + 1) % 3][(k + 2) % 3] * a[(i + 2) % 3][(k + 1) % 3];
}

/* The field is linear, and J what it is whatever the pairs. */
static void make_reference(struct packed *packed, int32_t target)
{
    static const double gradient[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2};
    double m[3][3] = {{0}}, determinant = 0;
    double *next = packed->reference[target];
    for (int32_t slot = 0; slot < packed->data.slots; ++slot)
        add_moments(packed, target, slot, m);
    for (int k = 0; k < 3; ++k)
        determinant += m[0][k] * cofactor(m, 0, k);
    for (int a = 0, k = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b, ++k) {
            *next = cofactor(m, a, b) / determinant;
            *number_of(packed, packed->data.corrections, target, 6, k) = (float)*next++;
        }
    memcpy(next, gradient, sizeof gradient);
}

/* ---- All of it ------------------------------------------------------------------------------- */

struct packed packed_create(const struct limit_set *set, const struct probe *probe)
{
    const int32_t count = probe->count;
    const int64_t *offsets = probe->lists.offsets;
    const int32_t slots = (int32_t)ceil(probe_pairs(probe) / set->lanes) * set->lanes;
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
        while ((double)(offsets[particle + 1] - offsets[particle]) < probe_pairs(probe))
            particle = (particle + 1) % count; /* at a surface */
        packed.pairs += (double)pack_target(&packed, probe, particle, target) / LIMIT_TARGETS;
        make_reference(&packed, target);
    }
    return packed;
}

static double deviation(const struct packed *packed, int32_t target, int first, int count)
{
    double difference = 0, size = 0;
    for (int k = first; k < first + count; ++k) {
        const double expected = packed->reference[target][k],
                     d = expected -
                         (double)*number_of(packed, packed->data.results, target, LIMIT_SUMS, k);
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
            most = numbers_larger(most, deviation(packed, target, 0, 6));
        if (work != LIMIT_MATRICES)
            most = numbers_larger(most, deviation(packed, target, 6, 9));
    }
    return most;
}
