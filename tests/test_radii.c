/* SPDX-License-Identifier: MIT */
/* A support radius per particle: the pairs of brute force, results against the oracle, and the same
 * bits as with one radius where all are the same. */
#include "support/brute_force.h"
#include "support/graded.h"
#include "support/second_order.h"
#include <math.h>
#include <string.h>

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void scatter(const scene *particles, int count, double *x, double low, double side,
                    random_state *random)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = scene_rounded(particles, random_between(random, low, low + side));
}

/* Between 1 / ratio and 1: anywhere, or rising along the first axis. */
static double *radii_for(const scene *particles, int count, const double *x, double side,
                         double ratio, int rising, random_state *random)
{
    double *radii = test_memory(((size_t)count + 1) * sizeof *radii);
    for (int i = 0; i < count; ++i) {
        const double share =
            rising ? fabs(x[i * particles->dimension]) / side : random_between(random, 0, 1);
        radii[i] = scene_rounded(particles, pow(ratio, -share));
    }
    return radii;
}

static scene random_scene(const test_case *test, random_state *random)
{
    static const int counts[] = {0, 1, 2, 17, 100, 300, 500};
    static const double sides[] = {.5, 2.5, 6, 40, 1e4}, ratios[] = {1, 1.5, 2, 8, 64, 0x1p20};
    scene particles = scene_empty(test, counts[random_index(random, 7)]);
    const double side = sides[random_index(random, 5)], low = random_index(random, 2) ? -side : 0;
    const double ratio = ratios[random_index(random, 6)];
    const int rising = random_index(random, 2);
    scatter(&particles, particles.source_count, particles.sources, low, side, random);
    particles.support = radii_for(&particles, particles.source_count, particles.sources, side,
                                  ratio, rising, random);
    if (random_index(random, 3) == 0) {
        particles.target_count = counts[random_index(random, 7)];
        particles.targets = test_memory(((size_t)particles.target_count * 3 + 1) * sizeof(double));
        scatter(&particles, particles.target_count, particles.targets, low, side, random);
        particles.target_support = radii_for(&particles, particles.target_count, particles.targets,
                                             side, ratio, !rising, random);
    } else if (particles.source_count > 2 && random_index(random, 3) == 0) {
        particles.target_count = random_index(random, particles.source_count);
    }
    for (int a = 0; a < test->dimension && side > 2; ++a)
        particles.period[a] = random_index(random, 4) == 0 ? side : 0;
    particles.list_free = random_index(random, 3) == 0;
    particles.mutual = random_index(random, 2);
    return particles;
}

static void random_clouds_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(311 + (uint64_t)test->precision);
    int64_t pairs = 0;
    for (int k = 0; k < 150; ++k) {
        const scene particles = random_scene(test, &random);
        double largest = 0;
        for (int i = 0; i < particles.source_count; ++i)
            largest = fmax(largest, particles.support[i]);
        for (int i = 0; particles.targets && i < particles.target_count; ++i)
            largest = fmax(largest, particles.target_support[i]);
        pairs += rows_require_search_exact(context, neighbors, &particles, largest,
                                           test_text("cloud %d", k));
    }
    assert_true(pairs > 50000);
}

/* Long along one axis, which bars of cells then follow; every other one goes round. */
static void clouds_that_are_long_along_any_axis_have_the_pairs_of_brute_force(const test_case *test)
{
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(43);
    const int d = test->dimension;
    int64_t pairs = 0;
    for (int k = 0; k < 8 * d; ++k) {
        const int axis = k % d;
        scene particles = scene_empty(test, 400);
        scatter(&particles, 400, particles.sources, -1.25, 2.5, &random);
        for (int i = 0; i < 400; ++i)
            particles.sources[i * d + axis] *= 4; /* exact */
        particles.support = radii_for(&particles, 400, particles.sources, 2.5, 6, 0, &random);
        particles.period[axis] = k / d & 1 ? 10 : 0;
        particles.period[(axis + 1) % d] = k / d & 2 ? 2.5 : 0;
        particles.mutual = k / d >> 2;
        pairs += rows_require_search_exact(context, neighbors, &particles, 1,
                                           test_text("axis %d, cloud %d", axis, k));
    }
    assert_true(pairs > 2000);
}

/* Beyond 2^31 the small ones' cells are much wider than they reach. */
static void a_giant_hides_nobody(const test_case *test)
{
    enum { COUNT = 60 };
    /* In 3D f32 takes no larger ones. */
    const int most = test_field_type(test) == SPHG_F32 && test->dimension == 3 ? 42 : 60;
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(317 + (uint64_t)test->precision);
    int64_t pairs = 0;
    for (int k = 0; k <= most; ++k) {
        scene particles = scene_empty(test, COUNT);
        scatter(&particles, COUNT, particles.sources, -4, 8, &random);
        particles.support = test_memory(COUNT * sizeof *particles.support);
        for (int i = 0; i < COUNT; ++i)
            particles.support[i] = i % 3 ? 1 : 2;
        particles.support[random_index(&random, COUNT)] = ldexp(1, k);
        particles.list_free = k % 2;
        particles.mutual = k / 2 % 2;
        pairs += rows_require_search_exact(context, neighbors, &particles, fmax(2, ldexp(1, k)),
                                           test_text("radii of up to 2^%d", k));
    }
    assert_true(pairs > most * COUNT);
}

/* Where cells are small beside the period their numbers are too large for the tree, and large
 * particles near its ends look at both of them. */
static void tiny_particles_near_the_ends_of_a_period_are_found_once(const test_case *test)
{
    enum { COUNT = 24, PERIOD = 8 };
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(313 + (uint64_t)test->precision);
    int64_t pairs = 0;
    for (int k = 0; k < 120; ++k) {
        scene particles = scene_empty(test, COUNT);
        particles.support = test_memory(COUNT * sizeof *particles.support);
        for (int c = 0; c < COUNT * test->dimension; ++c)
            particles.sources[c] =
                scene_rounded(&particles, (random_index(&random, 5) - 2) * PERIOD +
                                              random_between(&random, -1, 1));
        for (int i = 0; i < COUNT; ++i)
            particles.support[i] = i % 4 ? 1 : scene_rounded(&particles, ldexp(1, -20 - i));
        particles.target_count =
            random_index(&random, 2) ? COUNT : 1 + random_index(&random, COUNT);
        for (int a = 0; a < test->dimension; ++a)
            particles.period[a] = random_index(&random, 3) ? PERIOD : 0;
        particles.list_free = random_index(&random, 2);
        particles.mutual = random_index(&random, 2);
        pairs +=
            rows_require_search_exact(context, neighbors, &particles, 1, test_text("cloud %d", k));
    }
    assert_true(pairs > 2000);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void operators_match_the_oracle(const test_case *test)
{
    static const double ratios[] = {1.5, 8, 64};
    for (int k = 0; k < 3; ++k) {
        graded block = graded_block(test->dimension, ratios[k], 2.5);
        comparison on =
            comparison_of_radii(test, "graded block", block.points, block.radii, k == 1);
        setup_array table = comparison_table(&on);
        graded_compare(&on, SPHG_SCALAR, SPHG_DIFFERENCE, NULL);
        graded_compare(&on, SPHG_SCALAR, SPHG_DIRECT, &table);
        graded_compare(&on, SPHG_VECTOR, SPHG_DIFFERENCE, &table);
        graded_compare(&on, SPHG_VECTOR, SPHG_DIRECT, NULL);
        graded_compare(&on, SPHG_TENSOR, SPHG_DIFFERENCE, NULL);
    }
}

/* ---- Known figures --------------------------------------------------------------------------- */

enum { RINGS = 26 };

/* Rings around the origin whose radii grow so many times, H = c spacings. */
static comparison rings(const test_case *test, double ratio, double c, int mutual)
{
    const double grown = log(ratio);
    cloud points = cloud_lattice(2, RINGS, 1);
    double *radii = test_memory(RINGS * RINGS * sizeof *radii),
           *volume = test_memory(RINGS * RINGS * sizeof *volume);
    for (int i = 0; i < points.count; ++i) {
        const double u = (i % RINGS + .5) / RINGS, v = (i / RINGS + .5) / RINGS;
        const double spacing = grown * exp(grown * u) / RINGS;
        points.x[2 * i] = exp(grown * u) * cos(grown * v);
        points.x[2 * i + 1] = exp(grown * u) * sin(grown * v);
        radii[i] = c * spacing * (1 + 1e-7);
        volume[i] = spacing * spacing;
    }
    const comparison made = comparison_of_radii(test, "rings", points, radii, mutual);
    return comparison_with_volumes(&made, volume);
}

typedef struct ring_errors {
    double most, inside; /* of all, and two rings off the rim */
} ring_errors;

/* Of the gradient of A = cos(2x / ratio) + sin(3y / ratio), times the ratio. */
static ring_errors errors_on_rings(const comparison *on, double ratio)
{
    ring_errors worst = {0, 0};
    double *a = test_memory((size_t)on->points.count * sizeof *a);
    for (int i = 0; i < on->points.count; ++i)
        a[i] = cos(2 * on->points.x[2 * i] / ratio) + sin(3 * on->points.x[2 * i + 1] / ratio);
    const comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, a};
    const comparison_result found = comparison_apply(on, &field, NULL);
    for (int i = 0; i < on->points.count; ++i) {
        const double *x = on->points.x + 2 * i;
        const double error =
            hypot(ratio * setup_get(&found.gradient, i, 0) + 2 * sin(2 * x[0] / ratio),
                  ratio * setup_get(&found.gradient, i, 1) - 3 * cos(3 * x[1] / ratio));
        const int u = i % RINGS, v = i / RINGS;
        worst.most = test_larger(worst.most, error);
        if (u > 1 && v > 1 && u < RINGS - 2 && v < RINGS - 2)
            worst.inside = test_larger(worst.inside, error);
    }
    return worst;
}

/* By an independent program: order 1 with H = 2 spacings, order 2 with 3. */
static void errors_and_pairs_of_rings_are_known(const test_case *test)
{
    static const struct {
        double ratio;
        ring_errors errors[2];
        double pairs[2][2]; /* [c is 2, 3][mutual] */
    } known[] = {{2, {{.10835, .00296}, {.00689, .00605}}, {{10.31, 11.24}, {24.40, 25.28}}},
                 {8, {{.25435, .01804}, {.05097, .03799}}, {{10.31, 11.24}, {24.40, 28.69}}},
                 {64, {{.55012, .05380}, {.19462, .11338}}, {{12.09, 14.79}, {28.58, 37.05}}}};
    for (int k = 0; k < 3; ++k)
        for (int way = 0; way < 4; ++way) {
            comparison on = rings(test, known[k].ratio, 2 + way / 2, way % 2);
            on.scheme.order = 1 + way / 2;
            sphg_neighbors_info info;
            SETUP_OK(on.context, sphg_neighbors_get_info(on.context, on.neighbors, &info));
            const double pairs = (double)info.pairs / on.points.count;
            TEST_REQUIRE(fabs(pairs - known[k].pairs[way / 2][way % 2]) < .0051,
                         "%g pairs, ratio %g, way %d", pairs, known[k].ratio, way);
            const ring_errors found = errors_on_rings(&on, known[k].ratio),
                              expected = known[k].errors[way / 2];
            TEST_REQUIRE(fabs(found.most - expected.most) < 6e-6 &&
                             fabs(found.inside - expected.inside) < 6e-6,
                         "errors %.5f, %.5f, ratio %g, order %d", found.most, found.inside,
                         known[k].ratio, on.scheme.order);
        }
}

/* ---- The same bits --------------------------------------------------------------------------- */

static void require_same_bits(const comparison *a, const comparison *b, int mutual,
                              const char *where)
{
    const setup_array table = comparison_table(a), other = comparison_table(b);
    TEST_REQUIRE(setup_same_bits(&table, &other), "table, %s", where);
    for (int form = SPHG_DIFFERENCE; form <= (mutual ? SPHG_ADJOINT : SPHG_DIRECT); ++form) {
        const int two_sided = form >= SPHG_SYMMETRIC, direct = form == SPHG_DIRECT;
        comparison_field field = {SPHG_SCALAR, (sphg_form)form,
                                  comparison_random_field(a, SPHG_SCALAR, 3)};
        if (direct && a->scheme.order == 2)
            continue;
        const comparison_result one = comparison_apply(a, &field, two_sided ? &table : NULL),
                                two = comparison_apply(b, &field, two_sided ? &table : NULL);
        TEST_REQUIRE(comparison_results_have_same_bits(&one, &two), "form %d, %s", form, where);
    }
}

/* Second derivatives, what is lent and what comes of it. */
static void require_same_second(const comparison *a, const comparison *b, const char *where)
{
    const double *numbers = comparison_random_field(a, SPHG_VECTOR, 4);
    second_order_how how = {.lends = 1};
    const second_order one = second_order_apply(a, SPHG_VECTOR, numbers, how),
                       two = second_order_apply(b, SPHG_VECTOR, numbers, how);
    second_order_require_same_bits(&one, &two, where);
    how.lent = &one.curvature;
    const second_order borrowed = second_order_apply(a, SPHG_VECTOR, numbers, how),
                       other = second_order_apply(b, SPHG_VECTOR, numbers, how);
    second_order_require_same_bits(&borrowed, &other, where);
}

/* Also where a stride of 0 gives one radius to all; the scheme's is not read. */
static void same_radii_give_the_bits_of_one(const test_case *test)
{
    random_state random = random_seeded(9);
    const int d = test->dimension;
    comparison one =
        comparison_of(test, "block", cloud_jittered(d, d == 2 ? 9 : 5, .125, .3, &random), .275);
    double *radii = test_memory((size_t)one.points.count * sizeof *radii);
    for (int i = 0; i < one.points.count; ++i)
        radii[i] = one.scheme.support_radius;
    const setup_array x = setup_positions(test, &one.points);
    const setup_array h = setup_numbers(test_position_type(test), one.points.count, 1, radii);
    for (int way = 0; way < 8; ++way) {
        comparison same = one;
        sphg_geometry geometry = setup_geometry(test, &one.points, &x);
        geometry.source_support = setup_view(&h);
        geometry.source_support.stride *= way & 1;
        geometry.mutual = way >> 1 & 1;
        geometry.list_free = way >> 2;
        same.scheme.support_radius = way & 1 ? 0 : 17;
        same.neighbors = setup_search(one.context, &same.scheme, &geometry);
        require_same_bits(&one, &same, geometry.mutual, test_text("way %d", way));
        if (test_is_classic(test) || test->method == SPHG_PLAIN)
            continue;
        one = second_order_comparison(one);
        same = second_order_comparison(same);
        require_same_bits(&one, &same, geometry.mutual, test_text("order 2, way %d", way));
        require_same_second(&one, &same, test_text("order 2, way %d", way));
        one.scheme.order = 1;
    }
}

/* Lengths and radii times a power of two: every bit but the exponents stays. */
static void results_scale_with_the_unit_of_length(const test_case *test)
{
    for (int k = -3; k <= 5; k += 4) {
        graded block = graded_block(test->dimension, 8, 2.2), other = block;
        const comparison on =
            comparison_of_radii(test, "graded block", block.points, block.radii, 0);
        other.points = cloud_copy(&on.points);
        other.radii = test_memory((size_t)on.points.count * sizeof *other.radii);
        for (int i = 0; i < on.points.count * test->dimension; ++i)
            other.points.x[i] = ldexp(on.points.x[i], k);
        for (int i = 0; i < on.points.count; ++i)
            other.radii[i] = ldexp(on.scene.support[i], k);
        other.points.spacing = ldexp(other.points.spacing, k);
        const comparison scaled =
            comparison_of_radii(test, "scaled block", other.points, other.radii, 0);
        comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                                  comparison_random_field(&on, SPHG_SCALAR, 3)};
        const comparison_result a = comparison_apply(&on, &field, NULL);
        const comparison_result b = comparison_apply(&scaled, &field, NULL);
        for (int i = 0; i < on.points.count; ++i)
            for (int c = 0; c < test->dimension; ++c)
                TEST_REQUIRE(setup_get(&a.gradient, i, c) == ldexp(setup_get(&b.gradient, i, c), k),
                             "particle %d, 2^%d", i, k);
    }
}

/* ---- Ways to the same result ----------------------------------------------------------------- */

static comparison graded_stage(const test_case *test, int mutual)
{
    graded block = graded_block(test->dimension, 8, 2.2);
    return comparison_of_radii(test, "graded block", block.points, block.radii, mutual);
}

static void tables_subsets_and_lists_give_the_same_bits(const test_case *test)
{
    const comparison on = graded_stage(test, 0), mutual = graded_stage(test, 1);
    const setup_array table = comparison_table(&on);
    for (int form = SPHG_DIFFERENCE; form <= SPHG_DIRECT; ++form) {
        comparison_field field = {SPHG_VECTOR, (sphg_form)form,
                                  comparison_random_field(&on, SPHG_VECTOR, 4)};
        const comparison_result fused = comparison_apply(&on, &field, NULL);
        const comparison_result given = comparison_apply(&on, &field, &table);
        const comparison_result wide = comparison_apply(&mutual, &field, NULL);
        assert_true(comparison_results_have_same_bits(&fused, &given));
        for (int i = 0; i < on.points.count; ++i) { /* other lists: another order of the sums */
            comparison_compare(&on, &field, &wide, i);
            i += on.points.count / 4;
        }
        const sphg_subset one = sphg_range(on.points.count / 2, on.points.count / 2 + 1);
        const comparison_result alone = comparison_apply_to(&on, &field, NULL, &one);
        for (int k = 0; k < alone.gradient.width; ++k)
            assert_true(setup_get(&alone.gradient, one.begin, k) ==
                        setup_get(&fused.gradient, one.begin, k));
    }
}

/* Targets left out here and there: what is left of each group has its own radii. */
static void masks_give_the_same_bits(const test_case *test)
{
    const comparison on = graded_stage(test, 1);
    const int n = on.points.count;
    const setup_array table = comparison_table(&on);
    uint8_t *mask = test_memory((size_t)n);
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form) {
        comparison_field field = {SPHG_VECTOR, (sphg_form)form,
                                  comparison_random_field(&on, SPHG_VECTOR, 4)};
        const comparison_result all = comparison_apply(&on, &field, &table);
        for (int every = 2; every < 9; every += 3) {
            for (int i = 0; i < n; ++i)
                mask[i] = i * 7 % every != 0;
            const sphg_subset some = sphg_masked(mask, n);
            const comparison_result found = comparison_apply_to(&on, &field, &table, &some);
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < found.gradient.width && mask[i]; ++k)
                    TEST_REQUIRE(setup_get(&found.gradient, i, k) == setup_get(&all.gradient, i, k),
                                 "form %d, particle %d", form, i);
        }
    }
}

/* What is farther than H_i does not count, whatever it is. */
static void nothing_comes_from_beyond_the_targets_radius(const test_case *test)
{
    const comparison on = graded_stage(test, 1);
    const int n = on.points.count, d = on.points.dimension;
    double *numbers = comparison_random_field(&on, SPHG_SCALAR, 5);
    int largest = 0, touched = 0;
    for (int i = 1; i < n; ++i)
        largest = on.scene.support[i] > on.scene.support[largest] ? i : largest;
    numbers[largest] = (double)NAN;
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers};
    const comparison_result found = comparison_apply(&on, &field, NULL);
    for (int i = 0; i < n; ++i) {
        double square = 0;
        for (int a = 0; a < d; ++a)
            square += pow(on.points.x[i * d + a] - on.points.x[largest * d + a], 2);
        const int near = sqrt(square) < on.scene.support[i] * (1 + 1e-6);
        touched += near;
        TEST_REQUIRE(near || isfinite(setup_get(&found.gradient, i, 0)), "particle %d", i);
    }
    assert_true(touched > 1);
}

/* ---- Skin ------------------------------------------------------------------------------------ */

enum { SKIN_COUNT = 400 };

/* Moves and growth of up to `share` of half the margin of each. */
static void move_all(const scene *particles, double *x, double *support, const double *radii,
                     double share, random_state *random)
{
    const int d = particles->dimension;
    for (int i = 0; i < SKIN_COUNT; ++i) {
        const double most = share * .15 * radii[i], growth = random_between(random, 0, .5);
        double way[3] = {0}, size = 0;
        for (int a = 0; a < d; ++a)
            size += pow(way[a] = random_between(random, -1, 1), 2);
        for (int a = 0; a < d; ++a)
            x[i * d + a] =
                scene_rounded(particles, x[i * d + a] + way[a] / sqrt(size) * most * (1 - growth));
        support[i] = scene_rounded(particles, radii[i] + most * growth);
    }
}

/* The first has the largest radius, 1. */
static double *scatter_with_radii(const scene *particles, double *x, double **support, double side,
                                  int rising, random_state *random)
{
    scatter(particles, SKIN_COUNT, x, 0, side, random);
    double *radii = radii_for(particles, SKIN_COUNT, x, side, 10, rising, random);
    radii[0] = 1;
    *support = test_memory(SKIN_COUNT * sizeof *radii);
    memcpy(*support, radii, SKIN_COUNT * sizeof *radii);
    return radii;
}

/* What is evaluated is what brute force finds now, whether lists were kept or not. Of targets
 * apart, these alone move, or the sources alone. */
static void skins_in_proportion_miss_no_pair(const test_case *test)
{
    sphg_context *context = setup_context_of(2);
    random_state random = random_seeded(41);
    int kept = 0, rebuilt = 0;
    for (int k = 0; k < 24; ++k) {
        scene particles = scene_empty(test, SKIN_COUNT);
        const double side = test->dimension == 2 ? 6 : 3, share = k & 4 ? 1.2 : .98;
        const int apart = k >= 12;
        double *radii = scatter_with_radii(&particles, particles.sources, &particles.support, side,
                                           k & 1, &random);
        double *of_targets = NULL;
        if (apart) {
            particles.targets = test_memory(SKIN_COUNT * 3 * sizeof(double));
            of_targets = scatter_with_radii(&particles, particles.targets,
                                            &particles.target_support, side, k & 1, &random);
        }
        particles.period[0] = k & 2 ? side : 0;
        particles.skin = .3;
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        rows_require_search_exact(context, neighbors, &particles, 1, "at first");
        if (apart && k & 1)
            move_all(&particles, particles.targets, particles.target_support, of_targets, share,
                     &random);
        else
            move_all(&particles, particles.sources, particles.support, radii, share, &random);
        particles.support[0] = 1;
        rows_require_search_exact(context, neighbors, &particles, 1.2, test_text("moved %d", k));
        sphg_neighbors_info info;
        SETUP_OK(context, sphg_neighbors_get_info(context, neighbors, &info));
        kept += !info.rebuilt;
        rebuilt += info.rebuilt;
        assert_true(info.skin_left >= 0 && info.skin_left <= .2);
    }
    assert_int_equal(kept, 12);
    assert_int_equal(rebuilt, 12);
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void pair_gradients_are_those_of_one_pair(const test_case *test)
{
    const comparison on = graded_stage(test, 0);
    graded_require_pair_gradients(&on, 0, 4096);
}

typedef struct written {
    int64_t *offsets;
    int32_t *indices;
    setup_array gradient;
} written;

static written write_pairs(const comparison *on, sphg_neighbors *neighbors, const setup_array *c,
                           int same_volume)
{
    const int n = on->points.count, most = n * n;
    written made = {test_memory(((size_t)n + 1) * sizeof *made.offsets),
                    test_memory((size_t)most * sizeof *made.indices),
                    setup_output(test_field_type(on->test), most, on->points.dimension)};
    sphg_sources sources = comparison_sources(on);
    sources.neighbors = neighbors;
    if (same_volume)
        sources.volume.stride = 0;
    if (on->test->method != SPHG_PLAIN)
        sources.correction = comparison_table_view(on, c);
    sphg_pairs pairs = {.offsets = made.offsets,
                        .indices = made.indices,
                        .gradient = setup_view(&made.gradient),
                        .capacity = most};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, sphg_absent(), &pairs));
    return made;
}

/* Lists that hold more, those of a skin, where particles have moved since: the pairs are those of a
 * search of now. */
static void pairs_of_mutual_lists_with_a_skin_are_those_without(const test_case *test)
{
    comparison on = graded_stage(test, 1);
    const int n = on.points.count, d = test->dimension;
    const setup_array table = comparison_table(&on);
    const setup_array h = setup_numbers(test_position_type(test), n, 1, on.scene.support);
    random_state random = random_seeded(31);
    sphg_neighbors *skinned = NULL;
    for (int step = 0; step < 3; ++step) {
        for (int i = 0; i < n * d && step; ++i)
            on.points.x[i] += .02 * on.scene.support[i / d] * random_between(&random, -1, 1);
        const setup_array x = setup_positions(test, &on.points);
        sphg_geometry geometry = setup_geometry(test, &on.points, &x);
        geometry.source_support = setup_view(&h);
        geometry.mutual = 1;
        sphg_neighbors *const plain = setup_search(on.context, &on.scheme, &geometry);
        geometry.skin = .5;
        if (!skinned)
            skinned = setup_search(on.context, &on.scheme, &geometry);
        else
            SETUP_OK(on.context, sphg_neighbors_search(on.context, skinned, &on.scheme, &geometry));
        const written a = write_pairs(&on, plain, &table, step > 1);
        const written b = write_pairs(&on, skinned, &table, step > 1);
        TEST_REQUIRE(memcmp(a.offsets, b.offsets, ((size_t)n + 1) * sizeof *a.offsets) == 0,
                     "%lld pairs and %lld", (long long)a.offsets[n], (long long)b.offsets[n]);
        for (int64_t k = 0; k < a.offsets[n]; ++k) {
            assert_int_equal(a.indices[k], b.indices[k]);
            for (int c = 0; c < d; ++c)
                assert_true(setup_get(&a.gradient, (int)k, c) == setup_get(&b.gradient, (int)k, c));
        }
    }
}

/* Of the particles themselves, and of targets apart, which are every other one of them. */
static void lists_of_the_library_pass_the_check(const test_case *test)
{
    for (int mutual = 0; mutual < 2; ++mutual) {
        comparison on = graded_stage(test, mutual);
        sphg_list_fault fault;
        SETUP_OK(on.context, sphg_neighbors_check(on.context, &on.scheme, on.neighbors, &fault));
        assert_int_equal(fault.kind, SPHG_FAULT_NONE);
        const setup_array x = setup_positions(test, &on.points);
        const setup_array h =
            setup_numbers(test_position_type(test), on.points.count, 1, on.scene.support);
        sphg_geometry apart = setup_geometry(test, &on.points, &x);
        apart.targets = apart.sources;
        apart.targets.stride *= 2;
        apart.target_count = on.points.count / 2;
        apart.source_support = apart.target_support = setup_view(&h);
        apart.target_support.stride *= 2;
        apart.mutual = mutual;
        const sphg_neighbors *neighbors = setup_search(on.context, &on.scheme, &apart);
        SETUP_OK(on.context, sphg_neighbors_check(on.context, &on.scheme, neighbors, &fault));
        assert_int_equal(fault.kind, SPHG_FAULT_NONE);
    }
}

/* ---- Omega ----------------------------------------------------------------------------------- */

/* tr M / (d rho) is 1 + (H / (d rho)) sum m dW/dH, differentiated by a quotient. */
static void moments_hold_the_grad_h_term(const test_case *test)
{
    const comparison on = graded_stage(test, 0);
    const int d = test->dimension;
    for (int i = 0; i < on.points.count; i += 11) {
        const oracle_point *point = oracle_at(on.reference, i);
        sphg_scheme low = on.scheme, high = on.scheme;
        const double H = on.scene.support[i], step = 1e-5;
        low.support_radius = H * (1 - step);
        high.support_radius = H * (1 + step);
        double trace = 0, rho = 0, below = 0, above = 0;
        for (int a = 0; a < d; ++a)
            trace += (double)point->moment[a][a];
        for (int k = -1; k < point->pair_count; ++k) {
            const double r = k < 0 ? 0 : (double)point->pairs[k].r;
            const double m = on.scene.volume[k < 0 ? i : point->pairs[k].j];
            sphg_scheme own = on.scheme;
            double w[3];
            own.support_radius = H;
            sphg_kernel_value(&own, r, &w[0], NULL);
            sphg_kernel_value(&low, r, &w[1], NULL);
            sphg_kernel_value(&high, r, &w[2], NULL);
            rho += m * w[0];
            below += m * w[1];
            above += m * w[2];
        }
        const double omega = 1 + (above - below) / (2 * step) / (d * rho);
        TEST_REQUIRE(fabs(omega - trace / (d * rho)) < 1e-7, "Omega %g, moments give %g", omega,
                     trace / (d * rho));
    }
}

/* ---- Several sets ---------------------------------------------------------------------------- */

/* The sources in two halves: the sums of both are those of all. */
static void halves_add_up(const test_case *test)
{
    graded block = graded_block(test->dimension, 8, 2.2);
    const comparison on = comparison_of_radii(test, "graded block", block.points, block.radii, 0);
    const int n = on.points.count, d = on.points.dimension, half = n / 2;
    const setup_array x = setup_positions(test, &block.points);
    const setup_array h = setup_numbers(test_position_type(test), n, 1, block.radii);
    double *numbers = comparison_random_field(&on, SPHG_SCALAR, 6);
    const setup_array a = setup_numbers(test_field_type(test), n, 1, numbers);
    sphg_sources sets[2] = {{0}, {0}};
    sphg_view at_sources[2];
    for (int s = 0; s < 2; ++s) {
        const int count = s ? n - half : half;
        sphg_view places = setup_view(&x), radii = setup_view(&h);
        sphg_view volumes = setup_view(&on.volume), values = setup_view(&a);
        sphg_view *const views[] = {&places, &radii, &volumes, &values};
        for (int k = 0; k < 4 && s; ++k)
            views[k]->x = (const char *)views[k]->x + half * views[k]->stride;
        sphg_geometry geometry = sphg_targets_apart(setup_view(&x), n, places, count);
        geometry.source_support = radii;
        geometry.target_support = setup_view(&h);
        geometry.precision = test_field_type(test);
        sets[s].neighbors = setup_search(on.context, &on.scheme, &geometry);
        sets[s].volume = volumes;
        at_sources[s] = values;
    }
    const setup_array gradient = setup_output(test_field_type(test), n, d);
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = at_sources};
    field.at_targets = setup_view(&a);
    field.gradient = setup_view(&gradient);
    sphg_request request = {.sources = sets, .fields = &field, .set_count = 2, .field_count = 1};
    request.target_volume = setup_view(&on.volume);
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    comparison_field asked = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers};
    comparison_result both = {.gradient = gradient};
    for (int i = 0; i < n; i += n / 9)
        comparison_compare(&on, &asked, &both, i);
}

/* ---- What is refused ------------------------------------------------------------------------- */

static void require_refused(const comparison *on, sphg_result found, sphg_result expected,
                            const char *words)
{
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(found == expected && strstr(message, words), "%s: %s", sphg_result_string(found),
                 message);
}

static void what_has_one_radius_says_so(const test_case *test)
{
    const comparison on = graded_stage(test, 0);
    const int n = on.points.count;
    const setup_array a =
        setup_numbers(test_field_type(test), n, 1, comparison_random_field(&on, SPHG_SCALAR, 7));
    const setup_array out = setup_output(test_field_type(test), n, test->dimension);
    sphg_sources sources = comparison_sources(&on);
    require_refused(&on,
                    sphg_force(on.context, &on.scheme, &sources, NULL, SPHG_SCALAR, setup_view(&a),
                               setup_view(&out)),
                    SPHG_ERROR_UNSUPPORTED, "not mutual");
    const comparison one = comparison_of(test, "block", cloud_copy(&on.points), .25);
    sphg_sources sets[2] = {sources, comparison_sources(&one)};
    sphg_view at_sources[2] = {setup_view(&a), setup_view(&a)};
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = at_sources};
    field.gradient = setup_view(&out);
    sphg_request request = {.sources = sets, .fields = &field, .set_count = 2, .field_count = 1};
    require_refused(&on, sphg_evaluate(on.context, &on.scheme, &request), SPHG_ERROR_SIZE,
                    "one radius for all");
}

static void half_given_radii_are_refused(const test_case *test)
{
    const comparison on = graded_stage(test, 0);
    const setup_array x = setup_positions(test, (cloud *)(uintptr_t)&on.points);
    const setup_array h =
        setup_numbers(test_position_type(test), on.points.count, 1, on.scene.support);
    sphg_geometry geometry = setup_geometry(test, &on.points, &x);
    geometry.target_support = setup_view(&h);
    require_refused(&on, sphg_neighbors_search(on.context, on.neighbors, &on.scheme, &geometry),
                    SPHG_ERROR_ARGUMENT, "part of the sources");
    geometry.targets = geometry.sources;
    require_refused(&on, sphg_neighbors_search(on.context, on.neighbors, &on.scheme, &geometry),
                    SPHG_ERROR_ARGUMENT, "source_support is absent");
    geometry.source_support = geometry.target_support;
    geometry.target_support = sphg_absent();
    require_refused(&on, sphg_neighbors_search(on.context, on.neighbors, &on.scheme, &geometry),
                    SPHG_ERROR_ARGUMENT, "target_support is absent");
    geometry.targets = sphg_absent();
    geometry.period[0] = 1e-3;
    require_refused(&on, sphg_neighbors_search(on.context, on.neighbors, &on.scheme, &geometry),
                    SPHG_ERROR_ARGUMENT, "geometry.period[0]");
}

static const test_entry entries[] = {
    TEST_ENTRY(random_clouds_have_the_pairs_of_brute_force, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(clouds_that_are_long_along_any_axis_have_the_pairs_of_brute_force,
               TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(a_giant_hides_nobody, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(tiny_particles_near_the_ends_of_a_period_are_found_once, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(operators_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(errors_and_pairs_of_rings_are_known, TEST_BIT(TEST_F64), TEST_2D, 0, 0),
    TEST_ENTRY(same_radii_give_the_bits_of_one, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(results_scale_with_the_unit_of_length, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(tables_subsets_and_lists_give_the_same_bits, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(masks_give_the_same_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(nothing_comes_from_beyond_the_targets_radius, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(skins_in_proportion_miss_no_pair, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(pair_gradients_are_those_of_one_pair, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(pairs_of_mutual_lists_with_a_skin_are_those_without, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(lists_of_the_library_pass_the_check, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0,
               0),
    TEST_ENTRY(moments_hold_the_grad_h_term, 0, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(halves_add_up, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(what_has_one_radius_says_so, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(half_given_radii_are_refused, TEST_ALL_PRECISIONS, 0, 0, 0),
};
TEST_MAIN(entries)
