/* SPDX-License-Identifier: MIT */
/* Domains of any extent: periodic axes, and open ones that reach as far as numbers do while memory
 * stays linear in the number of particles. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* ---- Periodic ----------------------------------------------------------------------------- */

/* In units of H, with few bits: multiples are exact in f32. */
static const double LENGTHS[] = {2, 2.015625, 2.5, 3, 3.984375, 4, 7.25, 20};

static void scatter_in_box(const scene *particles, double H, double periods_out,
                           random_state *random)
{
    const int d = particles->dimension;
    for (int k = 0; k < particles->source_count * d; ++k) {
        const double length = particles->period[k % d] > 0 ? particles->period[k % d] : 4 * H;
        const double away = nearbyint(random_between(random, -periods_out, periods_out));
        const double x = random_between(random, 0, length) + away * length;
        particles->sources[k] =
            scene_rounded(particles, random_index(random, 8) ? x : length * nearbyint(x / length));
    }
}

/* Every combination of axes, every length, inside the box and several periods out of it, with
 * faces and corners of the box occupied. */
static void check_periods(const test_case *test, double periods_out, int list_free)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(61);
    int64_t pairs = 0;
    for (int axes = 1; axes < 1 << test->dimension; ++axes)
        for (int k = 0; k < 8; ++k) {
            const double H = k % 2 ? 1 : 0.6875;
            scene particles = scene_empty(test, 110);
            particles.list_free = list_free;
            for (int axis = 0; axis < test->dimension; ++axis)
                particles.period[axis] = axes >> axis & 1 ? LENGTHS[(k + 3 * axis) % 8] * H : 0;
            scatter_in_box(&particles, H, periods_out, &random);
            const char *where =
                test_text("axes %d, periods %g %g %g, H %g", axes, particles.period[0],
                          particles.period[1], particles.period[2], H);
            pairs += rows_require_search_exact(context, neighbors, &particles, H, where);
        }
    assert_true(pairs > 1000);
}

static void periodic_boxes_have_the_pairs_of_brute_force(const test_case *test)
{
    check_periods(test, 0, 0);
    check_periods(test, 0, 1);
}

static void positions_may_lie_outside_the_box(const test_case *test)
{
    check_periods(test, 1, 0);
    check_periods(test, 6, 1);
    check_periods(test, test->precision == TEST_F32 ? 1500 : 0x1p40,
                  0); /* differences are rounded to 2^-9 H */
}

/* Periods with all their bits: images one period away, so that shifting rounds once. */
static void lengths_of_any_bits_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(67);
    for (int k = 0; k < 40; ++k) {
        scene particles = scene_empty(test, 110);
        for (int axis = 0; axis < test->dimension; ++axis)
            particles.period[axis] = scene_rounded(&particles, random_between(&random, 2, 5));
        scatter_in_box(&particles, 1, 0, &random);
        rows_require_search_exact(context, neighbors, &particles, 1, test_text("box %d", k));
    }
}

/* A box of exactly twice the reach: two particles a rounding more than half a box apart meet
 * through the other side, a rounding inside the reach. The quotient that counts boxes may round to
 * a tie. */
static void halves_of_the_smallest_box_meet_through_its_side(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    for (int k = 0; k < 200; ++k) {
        scene particles = scene_empty(test, 2);
        const double given = 1.5 + 0.5 * k / 200 + 0x1p-30;
        const double reach = particles.is_double ? given : (double)(float)given;
        memset(particles.sources, 0, 2 * (size_t)test->dimension * sizeof(double));
        particles.sources[test->dimension] =
            particles.is_double ? nextafter(reach, 9) : (double)nextafterf((float)reach, 9);
        particles.period[0] = 2 * reach;
        rows_require_search_exact(context, neighbors, &particles, reach, "half a box apart");
    }
}

/* So little below 0 that a period added rounds to the period itself: outside the box, which has no
 * cell there. */
static void positions_just_outside_the_box_have_a_cell(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(71);
    for (int k = 0; k < 8; ++k) {
        scene particles = scene_empty(test, 110);
        particles.list_free = k % 2;
        for (int axis = 0; axis < test->dimension; ++axis)
            particles.period[axis] = LENGTHS[(k + axis) % 8];
        scatter_in_box(&particles, 1, 0, &random);
        for (int i = 0; i < 110 * test->dimension; i += 7)
            particles.sources[i] = k % 4 < 2 ? -0x1p-60 : -0x1p-140;
        rows_require_search_exact(context, neighbors, &particles, 1, test_text("box %d", k));
    }
}

/* A lattice that fills the box looks the same from each of its points. */
static void periodic_lattice_has_no_boundary(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    cloud points = cloud_lattice(test->dimension, 6, 0.5);
    scene particles = scene_of_cloud(test, &points);
    for (int axis = 0; axis < test->dimension; ++axis)
        particles.period[axis] = 3;
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = 1;
    const sphg_geometry geometry = scene_geometry(&particles);
    const sphg_neighbors *neighbors = setup_search(context, &scheme, &geometry);
    const rows found = rows_listed(context, neighbors, &scheme, NULL);
    for (int32_t i = 0; i < found.count; ++i)
        assert_int_equal(found.offsets[i + 1] - found.offsets[i], test->dimension == 2 ? 8 : 26);
}

/* Targets of their own, also across the faces. */
static void periodic_targets_need_not_be_sources(const test_case *test)
{
    sphg_context *context = setup_context();
    random_state random = random_seeded(71);
    scene particles = scene_empty(test, 200), others = scene_empty(test, 90);
    for (int axis = 0; axis < test->dimension; ++axis)
        particles.period[axis] = others.period[axis] = 4;
    scatter_in_box(&particles, 1, 2, &random);
    scatter_in_box(&others, 1, 2, &random);
    particles.targets = others.sources;
    particles.target_count = 90;
    assert_true(rows_require_search_exact(context, brute_force_neighbors(context), &particles, 1,
                                          "own targets") > 90);
}

static void periods_shorter_than_twice_the_reach_are_refused(const test_case *test)
{
    sphg_context *context = setup_context();
    scene particles = scene_empty(test, 4);
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = 1;
    for (int k = 0; k < 4; ++k) {
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        const double unit = test->precision == TEST_F32 ? 0x1p-24 : 0x1p-53;
        const double shorter[] = {2 * (1 - 16 * unit), 1, -5, NAN};
        sphg_geometry geometry = scene_geometry(&particles);
        geometry.period[test->dimension - 1] = shorter[k];
        assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry),
                         SPHG_ERROR_ARGUMENT);
        geometry.period[test->dimension - 1] = 2;
        geometry.skin = k == 0 ? 0x1p-20 : 0.5;
        assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry),
                         SPHG_ERROR_ARGUMENT);
        geometry.skin = 0;
        assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry), SPHG_OK);
    }
}

/* Three tenths are not half of six tenths: a period of 2 H up to rounding is meant and searched;
 * one that is shorter is refused with digits that say so. */
static void periods_of_twice_the_reach_may_be_rounded(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(73);
    const bool narrow = test->precision == TEST_F32;
    const double H = narrow ? (double)nextafterf(0.1f * 3, 1) : 0.1 * 3;
    const double period = narrow ? (double)0.6f : 0.6;
    assert_true(period < 2 * H);
    scene particles = scene_empty(test, 110);
    for (int axis = 0; axis < test->dimension; ++axis)
        particles.period[axis] = period;
    scatter_in_box(&particles, H, 1, &random);
    assert_true(rows_require_search_exact(context, neighbors, &particles, H, "a rounded box") >
                110);

    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = H;
    sphg_geometry geometry = scene_geometry(&particles);
    geometry.period[0] = 2 * H * (1 - (narrow ? 0x1p-20 : 0x1p-49));
    assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry),
                     SPHG_ERROR_ARGUMENT);
    const char *message = sphg_last_message(context);
    double said[2] = {0};
    assert_int_equal(sscanf(strstr(message, "] is ") + 5, "%lf", &said[0]), 1);
    assert_int_equal(sscanf(strstr(message, " = ") + 3, "%lf", &said[1]), 1);
    assert_true(said[0] < said[1]);
}

/* ---- Extent ------------------------------------------------------------------------------- */

/* Beyond what two particles take. The most is 680 bytes: a particle alone in a block of cells, and
 * the room that sorting it needs. */
enum { FIXED_BYTES = 4096, BYTES_PER_PARTICLE = 768 };

/* A context whose memory is counted; one thread, so that nothing is per worker. */
static sphg_context *counted_context(fake_host **host)
{
    *host = setup_hooks();
    const sphg_config config = fake_host_config(*host, 1);
    return setup_context_with(&config);
}

/* The most memory that was live during a search in a fresh context, and after it. */
static int64_t peak_of(const scene *particles, double support_radius)
{
    fake_host *host = NULL;
    sphg_context *context = counted_context(&host);
    rows_require_search_exact(context, brute_force_neighbors(context), particles, support_radius,
                              "far");
    assert_int_equal(host->faults, 0);
    return host->peak_bytes;
}

/* Two particles side by side: what every search takes. */
static int64_t least_peak(const test_case *test)
{
    scene pair = scene_empty(test, 2);
    pair.sources[0] = 0.5;
    return peak_of(&pair, 1);
}

static void require_linear(const test_case *test, const scene *particles, const char *what)
{
    const int64_t most =
        least_peak(test) + FIXED_BYTES + (int64_t)BYTES_PER_PARTICLE * particles->source_count;
    const int64_t peak = peak_of(particles, 1);
    TEST_REQUIRE(peak <= most, "%s: %lld bytes, more than %lld", what, (long long)peak,
                 (long long)most);
}

static void two_particles_may_be_as_far_apart_as_numbers_reach(const test_case *test)
{
    const double single[] = {1e3, 1e10, 1e20, 1e30, FLT_MAX};
    const double full[] = {1e3, 1e30, 1e150, 1e300, DBL_MAX};
    for (int k = 0; k < 5; ++k)
        for (int axis = 0; axis < test->dimension; ++axis) {
            scene pair = scene_empty(test, 2);
            const double far = scene_rounded(&pair, pair.is_double ? full[k] : single[k]);
            pair.sources[axis] = far;
            require_linear(test, &pair, "one far away");
            pair.sources[test->dimension + axis] = -far;
            require_linear(test, &pair, "both far away");
        }
}

/* A box around these would have 10^10 cells in 3D. */
static void diagonal_line_takes_linear_memory(const test_case *test)
{
    scene line = scene_empty(test, 3000);
    for (int k = 0; k < 3000 * test->dimension; ++k)
        line.sources[k] = 10.0 * (k / test->dimension);
    require_linear(test, &line, "diagonal");
}

/* Magnitudes from 1 to the largest, each particle alone. */
static void scattered_magnitudes_take_linear_memory(const test_case *test)
{
    random_state random = random_seeded(73);
    scene particles = scene_empty(test, 2000);
    const double top = particles.is_double ? 300 : 37;
    for (int k = 0; k < 2000 * test->dimension; ++k)
        particles.sources[k] =
            scene_rounded(&particles, (random_index(&random, 2) ? 1 : -1) *
                                          pow(10, random_between(&random, 1, top)));
    require_linear(test, &particles, "magnitudes");
}

/* Where floats are further apart than H, neighbours are those that coincide, whoever is next. */
static void coincident_particles_are_neighbours_at_any_distance(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    const int top = test->precision == TEST_F32 ? 38 : 308;
    for (int decade = 1; decade <= top; ++decade) {
        scene particles = scene_empty(test, 12);
        for (int k = 0; k < 12 * test->dimension; ++k) {
            const int i = k / test->dimension, axis = k % test->dimension;
            const double x = scene_rounded(&particles, (axis ? -1 : 1) * pow(10, decade));
            const double far = particles.is_double ? nextafter(x, 0) : nextafterf((float)x, 0);
            particles.sources[k] = i % 4 == 1 + axis % 3 ? far : x;
        }
        rows_require_search_exact(context, neighbors, &particles, 1, test_text("1e%d", decade));
    }
}

/* One particle leaves for good: the others' rows are as before, and so is the memory. */
static void escapee_disturbs_nobody(const test_case *test)
{
    random_state random = random_seeded(79);
    scene particles = scene_empty(test, 2001);
    for (int k = 0; k < 2001 * test->dimension; ++k)
        particles.sources[k] = scene_rounded(&particles, random_between(&random, 0, 12));
    const double far[] = {1e30, particles.is_double ? DBL_MAX : (double)FLT_MAX};
    const int64_t before = peak_of(&particles, 1);
    for (int k = 0; k < 2; ++k) {
        particles.sources[1000 * test->dimension] = far[k];
        const int64_t after = peak_of(&particles, 1);
        assert_true((double)after <= 1.05 * (double)before + FIXED_BYTES);
    }
}

/* More sources about a target than 16 bits can number, in every way to name the targets. */
static void crowds_have_the_pairs_of_brute_force(const test_case *test)
{
    enum { CROWD = 70000, TARGETS = 25 };
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(83);
    scene particles = scene_empty(test, CROWD), others = scene_empty(test, TARGETS);
    for (int k = 0; k < CROWD * test->dimension; ++k)
        particles.sources[k] = scene_rounded(&particles, random_between(&random, 0, 3));
    memcpy(others.sources, particles.sources + 9 * test->dimension,
           (size_t)(TARGETS * test->dimension) * sizeof(double));
    particles.target_count = TARGETS;
    rows_require_search_exact(context, neighbors, &particles, 0.75, "part of the crowd");
    particles.list_free = 1;
    rows_require_search_exact(context, neighbors, &particles, 0.75, "list-free");
    particles.targets = others.sources;
    rows_require_search_exact(context, neighbors, &particles, 0.75, "own targets, list-free");
    particles.list_free = 0;
    particles.period[0] = 3;
    rows_require_search_exact(context, neighbors, &particles, 0.75, "own targets, periodic");
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(periodic_boxes_have_the_pairs_of_brute_force),
    EACH(positions_may_lie_outside_the_box),
    EACH(lengths_of_any_bits_have_the_pairs_of_brute_force),
    EACH(halves_of_the_smallest_box_meet_through_its_side),
    EACH(positions_just_outside_the_box_have_a_cell),
    EACH(periodic_lattice_has_no_boundary),
    EACH(periodic_targets_need_not_be_sources),
    EACH(periods_shorter_than_twice_the_reach_are_refused),
    EACH(periods_of_twice_the_reach_may_be_rounded),
    EACH(two_particles_may_be_as_far_apart_as_numbers_reach),
    EACH(diagonal_line_takes_linear_memory),
    EACH(scattered_magnitudes_take_linear_memory),
    EACH(coincident_particles_are_neighbours_at_any_distance),
    EACH(escapee_disturbs_nobody),
    EACH(crowds_have_the_pairs_of_brute_force),
};
TEST_MAIN(entries)
