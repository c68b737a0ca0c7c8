/* SPDX-License-Identifier: MIT */
/* Nothing is ordinary: an empty std::vector hands over NULL and 0, and no call minds. */
#include "support/setup.h"
#include <math.h>
#include <string.h>

typedef struct nobody {
    sphg_context *context;
    sphg_scheme scheme;
    sphg_type type;
    sphg_neighbors *neighbors;
} nobody;

static sphg_type type_of(const test_case *test)
{
    return test->precision == TEST_F64 ? SPHG_F64 : SPHG_F32;
}

/* A view of an empty array in the case's precision. */
static sphg_view nothing(sphg_type type)
{
    sphg_view view = sphg_absent();
    view.type = type;
    return view;
}

static sphg_geometry empty_geometry(const test_case *test)
{
    sphg_geometry geometry = {.sources = nothing(type_of(test))};
    if (test->precision == TEST_MIXED) {
        geometry.sources.type = SPHG_F64;
        geometry.precision = SPHG_F32;
    }
    return geometry;
}

static nobody nobody_of(const test_case *test)
{
    const sphg_geometry geometry = empty_geometry(test);
    nobody own = {setup_context(), setup_scheme(test, 1), type_of(test), NULL};
    own.neighbors = setup_search(own.context, &own.scheme, &geometry);
    return own;
}

/* Fields of one particle that lies alone, a table and results for it. */
typedef struct single {
    setup_array numbers, table, result;
} single;

static single single_of(const nobody *own)
{
    const double ones[16] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    const int width = sphg_correction_width(&own->scheme);
    return (single){setup_numbers(own->type, 1, 9, ones),
                    setup_numbers(own->type, 1, width ? width : 1, ones),
                    setup_output(own->type, 1, 9)};
}

static void every_form(const nobody *own, const sphg_sources *sources, int sets,
                       const sphg_view *at_sources, sphg_view target, sphg_view gradient)
{
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
        for (int shape = SPHG_SCALAR; shape <= SPHG_TENSOR; ++shape) {
            sphg_field field = {.shape = (sphg_shape)shape,
                                .form = (sphg_form)form,
                                .at_sources = at_sources,
                                .at_targets = target};
            if (shape == SPHG_SCALAR)
                field.gradient = gradient;
            else
                field.divergence = gradient;
            const sphg_request request = {
                .sources = sources, .set_count = sets, .fields = &field, .field_count = 1};
            SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
        }
}

static void every_operator_takes_an_empty_set(const test_case *test)
{
    const nobody own = nobody_of(test);
    const sphg_view none = sphg_absent();
    const sphg_sources sources = {.neighbors = own.neighbors};
    const single one = single_of(&own);
    const sphg_view out = setup_view(&one.result);
    const sphg_view outs[] = {none, out};
    for (int k = 0; k < 2; ++k) {
        every_form(&own, &sources, 1, &none, none, outs[k]);
        SETUP_OK(own.context,
                 sphg_gradient(own.context, &own.scheme, &sources, NULL, none, outs[k]));
        SETUP_OK(own.context,
                 sphg_jacobian(own.context, &own.scheme, &sources, NULL, none, outs[k]));
        SETUP_OK(own.context,
                 sphg_divergence(own.context, &own.scheme, &sources, NULL, none, outs[k]));
        SETUP_OK(own.context, sphg_curl(own.context, &own.scheme, &sources, NULL, none, outs[k]));
        SETUP_OK(own.context,
                 sphg_force(own.context, &own.scheme, &sources, NULL, SPHG_SCALAR, none, outs[k]));
    }
    if (test->method != SPHG_PLAIN)
        SETUP_OK(own.context,
                 sphg_correction(own.context, &own.scheme, &sources, NULL, none, none));
    sphg_pairs pairs = {.count = 7};
    SETUP_OK(own.context,
             sphg_pair_gradients(own.context, &own.scheme, &sources, NULL, none, &pairs));
    assert_int_equal(pairs.count, 0);
    SETUP_OK(own.context, sphg_neighbors_get_order(own.context, own.neighbors, NULL));
    assert_true(setup_is_canary(&one.result, 0));
}

/* Its views are the precision that the geometry named: others are refused, as for any set. */
/* Nobody looks, from a place of their own: what stands at the targets may be absent. */
static void no_targets_apart_need_nothing(const test_case *test)
{
    nobody own = nobody_of(test);
    const single one = single_of(&own);
    const sphg_type type = test_position_type(test);
    const setup_array place = setup_numbers(type, 1, test->dimension, (const double[]){1, 1, 1});
    sphg_geometry geometry = sphg_targets_apart(setup_view(&place), 0, setup_view(&place), 1);
    geometry.precision = own.type;
    const sphg_sources sources = {.neighbors = setup_search(own.context, &own.scheme, &geometry),
                                  .volume = setup_view(&one.numbers),
                                  .correction = setup_view(&one.table)};
    const sphg_view numbers = setup_view(&one.numbers);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_ADJOINT,
                              .at_sources = &numbers,
                              .coefficient = &numbers,
                              .laplacian = setup_view(&one.result)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    SETUP_OK(own.context, sphg_evaluate(own.context, &own.scheme, &request));
    assert_true(setup_is_canary(&one.result, 0));
}

static void an_empty_set_has_the_type_of_its_views(const test_case *test)
{
    const nobody own = nobody_of(test);
    const single one = single_of(&own);
    const sphg_view none = sphg_absent();
    sphg_sources sources = {.neighbors = own.neighbors, .volume = setup_view(&one.numbers)};
    every_form(&own, &sources, 1, &none, none, setup_view(&one.result));
    sources.volume.type = own.type == SPHG_F32 ? SPHG_F64 : SPHG_F32;
    const sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &none};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    assert_int_equal(sphg_evaluate(own.context, &own.scheme, &request), SPHG_ERROR_TYPE);
    const sphg_geometry named = {.precision = own.type};
    sources.neighbors = setup_search(own.context, &own.scheme, &named);
    sources.volume.type = own.type;
    SETUP_OK(own.context, sphg_evaluate(own.context, &own.scheme, &request));
}

/* One particle alone, and as the target of nobody. */
static void place_one(const test_case *test, sphg_geometry *alone, sphg_geometry *beside)
{
    const double origin[3] = {0};
    const sphg_type at = test->precision == TEST_F32 ? SPHG_F32 : SPHG_F64;
    const setup_array place = setup_numbers(at, 1, test->dimension, origin);
    *alone = *beside = empty_geometry(test);
    alone->sources = beside->targets = setup_view(&place);
    alone->source_count = alone->target_count = beside->target_count = 1;
}

/* A wall of nobody beside one particle; then nobody beside a wall. */
static void an_empty_set_beside_another_adds_nothing(const test_case *test)
{
    nobody own = nobody_of(test);
    const single one = single_of(&own);
    sphg_geometry alone, beside;
    place_one(test, &alone, &beside);
    const sphg_view ones = setup_view(&one.numbers), none = sphg_absent();
    const sphg_view of_nobody[] = {ones, none};
    const sphg_sources sources[] = {{.neighbors = setup_search(own.context, &own.scheme, &alone),
                                     .volume = ones,
                                     .density = ones,
                                     .correction = setup_view(&one.table)},
                                    {.neighbors = setup_search(own.context, &own.scheme, &beside)}};
    every_form(&own, sources, 2, of_nobody, none, setup_view(&one.result));
    for (int c = 0; c < (test->dimension == 2 ? 2 : 3); ++c)
        assert_false(setup_get(&one.result, 0, c) != setup_get(&one.result, 0, c));
}

/* A second and a third set beside one particle, nobody in either. */
static void a_third_set_of_nobody_adds_nothing(const test_case *test)
{
    nobody own = nobody_of(test);
    const single one = single_of(&own);
    sphg_geometry alone, beside;
    place_one(test, &alone, &beside);
    const sphg_view ones = setup_view(&one.numbers), none = sphg_absent();
    const sphg_view fields[] = {none, ones, none};
    const sphg_sources sources[] = {{.neighbors = setup_search(own.context, &own.scheme, &beside)},
                                    {.neighbors = setup_search(own.context, &own.scheme, &alone),
                                     .volume = ones,
                                     .density = ones,
                                     .correction = setup_view(&one.table)},
                                    {.neighbors = setup_search(own.context, &own.scheme, &beside)}};
    every_form(&own, sources, 3, fields, none, setup_view(&one.result));
    for (int c = 0; c < (test->dimension == 2 ? 2 : 3); ++c)
        assert_true(isfinite(setup_get(&one.result, 0, c)));
}

/* Without lists, and with a skin, again and again. */
static void every_search_finds_nobody(const test_case *test)
{
    const nobody own = nobody_of(test);
    const sphg_geometry base = empty_geometry(test);
    sphg_geometry geometries[] = {base, base, base};
    geometries[0].list_free = 1;
    geometries[1].skin = 0.25;
    geometries[2].sources = sphg_absent(); /* says nothing about the precision */
    geometries[2].precision = own.type;
    const sphg_view none = sphg_absent();
    for (int k = 0; k < 3; ++k) {
        sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &geometries[k]);
        const sphg_sources sources = {.neighbors = neighbors};
        for (int round = 0; round < 2; ++round) {
            SETUP_OK(own.context,
                     sphg_neighbors_search(own.context, neighbors, &own.scheme, &geometries[k]));
            every_form(&own, &sources, 1, &none, none, none);
        }
        sphg_sources typed = sources;
        const single one = single_of(&own);
        typed.volume = setup_view(&one.numbers); /* of the precision that was asked for */
        every_form(&own, &typed, 1, &none, none, setup_view(&one.result));
        assert_true(setup_is_canary(&one.result, 0));
        sphg_neighbors_info info;
        SETUP_OK(own.context, sphg_neighbors_get_info(own.context, neighbors, &info));
        assert_int_equal(info.pairs, 0);
    }
}

static void lists_of_nobody_are_lists(const test_case *test)
{
    nobody own = nobody_of(test);
    const sphg_geometry geometry = empty_geometry(test);
    const int64_t offset = 0;
    const int32_t unused = 0;
    const int32_t *row = &unused;
    const sphg_lists lists[] = {{.offsets = NULL},
                                {.offsets = &offset},
                                {.indices = &unused},
                                {.rows = &row},
                                {.lengths = &unused}};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k) {
        own.neighbors = setup_lists(own.context, &own.scheme, &geometry, &lists[k]);
        const sphg_sources sources = {.neighbors = own.neighbors};
        const sphg_view none = sphg_absent();
        every_form(&own, &sources, 1, &none, none, none);
        SETUP_OK(own.context, sphg_neighbors_get_order(own.context, own.neighbors, NULL));
        sphg_neighbors_info info;
        SETUP_OK(own.context, sphg_neighbors_get_info(own.context, own.neighbors, &info));
        assert_int_equal(info.pairs, 0);
    }
}

static void batches_of_no_matrices_are_done(const test_case *test)
{
    const nobody own = nobody_of(test);
    const sphg_view none = sphg_absent();
    const sphg_inversion wanted = {.stats = NULL};
    SETUP_OK(own.context, sphg_eigen(own.context, test->dimension, 0, none, none, none));
    SETUP_OK(own.context, sphg_svd(own.context, 0, none, none, none, none));
    SETUP_OK(own.context, sphg_invert_moments(own.context, &own.scheme, 0, none, none, &wanted));
}

static const test_entry entries[] = {
    TEST_ENTRY(every_operator_takes_an_empty_set, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(no_targets_apart_need_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(an_empty_set_has_the_type_of_its_views, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(an_empty_set_beside_another_adds_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(a_third_set_of_nobody_adds_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(every_search_finds_nobody, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(lists_of_nobody_are_lists, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(batches_of_no_matrices_are_done, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
};
TEST_MAIN(entries)
