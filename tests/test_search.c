/* SPDX-License-Identifier: MIT */
/* The search against brute force: the same pairs, exactly, wherever particles stand. */
#include "support/setup.h"
#include "support/fake_host.h"
#include "support/brute_force.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Clouds ------------------------------------------------------------------------------- */

static double rounded(const scene *particles, double x)
{
    return particles->is_double ? x : (double)(float)x;
}

static void scatter(const scene *particles, int count, double *x, double low, double side,
                    random_state *random)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = rounded(particles, random_between(random, low, low + side));
}

static double next_after(const scene *particles, double x, int steps)
{
    for (int k = 0; k < abs(steps); ++k)
        x = particles->is_double ? nextafter(x, steps < 0 ? -INFINITY : INFINITY)
                                 : (double)nextafterf((float)x, steps < 0 ? -INFINITY : INFINITY);
    return x;
}

/* A spot where the coordinates have few bits to spare, or none. */
static double choose_offset(const scene *particles, random_state *random)
{
    const double far = particles->is_double ? 1e12 : 1e3;
    const double places[] = {0, 0, -3, 100, -far, far};
    return places[random_index(random, 6)];
}

/* Random count, density, place and options; H has few bits, so H^2 is exact. */
static scene random_scene(const test_case *test, random_state *random, double *support_radius)
{
    const int counts[] = {0, 1, 2, 3, 17, 64, 100, 129, 200};
    const double sides[] = {0.3, 1, 2.5, 6, 30, 1e4};
    scene particles = scene_empty(test, counts[random_index(random, 9)]);
    const double H = (1 + random_index(random, 4095)) / 1024.0;
    const double low = choose_offset(&particles, random) * H;
    const double side = sides[random_index(random, 6)] * H;
    scatter(&particles, particles.source_count, particles.sources, low, side, random);
    if (random_index(random, 3) == 0) {
        particles.target_count = counts[random_index(random, 9)];
        particles.targets = test_memory((size_t)particles.target_count * 3 * sizeof(double));
        scatter(&particles, particles.target_count, particles.targets, low, side, random);
    } else if (particles.source_count > 2 && random_index(random, 3) == 0) {
        particles.target_count = random_index(random, particles.source_count);
    }
    particles.list_free = random_index(random, 3) == 0;
    particles.skin = !particles.list_free && random_index(random, 2) ? 0.25 * H : 0;
    *support_radius = H;
    return particles;
}

/* Two hundred per precision and dimension: twelve hundred in all, through one object each time. */
static void random_clouds_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(11 + (uint64_t)test->precision);
    int64_t pairs = 0;
    for (int k = 0; k < 200; ++k) {
        double H = 0;
        const scene particles = random_scene(test, &random, &H);
        const char *where = test_text("cloud %d, %d sources, H %g", k, particles.source_count, H);
        pairs += rows_require_search_exact(context, neighbors, &particles, H, where);
    }
    assert_true(pairs > 10000);
}

/* Large enough for many blocks and all threads. */
static void large_cloud_has_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context();
    random_state random = random_seeded(5);
    scene particles = scene_empty(test, 4000);
    scatter(&particles, particles.source_count, particles.sources, -1, 2, &random);
    const double H = test->dimension == 2 ? 0.0625 : 0.25;
    assert_true(rows_require_search_exact(context, brute_force_neighbors(context), &particles, H,
                                          "4000 particles") > 20000);
}

/* One thread's share of the particles fills its blocks, the other's does at first. */
static void dense_and_thin_shares_have_the_pairs_of_brute_force(const test_case *test)
{
    enum { SHARE = 4200, DENSE = SHARE + 400 };
    sphg_context *context = setup_context_of(2);
    random_state random = random_seeded(6);
    scene particles = scene_empty(test, 2 * SHARE);
    double *x = particles.sources;
    const double H = test->dimension == 2 ? 0.0625 : 0.25;
    scatter(&particles, DENSE, x, -1, 2, &random);
    scatter(&particles, 2 * SHARE - DENSE, x + DENSE * test->dimension, -200, 400, &random);
    assert_true(rows_require_search_exact(context, brute_force_neighbors(context), &particles, H,
                                          "shares") > 20000);
}

static scene lattice_scene(const test_case *test, int per_axis, double spacing, double origin)
{
    cloud points = cloud_lattice(test->dimension, per_axis, 1);
    scene particles = scene_of_cloud(test, &points);
    for (int k = 0; k < points.count * points.dimension; ++k)
        particles.sources[k] = rounded(&particles, origin + points.x[k] * spacing);
    return particles;
}

/* Distances of exactly H, and an ulp beside it, in every direction of the lattice. */
static void lattices_at_the_support_radius_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    const scene any = scene_empty(test, 0);
    int64_t pairs = 0;
    const double radii[] = {1, 0.6875, 3}, origins[] = {0, -2, 17.3, -1000};
    const int parts[] = {1, 2, 3, 5}; /* (1, 2, 2) / 3 and (3, 4, 0) / 5 are ties as well */
    for (int k = 0; k < 3 * 4 * 4 * 5; ++k) {
        const double H = radii[k % 3], part = rounded(&any, H / parts[k / 12 % 4]);
        const double spacing = next_after(&any, part, k / 48 - 2);
        const scene particles = lattice_scene(test, 5, spacing, origins[k / 3 % 4]);
        const char *where = test_text("spacing %.17g, origin %g", spacing, origins[k / 3 % 4]);
        pairs += rows_require_search_exact(context, neighbors, &particles, H, where);
    }
    assert_true(pairs > 10000);
}

/* Sources on spheres of radius H about the targets, a few roundings in or out: the predicate is
 * rounded as written, term by term. With FMA, or in another precision, some would change sides. */
static void near_ties_are_rounded_as_the_predicate_says(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(19);
    const int d = test->dimension;
    for (int k = 0; k < 30; ++k) {
        scene sources = scene_empty(test, 1000), targets = scene_empty(test, 10);
        const double H = 0.6875, unit = test_position_type(test) == SPHG_F32 ? 0x1p-24 : 0x1p-53;
        scatter(&targets, 10, targets.sources, -1, 2, &random);
        for (int i = 0; i < 1000; ++i) {
            double way[3], square = 0;
            for (int a = 0; a < d; ++a)
                square += pow(way[a] = random_between(&random, -1, 1), 2);
            const double r = H * (1 + 4 * unit * random_between(&random, -1, 1)) / sqrt(square);
            for (int a = 0; a < d; ++a)
                sources.sources[i * d + a] =
                    rounded(&sources, targets.sources[i % 10 * d + a] + r * way[a]);
        }
        sources.targets = targets.sources;
        sources.target_count = 10;
        sources.list_free = k % 2;
        rows_require_search_exact(context, neighbors, &sources, H, test_text("sphere %d", k));
    }
}

/* Every coordinate at k H, or a float beside it: where a cell ends. */
static void positions_at_cell_borders_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(23);
    const double radii[] = {1, 0.6875, 0.34375}, bases[] = {-1, 1 << 20, -(1 << 20)};
    int64_t pairs = 0;
    for (int k = 0; k < 60; ++k) {
        scene particles = scene_empty(test, 150);
        const double H = radii[k % 3];
        const double base = k % 4 ? random_index(&random, 2000) - 1000 : bases[k / 4 % 3];
        for (int n = 0; n < 150 * test->dimension; ++n)
            particles.sources[n] =
                next_after(&particles, rounded(&particles, (base + random_index(&random, 4)) * H),
                           random_index(&random, 3) - 1);
        pairs += rows_require_search_exact(context, neighbors, &particles, H,
                                           test_text("k near %g, H %g", base, H));
    }
    assert_true(pairs > 10000);
}

/* Both signs, and zeros of both signs. */
static void signs_do_not_matter(const test_case *test)
{
    sphg_context *context = setup_context();
    random_state random = random_seeded(29);
    scene particles = scene_empty(test, 200);
    scatter(&particles, 200, particles.sources, -2, 4, &random);
    for (int k = 0; k < 200; k += 3)
        particles.sources[k] = k % 2 ? -0.0 : 0.0;
    rows_require_search_exact(context, brute_force_neighbors(context), &particles, 1, "zeros");
    for (int k = 0; k < 200 * test->dimension; ++k)
        particles.sources[k] = -fabs(particles.sources[k]);
    rows_require_search_exact(context, brute_force_neighbors(context), &particles, 1, "negative");
}

/* To where the spacing of floats is H itself. */
static void far_offsets_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(31);
    const int top = test->precision == TEST_F32 ? 23 : 52;
    for (int k = 10; k <= top; k += k + 3 > top && k < top ? top - k : 3)
        for (int sign = -1; sign <= 1; sign += 2) {
            scene particles = scene_empty(test, 120);
            scatter(&particles, 120, particles.sources, sign * ldexp(1, k), 4, &random);
            rows_require_search_exact(context, neighbors, &particles, 1,
                                      test_text("offset %d 2^%d", sign, k));
        }
}

/* count: the lists of one block fit its worker's memory, or are too long for it. */
static void require_crowd(const test_case *test, sphg_context *context, int count)
{
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(37);
    scene particles = scene_empty(test, count);
    const int64_t all = (int64_t)count * (count - 1);
    scatter(&particles, count, particles.sources, 0.4, 0.01, &random);
    assert_int_equal(rows_require_search_exact(context, neighbors, &particles, 1, "one cell"), all);
    for (int k = 0; k < count * test->dimension; ++k)
        particles.sources[k] = 0.375;
    assert_int_equal(rows_require_search_exact(context, neighbors, &particles, 1, "coincident"),
                     all);
    for (int k = 0; k < count * test->dimension; ++k)
        particles.sources[k] = k / test->dimension % 7;
    rows_require_search_exact(context, neighbors, &particles, 1, "seven places");
}

static void crowded_cells_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context();
    require_crowd(test, context, 600);
    require_crowd(test, context, 1300);
}

/* Fewer blocks than a task is meant to have particles: it still has a block to work on. */
static void executors_of_the_host_search_crowded_cells(const test_case *test)
{
    fake_host_executor *const executors[] = {fake_host_odd_splits, fake_host_reversed,
                                             fake_host_pthreads};
    for (int k = 0; k < 3; ++k) {
        fake_host *host = setup_hooks();
        sphg_config config = fake_host_config(host, host->workers);
        config.parallel_for = executors[k];
        require_crowd(test, setup_context_with(&config), 600);
    }
}

/* ---- Relation ----------------------------------------------------------------------------- */

static int lists(const rows *found, int32_t i, int32_t j)
{
    int64_t low = found->offsets[i], high = found->offsets[i + 1];
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (found->indices[middle] < j)
            low = middle + 1;
        else
            high = middle;
    }
    return low < found->offsets[i + 1] && found->indices[low] == j;
}

/* Rows ascend strictly and j lists i where i lists j; too many particles for brute force. */
static void relation_is_symmetric_and_rows_ascend(const test_case *test)
{
    sphg_context *context = setup_context();
    random_state random = random_seeded(41);
    scene particles = scene_empty(test, 20000);
    scatter(&particles, 20000, particles.sources, -7, 14, &random);
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.support_radius = test->dimension == 2 ? 0.25 : 1;
    const sphg_geometry geometry = scene_geometry(&particles);
    const sphg_neighbors *neighbors = setup_search(context, &scheme, &geometry);
    const rows found = rows_listed(context, neighbors, &scheme, NULL);
    assert_true(found.offsets[20000] > 200000);
    for (int32_t i = 0; i < found.count; ++i)
        for (int64_t k = found.offsets[i]; k < found.offsets[i + 1]; ++k) {
            assert_true(k == found.offsets[i] || found.indices[k - 1] < found.indices[k]);
            assert_true(lists(&found, found.indices[k], i));
        }
}

/* A scheme with a smaller support radius sees the pairs of that radius; subsets their rows. */
static void smaller_radius_and_subsets_select_from_the_same_pairs(const test_case *test)
{
    sphg_context *context = setup_context();
    random_state random = random_seeded(43);
    for (int list_free = 0; list_free < 2; ++list_free) {
        scene particles = scene_empty(test, 500);
        particles.list_free = list_free;
        scatter(&particles, 500, particles.sources, 0, 4, &random);
        sphg_scheme scheme = {0};
        scheme.dimension = test->dimension;
        scheme.support_radius = 1;
        const sphg_geometry geometry = scene_geometry(&particles);
        const sphg_neighbors *neighbors = setup_search(context, &scheme, &geometry);
        scheme.support_radius = 0.6875;
        const rows expected = rows_by_brute_force(&particles, 0.6875);
        const rows found = rows_listed(context, neighbors, &scheme, NULL);
        rows_require_equal(&found, &expected, "smaller radius");
        const int32_t picked[] = {400, 3, 77, 499, 0, 78};
        const sphg_subset subset = {1, 5, picked, NULL};
        const rows some = rows_listed(context, neighbors, &scheme, &subset);
        assert_int_equal(some.count, 4);
        for (int k = 0; k < 4; ++k) {
            const int32_t i = picked[1 + k];
            const int64_t length = some.offsets[k + 1] - some.offsets[k];
            assert_int_equal(length, expected.offsets[i + 1] - expected.offsets[i]);
            assert_memory_equal(some.indices + some.offsets[k],
                                expected.indices + expected.offsets[i],
                                (size_t)length * sizeof(int32_t));
        }
    }
}

/* ---- Skin --------------------------------------------------------------------------------- */

/* The largest distance that a particle has gone since `old`. */
static double largest_move(const scene *particles, const double *old)
{
    const int d = particles->dimension;
    double largest = 0;
    for (int i = 0; i < particles->source_count; ++i) {
        double square = 0;
        for (int k = 0; k < d; ++k)
            square += pow(particles->sources[i * d + k] - old[i * d + k], 2);
        largest = fmax(largest, sqrt(square));
    }
    return largest;
}

static void require_skin_promise(sphg_context *context, const sphg_neighbors *neighbors,
                                 const scene *particles, double *old)
{
    const size_t bytes = (size_t)(particles->source_count * particles->dimension) * sizeof *old;
    const double moved = largest_move(particles, old), half = particles->skin / 2;
    sphg_neighbors_info info = {0};
    SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
    if (moved < 0.999 * half)
        assert_int_equal(info.rebuilt, 0);
    if (moved > 1.001 * half)
        assert_int_equal(info.rebuilt, 1);
    const double left = info.rebuilt ? half : half - moved;
    assert_true(fabs(info.skin_left - left) <= 1e-3 * half);
    if (info.rebuilt)
        memcpy(old, particles->sources, bytes);
}

/* A random walk: lists are kept while the skin holds, and every result is that of brute force. */
static void skin_keeps_lists_and_exactness(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    for (int periodic = 0; periodic < 2; ++periodic) {
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        random_state random = random_seeded(47);
        scene particles = scene_empty(test, 200);
        double *old = test_memory(200 * 3 * sizeof *old);
        int kept = 0, steps = 60;
        particles.skin = 0.25;
        particles.period[0] = periodic ? 3 : 0;
        scatter(&particles, 200, particles.sources, 0, 3, &random);
        old[0] = 1e3; /* the first search has nothing to keep */
        for (int step = 0; step < steps; ++step) {
            sphg_neighbors_info info = {0};
            rows_require_search_exact(context, neighbors, &particles, 0.75, "random walk");
            require_skin_promise(context, neighbors, &particles, old);
            SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
            kept += !info.rebuilt;
            for (int k = 0; k < 200 * test->dimension; ++k)
                particles.sources[k] = rounded(
                    &particles, particles.sources[k] + random_between(&random, -0.02, 0.02));
        }
        assert_true(kept > steps / 4 && kept < steps);
    }
}

/* Targets of their own walk through sources at rest, then the other way round: what moves decides
 * what the skin has left. */
static void moves_of_either_side_use_up_the_skin(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    random_state random = random_seeded(59);
    for (int side = 0; side < 2; ++side) {
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        scene particles = scene_empty(test, 200);
        particles.skin = 0.25;
        particles.target_count = 90;
        particles.targets = test_memory(90 * 3 * sizeof(double));
        scatter(&particles, 200, particles.sources, 0, 3, &random);
        scatter(&particles, 90, particles.targets, 0, 3, &random);
        double *moving = side ? particles.sources : particles.targets, start = moving[0];
        for (int step = 0; step < 24; ++step) {
            sphg_neighbors_info info = {0};
            rows_require_search_exact(context, neighbors, &particles, 0.75, "one side walks");
            SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
            assert_int_equal(info.rebuilt, step % 4 == 0); /* 4 / 32 is half of the skin */
            start = info.rebuilt ? moving[0] : start;
            assert_true(fabs(info.skin_left - (0.125 - fabs(moving[0] - start))) <= 1e-3);
            moving[0] = rounded(&particles, moving[0] + (step % 4 == 3 ? 0.04 : 0.03));
        }
    }
}

/* What is no small move asks for a rebuild: another radius, count, period, or a jump. */
static void changed_arguments_rebuild(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(53);
    scene particles = scene_empty(test, 200);
    particles.skin = 0.25;
    scatter(&particles, 200, particles.sources, 0, 4, &random);
    rows_require_search_exact(context, neighbors, &particles, 0.75, "first");
    rows_require_search_exact(context, neighbors, &particles, 1.25, "larger radius");
    rows_require_search_exact(context, neighbors, &particles, 0.5, "smaller radius");
    particles.source_count = particles.target_count = 150;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "fewer particles");
    particles.target_count = 100;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "fewer targets");
    particles.period[1] = 4;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "periodic");
    particles.skin = 0.5;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "wider skin");
    particles.period[0] = particles.period[2] = 4;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "periodic along others");
    particles.period[2] = 5;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "another period");
    particles.targets = particles.sources;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "targets apart");
    particles.targets = NULL;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "part of the sources again");
    particles.dimension = 5 - test->dimension;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "other dimension");
    particles.dimension = test->dimension;
    if (particles.is_double) {
        for (int k = 0; k < 600; ++k)
            particles.sources[k] = (double)(float)particles.sources[k];
        particles.precision = SPHG_F32;
        rows_require_search_exact(context, neighbors, &particles, 0.5, "narrow fields");
        particles.is_double = 0;
        rows_require_search_exact(context, neighbors, &particles, 0.5, "narrow positions");
    }
    particles.list_free = 1;
    particles.skin = 0;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "list-free");
    particles.sources[0] = 1e9;
    rows_require_search_exact(context, neighbors, &particles, 0.5, "jump");
}

/* Fields of another precision need rows of another type. */
static void another_precision_rebuilds(const test_case *test)
{
    sphg_context *context = setup_context_of(1);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(61);
    scene particles = scene_empty(test, 200);
    scatter(&particles, 200, particles.sources, 0, 4, &random);
    particles.skin = 0.25;
    for (int step = 0; step < 6; ++step) {
        sphg_neighbors_info info = {0};
        particles.precision = step / 2 % 2 ? SPHG_F32 : SPHG_F64;
        rows_require_search_exact(context, neighbors, &particles, 0.75, "precision");
        SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
        assert_int_equal(info.rebuilt, step % 2 == 0);
    }
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(random_clouds_have_the_pairs_of_brute_force),
    EACH(large_cloud_has_the_pairs_of_brute_force),
    EACH(dense_and_thin_shares_have_the_pairs_of_brute_force),
    EACH(lattices_at_the_support_radius_have_the_pairs_of_brute_force),
    EACH(near_ties_are_rounded_as_the_predicate_says),
    EACH(positions_at_cell_borders_have_the_pairs_of_brute_force),
    EACH(signs_do_not_matter),
    EACH(far_offsets_have_the_pairs_of_brute_force),
    EACH(crowded_cells_have_the_pairs_of_brute_force),
    EACH(executors_of_the_host_search_crowded_cells),
    EACH(relation_is_symmetric_and_rows_ascend),
    EACH(smaller_radius_and_subsets_select_from_the_same_pairs),
    EACH(skin_keeps_lists_and_exactness),
    EACH(moves_of_either_side_use_up_the_skin),
    EACH(changed_arguments_rebuild),
    TEST_ENTRY(another_precision_rebuilds, TEST_BIT(TEST_F64), TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
