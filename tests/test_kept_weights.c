/* SPDX-License-Identifier: MIT */
/* Weights that neighbours keep beside their lists: the same bits as without, read only where they
 * are those of the sweep, and really read. */
#include "support/setup.h"
#include <string.h>

typedef struct kept {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    cloud points;
    setup_array positions, volume, other_volume, scalar, vector;
    sphg_neighbors *keeping, *plain;
} kept;

static sphg_geometry geometry_of(const kept *on, int keep)
{
    cloud points = on->points;
    sphg_geometry geometry = setup_geometry(on->test, &points, &on->positions);
    geometry.keep_weights = keep;
    return geometry;
}

static kept kept_on(const test_case *test, sphg_context *context)
{
    kept made = {.test = test, .context = context, .scheme = setup_scheme(test, 2)};
    random_state random = random_seeded(71);
    const sphg_type type = test_field_type(test);
    made.points = cloud_jittered(test->dimension, test->dimension == 3 ? 9 : 24, 1, .3, &random);
    made.positions = setup_positions(test, &made.points);
    const int n = made.points.count;
    made.volume = setup_numbers(type, n, 1, cloud_volumes(&made.points, .3, &random));
    made.other_volume = setup_numbers(type, n, 1, cloud_volumes(&made.points, .3, &random));
    made.scalar = setup_numbers(type, n, 1, cloud_numbers(&made.points, -1, 1, &random));
    made.vector = setup_output(type, n, test->dimension);
    for (int k = 0; k < n * test->dimension; ++k)
        setup_put(&made.vector, k, random_between(&random, -1, 1));
    const sphg_geometry keeping = geometry_of(&made, 1), plain = geometry_of(&made, 0);
    made.keeping = setup_search(context, &made.scheme, &keeping);
    made.plain = setup_search(context, &made.scheme, &plain);
    return made;
}

/* Where fields are narrower than positions, pairs are formed another way. */
static int keeps(const kept *on)
{
    return on->test->precision != TEST_MIXED && !test_is_classic(on->test);
}

typedef struct results {
    setup_array table, jacobian, force;
} results;

static results results_of(const kept *on)
{
    const int n = on->points.count, d = on->test->dimension;
    const int width = sphg_correction_width(&on->scheme);
    const sphg_type type = test_field_type(on->test);
    return (results){setup_output(type, n, width ? width : 1), setup_output(type, n, d * d),
                     setup_output(type, n, d)};
}

/* Corrections and a Jacobian in one sweep, then a force that uses them. */
static results evaluate(const kept *on, const sphg_neighbors *neighbors, sphg_view volume,
                        int same_volumes, const sphg_subset *subset)
{
    results found = results_of(on);
    const sphg_view vector = setup_view(&on->vector), scalar = setup_view(&on->scalar);
    const int width = sphg_correction_width(&on->scheme);
    sphg_sources sources = {.neighbors = neighbors, .volume = volume, .same_volumes = same_volumes};
    sphg_field field = {
        .shape = SPHG_VECTOR, .at_sources = &vector, .gradient = setup_view(&found.jacobian)};
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1, .subset = subset};
    if (width)
        request.correction = setup_view(&found.table);
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    if (subset)
        return found;
    field = (sphg_field){.shape = SPHG_SCALAR,
                         .form = SPHG_ADJOINT,
                         .at_sources = &scalar,
                         .gradient = setup_view(&found.force)};
    request.correction = sphg_absent();
    if (width)
        sources.correction = setup_view(&found.table);
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

static void require_same(const results *a, const results *b, const char *how)
{
    TEST_REQUIRE(setup_same_bits(&a->table, &b->table), "%s: corrections", how);
    TEST_REQUIRE(setup_same_bits(&a->jacobian, &b->jacobian), "%s: Jacobian", how);
    TEST_REQUIRE(setup_same_bits(&a->force, &b->force), "%s: force", how);
}

static void require_fresh(const kept *on, sphg_view volume, int same_volumes, const char *how)
{
    const results expected = evaluate(on, on->plain, volume, 0, NULL);
    const results found = evaluate(on, on->keeping, volume, same_volumes, NULL);
    require_same(&found, &expected, how);
}

/* ---- Same bits ------------------------------------------------------------------------------ */

static void bits_are_those_without(const test_case *test)
{
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        if (!context)
            continue;
        const kept on = kept_on(test, context);
        const sphg_view volume = setup_view(&on.volume);
        uint8_t *mask = test_memory((size_t)on.points.count);
        for (int i = 0; i < on.points.count; ++i)
            mask[i] = i < on.points.count / 2 || i % 3 == 0;
        const sphg_subset some = sphg_masked(mask, on.points.count);
        evaluate(&on, on.keeping, volume, 0, &some); /* fills some of the groups */
        require_fresh(&on, volume, 1, test_text("path %d, after a mask", (int)isa));
        require_fresh(&on, volume, 1, test_text("path %d, read", (int)isa));
        require_fresh(&on, volume, 0, test_text("path %d, formed anew", (int)isa));
    }
}

/* ---- What makes them others ----------------------------------------------------------------- */

static sphg_scheme with_kernel(const kept *on, sphg_kernel kernel)
{
    sphg_scheme scheme = on->scheme;
    scheme.kernel = kernel;
    return scheme;
}

static void another_scheme_or_volume_forms_them_anew(const test_case *test)
{
    kept on = kept_on(test, setup_context());
    const sphg_view volume = setup_view(&on.volume), other = setup_view(&on.other_volume);
    require_fresh(&on, volume, 0, "first");
    require_fresh(&on, other, 0, "other volumes");
    const sphg_scheme mine = on.scheme;
    on.scheme = with_kernel(&on, SPHG_WENDLAND_C2);
    require_fresh(&on, other, 1, "another kernel");
    on.scheme = mine;
    require_fresh(&on, other, 1, "the kernel of before");
    on.scheme.method = mine.method == SPHG_MLS ? SPHG_KGC : SPHG_MLS;
    require_fresh(&on, other, 1, "another method");
    on.scheme = mine;
    on.scheme.support_radius = 1.5;
    require_fresh(&on, other, 1, "a smaller radius");
    on.scheme = mine;
    require_fresh(&on, other, 1, "the radius of before");
}

/* A gradient of every pair: the sums of a host's own loop, whose volumes count as those of a sweep
 * do. */
static void export_pairs(const kept *on, sphg_view volume)
{
    const int most = on->points.count * on->points.count, d = on->test->dimension;
    const setup_array gradient = setup_output(test_field_type(on->test), most, d);
    const sphg_sources sources = {.neighbors = on->keeping, .volume = volume};
    sphg_pairs pairs = {.indices = test_memory((size_t)most * sizeof *pairs.indices),
                        .gradient = setup_view(&gradient),
                        .capacity = most};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, sphg_absent(), &pairs));
}

/* Sweeps that keep nothing: by a classic method, of order 2, over pairs for the host. */
static void volumes_of_sweeps_that_keep_nothing_count(const test_case *test)
{
    kept on = kept_on(test, setup_context());
    const sphg_view volume = setup_view(&on.volume), other = setup_view(&on.other_volume);
    const sphg_scheme mine = on.scheme;
    require_fresh(&on, volume, 0, "before a classic method");
    on.scheme.method = SPHG_CRKPM;
    require_fresh(&on, other, 0, "a classic method");
    on.scheme = mine;
    require_fresh(&on, other, 1, "after a classic method");
    require_fresh(&on, volume, 0, "before order 2");
    on.scheme.method = SPHG_RKPM;
    on.scheme.order = 2;
    require_fresh(&on, other, 0, "order 2");
    on.scheme = mine;
    require_fresh(&on, other, 1, "after order 2");
    require_fresh(&on, volume, 0, "before pairs");
    export_pairs(&on, other);
    require_fresh(&on, other, 1, "after pairs");
}

static void one_volume_for_all_is_compared(const test_case *test)
{
    const kept on = kept_on(test, setup_context());
    const sphg_type type = test_field_type(test);
    for (int k = 0; k < 3; ++k) {
        const setup_array one = setup_numbers(type, 1, 1, (const double[]){k == 1 ? .75 : 1});
        sphg_view volume = setup_view(&one);
        volume.stride = 0;
        require_fresh(&on, volume, 0, test_text("volume %d, first", k));
        require_fresh(&on, volume, 1, test_text("volume %d, again", k));
    }
    require_fresh(&on, setup_view(&on.volume), 1, "volumes of their own");
}

static void a_new_search_forgets_them(const test_case *test)
{
    kept on = kept_on(test, setup_context());
    const sphg_view volume = setup_view(&on.volume);
    require_fresh(&on, volume, 0, "before");
    for (int k = 0; k < on.points.count; ++k)
        on.points.x[k * test->dimension] *= 1.125;
    on.positions = setup_positions(test, &on.points);
    const sphg_geometry keeping = geometry_of(&on, 1), plain = geometry_of(&on, 0);
    SETUP_OK(on.context, sphg_neighbors_search(on.context, on.keeping, &on.scheme, &keeping));
    SETUP_OK(on.context, sphg_neighbors_search(on.context, on.plain, &on.scheme, &plain));
    require_fresh(&on, volume, 1, "after");
}

/* A sweep that failed wrote what nobody may read. */
static void bad_volumes_leave_nothing_behind(const test_case *test)
{
    const kept on = kept_on(test, setup_context());
    const setup_array bad =
        setup_numbers(test_field_type(test), on.points.count, 1, setup_doubles(&on.volume));
    setup_put(&bad, on.points.count / 2, -1);
    const sphg_view vector = setup_view(&on.vector);
    results found = results_of(&on);
    const sphg_sources sources = {.neighbors = on.keeping, .volume = setup_view(&bad)};
    const sphg_field field = {
        .shape = SPHG_VECTOR, .at_sources = &vector, .gradient = setup_view(&found.jacobian)};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    assert_int_equal(sphg_evaluate(on.context, &on.scheme, &request), SPHG_ERROR_VOLUME);
    require_fresh(&on, setup_view(&on.volume), 1, "after a volume of -1");
}

/* ---- They are read -------------------------------------------------------------------------- */

/* Told that volumes are those of before, which they are not, sums are still those of before. */
static void what_is_kept_is_read(const test_case *test)
{
    const kept on = kept_on(test, setup_context());
    if (!keeps(&on))
        test_skip();
    const results before = evaluate(&on, on.keeping, setup_view(&on.volume), 0, NULL);
    const results told = evaluate(&on, on.keeping, setup_view(&on.other_volume), 1, NULL);
    const results honest = evaluate(&on, on.keeping, setup_view(&on.other_volume), 0, NULL);
    int equal = 0, honest_equal = 0;
    for (int i = 0; i < on.points.count; ++i) {
        const double x = setup_get(&before.jacobian, i, 0);
        equal += setup_get(&told.jacobian, i, 0) == x;
        honest_equal += setup_get(&honest.jacobian, i, 0) == x;
    }
    /* the last group may be too small to be kept */
    TEST_REQUIRE(equal > on.points.count - 16, "%d of %d were read", equal, on.points.count);
    TEST_REQUIRE(honest_equal < on.points.count / 8, "%d of %d did not change", honest_equal,
                 on.points.count);
}

static void they_are_counted_among_the_bytes(const test_case *test)
{
    const kept on = kept_on(test, setup_context());
    sphg_neighbors_info with, without;
    SETUP_OK(on.context, sphg_neighbors_get_info(on.context, on.keeping, &with));
    SETUP_OK(on.context, sphg_neighbors_get_info(on.context, on.plain, &without));
    const int64_t each = test_field_type(test) == SPHG_F64 ? 8 : 4;
    if (test->precision == TEST_MIXED)
        assert_int_equal(with.bytes, without.bytes);
    else
        TEST_REQUIRE(with.bytes >= without.bytes + each * with.pairs, "%lld and %lld bytes",
                     (long long)with.bytes, (long long)without.bytes);
}

/* ---- In company ----------------------------------------------------------------------------- */

/* A host that evaluates on the same neighbours, through another context, before each task. */
typedef struct company {
    const kept *on;
    results found;
    int calls;
} company;

static void run_in_company(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    company *with = user;
    (void)grain;
    if (with->on && !with->calls++)
        with->found = evaluate(with->on, with->on->keeping, setup_view(&with->on->volume), 0, NULL);
    task(data, 0, count, 0);
}

static void a_sweep_beside_another_has_the_same_bits(const test_case *test)
{
    company with = {.on = NULL};
    const sphg_config config = {
        .threads = 1, .isa = test_isa(), .parallel_for = run_in_company, .user = &with};
    const kept inner = kept_on(test, setup_context());
    kept outer = inner;
    outer.context = setup_context_with(&config);
    const results expected = evaluate(&inner, inner.plain, setup_view(&inner.volume), 0, NULL);
    with.on = &inner;
    const results found = evaluate(&outer, inner.keeping, setup_view(&inner.volume), 0, NULL);
    TEST_REQUIRE(with.calls > 0, "nobody came");
    require_same(&found, &expected, "the first");
    require_same(&with.found, &expected, "the second");
    with.on = NULL;
    require_fresh(&inner, setup_view(&inner.volume), 1, "afterwards");
}

/* ---- Refusals ------------------------------------------------------------------------------- */

static void lists_must_be_kept_by_a_search(const test_case *test)
{
    const kept on = kept_on(test, setup_context());
    sphg_geometry geometry = geometry_of(&on, 1);
    geometry.list_free = 1;
    assert_int_equal(sphg_neighbors_search(on.context, on.keeping, &on.scheme, &geometry),
                     SPHG_ERROR_ARGUMENT);
    TEST_REQUIRE(strstr(sphg_last_message(on.context), "keep_weights"), "%s",
                 sphg_last_message(on.context));
    geometry.list_free = 0;
    const int64_t *offsets = test_memory((size_t)(on.points.count + 1) * sizeof *offsets);
    const int32_t *indices = test_memory(sizeof *indices);
    const sphg_lists lists = {.offsets = offsets, .indices = indices};
    assert_int_equal(
        sphg_neighbors_use_lists(on.context, on.keeping, &on.scheme, &geometry, &lists),
        SPHG_ERROR_ARGUMENT);
    TEST_REQUIRE(strstr(sphg_last_message(on.context), "keep_weights"), "%s",
                 sphg_last_message(on.context));
    require_fresh(&on, setup_view(&on.volume), 0, "the neighbours of before");
}

static const test_entry entries[] = {
    TEST_ENTRY(bits_are_those_without, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS,
               0),
    TEST_ENTRY(another_scheme_or_volume_forms_them_anew, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(volumes_of_sweeps_that_keep_nothing_count, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(one_volume_for_all_is_compared, TEST_SINGLE_AND_DOUBLE, 0,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(a_new_search_forgets_them, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
    TEST_ENTRY(bad_volumes_leave_nothing_behind, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
    TEST_ENTRY(what_is_kept_is_read, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_PLAIN) | TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM), 0),
    TEST_ENTRY(they_are_counted_among_the_bytes, TEST_ALL_PRECISIONS, 0, 0, 0),
    TEST_ONCE(a_sweep_beside_another_has_the_same_bits),
    TEST_ONCE(lists_must_be_kept_by_a_search),
};
TEST_MAIN(entries)
