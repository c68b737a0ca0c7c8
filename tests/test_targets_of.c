/* SPDX-License-Identifier: MIT */
/* Searches whose targets are those of another object: as if they were handed over once more. */
#include "support/brute_force.h"
#include "support/setup.h"
#include <string.h>

enum { FLUID = 300, WALL = 400 };

typedef struct pair_of {
    sphg_context *context;
    scene fluid, wall; /* wall: with the fluid's targets, handed over */
    double support[FLUID], wall_support[WALL];
    sphg_neighbors *own, *beside;
} pair_of;

static void scatter(const scene *particles, double *x, int count, random_state *random)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = scene_rounded(particles, random_between(random, 0, 4));
}

static pair_of pair_for(const test_case *test, int threads, random_state *random)
{
    pair_of made = {.context = setup_context_of(threads),
                    .fluid = scene_empty(test, FLUID),
                    .wall = scene_empty(test, WALL)};
    scatter(&made.fluid, made.fluid.sources, FLUID, random);
    scatter(&made.wall, made.wall.sources, WALL, random);
    made.own = brute_force_neighbors(made.context);
    made.beside = brute_force_neighbors(made.context);
    return made;
}

/* As the fluid's targets stand now. */
static void hand_over(pair_of *pair)
{
    scene *fluid = &pair->fluid;
    pair->wall.targets = fluid->targets ? fluid->targets : fluid->sources;
    pair->wall.target_count = fluid->target_count;
    memcpy(pair->wall.period, fluid->period, sizeof fluid->period);
    if (fluid->support)
        pair->wall.target_support = fluid->targets ? fluid->target_support : fluid->support;
}

static void search(sphg_context *context, sphg_neighbors *neighbors, const scene *particles,
                   double H)
{
    const sphg_scheme scheme = {.dimension = particles->dimension, .support_radius = H};
    const sphg_geometry geometry = scene_geometry(particles);
    SETUP_OK(context, sphg_neighbors_search(context, neighbors, &scheme, &geometry));
}

static sphg_geometry geometry_of(const pair_of *pair, const sphg_neighbors *other)
{
    const sphg_geometry wall = scene_geometry(&pair->wall);
    sphg_geometry geometry = sphg_targets_of(other, wall.sources, wall.source_count);
    geometry.source_support = wall.source_support;
    geometry.mutual = wall.mutual;
    geometry.precision = wall.precision;
    geometry.list_free = wall.list_free;
    geometry.skin = wall.skin;
    memcpy(geometry.period, wall.period, sizeof wall.period);
    return geometry;
}

static sphg_result search_beside(const pair_of *pair, const sphg_neighbors *other, double H)
{
    const sphg_scheme scheme = {.dimension = pair->wall.dimension, .support_radius = H};
    const sphg_geometry geometry = geometry_of(pair, other);
    return sphg_neighbors_search(pair->context, pair->beside, &scheme, &geometry);
}

static void require_pairs(pair_of *pair, double H, const char *where)
{
    const sphg_scheme scheme = {.dimension = pair->wall.dimension, .support_radius = H};
    hand_over(pair);
    const rows expected = rows_by_brute_force(&pair->wall, H);
    const rows found = rows_listed(pair->context, pair->beside, &scheme, NULL);
    rows_require_equal(&found, &expected, where);
}

/* ---- The pairs ------------------------------------------------------------------------------- */

/* What a step may change. */
static void next_step(pair_of *pair, double *H, random_state *random)
{
    static double apart[FLUID * 3];
    scene *fluid = &pair->fluid, *wall = &pair->wall;
    if (random_index(random, 2))
        scatter(fluid, fluid->sources, FLUID, random);
    if (random_index(random, 4) == 0)
        scatter(wall, wall->sources, WALL, random);
    scatter(fluid, apart, FLUID, random);
    const int kind = random_index(random, 3); /* all; own and ghosts; apart */
    fluid->targets = kind == 2 ? apart : NULL;
    fluid->target_count = kind == 1 ? FLUID / 3 : FLUID;
    fluid->list_free = random_index(random, 3) == 0;
    wall->list_free = random_index(random, 3) == 0;
    fluid->skin = !fluid->list_free && random_index(random, 4) == 0 ? .25 : 0;
    wall->skin = !wall->list_free && random_index(random, 4) == 0 ? .25 : 0;
    fluid->period[0] = random_index(random, 4) == 0 ? 4 : 0;
    *H = random_index(random, 4) == 0 ? .7 : .5;
}

static void pairs_are_those_of_brute_force(const test_case *test)
{
    for (int threads = 1; threads < 3; ++threads) {
        random_state random = random_seeded(90 + (uint64_t)threads);
        pair_of pair = pair_for(test, threads, &random);
        double H = .5, own_H = .5;
        for (int step = 0; step < 24; ++step) {
            next_step(&pair, &H, &random);
            own_H = random_index(&random, 4) == 0 ? .75 : H;
            search(pair.context, pair.own, &pair.fluid, own_H);
            hand_over(&pair);
            SETUP_OK(pair.context, search_beside(&pair, pair.own, H));
            require_pairs(&pair, H, test_text("%d threads, step %d", threads, step));
        }
    }
}

/* Each particle of the wall about H from one of the fluid along x. */
static void stand_at_the_radius(pair_of *pair, double shift, random_state *random)
{
    const int d = pair->wall.dimension;
    scatter(&pair->fluid, pair->fluid.sources, FLUID, random);
    for (int k = 0; k < WALL * d; ++k) {
        const double sign = random_index(random, 2) ? 1 : -1;
        const double by = k % d ? 0 : sign * random_between(random, .499, .501);
        pair->wall.sources[k] =
            scene_rounded(&pair->wall, pair->fluid.sources[k % (FLUID * d)] + by);
    }
    for (int k = 0; k < FLUID * d; k += d)
        pair->fluid.sources[k] = scene_rounded(&pair->fluid, pair->fluid.sources[k] + shift);
}

/* So many periods away that coordinates have few digits left: only who knows how far out the
 * targets stand finds all. */
static void far_images_are_those_of_brute_force(const test_case *test)
{
    random_state random = random_seeded(93);
    pair_of pair = pair_for(test, 2, &random);
    const double shift = 4.0012 * (pair.wall.is_double ? 2.5e12 : 7500);
    pair.fluid.period[0] = 4.0012;
    for (int step = 0; step < 24; ++step) {
        stand_at_the_radius(&pair, step % 3 ? shift : 0, &random);
        search(pair.context, pair.own, &pair.fluid, .5);
        pair.wall.skin = step % 2 ? 0 : 1e-5; /* with a skin targets are copied */
        hand_over(&pair);
        SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
        require_pairs(&pair, .5, test_text("step %d", step));
    }
}

/* Radii come along with the places. */
static void radii_are_those_of_the_targets(const test_case *test)
{
    random_state random = random_seeded(94);
    pair_of pair = pair_for(test, 2, &random);
    pair.fluid.support = pair.support;
    pair.wall.support = pair.wall_support;
    for (int step = 0; step < 24; ++step) {
        const double low = step % 3 ? .2 : .5, high = step % 3 == 1 ? .9 : .5;
        for (int k = 0; k < FLUID; ++k)
            pair.support[k] = scene_rounded(&pair.fluid, random_between(&random, low, high));
        for (int k = 0; k < WALL; ++k)
            pair.wall_support[k] = step % 4
                                       ? pair.support[k % FLUID]
                                       : scene_rounded(&pair.wall, random_between(&random, .1, .4));
        pair.wall.mutual = step % 5 == 0;
        pair.fluid.skin = step % 7 == 0 ? .1 : 0;
        search(pair.context, pair.own, &pair.fluid, 1);
        hand_over(&pair);
        SETUP_OK(pair.context, search_beside(&pair, pair.own, 1));
        require_pairs(&pair, 1, test_text("step %d", step));
    }
}

/* Nobody to be near: also where the other object has radii, which such a set cannot have. */
static void empty_sets_have_no_pairs(const test_case *test)
{
    random_state random = random_seeded(99);
    pair_of pair = pair_for(test, 2, &random);
    const sphg_scheme scheme = {.dimension = test->dimension, .support_radius = .5};
    for (int k = 0; k < FLUID; ++k)
        pair.support[k] = .25 + .25 * (k & 1);
    for (int way = 0; way < 4; ++way) {
        pair.fluid.support = way & 1 ? pair.support : NULL;
        search(pair.context, pair.own, &pair.fluid, .5);
        sphg_geometry empty = geometry_of(&pair, pair.own);
        empty.source_count = 0;
        empty.target_count = way & 2 ? FLUID : 0;
        if (way & 2)
            empty.sources = sphg_absent();
        SETUP_OK(pair.context, sphg_neighbors_search(pair.context, pair.beside, &scheme, &empty));
        const rows found = rows_listed(pair.context, pair.beside, &scheme, NULL);
        TEST_REQUIRE(found.offsets[FLUID] == 0, "%lld pairs", (long long)found.offsets[FLUID]);
    }
}

/* ---- Results --------------------------------------------------------------------------------- */

static setup_array gradient_of(const test_case *test, const pair_of *pair)
{
    const sphg_scheme scheme = setup_scheme(test, .5);
    const sphg_type type = test_field_type(test);
    double ones[WALL], ramp[WALL];
    for (int k = 0; k < WALL; ++k) {
        ones[k] = .01;
        ramp[k] = k * .01;
    }
    const setup_array volumes = setup_numbers(type, WALL, 1, ones);
    const setup_array field = setup_numbers(type, WALL, 1, ramp);
    const setup_array gradient = setup_output(type, FLUID, test->dimension);
    const sphg_sources sources[] = {{.neighbors = pair->own, .volume = setup_view(&volumes)},
                                    {.neighbors = pair->beside, .volume = setup_view(&volumes)}};
    const sphg_view views[] = {setup_view(&field), setup_view(&field)};
    const sphg_field one = {
        .shape = SPHG_SCALAR, .at_sources = views, .gradient = setup_view(&gradient)};
    const sphg_request request = {
        .sources = sources, .fields = &one, .set_count = 2, .field_count = 1};
    SETUP_OK(pair->context, sphg_evaluate(pair->context, &scheme, &request));
    return gradient;
}

static void results_have_the_bits_of_targets_handed_over(const test_case *test)
{
    random_state random = random_seeded(95);
    pair_of pair = pair_for(test, 2, &random);
    search(pair.context, pair.own, &pair.fluid, .5);
    hand_over(&pair);
    search(pair.context, pair.beside, &pair.wall, .5);
    const setup_array expected = gradient_of(test, &pair);
    SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    const setup_array found = gradient_of(test, &pair);
    assert_true(setup_same_bits(&found, &expected));
}

/* ---- One grid for two objects ---------------------------------------------------------------- */

static int64_t bytes_of(const pair_of *pair)
{
    sphg_neighbors_info info = {0};
    SETUP_OK(pair->context, sphg_neighbors_get_info(pair->context, pair->beside, &info));
    return info.bytes;
}

static void memory_is_shared_and_warm(const test_case *test)
{
    fake_host *host = setup_hooks();
    random_state random = random_seeded(96);
    pair_of pair = pair_for(test, 1, &random);
    const sphg_config config = fake_host_config(host, 2);
    pair.context = setup_context_with(&config);
    pair.own = brute_force_neighbors(pair.context);
    pair.beside = brute_force_neighbors(pair.context);
    search(pair.context, pair.own, &pair.fluid, .5);
    hand_over(&pair);
    search(pair.context, pair.beside, &pair.wall, .5);
    const int64_t apart = bytes_of(&pair);
    const size_t row = pair.wall.is_double ? 32 : 16;
    SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    TEST_REQUIRE(bytes_of(&pair) <= apart - (int64_t)(FLUID * (row + 8)), "%d of %d bytes",
                 (int)bytes_of(&pair), (int)apart);
    const int64_t before = host->allocations;
    for (int step = 0; step < 5; ++step) {
        search(pair.context, pair.own, &pair.fluid, .5);
        SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    }
    assert_int_equal(host->allocations, before);
    search(pair.context, pair.beside, &pair.wall, .5); /* its own again */
    require_pairs(&pair, .5, "handed over again");
}

static void require_refused(const pair_of *pair, sphg_result result, sphg_result expected,
                            const char *words)
{
    const char *message = sphg_last_message(pair->context);
    TEST_REQUIRE(result == expected, "%s", sphg_result_string(result));
    TEST_REQUIRE(strstr(message, words), "%s", message);
}

/* Who builds the other object anew, and forgets this one, is told. */
static void targets_that_were_built_anew_are_refused(const test_case *test)
{
    static const char *const anew = "built anew since";
    random_state random = random_seeded(97);
    pair_of pair = pair_for(test, 2, &random);
    sphg_neighbors *third = brute_force_neighbors(pair.context);
    const sphg_scheme scheme = setup_scheme(test, .5);
    sphg_pairs pairs = {0};
    search(pair.context, pair.own, &pair.fluid, .5);
    hand_over(&pair);
    SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    for (int k = 0; k < 2; ++k) { /* of an object whose targets are another's themselves */
        const sphg_geometry geometry = geometry_of(&pair, pair.beside);
        sphg_result result = sphg_neighbors_search(pair.context, third, &scheme, &geometry);
        if (k) {
            require_refused(&pair, result, SPHG_ERROR_STATE, anew);
            break;
        }
        SETUP_OK(pair.context, result);
        search(pair.context, pair.own, &pair.fluid, .5);
        const sphg_sources of[] = {{.neighbors = pair.beside}, {.neighbors = third}};
        for (int n = 0; n < 2; ++n) {
            result =
                sphg_pair_gradients(pair.context, &scheme, &of[n], NULL, sphg_absent(), &pairs);
            require_refused(&pair, result, SPHG_ERROR_STATE, anew);
            result = sphg_neighbors_check(pair.context, &scheme, of[n].neighbors, NULL);
            require_refused(&pair, result, SPHG_ERROR_STATE, anew);
        }
    }
    SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    require_pairs(&pair, .5, "searched again");
    const sphg_geometry geometry = geometry_of(&pair, pair.beside);
    SETUP_OK(pair.context, sphg_neighbors_search(pair.context, third, &scheme, &geometry));
    const rows expected = rows_by_brute_force(&pair.wall, .5);
    const rows found = rows_listed(pair.context, third, &scheme, NULL);
    rows_require_equal(&found, &expected, "of an object whose targets are another's");
}

/* ---- What does not fit ----------------------------------------------------------------------- */

static void refuse(const pair_of *pair, const sphg_geometry *geometry, int dimension,
                   sphg_result expected, const char *words)
{
    const sphg_scheme scheme = {.dimension = dimension, .support_radius = .5};
    const sphg_result result =
        sphg_neighbors_search(pair->context, pair->beside, &scheme, geometry);
    require_refused(pair, result, expected, words);
}

static void what_does_not_fit_is_refused(const test_case *test)
{
    random_state random = random_seeded(98);
    pair_of pair = pair_for(test, 1, &random);
    const int d = test->dimension;
    sphg_geometry wrong = geometry_of(&pair, pair.own);
    refuse(&pair, &wrong, d, SPHG_ERROR_STATE, "targets_of holds no search");
    search(pair.context, pair.own, &pair.fluid, .5);
    hand_over(&pair);
    SETUP_OK(pair.context, search_beside(&pair, pair.own, .5));
    wrong = geometry_of(&pair, pair.beside);
    refuse(&pair, &wrong, d, SPHG_ERROR_ARGUMENT, "the object that is to be built");
    wrong = geometry_of(&pair, pair.own);
    wrong.targets = wrong.sources;
    refuse(&pair, &wrong, d, SPHG_ERROR_ARGUMENT, "geometry.targets and targets_of are both set");
    wrong = geometry_of(&pair, pair.own);
    wrong.target_support = wrong.sources;
    refuse(&pair, &wrong, d, SPHG_ERROR_ARGUMENT,
           "geometry.target_support and targets_of are both set");
    wrong = geometry_of(&pair, pair.own);
    wrong.target_count = FLUID - 1;
    refuse(&pair, &wrong, d, SPHG_ERROR_SIZE, "target_count is 299, but targets_of has 300");
    wrong = geometry_of(&pair, pair.own);
    refuse(&pair, &wrong, 5 - d, SPHG_ERROR_ARGUMENT, "in geometry.targets_of");
    wrong.sources.type = pair.wall.is_double ? SPHG_F32 : SPHG_F64;
    refuse(&pair, &wrong, d, SPHG_ERROR_TYPE, "positions of targets_of");
    wrong = geometry_of(&pair, pair.own);
    wrong.period[1] = 5;
    refuse(&pair, &wrong, d, SPHG_ERROR_ARGUMENT, "period[1] is another one");
    pair.wall.support = pair.wall_support;
    for (int k = 0; k < WALL; ++k)
        pair.wall_support[k] = .5;
    wrong = geometry_of(&pair, pair.own);
    refuse(&pair, &wrong, d, SPHG_ERROR_ARGUMENT, "source_support is set, but targets_of has none");
    pair.wall.support = NULL;
    wrong = geometry_of(&pair, pair.own);
    const int64_t offsets[FLUID + 1] = {0};
    const sphg_lists lists = {.offsets = offsets};
    const sphg_scheme scheme = {.dimension = d, .support_radius = .5};
    const sphg_result result =
        sphg_neighbors_use_lists(pair.context, pair.beside, &scheme, &wrong, &lists);
    require_refused(&pair, result, SPHG_ERROR_ARGUMENT, "it is for searches only");
    require_pairs(&pair, .5, "the object is as it was");
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(pairs_are_those_of_brute_force), EACH(far_images_are_those_of_brute_force),
    EACH(radii_are_those_of_the_targets), EACH(results_have_the_bits_of_targets_handed_over),
    EACH(memory_is_shared_and_warm),      EACH(targets_that_were_built_anew_are_refused),
    EACH(empty_sets_have_no_pairs),       EACH(what_does_not_fit_is_refused),
};
TEST_MAIN(entries)
