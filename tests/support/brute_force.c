/* SPDX-License-Identifier: MIT */
#include "brute_force.h"
#include "setup.h"
#include <float.h>
#include <math.h>
#include <string.h>

scene scene_empty(const test_case *test, int count)
{
    scene particles = {0};
    particles.dimension = test->dimension;
    particles.is_double = test->precision != TEST_F32;
    particles.precision = test_field_type(test);
    particles.source_count = particles.target_count = count;
    particles.sources = test_memory((size_t)count * 3 * sizeof(double));
    return particles;
}

double scene_rounded(const scene *particles, double x)
{
    return particles->is_double ? x : (double)(float)x;
}

scene scene_of_cloud(const test_case *test, const cloud *points)
{
    scene particles = {0};
    particles.dimension = points->dimension;
    particles.is_double = test->precision != TEST_F32;
    particles.precision = test_field_type(test);
    particles.source_count = particles.target_count = points->count;
    particles.sources = points->x;
    for (int k = 0; k < points->count * points->dimension && !particles.is_double; ++k)
        points->x[k] = (double)(float)points->x[k];
    return particles;
}

static sphg_view numbers_of(const scene *particles, int count, int width, const double *x)
{
    const sphg_type type = particles->is_double ? SPHG_F64 : SPHG_F32;
    const setup_array array = setup_numbers(type, count, width, x);
    return setup_view(&array);
}

static sphg_view positions_of(const scene *particles, int count, const double *x)
{
    return numbers_of(particles, count, particles->dimension, x);
}

sphg_geometry scene_geometry(const scene *particles)
{
    sphg_geometry geometry = {0};
    geometry.sources = positions_of(particles, particles->source_count, particles->sources);
    if (particles->targets)
        geometry.targets = positions_of(particles, particles->target_count, particles->targets);
    geometry.source_count = particles->source_count;
    geometry.target_count = particles->target_count;
    geometry.precision = particles->precision;
    geometry.list_free = particles->list_free;
    geometry.skin = particles->skin;
    memcpy(geometry.period, particles->period, sizeof geometry.period);
    if (particles->support)
        geometry.source_support =
            numbers_of(particles, particles->source_count, 1, particles->support);
    if (particles->target_support)
        geometry.target_support =
            numbers_of(particles, particles->target_count, 1, particles->target_support);
    geometry.mutual = particles->mutual;
    return geometry;
}

/* Floats and doubles are rounded as written: the predicate decides by single bits. */
_Static_assert(FLT_EVAL_METHOD == 0, "extended precision would decide otherwise");

static double rounded(const scene *particles, double x)
{
    return particles->is_double ? x : (double)(float)x;
}

/* A coordinate along a periodic axis, taken into the box where it is too far out to be told from
 * its neighbours within 2^-8 H. */
static double boxed(const scene *particles, double x, int axis, double support_radius)
{
    const double period = rounded(particles, particles->period[axis]);
    const double coarse = support_radius * (particles->is_double ? 0x1p45 : 0x1p16);
    return period > 0 && fabs(x) > fmax(coarse, period) ? fmod(x, period) : x;
}

/* The difference of two coordinates, shifted by whole periods to the nearest image. A sum of two
 * floats that is rounded to double first and then to float is the one that is rounded once, since
 * 53 >= 2 * 24 + 2. */
static double separation(const scene *particles, double a, double b, int axis)
{
    const double period = rounded(particles, particles->period[axis]);
    const double difference = rounded(particles, a - b);
    double best = difference;
    const double nearest = period > 0 ? -nearbyint(difference / period) : 0;
    for (int k = -1; k <= 1 && period > 0; ++k) {
        const double shift = rounded(particles, (nearest + k) * period);
        const double image = rounded(particles, difference + shift);
        if (fabs(image) < fabs(best))
            best = image;
    }
    return best;
}

static int is_near_single(int d, const double *difference, float support_radius)
{
    float sum = 0;
    for (int k = 0; k < d; ++k) {
        const float square = (float)difference[k] * (float)difference[k];
        sum = sum + square;
    }
    return sum < support_radius * support_radius;
}

static int is_near_double(int d, const double *difference, double support_radius)
{
    double sum = 0;
    for (int k = 0; k < d; ++k)
        sum = sum + difference[k] * difference[k];
    return sum < support_radius * support_radius;
}

/* The radius that decides about a pair. */
static double radius_of(const scene *particles, int i, int j, double support_radius)
{
    const double *targets = particles->targets ? particles->target_support : particles->support;
    if (!targets || !particles->support)
        return support_radius;
    return particles->mutual ? fmax(targets[i], particles->support[j]) : targets[i];
}

static int is_neighbour(const scene *particles, int i, int j, double support_radius)
{
    const int d = particles->dimension;
    const double *target = (particles->targets ? particles->targets : particles->sources) + i * d;
    const double *source = particles->sources + j * d;
    const double radius = radius_of(particles, i, j, support_radius);
    const double far = radius < 1e18 ? 1.5 * radius : INFINITY; /* whatever rounding does */
    double difference[3];
    if (!particles->targets && i == j)
        return 0;
    for (int k = 0; k < d; ++k) {
        difference[k] = separation(particles, boxed(particles, target[k], k, support_radius),
                                   boxed(particles, source[k], k, support_radius), k);
        if (fabs(difference[k]) > far)
            return 0;
    }
    return particles->is_double ? is_near_double(d, difference, radius)
                                : is_near_single(d, difference, (float)radius);
}

/* The farthest that any radius and its rounding can reach. */
static double reach_of(const scene *particles, double support_radius)
{
    double most = support_radius;
    for (int j = 0; j < particles->source_count && particles->support; ++j)
        most = fmax(most, particles->support[j]);
    for (int i = 0; i < particles->target_count && particles->target_support; ++i)
        most = fmax(most, particles->target_support[i]);
    return most < 1e18 ? 1.5 * most : INFINITY;
}

/* The coordinates along each axis one after the other, for the loop that rules out most pairs. */
static double *columns_of(const scene *particles)
{
    const int d = particles->dimension, count = particles->source_count;
    double *columns = test_memory((size_t)count * (size_t)d * sizeof *columns);
    for (int k = 0; k < d * count; ++k)
        columns[k % d * count + k / d] = particles->sources[k];
    return columns;
}

static void rule_out(int count, double target, const double *restrict sources, double reach,
                     char *restrict near)
{
    for (int j = 0; j < count; ++j)
        near[j] &= (char)!(fabs(target - sources[j]) > reach);
}

/* Sources that are not beyond all reach along an axis without period. */
static void mark_candidates(const scene *particles, int i, const double *columns, double reach,
                            char *near)
{
    const int d = particles->dimension, count = particles->source_count;
    const double *target = (particles->targets ? particles->targets : particles->sources) + i * d;
    memset(near, 1, (size_t)count);
    for (int k = 0; k < d; ++k)
        if (!(particles->period[k] > 0))
            rule_out(count, target[k], columns + k * count, reach, near);
}

rows rows_by_brute_force(const scene *particles, double support_radius)
{
    const int targets = particles->target_count, sources = particles->source_count;
    const double *columns = columns_of(particles), reach = reach_of(particles, support_radius);
    char *near = test_memory((size_t)targets * (size_t)sources);
    rows found = {targets, test_memory(((size_t)targets + 1) * sizeof(int64_t)), NULL};
    for (int i = 0; i < targets; ++i) {
        char *row = near + (size_t)i * (size_t)sources;
        found.offsets[i + 1] = found.offsets[i];
        mark_candidates(particles, i, columns, reach, row);
        for (int j = 0; j < sources; ++j)
            if (row[j])
                found.offsets[i + 1] += row[j] =
                    (char)is_neighbour(particles, i, j, support_radius);
    }
    found.indices = test_memory((size_t)found.offsets[targets] * sizeof(int32_t));
    int64_t next = 0;
    for (int i = 0; i < targets; ++i)
        for (int j = 0; j < sources; ++j)
            if (near[(size_t)i * (size_t)sources + (size_t)j])
                found.indices[next++] = j;
    return found;
}

static int32_t selected_count(sphg_context *context, const sphg_neighbors *neighbors,
                              const sphg_subset *subset)
{
    sphg_neighbors_info info = {0};
    SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
    if (!subset)
        return info.target_count;
    int32_t count = 0;
    for (int32_t k = subset->begin; k < subset->end; ++k)
        count += !subset->mask || subset->mask[subset->indices ? subset->indices[k] : k];
    return count;
}

rows rows_listed(sphg_context *context, const sphg_neighbors *neighbors, const sphg_scheme *scheme,
                 const sphg_subset *subset)
{
    const int32_t count = selected_count(context, neighbors, subset);
    sphg_scheme plain = *scheme; /* the pairs alone: classic methods list i itself as well */
    plain.method = SPHG_PLAIN;
    rows found = {count, test_memory(((size_t)count + 1) * sizeof(int64_t)), NULL};
    sphg_sources sources = {0};
    sphg_pairs pairs = {0};
    sources.neighbors = neighbors;
    pairs.offsets = found.offsets;
    SETUP_OK(context,
             sphg_pair_gradients(context, &plain, &sources, subset, sphg_absent(), &pairs));
    assert_int_equal(found.offsets[0], 0);
    assert_int_equal(found.offsets[count], pairs.count);
    found.indices = test_memory((size_t)pairs.count * sizeof(int32_t));
    pairs.indices = found.indices;
    pairs.capacity = pairs.count;
    SETUP_OK(context,
             sphg_pair_gradients(context, &plain, &sources, subset, sphg_absent(), &pairs));
    return found;
}

void rows_require_equal(const rows *found, const rows *expected, const char *where)
{
    TEST_REQUIRE(found->count == expected->count, "%s: %d rows, not %d", where, found->count,
                 expected->count);
    for (int32_t i = 0; i < expected->count; ++i) {
        const int64_t length = expected->offsets[i + 1] - expected->offsets[i];
        const int64_t listed = found->offsets[i + 1] - found->offsets[i];
        TEST_REQUIRE(listed == length, "%s: row %d has %lld neighbours, not %lld", where, i,
                     (long long)listed, (long long)length);
        for (int64_t k = 0; k < length; ++k) {
            const int32_t a = found->indices[found->offsets[i] + k];
            const int32_t b = expected->indices[expected->offsets[i] + k];
            TEST_REQUIRE(a == b, "%s: row %d lists %d, not %d", where, i, a, b);
        }
    }
}

static void destroy_neighbors(void *neighbors)
{
    sphg_neighbors_destroy(neighbors);
}

sphg_neighbors *brute_force_neighbors(sphg_context *context)
{
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    test_at_end(destroy_neighbors, neighbors);
    return neighbors;
}

int64_t rows_require_search_exact(sphg_context *context, sphg_neighbors *neighbors,
                                  const scene *particles, double support_radius, const char *where)
{
    sphg_scheme scheme = {0};
    scheme.dimension = particles->dimension;
    scheme.support_radius = support_radius;
    const sphg_geometry geometry = scene_geometry(particles);
    int32_t rebuild = -1;
    SETUP_OK(context,
             sphg_neighbors_would_rebuild(context, neighbors, &scheme, &geometry, &rebuild));
    SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
    const rows expected = rows_by_brute_force(particles, support_radius);
    const rows found = rows_listed(context, neighbors, &scheme, NULL);
    rows_require_equal(&found, &expected, where);
    sphg_neighbors_info info = {0};
    SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
    TEST_REQUIRE(info.rebuilt == rebuild, "%s: rebuilt %d, foretold %d", where, (int)info.rebuilt,
                 (int)rebuild);
    const int64_t pairs = expected.offsets[expected.count];
    TEST_REQUIRE(geometry.list_free || geometry.skin > 0 || info.pairs == pairs,
                 "%s: says %lld pairs, not %lld", where, (long long)info.pairs, (long long)pairs);
    return pairs;
}
