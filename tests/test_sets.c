/* SPDX-License-Identifier: MIT */
/* Fluid and wall as two source sets give what their union gives; targets may lie anywhere; fields
 * and calls add up. */
#include "support/brute_force.h"
#include "support/comparison.h"
#include <math.h>
#include <string.h>

/* A block whose lower layers are wall: the first `fluid` points are fluid. */
typedef struct two_sets {
    comparison whole; /* one set of all points, with the oracle */
    int fluid;
    cloud part[2];
    setup_array volume[2], density[2], positions[2];
    sphg_neighbors *from[2][2]; /* [target set][source set] */
} two_sets;

static const double *part_of(const two_sets *sets, const double *numbers, int set, int width)
{
    return numbers + (set ? sets->fluid * width : 0);
}

static int by_height(const cloud *points, cloud *sorted)
{
    int d = points->dimension, used = 0, fluid = 0;
    double border = .2;
    *sorted = *points;
    sorted->x = test_memory((size_t)(points->count * d) * sizeof *sorted->x);
    for (int wall = 0; wall < 2; ++wall)
        for (int i = 0; i < points->count; ++i) {
            const double *x = points->x + i * d;
            if ((x[d - 1] < border) != wall)
                continue;
            memcpy(sorted->x + used++ * d, x, (size_t)d * sizeof *x);
            fluid += !wall;
        }
    return fluid;
}

static sphg_geometry geometry_between(const two_sets *sets, int targets, int sources)
{
    const test_case *test = sets->whole.test;
    sphg_geometry geometry = setup_geometry(test, &sets->part[sources], &sets->positions[sources]);
    if (targets != sources) {
        geometry.targets = setup_view(&sets->positions[targets]);
        geometry.target_count = sets->part[targets].count;
    }
    return geometry;
}

static sphg_neighbors *neighbors_between(const two_sets *sets, int targets, int sources)
{
    const sphg_geometry geometry = geometry_between(sets, targets, sources);
    return setup_search(sets->whole.context, &sets->whole.scheme, &geometry);
}

static two_sets split_block(const test_case *test)
{
    random_state random = random_seeded(81);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 7 : 4, .125, .25, &random), sorted;
    two_sets sets = {.fluid = by_height(&points, &sorted)};
    sets.whole = comparison_of(test, "fluid and wall", sorted, 2.5 * .125);
    sphg_type type = test_field_type(test);
    for (int s = 0; s < 2; ++s) {
        sets.part[s] = sets.whole.points;
        sets.part[s].x += s ? sets.fluid * d : 0;
        sets.part[s].count = s ? sorted.count - sets.fluid : sets.fluid;
        int n = sets.part[s].count;
        sets.positions[s] = setup_positions(test, &sets.part[s]);
        sets.volume[s] = setup_numbers(type, n, 1, part_of(&sets, sets.whole.scene.volume, s, 1));
        sets.density[s] = setup_numbers(type, n, 1, part_of(&sets, sets.whole.scene.density, s, 1));
    }
    for (int t = 0; t < 2; ++t)
        for (int s = 0; s < 2; ++s)
            sets.from[t][s] = neighbors_between(&sets, t, s);
    return sets;
}

/* Both sets as targets of set t see them. */
static void sources_of(const two_sets *sets, int t, sphg_sources *sources)
{
    for (int s = 0; s < 2; ++s) {
        sources[s] = (sphg_sources){.neighbors = sets->from[t][s]};
        sources[s].volume = setup_view(&sets->volume[s]);
        sources[s].density = setup_view(&sets->density[s]);
    }
}

/* C of one set's particles, moments summed over both sets. */
static setup_array table_of(const two_sets *sets, int t)
{
    const comparison *on = &sets->whole;
    int width = sphg_correction_width(&on->scheme);
    setup_array table = setup_output(test_field_type(on->test), sets->part[t].count, width);
    sphg_sources sources[2];
    sources_of(sets, t, sources);
    sphg_request request = {.sources = sources, .set_count = 2};
    request.correction = setup_view(&table);
    if (width > 0)
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return table;
}

/* lacks: a bit per set that has no field and mirrors the targets' instead. */
static comparison_result evaluate_fluid(const two_sets *sets, const comparison_field *field,
                                        const setup_array *tables, unsigned lacks)
{
    const comparison *on = &sets->whole;
    sphg_type type = test_field_type(on->test);
    int width = setup_width(field->shape, on->points.dimension);
    comparison_result found = comparison_outputs(on, field, sets->fluid);
    sphg_sources sources[2];
    sphg_view at_sources[2];
    sources_of(sets, 0, sources);
    for (int s = 0; s < 2; ++s) {
        setup_array numbers = setup_numbers(type, sets->part[s].count, width,
                                            part_of(sets, field->numbers, s, width));
        at_sources[s] = lacks >> s & 1 ? sphg_absent() : setup_view(&numbers);
        if (tables)
            sources[s].correction = comparison_table_view(on, &tables[s]);
    }
    sphg_field asked = {.shape = field->shape, .form = field->form, .at_sources = at_sources};
    const setup_array own = setup_numbers(type, sets->fluid, width, field->numbers);
    asked.mirror = lacks != 0;
    asked.at_targets = lacks & 1 ? setup_view(&own) : sphg_absent();
    comparison_ask_for(&found, &asked);
    sphg_request request = {.sources = sources, .fields = &asked, .set_count = 2};
    request.field_count = 1;
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

static void two_source_sets_equal_their_union(const test_case *test)
{
    two_sets sets = split_block(test);
    setup_array tables[] = {table_of(&sets, 0), table_of(&sets, 1)};
    TEST_REQUIRE(sets.fluid > 10 && sets.part[1].count > 10, "not two sets");
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form) {
        comparison_field field = {SPHG_SCALAR, (sphg_form)form,
                                  comparison_random_field(&sets.whole, SPHG_SCALAR, 21)};
        comparison_result found =
            evaluate_fluid(&sets, &field, form >= SPHG_SYMMETRIC ? tables : NULL, 0);
        for (int i = 0; i < sets.fluid; i += 7)
            comparison_compare(&sets.whole, &field, &found, i);
    }
}

/* One set goes round along an axis that is longer than both. */
static void sets_may_differ_in_their_periods(const test_case *test)
{
    two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    const comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                                    comparison_random_field(on, SPHG_SCALAR, 22)};
    const comparison_result open = evaluate_fluid(&sets, &field, NULL, 0);
    sphg_geometry wall = geometry_between(&sets, 0, 1);
    wall.period[0] = 64;
    sets.from[0][1] = setup_search(on->context, &on->scheme, &wall);
    const comparison_result found = evaluate_fluid(&sets, &field, NULL, 0);
    setup_require_close(&open.gradient, &found.gradient, "one set is periodic");
}

/* What target i sees of a field that some sets mirror: its own value there. */
static double *seen_by(const two_sets *sets, const comparison_field *field, unsigned lacks, int i)
{
    const int width = setup_width(field->shape, sets->whole.points.dimension);
    const size_t item = (size_t)width * sizeof(double);
    double *numbers = test_memory((size_t)sets->whole.points.count * item);
    for (int j = 0; j < sets->whole.points.count; ++j)
        memcpy(numbers + j * width,
               field->numbers + (lacks >> (j >= sets->fluid) & 1 ? i : j) * width, item);
    return numbers;
}

static void a_mirrored_field_has_the_value_of_the_target(const test_case *test)
{
    const two_sets sets = split_block(test);
    const setup_array tables[] = {table_of(&sets, 0), table_of(&sets, 1)};
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
        for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape)
            for (unsigned lacks = 1; lacks < 4; ++lacks) {
                const comparison_field field = {
                    (sphg_shape)shape, (sphg_form)form,
                    comparison_random_field(&sets.whole, (sphg_shape)shape, 24)};
                const comparison_result found =
                    evaluate_fluid(&sets, &field, form >= SPHG_SYMMETRIC ? tables : NULL, lacks);
                for (int i = 0; i < sets.fluid; i += 11) {
                    comparison_field seen = field;
                    seen.numbers = seen_by(&sets, &field, lacks, i);
                    comparison_compare(&sets.whole, &seen, &found, i);
                }
            }
}

/* Lists of the host from the search's own pairs. */
static sphg_neighbors *brought_between(const two_sets *sets, int targets, int sources)
{
    const comparison *on = &sets->whole;
    const sphg_geometry geometry = geometry_between(sets, targets, sources);
    const rows found = rows_listed(on->context, sets->from[targets][sources], &on->scheme, NULL);
    const sphg_lists lists = {.offsets = found.offsets, .indices = found.indices};
    return setup_lists(on->context, &on->scheme, &geometry, &lists);
}

/* Without a set that the targets are part of, and through lists of the host. Classic gradients of
 * what is constant are nothing but rounding. */
static void probes_may_look_into_mirrors(const test_case *test)
{
    const two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    const setup_array own = setup_numbers(test_field_type(test), sets.fluid, 1,
                                          comparison_random_field(on, SPHG_SCALAR, 25));
    const sphg_view absent = sphg_absent();
    setup_array found[3];
    for (int way = 0; way < 3; ++way) {
        sphg_sources sources[2];
        sources_of(&sets, 0, sources);
        if (way == 2)
            sources[1].neighbors = brought_between(&sets, 0, 1);
        found[way] = setup_output(own.type, sets.fluid, test->dimension);
        const sphg_view one_by_one = setup_view(&own);
        const sphg_field asked = {.shape = SPHG_SCALAR,
                                  .form = way ? SPHG_DIRECT : SPHG_DIFFERENCE,
                                  .at_sources = &absent,
                                  .at_targets = one_by_one,
                                  .gradient = setup_view(&found[way]),
                                  .mirror = 1};
        const sphg_request request = {.sources = sources + 1,
                                      .fields = &asked,
                                      .set_count = 1,
                                      .field_count = 1,
                                      .target_volume = sources[0].volume};
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    }
    for (int i = 0; i < sets.fluid; ++i)
        for (int c = 0; c < test->dimension; ++c)
            TEST_REQUIRE(setup_get(&found[0], i, c) == 0, "a difference to itself, target %d", i);
    TEST_REQUIRE(setup_get(&found[1], 0, test->dimension - 1) != 0, "no wall is seen");
    setup_require_close(&found[1], &found[2], "through lists");
}

/* In the direct form; a difference to it would be -A_i, which nobody means. */
static void an_absent_field_is_zero(const test_case *test)
{
    two_sets sets = split_block(test);
    int n = sets.fluid;
    sphg_type type = test_field_type(test);
    double *zeros = test_memory((size_t)sets.part[1].count * sizeof *zeros);
    double *numbers = comparison_random_field(&sets.whole, SPHG_SCALAR, 22);
    setup_array here = setup_numbers(type, n, 1, numbers);
    setup_array none = setup_numbers(type, sets.part[1].count, 1, zeros);
    setup_array found[2];
    for (int way = 0; way < 2; ++way) {
        sphg_view at_sources[] = {setup_view(&here), way ? sphg_absent() : setup_view(&none)};
        sphg_sources sources[2];
        sources_of(&sets, 0, sources);
        found[way] = setup_output(type, n, test->dimension);
        sphg_field asked = {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = at_sources};
        asked.gradient = setup_view(&found[way]);
        sphg_request request = {.sources = sources, .fields = &asked, .set_count = 2};
        request.field_count = 1;
        SETUP_OK(sets.whole.context,
                 sphg_evaluate(sets.whole.context, &sets.whole.scheme, &request));
    }
    assert_true(setup_same_bits(&found[0], &found[1]));
}

/* Through lists of the host, with a field that one of the sets has not. */
static void lists_of_the_host_may_lack_a_field(const test_case *test)
{
    const two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    const setup_array here = setup_numbers(test_field_type(test), sets.fluid, 1,
                                           comparison_random_field(on, SPHG_SCALAR, 23));
    const sphg_view at_sources[] = {setup_view(&here), sphg_absent()};
    setup_array found[2];
    for (int way = 0; way < 2; ++way) {
        sphg_sources sources[2];
        sources_of(&sets, 0, sources);
        for (int s = 0; s < 2 && way; ++s)
            sources[s].neighbors = brought_between(&sets, 0, s);
        found[way] = setup_output(here.type, sets.fluid, test->dimension);
        const sphg_field asked = {.shape = SPHG_SCALAR,
                                  .form = SPHG_DIRECT,
                                  .at_sources = at_sources,
                                  .gradient = setup_view(&found[way])};
        const sphg_request request = {
            .sources = sources, .fields = &asked, .set_count = 2, .field_count = 1};
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    }
    setup_require_close(&found[0], &found[1], "an absent field");
}

/* Sums of the other set are put away for the sweep that finishes, which a mask concerns as well. */
static void masked_targets_of_two_sets_have_the_bits_of_all(const test_case *test)
{
    const two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    const setup_array whole = table_of(&sets, 0);
    setup_array some = setup_output(whole.type, sets.fluid, whole.width);
    uint8_t *mask = test_memory((size_t)sets.fluid);
    for (int i = 0; i < sets.fluid; ++i)
        mask[i] = i % 3 == 1;
    const sphg_subset subset = {0, sets.fluid, NULL, mask};
    sphg_sources sources[2];
    sources_of(&sets, 0, sources);
    const sphg_request request = {
        .sources = sources, .set_count = 2, .subset = &subset, .correction = setup_view(&some)};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    for (int i = 0; i < sets.fluid; ++i)
        for (int c = 0; c < whole.width; ++c)
            TEST_REQUIRE(mask[i] ? setup_get(&some, i, c) == setup_get(&whole, i, c)
                                 : setup_is_canary(&some, i),
                         "target %d, number %d", i, c);
}

/* ---- Targets far from a wall -------------------------------------------------------------------
 */

typedef struct findings {
    setup_array table, gradient, rank, lambda_min;
    sphg_stats stats;
} findings;

static findings findings_of(const comparison *on, const sphg_sources *sources, int32_t sets,
                            const sphg_view *at_sources)
{
    const sphg_type type = test_field_type(on->test);
    const int n = on->points.count, d = on->points.dimension;
    findings found = {.table = setup_output(type, n, sphg_correction_width(&on->scheme)),
                      .gradient = setup_output(type, n, d * d),
                      .rank = setup_output(SPHG_U8, n, 1),
                      .lambda_min = setup_output(type, n, 1)};
    const sphg_field asked = {
        .shape = SPHG_VECTOR, .at_sources = at_sources, .gradient = setup_view(&found.gradient)};
    const sphg_request request = {.sources = sources,
                                  .fields = &asked,
                                  .set_count = sets,
                                  .field_count = 1,
                                  .correction = setup_view(&found.table),
                                  .rank = setup_view(&found.rank),
                                  .lambda_min = setup_view(&found.lambda_min),
                                  .stats = &found.stats};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

static int is_near(const comparison *on, const cloud *wall, int i)
{
    const int d = on->points.dimension;
    for (int j = 0; j < wall->count; ++j) {
        double square = 0;
        for (int k = 0; k < d; ++k)
            square += pow(on->points.x[i * d + k] - wall->x[j * d + k], 2);
        if (square < pow(on->scheme.support_radius, 2) * 1.001)
            return 1;
    }
    return 0;
}

static int same_number(const setup_array *a, const setup_array *b, int i)
{
    int same = 1;
    for (int c = 0; c < a->width; ++c)
        same &= setup_get(a, i, c) == setup_get(b, i, c);
    return same;
}

static setup_array random_vectors(const test_case *test, int count, random_state *random)
{
    const int d = test->dimension;
    double *numbers = test_memory((size_t)(count * d) * sizeof *numbers);
    for (int k = 0; k < count * d; ++k)
        numbers[k] = random_between(random, -1, 1);
    return setup_numbers(test_field_type(test), count, d, numbers);
}

/* Those that have no pairs in the other set are finished before those that have. */
static void compare_beside_wall(const test_case *test, double height, int some_are_near,
                                int list_free)
{
    random_state random = random_seeded(87);
    const int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 12 : 7, .125, .2, &random);
    cloud wall = cloud_plane(d, d == 2 ? 12 : 7, .125);
    for (int j = 0; j < wall.count; ++j)
        wall.x[d * j + d - 1] -= height;
    const comparison on = comparison_of(test, "beside a wall", points, 2 * .125);
    const setup_array positions[2] = {setup_positions(test, &points), setup_positions(test, &wall)};
    const sphg_geometry to_wall = {.sources = setup_view(&positions[1]),
                                   .source_count = wall.count,
                                   .targets = setup_view(&positions[0]),
                                   .target_count = points.count,
                                   .precision = test_field_type(test),
                                   .list_free = list_free};
    const setup_array volume =
        setup_numbers(test_field_type(test), wall.count, 1, cloud_volumes(&wall, .2, &random));
    const setup_array numbers[2] = {random_vectors(test, points.count, &random),
                                    random_vectors(test, wall.count, &random)};
    const sphg_view at_sources[2] = {setup_view(&numbers[0]), setup_view(&numbers[1])};
    const sphg_sources sources[2] = {comparison_sources(&on),
                                     {.neighbors = setup_search(on.context, &on.scheme, &to_wall),
                                      .volume = setup_view(&volume)}};
    const findings alone = findings_of(&on, sources, 1, at_sources);
    const findings beside = findings_of(&on, sources, 2, at_sources);
    int near = 0;
    for (int i = 0; i < points.count; ++i) {
        if (is_near(&on, &wall, i)) {
            near += !same_number(&alone.gradient, &beside.gradient, i);
            continue;
        }
        TEST_REQUIRE(same_number(&alone.table, &beside.table, i) &&
                         same_number(&alone.gradient, &beside.gradient, i) &&
                         same_number(&alone.rank, &beside.rank, i) &&
                         same_number(&alone.lambda_min, &beside.lambda_min, i),
                     "target %d", i);
    }
    TEST_REQUIRE(near < points.count / 2 && (near > 0) == some_are_near, "%d are near", near);
    if (!near)
        assert_true(memcmp(&alone.stats, &beside.stats, sizeof alone.stats) == 0);
    else
        assert_true(alone.stats.certified + alone.stats.decomposed ==
                    beside.stats.certified + beside.stats.decomposed);
}

static void targets_far_from_a_wall_have_the_bits_of_no_wall(const test_case *test)
{
    for (int list_free = 0; list_free < 2; ++list_free) {
        compare_beside_wall(test, .125, 1, list_free);
        compare_beside_wall(test, 1, 0, list_free);
    }
}

/* ---- Corrections of some targets ----------------------------------------------------------------
 */

static void findings_of_some(const comparison *on, const uint8_t *mask, findings *found)
{
    const sphg_type type = test_field_type(on->test);
    const int n = on->points.count;
    const sphg_subset some = {0, n, NULL, mask};
    const sphg_sources sources = comparison_sources(on);
    found->table = setup_output(type, n, sphg_correction_width(&on->scheme));
    found->rank = setup_output(SPHG_U8, n, 1);
    found->lambda_min = setup_output(type, n, 1);
    const sphg_request request = {.sources = &sources,
                                  .set_count = 1,
                                  .subset = mask ? &some : NULL,
                                  .correction = setup_view(&found->table),
                                  .rank = setup_view(&found->rank),
                                  .lambda_min = setup_view(&found->lambda_min),
                                  .stats = &found->stats};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
}

/* Of groups in which most targets are asked for, all are summed: the others must leave no trace. */
static void corrections_of_most_targets_have_the_bits_of_all(const test_case *test)
{
    random_state random = random_seeded(89);
    const int d = test->dimension;
    cloud points = cloud_random(d, 600, d == 2 ? 3 : 1, &random); /* some lack directions */
    const comparison on = comparison_of(test, "most", points, d == 2 ? .25 : .18);
    const int n = points.count;
    for (int of_sixteen = 9; of_sixteen < 16; of_sixteen += 3) {
        uint8_t *mask = test_memory((size_t)n);
        int64_t ranks[4] = {0}, chosen = 0;
        findings all, some;
        findings_of_some(&on, NULL, &all);
        for (int i = 0; i < n; ++i)
            chosen += mask[i] = random_index(&random, 16) < of_sixteen;
        findings_of_some(&on, mask, &some);
        for (int i = 0; i < n; ++i) {
            TEST_REQUIRE(mask[i] ? same_number(&all.table, &some.table, i) &&
                                       same_number(&all.rank, &some.rank, i) &&
                                       same_number(&all.lambda_min, &some.lambda_min, i)
                                 : setup_is_canary(&some.table, i),
                         "target %d, %d of 16", i, of_sixteen);
            ranks[(int)setup_get(&all.rank, i, 0)] += mask[i];
        }
        assert_true(some.stats.certified + some.stats.decomposed == chosen);
        assert_true(memcmp(ranks, some.stats.rank, sizeof ranks) == 0);
        assert_true(some.stats.decomposed > 0 && some.stats.certified > 0);
    }
}

/* ---- Targets unlike sources ------------------------------------------------------------------ */

typedef struct probe {
    comparison on;
    cloud targets;
    sphg_neighbors *neighbors;
    double *target_volume, *at_targets;
} probe;

static probe make_probe(const test_case *test, int with_volume)
{
    random_state random = random_seeded(82);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 7 : 4, .125, .25, &random);
    probe made = {.on = comparison_of(test, "probes", points, 2.5 * .125)};
    made.targets = cloud_random(d, 12, .5, &random);
    setup_array positions = setup_positions(test, &made.on.points);
    setup_array places = setup_positions(test, &made.targets);
    sphg_geometry geometry = setup_geometry(test, &made.on.points, &positions);
    geometry.targets = setup_view(&places);
    geometry.target_count = made.targets.count;
    made.neighbors = setup_search(made.on.context, &made.on.scheme, &geometry);
    made.at_targets = cloud_numbers(&made.targets, -1, 1, &random);
    if (with_volume)
        made.target_volume = cloud_volumes(&points, .2, &random);
    oracle_scene *probed = &made.on.scene;
    probed->targets = made.targets.x;
    probed->target_count = made.targets.count;
    probed->target_volume = made.target_volume;
    made.on.reference = oracle_of(probed);
    return made;
}

static void compare_probe(const probe *made, sphg_form form)
{
    const comparison *on = &made->on;
    sphg_type type = test_field_type(on->test);
    int n = made->targets.count, d = on->points.dimension;
    double *numbers = comparison_random_field(on, SPHG_SCALAR, 23);
    setup_array field = setup_numbers(type, on->points.count, 1, numbers);
    setup_array at_targets = setup_numbers(type, n, 1, made->at_targets);
    setup_array gradient = setup_output(type, n, d), square = setup_output(type, n, 1), volume;
    sphg_view at_sources = setup_view(&field);
    sphg_sources sources = comparison_sources(on);
    sources.neighbors = made->neighbors;
    sphg_field asked = {.shape = SPHG_SCALAR, .form = form, .at_sources = &at_sources};
    asked.at_targets = setup_view(&at_targets);
    asked.gradient = setup_view(&gradient);
    asked.square = form == SPHG_DIRECT ? setup_view(&square) : sphg_absent();
    sphg_request request = {.sources = &sources, .fields = &asked, .set_count = 1};
    request.field_count = 1;
    if (made->target_volume) {
        volume = setup_numbers(type, n, 1, made->target_volume);
        request.target_volume = setup_view(&volume);
    }
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    oracle_field exact_field = {SPHG_SCALAR, form, numbers, made->at_targets};
    for (int i = 0; i < n; ++i) {
        oracle_result exact = oracle_apply(on->reference, &exact_field, i);
        double ratio = comparison_ratio(&gradient, i, exact.gradient, exact.bound);
        double of_square = comparison_ratio(&square, i, &exact.square, exact.square_bound);
        if (form == SPHG_DIRECT && !(of_square <= ratio))
            ratio = of_square;
        if (exact.touched)
            TEST_WITHIN(oracle_ratio_touched, ratio, "probe");
        else
            TEST_WITHIN(oracle_ratio_full, ratio, "probe");
    }
}

/* Refused after the wall's sums were put away: the next call must not find them. */
static void a_refused_list_leaves_no_sums_behind(const test_case *test)
{
    const two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    const setup_array before = table_of(&sets, 0);
    const int32_t **nowhere = test_memory((size_t)sets.fluid * sizeof *nowhere);
    int32_t *lengths = test_memory((size_t)sets.fluid * sizeof *lengths);
    for (int i = 0; i < sets.fluid; ++i)
        lengths[i] = -1;
    const sphg_lists lists = {.rows = nowhere, .lengths = lengths};
    const sphg_geometry geometry = geometry_between(&sets, 0, 0);
    sphg_neighbors *wrong = NULL;
    SETUP_OK(on->context, sphg_neighbors_create(on->context, &wrong));
    SETUP_OK(on->context,
             sphg_neighbors_use_lists(on->context, wrong, &on->scheme, &geometry, &lists));
    setup_array table = setup_output(before.type, sets.fluid, before.width);
    sphg_sources sources[2];
    sources_of(&sets, 0, sources);
    sources[0].neighbors = wrong;
    const sphg_request request = {
        .sources = sources, .set_count = 2, .correction = setup_view(&table)};
    assert_int_equal(sphg_evaluate(on->context, &on->scheme, &request), SPHG_ERROR_INDEX);
    const setup_array after = table_of(&sets, 0);
    assert_true(setup_same_bits(&before, &after));
    sources_of(&sets, 0, sources);
    const sphg_request alone = {
        .sources = sources, .set_count = 1, .correction = setup_view(&table)};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &alone));
    assert_false(setup_same_bits(&before, &table)); /* the wall counts */
    sphg_neighbors_destroy(wrong);
}

/* The lists name other particles' neighbours: the fluid's last one stands elsewhere. */
static void lists_for_other_targets_are_refused(const test_case *test)
{
    const two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    setup_array moved = setup_numbers(sets.positions[0].type, sets.fluid, test->dimension,
                                      setup_doubles(&sets.positions[0]));
    setup_put(&moved, sets.fluid * test->dimension - 1, 3);
    int64_t *offsets = test_memory(((size_t)sets.fluid + 1) * sizeof *offsets);
    const sphg_lists none = {.offsets = offsets};
    sphg_geometry wall = geometry_between(&sets, 0, 1);
    wall.targets = setup_view(&moved);
    sphg_neighbors *listed = NULL;
    SETUP_OK(on->context, sphg_neighbors_create(on->context, &listed));
    SETUP_OK(on->context, sphg_neighbors_use_lists(on->context, listed, &on->scheme, &wall, &none));
    const setup_array table =
        setup_output(test_field_type(test), sets.fluid, sphg_correction_width(&on->scheme));
    sphg_sources sources[2];
    sources_of(&sets, 0, sources);
    sources[1].neighbors = listed;
    const sphg_request request = {
        .sources = sources, .set_count = 2, .correction = setup_view(&table)};
    assert_int_equal(sphg_evaluate(on->context, &on->scheme, &request), SPHG_ERROR_SIZE);
    const char *const named = test_text("target %d", sets.fluid - 1);
    TEST_REQUIRE(strstr(sphg_last_message(on->context), named), "'%s' does not name %s",
                 sphg_last_message(on->context), named);
    sphg_neighbors_destroy(listed);
}

static void targets_unlike_sources_match_the_oracle(const test_case *test)
{
    for (int with_volume = 0; with_volume < 2; ++with_volume) {
        probe made = make_probe(test, with_volume);
        compare_probe(&made, SPHG_DIFFERENCE);
        compare_probe(&made, SPHG_DIRECT);
    }
}

/* ---- Several fields, accumulation
 * --------------------------------------------------------------------- */

static void fields_of_one_call_equal_calls_of_one_field(const test_case *test)
{
    random_state random = random_seeded(83);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 6 : 4, .125, .25, &random);
    comparison on = comparison_of(test, "block", points, 2.5 * .125);
    static const sphg_shape shapes[] = {SPHG_SCALAR, SPHG_VECTOR, SPHG_SCALAR};
    static const sphg_form forms[] = {SPHG_DIFFERENCE, SPHG_DIFFERENCE, SPHG_DIRECT};
    sphg_view at_sources[3];
    sphg_field fields[3] = {{0}};
    setup_array numbers[3], together[3];
    comparison_result alone[3];
    for (int f = 0; f < 3; ++f) {
        int width = setup_width(shapes[f], d);
        comparison_field field = {shapes[f], forms[f],
                                  comparison_random_field(&on, shapes[f], (uint64_t)(90 + f))};
        alone[f] = comparison_apply(&on, &field, NULL);
        numbers[f] = setup_numbers(test_field_type(test), points.count, width, field.numbers);
        together[f] = setup_output(test_field_type(test), points.count, d * width);
        at_sources[f] = setup_view(&numbers[f]);
        fields[f].shape = shapes[f];
        fields[f].form = forms[f];
        fields[f].at_sources = &at_sources[f];
        fields[f].gradient = setup_view(&together[f]);
    }
    sphg_sources sources = comparison_sources(&on);
    sphg_request request = {.sources = &sources, .fields = fields, .set_count = 1};
    request.field_count = 3;
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    for (int f = 0; f < 3; ++f)
        TEST_REQUIRE(setup_same_bits(&together[f], &alone[f].gradient), "field %d", f);
}

static const setup_array *result_of(const comparison_result *found, int which)
{
    const setup_array *results[] = {&found->gradient, &found->divergence, &found->curl,
                                    &found->value, &found->square};
    return results[which];
}

static void a_result_alone_has_the_bits_it_has_among_all(const test_case *test)
{
    random_state random = random_seeded(84);
    int d = test->dimension;
    comparison on = comparison_of(
        test, "block", cloud_jittered(d, d == 2 ? 6 : 4, .125, .25, &random), 2.5 * .125);
    setup_array table = comparison_table(&on);
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
        for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape) {
            const setup_array *given = form < SPHG_SYMMETRIC ? NULL : &table;
            comparison_field field = {(sphg_shape)shape, (sphg_form)form,
                                      comparison_random_field(&on, (sphg_shape)shape, 91)};
            comparison_result all = comparison_apply(&on, &field, given);
            for (int which = 0; which < 5; ++which) {
                if (!result_of(&all, which)->width) /* this shape or form has none */
                    continue;
                comparison_result alone = comparison_apply_alone(&on, &field, given, which);
                TEST_REQUIRE(setup_same_bits(result_of(&all, which), result_of(&alone, which)),
                             "result %d of shape %d in form %d", which, shape, form);
            }
        }
}

/* One call for everything that is known of the corrections, one for each. */
static void what_is_known_of_corrections_is_the_same_alone(const test_case *test)
{
    random_state random = random_seeded(85);
    int d = test->dimension, n;
    comparison on =
        comparison_of(test, "thin", cloud_jittered(d, 4, .125, .5, &random), 1.5 * .125);
    sphg_type type = test_field_type(test);
    sphg_sources sources = comparison_sources(&on);
    sphg_stats stats[2];
    setup_array found[2][3];
    memset(stats, 0, sizeof stats);
    n = on.points.count;
    for (int which = -1; which < 4; ++which) {
        setup_array *to = found[which >= 0];
        sphg_request request = {.sources = &sources, .set_count = 1};
        to[0] = setup_output(type, n, sphg_correction_width(&on.scheme));
        to[1] = setup_output(SPHG_U8, n, 1);
        to[2] = setup_output(type, n, 1);
        request.correction = which < 0 || which == 0 ? setup_view(&to[0]) : sphg_absent();
        request.rank = which < 0 || which == 1 ? setup_view(&to[1]) : sphg_absent();
        request.lambda_min = which < 0 || which == 2 ? setup_view(&to[2]) : sphg_absent();
        request.stats = which < 0 || which == 3 ? &stats[which >= 0] : NULL;
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
        if (which == 3)
            assert_memory_equal(&stats[0], &stats[1], sizeof stats[0]);
        else if (which >= 0)
            TEST_REQUIRE(setup_same_bits(&found[0][which], &to[which]), "%d", which);
    }
}

static void accumulate_adds_to_what_is_there(const test_case *test)
{
    two_sets sets = split_block(test);
    const comparison *on = &sets.whole;
    sphg_type type = test_field_type(test);
    comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE,
                              comparison_random_field(on, SPHG_SCALAR, 24)};
    comparison_result once = comparison_apply(on, &field, NULL);
    setup_array numbers = setup_numbers(type, on->points.count, 1, field.numbers);
    double *start = test_memory((size_t)(on->points.count * test->dimension) * sizeof *start);
    for (int k = 0; k < on->points.count * test->dimension; ++k)
        start[k] = k % 5;
    setup_array sum = setup_numbers(type, on->points.count, test->dimension, start);
    sphg_view at_sources = setup_view(&numbers);
    sphg_sources sources = comparison_sources(on);
    sphg_field asked = {.shape = SPHG_SCALAR, .accumulate = 1, .at_sources = &at_sources};
    asked.gradient = setup_view(&sum);
    sphg_request request = {.sources = &sources, .fields = &asked, .set_count = 1};
    request.field_count = 1;
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    for (int k = 0; k < sum.count * sum.width; ++k) {
        int i = k / sum.width, c = k % sum.width;
        double g = setup_get(&once.gradient, i, c), expected = start[k] + g;
        double error = fabs(setup_get(&sum, i, c) - expected);
        TEST_WITHIN(one_addition, error / on->scene.unit / (fabs(expected) + fabs(g)), "sum");
    }
}

/* Targets in one place: `near` of them see a crowd of sources, the others, many more, see none. */
typedef struct crowd {
    sphg_context *context;
    sphg_scheme scheme;
    sphg_neighbors *neighbors;
    setup_array volume, field;
    int targets, near;
} crowd;

static void put_points(double *x, int dimension, int count, double where, random_state *random)
{
    for (int k = 0; k < count * dimension; ++k)
        x[k] = random_between(random, 0, .05) + (k % dimension ? 0 : where);
}

static crowd crowd_of(const test_case *test, int near, int list_free)
{
    enum { SOURCES = 4200 };
    random_state random = random_seeded(86);
    const int d = test->dimension, far = 16 * near + 101;
    const sphg_type type = test_field_type(test);
    crowd made = {.context = setup_context(), .targets = near + far, .near = near};
    cloud sources = {d, SOURCES, .01, test_memory(sizeof(double) * SOURCES * 3)};
    cloud targets = {d, near + far, .01, test_memory(sizeof(double) * (size_t)(near + far) * 3)};
    put_points(sources.x, d, SOURCES, 1.55, &random);
    put_points(targets.x, d, near, .7, &random);
    put_points(targets.x + near * d, d, far, .45, &random);
    const setup_array at = setup_positions(test, &sources);
    const setup_array places = setup_positions(test, &targets);
    sphg_geometry geometry = setup_geometry(test, &sources, &at);
    geometry.targets = setup_view(&places);
    geometry.target_count = targets.count;
    geometry.list_free = list_free;
    made.scheme = setup_scheme(test, 1);
    made.neighbors = setup_search(made.context, &made.scheme, &geometry);
    made.volume = setup_numbers(type, SOURCES, 1, cloud_volumes(&sources, .2, &random));
    made.field = setup_numbers(type, SOURCES, 1, cloud_numbers(&sources, -1, 1, &random));
    return made;
}

static setup_array values_in_crowd(const test_case *test, const crowd *on, const uint8_t *mask)
{
    setup_array value = setup_output(test_field_type(test), on->targets, test->dimension);
    const sphg_sources sources = {.neighbors = on->neighbors, .volume = setup_view(&on->volume)};
    const sphg_view field = setup_view(&on->field);
    const sphg_field asked = {.shape = SPHG_SCALAR,
                              .form = SPHG_DIRECT,
                              .at_sources = &field,
                              .gradient = setup_view(&value)};
    const sphg_subset subset = {0, on->targets, NULL, mask};
    const sphg_request request = {.sources = &sources,
                                  .fields = &asked,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .subset = mask ? &subset : NULL};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return value;
}

/* More pairs than are collected at once, of a few targets and of all. */
static void a_crowd_of_sources_is_summed_alike_for_any_subset(const test_case *test)
{
    static const int near[] = {90, 200};
    for (int k = 0; k < 4; ++k) {
        const crowd on = crowd_of(test, near[k / 2], k % 2);
        const setup_array full = values_in_crowd(test, &on, NULL);
        uint8_t *mask = test_memory((size_t)on.targets);
        for (int share = 1; share < 6; share += 4) {
            for (int t = 0; t < on.near; ++t)
                mask[t] = t % share == 0;
            const setup_array some = values_in_crowd(test, &on, mask);
            for (int t = 0; t < on.near; t += share)
                for (int c = 0; c < test->dimension; ++c)
                    TEST_REQUIRE(setup_get(&some, t, c) == setup_get(&full, t, c),
                                 "target %d, 1 of %d, %d see sources", t, share, on.near);
        }
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(two_source_sets_equal_their_union, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(a_mirrored_field_has_the_value_of_the_target, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(probes_may_look_into_mirrors, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(an_absent_field_is_zero, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS,
               0),
    TEST_ENTRY(lists_of_the_host_may_lack_a_field, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(masked_targets_of_two_sets_have_the_bits_of_all, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(targets_far_from_a_wall_have_the_bits_of_no_wall, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(corrections_of_most_targets_have_the_bits_of_all, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(sets_may_differ_in_their_periods, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(lists_for_other_targets_are_refused, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC), 0),
    TEST_ENTRY(a_refused_list_leaves_no_sums_behind, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(targets_unlike_sources_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(fields_of_one_call_equal_calls_of_one_field, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(a_result_alone_has_the_bits_it_has_among_all, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(what_is_known_of_corrections_is_the_same_alone, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(a_crowd_of_sources_is_summed_alike_for_any_subset, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(accumulate_adds_to_what_is_there, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
