/* SPDX-License-Identifier: MIT */
/* Periodic axes far from their box: escapees cost nothing and keep the pairs of brute force, and a
 * skin does not care whether its host wraps positions. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void scatter(const scene *particles, double *x, int count, double length,
                    random_state *random)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = scene_rounded(particles, random_between(random, 0, length));
}

/* ---- Escapees ------------------------------------------------------------------------------- */

/* In box lengths: on both sides of where positions are taken into the box, up to the largest. */
static const double FAR_SINGLE[] = {1e2, 3e3, 9e3, 1.1e4, 1e5, 4e6, 1e7, 1e9, 1e20, FLT_MAX};
static const double FAR_DOUBLE[] = {1e3, 1e9, 1e12, 5e12, 6e12, 1e15, 5e15, 1e30, 1e150, DBL_MAX};
enum { FAR_COUNT = 10, MANY = 90, ESCAPED = 8 };

/* Some of the particles leave by about that many periods, some of them side by side. */
static void let_escape(const scene *particles, double *x, double periods, int axes)
{
    const double largest = particles->is_double ? DBL_MAX : (double)FLT_MAX;
    for (int i = 0; i < ESCAPED; ++i)
        for (int a = 0; a < particles->dimension; ++a) {
            const double length = particles->period[a], sign = i % 4 < 2 ? 1 : -1;
            double *own = &x[(i * 7) * particles->dimension + a];
            if (axes >> a & 1 && periods < largest / 1e4)
                *own = scene_rounded(particles, *own + sign * length * nearbyint(periods));
            else if (axes >> a & 1)
                *own = sign * largest;
            if (i % 2)
                *own = x[((i - 1) * 7) * particles->dimension + a];
        }
}

static void require_lists_agree(sphg_context *context, const scene *particles, const char *where)
{
    enum { ROOM = MANY * MANY };
    int64_t offsets[MANY + 1];
    int32_t *indices = test_memory(ROOM * sizeof *indices);
    for (int i = 0; i <= MANY; ++i)
        offsets[i] = (int64_t)i * MANY;
    for (int k = 0; k < ROOM; ++k)
        indices[k] = k % MANY;
    sphg_scheme scheme = {0};
    sphg_lists lists = {0};
    scheme.dimension = particles->dimension;
    scheme.support_radius = 1;
    lists.offsets = offsets;
    lists.indices = indices;
    const sphg_geometry geometry = scene_geometry(particles);
    const sphg_neighbors *brought = setup_lists(context, &scheme, &geometry, &lists);
    const rows found = rows_listed(context, brought, &scheme, NULL);
    const rows expected = rows_by_brute_force(particles, 1);
    rows_require_equal(&found, &expected, where);
    int32_t order[MANY];
    char seen[MANY] = {0};
    SETUP_OK(context, sphg_neighbors_get_order(context, brought, order));
    for (int k = 0; k < MANY; ++k)
        ++seen[order[k]];
    for (int k = 0; k < MANY; ++k)
        assert_int_equal(seen[k], 1);
}

/* With lists, without, with a skin, with targets of their own, with lists of the host. */
static void check_supplies(sphg_context *context, scene particles, double *targets,
                           const char *where)
{
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    rows_require_search_exact(context, neighbors, &particles, 1, where);
    require_lists_agree(context, &particles, where);
    particles.list_free = 1;
    rows_require_search_exact(context, neighbors, &particles, 1, where);
    particles.targets = targets;
    rows_require_search_exact(context, neighbors, &particles, 1, where);
    particles.list_free = 0;
    particles.skin = 0.25;
    rows_require_search_exact(context, neighbors, &particles, 1, where);
    rows_require_search_exact(context, neighbors, &particles, 1, where); /* the skin holds */
}

static void check_escapees(const test_case *test, sphg_context *context, int far, int axes)
{
    random_state random = random_seeded(89 + (uint64_t)far);
    scene particles = scene_empty(test, MANY);
    double *targets = test_memory(MANY * 3 * sizeof *targets);
    for (int a = 0; a < test->dimension; ++a)
        particles.period[a] =
            axes >> a & 1 ? scene_rounded(&particles, random_between(&random, 2.6, 7)) : 0;
    scatter(&particles, particles.sources, MANY, 4, &random);
    scatter(&particles, targets, MANY, 4, &random);
    const double periods = particles.is_double ? FAR_DOUBLE[far] : FAR_SINGLE[far];
    let_escape(&particles, particles.sources, periods, axes);
    let_escape(&particles, targets, periods, axes);
    check_supplies(context, particles, targets,
                   test_text("%g periods away, axes %d", periods, axes));
}

static void escapees_have_the_pairs_of_brute_force(const test_case *test)
{
    static const sphg_isa sets[] = {SPHG_ISA_BASE, SPHG_ISA_X86_V3, SPHG_ISA_X86_V4};
    for (int k = 0; k < 3; ++k) {
        sphg_context *context = setup_watched_context_on(sets[k]);
        for (int far = 0; far < FAR_COUNT && context; ++far) {
            check_escapees(test, context, far, 1 << far % test->dimension);
            check_escapees(test, context, far, (1 << test->dimension) - 1);
        }
    }
}

/* Whole periods away from a place, an escapee is at that place: the grid, of which the order tells,
 * and the memory stay as they are. Cells that grew with the farthest coordinate were one at last.
 */
static void escapees_leave_the_grid_as_it_is(const test_case *test)
{
    enum { COUNT = 3000 };
    sphg_context *context = setup_context();
    random_state random = random_seeded(97);
    scene particles = scene_empty(test, COUNT);
    static int32_t before[COUNT], after[COUNT];
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = 0.5;
    for (int a = 0; a < test->dimension; ++a)
        particles.period[a] = 12;
    scatter(&particles, particles.sources, COUNT, 12, &random);
    for (int a = 0; a < test->dimension; ++a)
        particles.sources[1000 * test->dimension + a] = 0;
    sphg_geometry geometry = scene_geometry(&particles);
    const sphg_neighbors *neighbors = setup_search(context, &scheme, &geometry);
    SETUP_OK(context, sphg_neighbors_get_order(context, neighbors, before));
    const int doublings[] = {20, 23, 30, 60, 100, 120, 500, 1000};
    for (int k = 0; k < (particles.is_double ? 8 : 6); ++k) {
        for (int a = 0; a < (k % 2 ? 1 : test->dimension); ++a)
            particles.sources[1000 * test->dimension + a] = ldexp(-12, doublings[k]);
        geometry = scene_geometry(&particles);
        neighbors = setup_search(context, &scheme, &geometry);
        SETUP_OK(context, sphg_neighbors_get_order(context, neighbors, after));
        TEST_REQUIRE(!memcmp(before, after, sizeof before), "2^%d periods away: another order",
                     doublings[k]);
    }
}

/* Pairs a rounding inside and outside of H, at borders of so many cells, partners in images up to
 * `most` periods away. */
static void put_pairs_at_borders(const scene *particles, double length, int cells, double most,
                                 random_state *random)
{
    const int d = particles->dimension;
    const double step = (particles->is_double ? 0x1p-52 : 0x1p-23) * length;
    for (int i = 0; i < MANY; i += 2) {
        double *x = &particles->sources[i * d];
        memcpy(x + d, x, (size_t)d * sizeof *x);
        const double border = length / cells * (int)random_index(random, cells + 1);
        x[i % d] = border + step * ((int)random_index(random, 5) - 2);
        x[d + i % d] = x[i % d] + (i % 4 ? 1 : -1) + step * ((int)random_index(random, 3) - 1);
        for (int k = 0; k < 2 * d; ++k)
            x[k] = scene_rounded(particles,
                                 x[k] + length * nearbyint(random_between(random, -most, most)));
    }
}

/* Cells of any width, and cells no wider than they must be, which coordinates just within what is
 * taken into the box need to be wider, also beside one who is taken there. */
static void pairs_at_cell_borders_are_those_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(101);
    for (int round = 0; round < 300; ++round) {
        scene particles = scene_empty(test, MANY);
        const int d = test->dimension, narrow = round >= 60;
        const double narrowest = (4 + (int)random_index(&random, 4)) * (1 + 0x1p-9 + 0x1p-20);
        const double length =
            scene_rounded(&particles, narrow ? narrowest : random_between(&random, 3.02, 9));
        const double limit = (particles.is_double ? 0x1p45 : 0x1p16) / length - 2;
        const double most = narrow ? limit : round % 3 == 0 ? 0 : round % 3 == 1 ? 5 : 6000;
        scatter(&particles, particles.sources, MANY, length, &random);
        for (int a = 0; a < d; ++a)
            particles.period[a] = length;
        put_pairs_at_borders(&particles, length, (int)floor(length / (1 + 0x1p-9)), most, &random);
        for (int a = 0; a < d && narrow && round % 2; ++a)
            particles.sources[a] =
                scene_rounded(&particles, particles.sources[a] + length * 64 * limit);
        particles.list_free = round / 2 % 2;
        rows_require_search_exact(context, neighbors, &particles, 1, test_text("round %d", round));
    }
}

static void periods_without_room_for_differences_are_refused(const test_case *test)
{
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    scene particles = scene_empty(test, 4);
    const double most = (particles.is_double ? DBL_MAX : (double)FLT_MAX) / 4;
    particles.sources[0] = most;
    particles.sources[test->dimension] = -most;
    particles.period[0] = most;
    assert_int_equal(rows_require_search_exact(context, neighbors, &particles, 1, "longest"), 12);
    particles.period[0] = most * 1.001;
    const sphg_geometry geometry = scene_geometry(&particles);
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = 1;
    assert_int_equal(sphg_neighbors_search(context, neighbors, &scheme, &geometry),
                     SPHG_ERROR_ARGUMENT);
    assert_non_null(strstr(sphg_last_message(context), "geometry.period[0]"));
}

/* ---- Skin ----------------------------------------------------------------------------------- */

enum host { UNWRAPPED, FROM_ZERO, ABOUT_ZERO, HOSTS };

static double wrapped_by(enum host host, double x, double length)
{
    if (host == FROM_ZERO)
        return x - length * floor(x / length);
    return host == ABOUT_ZERO ? x - length * nearbyint(x / length) : x;
}

/* Searches that found pairs anew. The fastest goes three tenths of half the skin each step: one in
 * four steps rebuilds, whatever becomes of coordinates on their way through the sides. */
static int rebuilds_of(const test_case *test, enum host host, int axes, int own_targets)
{
    enum { WALKERS = 100, STEPS = 33 };
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(103);
    scene particles = scene_empty(test, WALKERS);
    const int d = test->dimension;
    double speed[WALKERS * 3], place[WALKERS * 3];
    int rebuilt = 0;
    particles.skin = 0.3;
    particles.targets = own_targets ? test_memory(WALKERS * 3 * sizeof(double)) : NULL;
    for (int a = 0; a < d; ++a)
        particles.period[a] = axes >> a & 1 ? 3 + a : 0;
    scatter(&particles, place, WALKERS, 3, &random);
    for (int k = 0; k < WALKERS * d; ++k)
        speed[k] = (k < d ? 1 : random_between(&random, -1, 1)) * 0.045 / sqrt(d);
    for (int step = 0; step < STEPS; ++step) {
        for (int k = 0; k < WALKERS * d; ++k) {
            const double length = particles.period[k % d], x = place[k] + speed[k] * step;
            const double put =
                scene_rounded(&particles, length > 0 ? wrapped_by(host, x, length) : x);
            (particles.targets ? particles.targets : particles.sources)[k] = put;
            if (particles.targets)
                particles.sources[k] = scene_rounded(&particles, place[WALKERS * d - 1 - k]);
        }
        rows_require_search_exact(context, neighbors, &particles, 1,
                                  test_text("host %d, axes %d, step %d", host, axes, step));
        sphg_neighbors_info info = {0};
        SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
        rebuilt += info.rebuilt;
    }
    return rebuilt;
}

static void skins_hold_whether_the_host_wraps_or_not(const test_case *test)
{
    for (int axes = 1; axes < 1 << test->dimension; ++axes)
        for (int host = 0; host < HOSTS; ++host)
            assert_int_equal(rebuilds_of(test, (enum host)host, axes, axes == 1), 9);
}

/* Images so far apart that differences are rounded by a good part of the skin: what is kept must
 * still hold every pair. */
static void skins_leave_room_for_rounding(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    random_state random = random_seeded(107);
    int kept = 0;
    for (int round = 0; round < 120; ++round) {
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        scene particles = scene_empty(test, MANY);
        const int d = test->dimension;
        const double unit = particles.is_double ? 0x1p-53 : 0x1p-24;
        const double away = ldexp(1, -(int)random_index(&random, 6)) * 0x1p-9 / unit;
        for (int a = 0; a < d; ++a)
            particles.period[a] = scene_rounded(&particles, random_between(&random, 3, 4));
        particles.skin = 16 * unit * away * random_between(&random, 0.25, 4);
        scatter(&particles, particles.sources, MANY, 3, &random);
        for (int i = 1; i < MANY; i += 2) { /* pairs just beyond H + skin */
            double *x = &particles.sources[i * d];
            memcpy(x, x - d, (size_t)d * sizeof *x);
            x[0] += 1 + particles.skin * random_between(&random, 0.9, 1.1);
        }
        for (int i = 0; i < MANY; ++i)
            for (int a = 0; a < d; ++a) {
                const double turns = nearbyint(away / particles.period[a]) * (i % 2 ? -1 : 1);
                double *x = &particles.sources[i * d + a];
                *x = scene_rounded(&particles, *x + turns * particles.period[a]);
            }
        for (int step = 0; step < 4; ++step) {
            sphg_neighbors_info info = {0};
            rows_require_search_exact(context, neighbors, &particles, 1, "rounded");
            SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
            kept += !info.rebuilt;
            for (int i = 0; i < MANY; ++i) /* towards each other */
                particles.sources[i * d] = scene_rounded(
                    &particles, particles.sources[i * d] + (i % 2 ? -0.16 : 0.16) * particles.skin);
        }
    }
    assert_true(kept > 20);
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(escapees_have_the_pairs_of_brute_force),
    EACH(escapees_leave_the_grid_as_it_is),
    EACH(pairs_at_cell_borders_are_those_of_brute_force),
    EACH(periods_without_room_for_differences_are_refused),
    EACH(skins_hold_whether_the_host_wraps_or_not),
    EACH(skins_leave_room_for_rounding),
};
TEST_MAIN(entries)
