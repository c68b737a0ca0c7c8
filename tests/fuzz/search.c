/* SPDX-License-Identifier: MIT */
/* The search finds the pairs of brute force, or refuses, whatever the positions. */
#include "fuzz.h"

enum { MOST = 40 }; /* more than two batches of targets that share candidates, and than a group */

typedef struct cloud {
    sphg_type type;
    int dimension, sources, targets, own_targets; /* own: they are no sources */
    float single[2][MOST * 3];
    double full[2][MOST * 3];
    float single_radii[2][MOST];
    double full_radii[2][MOST];
    double largest; /* radius of those of their own; 0: one for all */
    sphg_scheme scheme;
    sphg_geometry geometry;
} cloud;

static void *memory_of(cloud *made, int side)
{
    return made->type == SPHG_F64 ? (void *)made->full[side] : (void *)made->single[side];
}

static void *radii_of(cloud *made, int side)
{
    return made->type == SPHG_F64 ? (void *)made->full_radii[side]
                                  : (void *)made->single_radii[side];
}

static double radius_of(cloud *on, int side, int item)
{
    return on->largest > 0 ? fuzz_get(on->type, radii_of(on, side), item)
                           : on->scheme.support_radius;
}

/* Octaves apart, now and then anything at all. */
static void take_radii(fuzz_bytes *from, cloud *made, int side, int count)
{
    for (int k = 0; k < count; ++k) {
        const int kind = fuzz_byte(from);
        fuzz_put(made->type, radii_of(made, side), k,
                 kind == 255 ? fuzz_real(from) : ldexp(1 + kind % 16 / 16., -(kind / 16)));
        made->largest = fmax(made->largest, fuzz_get(made->type, radii_of(made, side), k));
    }
}

static void take_radii_of_cloud(fuzz_bytes *from, cloud *made)
{
    const int flags = fuzz_byte(from);
    if (!(flags & 1))
        return;
    take_radii(from, made, 0, made->sources);
    if (made->own_targets)
        take_radii(from, made, 1, made->targets);
    made->geometry.source_support = fuzz_view(made->type, radii_of(made, 0), 1);
    if (made->own_targets)
        made->geometry.target_support = fuzz_view(made->type, radii_of(made, 1), 1);
    made->geometry.mutual = flags >> 1 & 1;
}

static void take_positions(fuzz_bytes *from, cloud *made, int side, int count, int tame)
{
    for (int k = 0; k < count * made->dimension; ++k)
        fuzz_put(made->type, memory_of(made, side), k, tame ? fuzz_tame(from) : fuzz_real(from));
}

static void take_cloud(fuzz_bytes *from, cloud *made)
{
    const int flags = fuzz_byte(from);
    made->type = flags & 1 ? SPHG_F64 : SPHG_F32;
    made->dimension = flags & 2 ? 3 : 2;
    made->own_targets = (flags & 4) != 0;
    made->sources = fuzz_below(from, MOST + 1);
    made->targets = fuzz_below(from, (made->own_targets ? MOST : made->sources) + 1);
    made->scheme.dimension = made->dimension;
    made->scheme.support_radius = flags & 8 ? fabs(fuzz_real(from)) : (1 + fuzz_byte(from)) / 32.;
    const int tame = (flags & 16) != 0;
    for (int a = 0; a < made->dimension && tame; ++a)
        made->geometry.period[a] = fuzz_below(from, 3) ? 0 : fuzz_byte(from) / 4.;
    made->geometry.list_free = (flags & 32) != 0;
    made->geometry.skin = flags & 64 ? fuzz_byte(from) / 64. : 0;
    take_positions(from, made, 0, made->sources, tame);
    if (made->own_targets)
        take_positions(from, made, 1, made->targets, tame);
    made->geometry.sources = fuzz_view(made->type, memory_of(made, 0), made->dimension);
    if (made->own_targets)
        made->geometry.targets = fuzz_view(made->type, memory_of(made, 1), made->dimension);
    made->geometry.source_count = made->sources;
    made->geometry.target_count = made->targets;
    take_radii_of_cloud(from, made);
}

/* ---- Brute force, in the arithmetic that docs/theory.md prescribes ------------------------- */

static double rounded(const cloud *on, double x)
{
    return on->type == SPHG_F64 ? x : (double)(float)x;
}

/* Taken into the box where it is rounded by more than 2^-8 H. */
static double boxed(const cloud *on, double x, int axis)
{
    const double period = on->geometry.period[axis];
    const double reach = on->largest > 0 ? on->largest : on->scheme.support_radius;
    const double coarse = reach * (on->type == SPHG_F64 ? 0x1p45 : 0x1p16);
    return period > 0 && fabs(x) > fmax(coarse, period) ? fmod(x, period) : x;
}

/* Of fl(x_i - x_j) + k period the smallest. */
static double separation(const cloud *on, double x, double other, int axis)
{
    const double period = on->geometry.period[axis];
    const double a = boxed(on, x, axis), b = boxed(on, other, axis);
    const double difference = rounded(on, a - b);
    double best = difference;
    if (!(period > 0))
        return difference;
    const double nearest = -nearbyint(difference / period);
    for (int k = -1; k <= 1; ++k) {
        const double image = rounded(on, difference + (nearest + k) * period);
        if (fabs(image) < fabs(best))
            best = image;
    }
    return best;
}

static int is_near(cloud *on, int i, int j)
{
    const int d = on->dimension;
    double sum = 0;
    if (!on->own_targets && i == j)
        return 0;
    for (int a = 0; a < d; ++a) {
        const double target = fuzz_get(on->type, memory_of(on, on->own_targets), i * d + a);
        const double x = separation(on, target, fuzz_get(on->type, memory_of(on, 0), j * d + a), a);
        sum = rounded(on, sum + rounded(on, x * x));
    }
    double reach = rounded(on, radius_of(on, on->own_targets, i));
    if (on->geometry.mutual)
        reach = fmax(reach, rounded(on, radius_of(on, 0, j)));
    return sum < rounded(on, reach * reach);
}

static void compare(cloud *on, const int64_t *offsets, const int32_t *indices)
{
    for (int i = 0; i < on->targets; ++i) {
        int64_t at = offsets[i];
        for (int32_t j = 0; j < on->sources; ++j) {
            const int is_listed = at < offsets[i + 1] && indices[at] == j;
            FUZZ_REQUIRE(is_listed == is_near(on, i, j), "pair (%d, %d): listed %d", i, (int)j,
                         is_listed);
            at += is_listed;
        }
        FUZZ_REQUIRE(at == offsets[i + 1], "row %d is too long", i);
    }
}

/* Radii that were accepted: positive and finite. */
static int are_radii(cloud *on)
{
    for (int side = 0; side <= on->own_targets && on->largest > 0; ++side)
        for (int k = 0; k < (side ? on->targets : on->sources); ++k)
            if (!(radius_of(on, side, k) > 0) || !isfinite(radius_of(on, side, k)))
                return 0;
    return 1;
}

static int is_finite(cloud *on)
{
    const int d = on->dimension;
    for (int k = 0; k < on->sources * d; ++k)
        if (!isfinite(fuzz_get(on->type, memory_of(on, 0), k)))
            return 0;
    for (int k = 0; k < on->targets * d && on->own_targets; ++k)
        if (!isfinite(fuzz_get(on->type, memory_of(on, 1), k)))
            return 0;
    return 1;
}

/* Twice: the second search may keep what the first one found. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int64_t offsets[MOST + 1];
    static int32_t indices[MOST * MOST];
    fuzz_bytes from = {data, size};
    cloud on = {.type = SPHG_F32};
    const fuzz_instance *instance = fuzz_instance_for(size);
    sphg_context *context = instance->context;
    take_cloud(&from, &on);
    for (int turn = 0; turn < 2; ++turn) {
        const sphg_result result =
            sphg_neighbors_search(context, instance->neighbors, &on.scheme, &on.geometry);
        FUZZ_REQUIRE(result == SPHG_OK || result == SPHG_ERROR_ARGUMENT ||
                         result == SPHG_ERROR_NOT_FINITE,
                     "%s", sphg_last_message(context));
        if (result)
            return 0;
        FUZZ_REQUIRE(is_finite(&on), "accepted what is not finite");
        FUZZ_REQUIRE(are_radii(&on), "accepted what is no radius");
        const sphg_sources sources = {.neighbors = instance->neighbors};
        sphg_pairs pairs = {.offsets = offsets, .indices = indices, .capacity = MOST * MOST};
        FUZZ_REQUIRE(sphg_pair_gradients(context, &on.scheme, &sources, NULL, sphg_absent(),
                                         &pairs) == SPHG_OK,
                     "%s", sphg_last_message(context));
        compare(&on, offsets, indices);
        for (int k = 0; k < on.sources * on.dimension; ++k) {
            const double x = fuzz_get(on.type, memory_of(&on, 0), k);
            const double far = on.geometry.skin > 0 ? on.geometry.skin : 1. / 16;
            fuzz_put(on.type, memory_of(&on, 0), k, x + far * (fuzz_byte(&from) % 9 - 4) / 4);
        }
    }
    return 0;
}
