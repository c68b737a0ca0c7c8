/* SPDX-License-Identifier: MIT */
/* Adjoint and symmetric forms with a support radius per particle: G_ij has that of i, G_ji that of
 * j, over lists that hold the pairs of now or, with a skin, more than these. */
#include "support/graded_halves.h"
#include <math.h>
#include <string.h>

/* ---- The oracle ------------------------------------------------------------------------------ */

/* Pairs that only the source's radius reaches count, too. Each way has the forms of every shape,
 * with one ratio of radii or another. */
static void both_sides_match_the_oracle(const test_case *test)
{
    static const double ratios[] = {1.5, 8, 64};
    for (int k = 0; k < 3; ++k)
        for (int way = 0; way < GRADED_WAYS; ++way) {
            const comparison on = graded_stage_of(test, ratios[k], 2.5, (graded_way)way);
            const setup_array table = comparison_table(&on);
            for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form)
                for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape)
                    if ((shape + way) % 3 == k || (k == 1 && !way))
                        graded_compare(&on, (sphg_shape)shape, (sphg_form)form, &table);
        }
}

/* In f32 powers of a ratio of radii are far from 1. */
static void radii_far_apart_match_the_oracle(const test_case *test)
{
    const comparison on = graded_stage_of(test, 0x1p12, 2.5, GRADED_AT_ONCE);
    const setup_array table = comparison_table(&on);
    for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form)
        for (int shape = SPHG_SCALAR; shape <= SPHG_VECTOR; ++shape)
            graded_compare(&on, (sphg_shape)shape, (sphg_form)form, &table);
}

/* Orders that a method has. */
static int orders_of(const test_case *test)
{
    return test_is_classic(test) || test->method == SPHG_PLAIN ? 1 : 2;
}

/* ---- The same bits --------------------------------------------------------------------------- */

enum { MIXED = 5 };

/* What a solver may ask for in one call: each on its own, and all of them together. */
static void require_alone_as_together(const comparison *on, const sphg_sources *sources,
                                      const char *where)
{
    static const comparison_field kinds[MIXED] = {{SPHG_VECTOR, SPHG_DIFFERENCE, NULL},
                                                  {SPHG_SYM_TENSOR, SPHG_ADJOINT, NULL},
                                                  {SPHG_VECTOR, SPHG_ADJOINT, NULL},
                                                  {SPHG_SCALAR, SPHG_SYMMETRIC, NULL},
                                                  {SPHG_SCALAR, SPHG_ADJOINT, NULL}};
    comparison_result alone[MIXED], together[MIXED];
    sphg_field asked[MIXED] = {{0}};
    setup_array numbers[MIXED];
    sphg_view views[MIXED];
    sphg_request request = {.sources = sources, .set_count = 1, .field_count = 1};
    for (int k = 0; k < MIXED; ++k) {
        comparison_field field = kinds[k];
        field.numbers = comparison_random_field(on, field.shape, 20);
        alone[k] = comparison_outputs(on, &field, on->points.count);
        together[k] = comparison_outputs(on, &field, on->points.count);
        numbers[k] = setup_numbers(test_field_type(on->test), on->points.count,
                                   setup_width(field.shape, on->points.dimension), field.numbers);
        views[k] = setup_view(&numbers[k]);
        asked[k].shape = field.shape;
        asked[k].form = field.form;
        asked[k].at_sources = &views[k];
        comparison_ask_for(&alone[k], &asked[k]);
        request.fields = &asked[k];
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
        comparison_ask_for(&together[k], &asked[k]);
    }
    request.fields = asked;
    request.field_count = MIXED;
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    for (int k = 0; k < MIXED; ++k)
        TEST_REQUIRE(comparison_results_have_same_bits(&alone[k], &together[k]), "field %d, %s", k,
                     where);
}

/* Pairs may be weighed with both radii at once, or one after the other, with a guard or without. */
static void forces_alone_have_the_bits_of_those_among_others(const test_case *test)
{
    for (int k = 0; k < GRADED_WAYS * orders_of(test); ++k) {
        comparison on = graded_stage_of(test, 8, 2.2, (graded_way)(k % GRADED_WAYS));
        on.scheme.order = 1 + k / GRADED_WAYS;
        const setup_array table = comparison_table(&on);
        sphg_sources sources = comparison_sources(&on);
        if (test->method != SPHG_PLAIN)
            sources.correction = comparison_table_view(&on, &table);
        require_alone_as_together(&on, &sources, on.name);
        sources.volume.stride = 0;
        require_alone_as_together(&on, &sources, test_text("%s, one volume", on.name));
    }
}

/* ---- Targets apart ----------------------------------------------------------------------------
 */

static void halves_apart_match_the_oracle(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        const comparison on = graded_stage_of(test, 8, 2.2, (graded_way)way);
        const setup_array table = comparison_table(&on);
        for (int k = 0; k < 4; ++k) {
            const sphg_shape shape = k & 1 ? SPHG_SYM_TENSOR : way & 1 ? SPHG_SCALAR : SPHG_VECTOR;
            const comparison_field field = {shape, k & 2 ? SPHG_SYMMETRIC : SPHG_ADJOINT,
                                            comparison_random_field(&on, shape, 8)};
            const setup_array numbers =
                setup_numbers(test_field_type(test), on.points.count,
                              setup_width(shape, test->dimension), field.numbers);
            const graded_halves of =
                graded_halves_of(&on, 8, 2.2, (graded_way)way, &table, &numbers);
            for (int given = 0; given < 2; ++given) {
                const comparison_result found =
                    graded_apply_to_halves(&on, &of, &field, &table, given);
                for (int i = 0; i < on.points.count;
                     i += test_reference_stride() * (on.points.count / 5))
                    comparison_compare(&on, &field, &found, i);
            }
        }
    }
}

/* ---- Crowds ------------------------------------------------------------------------------------
 */

enum { CROWD = 1200 };

/* Lists of one chunk and of many, more than stay between rounds over the pairs; with radii that
 * grow from 1 to 4 and few large particles among them. */
typedef struct crowd {
    setup_array x, h, volume, density, numbers, table;
    sphg_geometry geometry;
    sphg_scheme scheme;
    const test_case *test;
} crowd;

static crowd crowd_of(const test_case *test, int order, graded_way way)
{
    random_state random = random_seeded(91);
    const int d = test->dimension;
    const double side = d == 2 ? 9 : 6;
    cloud points = cloud_random(d, CROWD, side, &random);
    crowd made = {.test = test, .scheme = setup_scheme(test, 0)};
    made.scheme.order = order;
    double *radii = test_memory(CROWD * sizeof *radii);
    for (int i = 0; i < CROWD; ++i)
        radii[i] = i % 97 ? .5 + points.x[i * d] / 12 : side / 2.1;
    made.x = setup_positions(test, &points);
    made.h = setup_numbers(test_position_type(test), CROWD, 1, radii);
    const sphg_type type = test_field_type(test);
    made.volume = setup_numbers(type, CROWD, 1, cloud_volumes(&points, .2, &random));
    made.density = setup_numbers(type, CROWD, 1, cloud_numbers(&points, .5, 1.5, &random));
    const int width = d * (d + 1) / 2;
    double *numbers = test_memory((size_t)(CROWD * width) * sizeof *numbers);
    for (int k = 0; k < CROWD * width; ++k)
        numbers[k] = random_between(&random, -1, 1);
    made.numbers = setup_numbers(type, CROWD, width, numbers);
    made.geometry = setup_geometry(test, &points, &made.x);
    made.geometry.source_support = setup_view(&made.h);
    made.geometry.mutual = 1;
    made.geometry.skin = way & GRADED_MOVED ? .1 : 0;
    for (int a = 0; way & GRADED_AROUND && a < d; ++a)
        made.geometry.period[a] = side;
    return made;
}

typedef struct pushed {
    setup_array force, table;
} pushed;

/* What acts on the selected ones; table NULL: corrections of the targets, which stand apart, come
 * in the same sweep and are handed out. */
static pushed push(const crowd *of, sphg_context *context, sphg_neighbors *neighbors,
                   sphg_form form, const setup_array *sources_table, const setup_array *table,
                   const sphg_subset *subset)
{
    const int width = sphg_correction_width(&of->scheme);
    const int computes = !table && width;
    pushed made = {setup_output(test_field_type(of->test), CROWD, of->test->dimension),
                   setup_output(test_field_type(of->test), CROWD, computes ? width : 1)};
    const sphg_view at_sources = setup_view(&of->numbers);
    const sphg_sources sources = {.neighbors = neighbors,
                                  .volume = setup_view(&of->volume),
                                  .density = setup_view(&of->density),
                                  .correction = width ? setup_view(sources_table) : sphg_absent()};
    const sphg_field field = {.shape = SPHG_SYM_TENSOR,
                              .form = form,
                              .at_sources = &at_sources,
                              .at_targets = at_sources,
                              .divergence = setup_view(&made.force)};
    sphg_request request = {.sources = &sources,
                            .fields = &field,
                            .set_count = 1,
                            .field_count = 1,
                            .subset = subset,
                            .target_volume = sources.volume,
                            .target_density = sources.density};
    if (table && width)
        request.target_correction = setup_view(table);
    if (computes)
        request.correction = setup_view(&made.table);
    SETUP_OK(context, sphg_evaluate(context, &of->scheme, &request));
    return made;
}

static setup_array table_of(const crowd *of, sphg_context *context, sphg_neighbors *neighbors)
{
    const int width = sphg_correction_width(&of->scheme);
    const setup_array table = setup_output(test_field_type(of->test), CROWD, width ? width : 1);
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&of->volume)};
    if (width)
        SETUP_OK(context, sphg_correction(context, &of->scheme, &sources, NULL, setup_view(&table),
                                          sphg_absent()));
    return table;
}

static void corrections_on_the_way_give_the_bits_of_a_table(const test_case *test)
{
    for (int k = 0; k < GRADED_WAYS * orders_of(test); ++k) {
        const int way = k % GRADED_WAYS;
        const crowd of = crowd_of(test, 1 + k / GRADED_WAYS, (graded_way)way);
        sphg_context *context = setup_context();
        sphg_geometry apart = of.geometry;
        apart.targets = apart.sources;
        apart.target_support = apart.source_support;
        sphg_neighbors *const own = setup_search(context, &of.scheme, &of.geometry);
        sphg_neighbors *const neighbors = setup_search(context, &of.scheme, &apart);
        const setup_array table = table_of(&of, context, own);
        for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
            const pushed fused = push(&of, context, neighbors, (sphg_form)form, &table, NULL, NULL);
            const pushed given =
                push(&of, context, neighbors, (sphg_form)form, &table, &fused.table, NULL);
            TEST_REQUIRE(setup_same_bits(&fused.force, &given.force), "%s, form %d",
                         graded_way_name((graded_way)way), form);
        }
    }
}

/* Threads, pairs that are found on the spot, and which targets are asked for. */
static void no_way_of_summing_changes_a_bit(const test_case *test)
{
    for (int k = 0; k < GRADED_WAYS * orders_of(test); ++k) {
        const int way = k % GRADED_WAYS;
        const crowd of = crowd_of(test, 1 + k / GRADED_WAYS, (graded_way)way);
        sphg_context *context = setup_context_of(1);
        sphg_neighbors *const alone = setup_search(context, &of.scheme, &of.geometry);
        const setup_array table = table_of(&of, context, alone);
        const pushed expected = push(&of, context, alone, SPHG_ADJOINT, &table, &table, NULL);
        for (int other = 0; other < 3; ++other) {
            sphg_geometry geometry = of.geometry;
            geometry.list_free = other == 2 && !(way & GRADED_MOVED); /* a skin keeps pairs */
            sphg_context *several = setup_context_of(2 + other);
            sphg_neighbors *const neighbors = setup_search(several, &of.scheme, &geometry);
            const pushed found = push(&of, several, neighbors, SPHG_ADJOINT, &table, &table, NULL);
            TEST_REQUIRE(setup_same_bits(&expected.force, &found.force), "%s, way %d",
                         graded_way_name((graded_way)way), other);
        }
        uint8_t *mask = test_memory(CROWD);
        for (int every = 2; every < 60; every *= 5) {
            for (int i = 0; i < CROWD; ++i)
                mask[i] = (uint8_t)(every == 2 ? i % 3 != 0 : i % every == 0);
            const sphg_subset some = sphg_masked(mask, CROWD);
            const pushed found = push(&of, context, alone, SPHG_ADJOINT, &table, &table, &some);
            for (int i = 0; i < CROWD; ++i)
                for (int a = 0; mask[i] && a < test->dimension; ++a)
                    TEST_REQUIRE(setup_get(&found.force, i, a) == setup_get(&expected.force, i, a),
                                 "%s, target %d of every %d", graded_way_name((graded_way)way), i,
                                 every);
        }
    }
}

/* ---- What is not finite ------------------------------------------------------------------------
 */

/* Does either radius reach, as the library decides it? */
static int are_near(const comparison *on, int i, int j, double slack)
{
    const int d = on->points.dimension;
    double square = 0;
    for (int a = 0; a < d; ++a) {
        double x = on->points.x[i * d + a] - on->points.x[j * d + a];
        if (on->scene.period[a] > 0)
            x = remainder(x, on->scene.period[a]);
        square += x * x;
    }
    return sqrt(square) < fmax(on->scene.support[i], on->scene.support[j]) * (1 + slack);
}

/* A value that is not finite reaches those near it and nobody else, whatever lists hold beside. */
static void nothing_comes_from_beyond_both_radii(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS * orders_of(test); ++way) {
        comparison on = graded_stage_of(test, 8, 2.2, (graded_way)(way % GRADED_WAYS));
        on.scheme.order = 1 + way / GRADED_WAYS;
        const setup_array table = comparison_table(&on);
        const int n = on.points.count;
        for (int k = 0; k < 6; ++k) {
            const int bad = k * (n - 1) / 5;
            const sphg_shape shape = k % 3 == 0   ? SPHG_SCALAR
                                     : k % 3 == 1 ? SPHG_VECTOR
                                                  : SPHG_TENSOR;
            const int width = setup_width(shape, test->dimension);
            double *numbers = comparison_random_field(&on, shape, 5);
            numbers[bad * width] = k & 1 ? (double)NAN : (double)INFINITY;
            const comparison_field field = {shape, k < 3 ? SPHG_SYMMETRIC : SPHG_ADJOINT, numbers};
            const comparison_result found = comparison_apply(&on, &field, &table);
            const setup_array *result = shape == SPHG_SCALAR ? &found.gradient : &found.divergence;
            int far = 0;
            for (int i = 0; i < n; ++i) {
                const int near = i == bad || are_near(&on, i, bad, 1e-6);
                far += !near;
                for (int c = 0; c < result->width; ++c)
                    TEST_REQUIRE(near || isfinite(setup_get(result, i, c)), "%s: %d from %d",
                                 on.name, i, bad);
            }
            assert_true(far > 0);
        }
    }
}

/* ---- What is refused ---------------------------------------------------------------------- */

static void require_refused(const comparison *on, sphg_result found, sphg_result expected,
                            const char *words)
{
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(found == expected && strstr(message, words), "%s: %s", sphg_result_string(found),
                 message);
}

/* Of ghosts, whose volumes a force alone reads as sources'. */
static void bad_volumes_of_forces_are_refused(const test_case *test)
{
    static const double bad[] = {-1, NAN, INFINITY};
    const comparison on = graded_stage_of(test, 8, 2.2, GRADED_AT_ONCE);
    const int n = on.points.count;
    const setup_array table = comparison_table(&on),
                      x = setup_positions(test, (cloud *)(uintptr_t)&on.points);
    const setup_array h = setup_numbers(test_position_type(test), n, 1, on.scene.support);
    const setup_array a =
        setup_numbers(test_field_type(test), n, 1, comparison_random_field(&on, SPHG_SCALAR, 7));
    const setup_array out = setup_output(test_field_type(test), n, test->dimension);
    sphg_geometry geometry = sphg_own_and_ghosts(setup_view(&x), n / 2, n - n / 2);
    geometry.precision = test_field_type(test);
    geometry.source_support = setup_view(&h);
    geometry.mutual = 1;
    sphg_neighbors *const neighbors = setup_search(on.context, &on.scheme, &geometry);
    double *volume = test_memory((size_t)n * sizeof *volume);
    for (int k = 0; k < 3; ++k) {
        memcpy(volume, on.scene.volume, (size_t)n * sizeof *volume);
        volume[n - 3] = bad[k];
        const setup_array volumes = setup_numbers(test_field_type(test), n, 1, volume);
        sphg_sources sources = comparison_sources(&on);
        sources.neighbors = neighbors;
        sources.volume = setup_view(&volumes);
        sources.correction = comparison_table_view(&on, &table);
        require_refused(&on,
                        sphg_force(on.context, &on.scheme, &sources, NULL, SPHG_SCALAR,
                                   setup_view(&a), setup_view(&out)),
                        SPHG_ERROR_VOLUME, "volume");
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(both_sides_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(radii_far_apart_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(forces_alone_have_the_bits_of_those_among_others, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(halves_apart_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(corrections_on_the_way_give_the_bits_of_a_table, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(no_way_of_summing_changes_a_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(nothing_comes_from_beyond_both_radii, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(bad_volumes_of_forces_are_refused, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
