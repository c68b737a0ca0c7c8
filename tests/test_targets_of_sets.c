/* SPDX-License-Identifier: MIT */
/* The source sets of a request must mean the same targets: in number, place and order. */
#include "support/setup.h"
#include <math.h>
#include <string.h>

enum { TARGETS = 300, WALL = 200 };

typedef struct scene {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    cloud fluid, wall;
    setup_array fluid_x, wall_x, fluid_volume, wall_volume, field[2], result;
    sphg_neighbors *own; /* fluid to fluid */
} scene;

static setup_array ones(const test_case *test, int count)
{
    double *numbers = test_memory((size_t)count * sizeof *numbers);
    for (int k = 0; k < count; ++k)
        numbers[k] = .01;
    return setup_numbers(test_field_type(test), count, 1, numbers);
}

static scene scene_of(const test_case *test, int trusted, int threads)
{
    random_state random = random_seeded(311);
    const sphg_config config = {.trusted = trusted, .threads = threads};
    scene made = {.test = test, .scheme = setup_scheme(test, .5)};
    made.context = setup_context_with(&config);
    made.fluid = cloud_random(test->dimension, TARGETS, 1, &random);
    made.wall = cloud_random(test->dimension, WALL, 1, &random);
    made.fluid_x = setup_positions(test, &made.fluid);
    made.wall_x = setup_positions(test, &made.wall);
    made.fluid_volume = ones(test, TARGETS);
    made.wall_volume = ones(test, WALL);
    made.field[0] = ones(test, TARGETS);
    made.field[1] = ones(test, WALL);
    made.result = setup_output(test_field_type(test), TARGETS, test->dimension);
    const sphg_geometry geometry = setup_geometry(test, &made.fluid, &made.fluid_x);
    made.own = setup_search(made.context, &made.scheme, &geometry);
    return made;
}

/* Wall as sources, so many of these points as targets. */
static sphg_geometry geometry_of(const scene *on, const cloud *targets, setup_array *at)
{
    cloud copy = *targets;
    *at = setup_positions(on->test, &copy);
    sphg_geometry geometry = setup_geometry(on->test, &on->wall, &on->wall_x);
    geometry.targets = setup_view(at);
    geometry.target_count = targets->count;
    return geometry;
}

static sphg_neighbors *wall_from(const scene *on, const cloud *targets)
{
    setup_array at;
    const sphg_geometry geometry = geometry_of(on, targets, &at);
    return setup_search(on->context, &on->scheme, &geometry);
}

static sphg_result evaluate(const scene *on, const sphg_neighbors *wall)
{
    const sphg_sources sources[] = {{.neighbors = on->own, .volume = setup_view(&on->fluid_volume)},
                                    {.neighbors = wall, .volume = setup_view(&on->wall_volume)}};
    const sphg_view views[] = {setup_view(&on->field[0]), setup_view(&on->field[1])};
    const sphg_field field = {
        .shape = SPHG_SCALAR, .at_sources = views, .gradient = setup_view(&on->result)};
    const sphg_request request = {
        .sources = sources, .fields = &field, .set_count = 2, .field_count = 1};
    return sphg_evaluate(on->context, &on->scheme, &request);
}

static void require_elsewhere(const scene *on, const sphg_neighbors *wall, int target)
{
    const sphg_result result = evaluate(on, wall);
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(result == SPHG_ERROR_SIZE, "%s", sphg_result_string(result));
    TEST_REQUIRE(strstr(message, test_text("target %d of sources[1]", target)), "%s", message);
    for (int i = 0; i < TARGETS; ++i)
        TEST_REQUIRE(setup_is_canary(&on->result, i), "target %d was written", i);
}

/* The next number of the type that positions have. */
static double next(const test_case *test, double x)
{
    return test->precision == TEST_F32 ? (double)nextafterf((float)x, 2) : nextafter(x, 2);
}

static void targets_that_differ_are_refused(const test_case *test)
{
    const int d = test->dimension;
    for (int threads = 1; threads < 4; threads += 2) {
        const scene on = scene_of(test, 0, threads);
        for (int target = 0; target < TARGETS; target += 149) {
            cloud moved = cloud_copy(&on.fluid);
            double *x = moved.x + target * d + d - 1;
            *x = next(test, *x);
            require_elsewhere(&on, wall_from(&on, &moved), target);
        }
        cloud swapped = cloud_copy(&on.fluid);
        memcpy(swapped.x + 7 * d, on.fluid.x + 8 * d, (size_t)d * sizeof *on.fluid.x);
        memcpy(swapped.x + 8 * d, on.fluid.x + 7 * d, (size_t)d * sizeof *on.fluid.x);
        require_elsewhere(&on, wall_from(&on, &swapped), 7);
        SETUP_OK(on.context, evaluate(&on, wall_from(&on, &on.fluid)));
    }
}

static void hosts_that_are_trusted_may_differ(const test_case *test)
{
    const scene on = scene_of(test, 1, 2);
    cloud moved = cloud_copy(&on.fluid);
    moved.x[5] += .01;
    SETUP_OK(on.context, evaluate(&on, wall_from(&on, &moved)));
}

/* Who moves the fluid rebuilds its view of the wall, too; also where a skin holds. */
static void moves_are_noticed(const test_case *test)
{
    scene on = scene_of(test, 0, 2);
    for (int skin = 0; skin < 2; ++skin) {
        setup_array at;
        sphg_geometry geometry = geometry_of(&on, &on.fluid, &at);
        geometry.skin = skin ? .1 : 0;
        sphg_neighbors *wall = setup_search(on.context, &on.scheme, &geometry);
        SETUP_OK(on.context, evaluate(&on, wall));
        cloud moved = cloud_copy(&on.fluid);
        moved.x[test->dimension] += .01;
        on.result = setup_output(test_field_type(test), TARGETS, test->dimension);
        geometry.targets = setup_view(&at);
        at = setup_positions(test, &moved);
        geometry.targets = setup_view(&at);
        SETUP_OK(on.context, sphg_neighbors_search(on.context, wall, &on.scheme, &geometry));
        require_elsewhere(&on, wall, 1);
        at = setup_positions(test, &on.fluid);
        geometry.targets = setup_view(&at);
        SETUP_OK(on.context, sphg_neighbors_search(on.context, wall, &on.scheme, &geometry));
        SETUP_OK(on.context, evaluate(&on, wall));
        on.result = setup_output(test_field_type(test), TARGETS, test->dimension);
    }
}

/* -0 is 0, lists of the host and searches store targets in other orders, and so do sets that the
 * targets are part of, however few of them. */
static void the_same_targets_in_other_words_are_accepted(const test_case *test)
{
    scene on = scene_of(test, 0, 2);
    cloud zero = cloud_copy(&on.fluid), minus = cloud_copy(&on.fluid);
    zero.x[0] = 0;
    minus.x[0] = -0.;
    setup_array at = setup_positions(test, &zero);
    const sphg_geometry own = setup_geometry(test, &zero, &at);
    on.own = setup_search(on.context, &on.scheme, &own);
    SETUP_OK(on.context, evaluate(&on, wall_from(&on, &minus)));

    setup_array places;
    const sphg_geometry geometry = geometry_of(&on, &zero, &places);
    static const int32_t lengths[TARGETS] = {0};
    static const int32_t *const rows[TARGETS] = {0};
    const sphg_lists lists = {.rows = rows, .lengths = lengths};
    SETUP_OK(on.context, evaluate(&on, setup_lists(on.context, &on.scheme, &geometry, &lists)));

    cloud few = cloud_copy(&zero);
    few.count = TARGETS / 3;
    sphg_geometry part = setup_geometry(test, &zero, &at);
    part.target_count = few.count;
    on.own = setup_search(on.context, &on.scheme, &part);
    on.result = setup_output(test_field_type(test), TARGETS, test->dimension);
    SETUP_OK(on.context, evaluate(&on, wall_from(&on, &few)));
    few.x[2] += .01;
    on.result = setup_output(test_field_type(test), TARGETS, test->dimension);
    require_elsewhere(&on, wall_from(&on, &few), 2 / test->dimension);
}

static const test_entry entries[] = {
    TEST_ENTRY(targets_that_differ_are_refused, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(hosts_that_are_trusted_may_differ, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(moves_are_noticed, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(the_same_targets_in_other_words_are_accepted, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
