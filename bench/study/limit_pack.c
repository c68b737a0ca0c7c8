/* SPDX-License-Identifier: MIT */
#include "limit_pack.h"
#include "lattice.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CACHE_LINE = 64 };

static const double pi = 3.14159265358979323846;

/* Arrays one behind the other, each on a cache line of its own. */
static float *take(float **next, int32_t count)
{
    const int32_t line = CACHE_LINE / (int32_t)sizeof(float);
    float *array = *next;
    *next += (count + line - 1) / line * line;
    return array;
}

static void lay_out(struct packed *packed, int32_t slots)
{
    const int32_t pair_numbers = LIMIT_TARGETS * LIMIT_COMPONENTS * slots;
    const int32_t width = LIMIT_SUMS * LIMIT_LANES_MOST;
    const size_t total = (size_t)(2 * pair_numbers + LIMIT_LANES_MOST * slots + 64 * width);
    packed->memory = aligned_alloc(CACHE_LINE, total * sizeof(float));
    if (!packed->memory) {
        fprintf(stderr, "sphgrad-bench: out of memory\n");
        exit(EXIT_FAILURE);
    }
    for (size_t k = 0; k < total; ++k)
        packed->memory[k] = 0;
    float *next = packed->memory;
    packed->data = (struct limit_data){.slots = slots,
                                       .by_target = take(&next, pair_numbers),
                                       .by_lane = take(&next, pair_numbers),
                                       .own = take(&next, LIMIT_TARGETS * LIMIT_OWN),
                                       .own_by_lane = take(&next, LIMIT_TARGETS * LIMIT_OWN),
                                       .corrections = take(&next, LIMIT_TARGETS * 6),
                                       .weights = take(&next, slots * LIMIT_LANES_MOST),
                                       .sums = take(&next, LIMIT_LANES_MOST * width),
                                       .results = take(&next, LIMIT_TARGETS * LIMIT_SUMS)};
    packed->kilobytes = 4e-3 * (pair_numbers + slots * packed->lanes);
}

/* v = (-y, x, 2z) */
static void describe(const struct numbers *positions, int32_t particle, double numbers[LIMIT_OWN])
{
    for (int axis = 0; axis < 3; ++axis)
        numbers[axis] = numbers_get(positions, particle, axis);
    numbers[3] = -numbers[1];
    numbers[4] = numbers[0];
    numbers[5] = 2 * numbers[2];
}

static void set_own(struct packed *packed, int32_t target, const double numbers[LIMIT_OWN])
{
    const int32_t group = target / packed->lanes, lane = target % packed->lanes;
    for (int32_t k = 0; k < LIMIT_OWN; ++k) {
        packed->data.own[target * LIMIT_OWN + k] = (float)numbers[k];
        packed->data.own_by_lane[(group * LIMIT_OWN + k) * packed->lanes + lane] =
            (float)numbers[k];
    }
}

static void set_pair(struct packed *packed, int32_t target, int32_t slot, double volume,
                     const double numbers[LIMIT_OWN])
{
    const int32_t slots = packed->data.slots, lanes = packed->lanes;
    const int32_t group = target / lanes, lane = target % lanes;
    const double components[LIMIT_COMPONENTS] = {numbers[0], numbers[1], numbers[2], volume,
                                                 numbers[3], numbers[4], numbers[5]};
    for (int32_t k = 0; k < LIMIT_COMPONENTS; ++k) {
        packed->data.by_target[(target * LIMIT_COMPONENTS + k) * slots + slot] =
            (float)components[k];
        packed->data.by_lane[((group * slots + slot) * LIMIT_COMPONENTS + k) * lanes + lane] =
            (float)components[k];
    }
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Neighbours beyond the room are left out; those missing sit on the target, without volume. The
 * number packed is returned. */
static int32_t pack_target(struct packed *packed, const struct numbers *positions, int32_t particle,
                           int32_t target, double volume)
{
    double own[LIMIT_OWN], other[LIMIT_OWN];
    int32_t count = 0;
    describe(positions, particle, own);
    set_own(packed, target, own);
    for (int32_t j = 0; j < positions->count && count < packed->data.slots; ++j) {
        describe(positions, j, other);
        if (j != particle && distance(own, other) < 1)
            set_pair(packed, target, count++, volume, other);
    }
    for (int32_t slot = count; slot < packed->data.slots; ++slot)
        set_pair(packed, target, slot, 0, own);
    return count;
}

/* Of the middle of the lattice, where neighbourhoods are full. */
static int32_t middle_particle(int32_t margin, int32_t side, int32_t target)
{
    const int32_t x = margin + target % 4, y = margin + target / 4 % 4, z = margin + target / 16;
    return (z * side + y) * side + x;
}

static double weight(double q)
{
    if (q >= 1)
        return 0;
    return q < 0.5 ? 2 - 3 * q : (1 - q) * (1 - q) / q;
}

static void add_reference(const float *p, int32_t slots, const double own[LIMIT_OWN],
                          double sums[LIMIT_SUMS])
{
    double x[3], field[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = own[k] - (double)p[k * slots];
        field[k] = own[3 + k] - (double)p[(4 + k) * slots];
    }
    const double q = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double g = weight(q) * (double)p[3 * slots];
    for (int a = 0, k = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b)
            sums[k++] += g * x[a] * x[b];
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            sums[6 + 3 * a + b] += g * field[a] * x[b];
}

static void invert(const double a[6], double c[6])
{
    const double cofactors[6] = {a[3] * a[5] - a[4] * a[4], a[2] * a[4] - a[1] * a[5],
                                 a[1] * a[4] - a[2] * a[3], a[0] * a[5] - a[2] * a[2],
                                 a[1] * a[2] - a[0] * a[4], a[0] * a[3] - a[1] * a[1]};
    const double determinant = a[0] * cofactors[0] + a[1] * cofactors[1] + a[2] * cofactors[2];
    for (int k = 0; k < 6; ++k)
        c[k] = cofactors[k] / determinant;
}

static void make_reference(struct packed *packed, int32_t target)
{
    const int32_t slots = packed->data.slots, lanes = packed->lanes;
    double own[LIMIT_OWN], sums[LIMIT_SUMS] = {0};
    double *reference = packed->reference + target * LIMIT_SUMS;
    for (int k = 0; k < LIMIT_OWN; ++k)
        own[k] = (double)packed->data.own[target * LIMIT_OWN + k];
    for (int32_t slot = 0; slot < slots; ++slot)
        add_reference(packed->data.by_target + target * LIMIT_COMPONENTS * slots + slot, slots, own,
                      sums);
    invert(sums, reference);
    static const int full[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            for (int k = 0; k < 3; ++k)
                reference[6 + 3 * a + b] += sums[6 + 3 * a + k] * reference[full[k][b]];
    for (int k = 0; k < 6; ++k)
        packed->data.corrections[(target / lanes * 6 + k) * lanes + target % lanes] =
            (float)reference[k];
}

struct packed packed_create(const struct limit_set *set, double support, double jitter,
                            double mean_pairs)
{
    const int32_t margin = (int32_t)ceil(support) + 1, side = 2 * margin + 4;
    const struct lattice lattice = {
        .dimension = 3, .side = side, .spacing = 1 / support, .jitter = jitter};
    const double volume = 48 / pi / (support * support * support); /* 6 sigma V / H^3 */
    struct numbers positions = numbers_create(SPHG_F32, lattice_count(&lattice), 3);
    struct packed packed = {.lanes = set->lanes};
    int32_t total = 0;
    lattice_fill(&lattice, &positions);
    lay_out(&packed, (int32_t)ceil(mean_pairs / set->lanes) * set->lanes);
    packed.reference = allocate_or_exit(LIMIT_TARGETS * LIMIT_SUMS, sizeof(double));
    for (int32_t target = 0; target < LIMIT_TARGETS; ++target) {
        total +=
            pack_target(&packed, &positions, middle_particle(margin, side, target), target, volume);
        make_reference(&packed, target);
    }
    packed.pairs = (double)total / LIMIT_TARGETS;
    numbers_destroy(&positions);
    return packed;
}

void packed_destroy(struct packed *packed)
{
    free(packed->memory);
    free(packed->reference);
    *packed = (struct packed){0};
}

static double relative_difference(const struct packed *packed, int32_t target, int first, int count)
{
    const int32_t lanes = packed->lanes;
    const double *reference = packed->reference + target * LIMIT_SUMS;
    const float *results = packed->data.results + target / lanes * LIMIT_SUMS * lanes;
    double difference = 0, size = 0;
    for (int k = first; k < first + count; ++k) {
        const double d = (double)results[k * lanes + target % lanes] - reference[k];
        difference += d * d;
        size += reference[k] * reference[k];
    }
    return sqrt(difference / size);
}

double packed_deviation(const struct packed *packed, enum limit_work work)
{
    double most = 0;
    for (int32_t target = 0; target < LIMIT_TARGETS; ++target) {
        const double c = work == LIMIT_GRADIENT ? 0 : relative_difference(packed, target, 0, 6);
        const double j = work == LIMIT_MATRICES ? 0 : relative_difference(packed, target, 6, 9);
        most = c <= most ? most : c; /* NaN stays */
        most = j <= most ? most : j;
    }
    return most;
}
