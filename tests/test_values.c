/* SPDX-License-Identifier: MIT */
/* Sums of values: of differences, over the sum of their weights, with volumes of their own; and
 * gradients contracted with a tensor of each target. */
#include "support/oracle_diffusion.h"
#include "support/scenes.h"
#include <math.h>
#include <string.h>

#define METHODS (TEST_LINEARISED | TEST_BIT(SPHG_PLAIN))

typedef struct sum {
    sphg_shape shape;
    sphg_form form;
    const double *numbers, *volume; /* volume: of the value alone, or NULL */
    int shepard;
} sum;

static setup_array evaluate(const comparison *on, const sum *of)
{
    const sphg_type type = test_field_type(on->test);
    const int width = setup_width(of->shape, on->points.dimension), n = on->points.count;
    const setup_array numbers = setup_numbers(type, n, width, of->numbers);
    const setup_array result = setup_output(type, n, width);
    setup_array volumes = {.width = 0};
    if (of->volume)
        volumes = setup_numbers(type, n, 1, of->volume);
    const sphg_view at_sources = setup_view(&numbers);
    const sphg_view volume = of->volume ? setup_view(&volumes) : sphg_absent();
    const sphg_sources sources = comparison_sources(on);
    sphg_field field = {.shape = of->shape, .form = of->form, .at_sources = &at_sources};
    field.value = setup_view(&result);
    field.value_volume = of->volume ? &volume : NULL;
    field.shepard = of->shepard;
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return result;
}

static double *weights(const comparison *on, uint64_t seed)
{
    random_state random = random_seeded(seed);
    return cloud_numbers(&on->points, .001, .1, &random);
}

static comparison block_of(const test_case *test)
{
    random_state random = random_seeded(51);
    const int d = test->dimension;
    return comparison_of(test, "block", cloud_jittered(d, d == 2 ? 9 : 5, .125, .3, &random), .27);
}

static comparison graded_stage(const test_case *test)
{
    random_state random = random_seeded(52);
    const int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 9 : 5, .125, .2, &random);
    double *radii = test_memory((size_t)points.count * sizeof *radii);
    for (int i = 0; i < points.count; ++i)
        radii[i] = .27 * exp(points.x[i * d]);
    return comparison_of_radii(test, "graded block", points, radii, 1);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void compare(const comparison *on, const sum *of)
{
    const setup_array found = evaluate(on, of);
    const oracle_field field = {of->shape, of->form, of->numbers, NULL};
    const int step = test_reference_stride() * (1 + on->points.count / 5);
    for (int i = 0; i < on->points.count; i += step) {
        const oracle_mean exact = oracle_value(on->reference, &field, of->volume, of->shepard, i);
        TEST_WITHIN(value_ratio, comparison_ratio(&found, i, exact.value, exact.bound),
                    test_text("particle %d, %s, form %d", i, on->name, (int)of->form));
    }
}

static void compare_all(const comparison *on)
{
    for (int way = 0; way < 6; ++way) {
        const sphg_shape shape = (sphg_shape)(1 + way % 4);
        const sum of = {shape, way % 3 ? SPHG_DIRECT : SPHG_DIFFERENCE,
                        comparison_random_field(on, shape, 3), way > 2 ? weights(on, 4) : NULL,
                        way % 3 == 2};
        compare(on, &of);
    }
}

static void results_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = comparison_of_scene(test, &scenes_hard[s]);
        compare_all(&on);
    }
}

static void radii_match_the_oracle(const test_case *test)
{
    const comparison on = graded_stage(test);
    compare_all(&on);
}

/* ---- Properties ------------------------------------------------------------------------------ */

/* A mean over weights of the field itself: constants stay, at surfaces, too. */
static void shepard_keeps_constants(const test_case *test)
{
    const comparison on = comparison_of_scene(test, &scenes_hard[5]);
    double *same = test_memory((size_t)on.points.count * sizeof *same);
    for (int i = 0; i < on.points.count; ++i)
        same[i] = 3;
    for (int own = 0; own < 2; ++own) {
        const sum of = {SPHG_SCALAR, SPHG_DIRECT, same, own ? weights(&on, 5) : NULL, 1};
        const setup_array found = evaluate(&on, &of);
        for (int i = 0; i < on.points.count; ++i)
            TEST_WITHIN(shepard_value,
                        fabs(setup_get(&found, i, 0) / 3 - 1) / test_unit_roundoff(test),
                        test_text("particle %d", i));
    }
    const sum of = {SPHG_SCALAR, SPHG_DIFFERENCE, same, NULL, 0};
    const setup_array still = evaluate(&on, &of);
    for (int i = 0; i < on.points.count; ++i)
        assert_true(setup_get(&still, i, 0) == 0);
}

/* Weights below the normal numbers have few digits, but a mean. */
static void tiny_weights_have_a_mean(const test_case *test)
{
    const comparison on = block_of(test);
    const int n = on.points.count;
    double *same = test_memory((size_t)n * sizeof *same),
           *tiny = test_memory((size_t)n * sizeof *tiny);
    for (int i = 0; i < n; ++i) {
        same[i] = 3;
        tiny[i] = ldexp(1, test_field_type(test) == SPHG_F64 ? -1066 : -141);
    }
    const sum of = {SPHG_SCALAR, SPHG_DIRECT, same, tiny, 1};
    const setup_array found = evaluate(&on, &of);
    for (int i = 0; i < n; ++i)
        TEST_REQUIRE(fabs(setup_get(&found, i, 0) / 3 - 1) < .1, "particle %d: %g", i,
                     setup_get(&found, i, 0));
}

/* Probes with nobody near: 0, not 0 / 0. */
static void nobody_gives_nothing(const test_case *test)
{
    const int d = test->dimension;
    const comparison on = block_of(test);
    cloud far = cloud_single(d);
    for (int a = 0; a < d; ++a)
        far.x[a] = 77;
    const setup_array x = setup_positions(test, (cloud *)&on.points),
                      probe = setup_positions(test, &far);
    sphg_geometry geometry =
        sphg_targets_apart(setup_view(&probe), 1, setup_view(&x), on.points.count);
    geometry.precision = test_field_type(test);
    sphg_sources sources = comparison_sources(&on);
    sources.neighbors = setup_search(on.context, &on.scheme, &geometry);
    const setup_array found = setup_output(test_field_type(test), 1, 1);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_DIRECT,
                              .at_sources = &sources.volume,
                              .value = setup_view(&found),
                              .shepard = 1};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    assert_true(setup_get(&found, 0, 0) == 0);
}

/* One request with curls by one volume and differences by another: what two requests give. */
static void fields_with_volumes_of_their_own_stand_beside_others(const test_case *test)
{
    const comparison on = block_of(test);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, d = test->dimension;
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 7), *own = weights(&on, 8);
    const sum alone[2] = {{SPHG_VECTOR, SPHG_DIFFERENCE, numbers, own, 0},
                          {SPHG_VECTOR, SPHG_DIFFERENCE, numbers, NULL, 0}};
    const setup_array one = evaluate(&on, &alone[0]), two = evaluate(&on, &alone[1]);
    const comparison_field curls = {SPHG_VECTOR, SPHG_DIFFERENCE, numbers};
    const comparison_result swirl = comparison_apply(&on, &curls, NULL);
    const setup_array values = setup_numbers(type, n, d, numbers),
                      volumes = setup_numbers(type, n, 1, own), first = setup_output(type, n, d),
                      second = setup_output(type, n, d),
                      curl = setup_output(type, n, d == 3 ? 3 : 1);
    const sphg_view at_sources = setup_view(&values), volume = setup_view(&volumes);
    const sphg_sources sources = comparison_sources(&on);
    const sphg_field fields[2] = {{.shape = SPHG_VECTOR,
                                   .at_sources = &at_sources,
                                   .value = setup_view(&first),
                                   .value_volume = &volume},
                                  {.shape = SPHG_VECTOR,
                                   .at_sources = &at_sources,
                                   .value = setup_view(&second),
                                   .curl = setup_view(&curl)}};
    const sphg_request request = {
        .sources = &sources, .fields = fields, .set_count = 1, .field_count = 2};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    TEST_REQUIRE(setup_same_bits(&first, &one), "with volumes of its own");
    TEST_REQUIRE(setup_same_bits(&second, &two), "with those of the set");
    setup_require_close(&curl, &swirl.curl, "curl beside values");
}

/* Two halves as two sets, list-free, by lists, and masked. */
static void every_path_gives_the_same(const test_case *test)
{
    const comparison on = block_of(test);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, half = n / 3, d = test->dimension;
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 9), *own = weights(&on, 10);
    const setup_array values = setup_numbers(type, n, d, numbers),
                      volumes = setup_numbers(type, n, 1, own),
                      x = setup_positions(test, (cloud *)&on.points);
    for (int way = 0; way < 3; ++way) {
        const sum of = {SPHG_VECTOR, way ? SPHG_DIRECT : SPHG_DIFFERENCE, numbers,
                        way == 1 ? NULL : own, way > 0};
        const setup_array whole = evaluate(&on, &of);
        comparison other = on;
        sphg_geometry geometry = setup_geometry(test, &on.points, &x);
        geometry.list_free = 1;
        other.neighbors = setup_search(on.context, &on.scheme, &geometry);
        const setup_array found = evaluate(&other, &of);
        TEST_REQUIRE(setup_same_bits(&whole, &found), "list-free, way %d", way);
        sphg_sources sources[2] = {comparison_sources(&on), comparison_sources(&on)};
        sphg_view at_sources[2], volume[2];
        for (int s = 0; s < 2; ++s) {
            const ptrdiff_t first = s ? half : 0;
            sphg_view place = setup_view(&x), targets = setup_view(&x);
            at_sources[s] = setup_view(&values);
            volume[s] = setup_view(&volumes);
            sphg_view *const moved[] = {&place, &sources[s].volume, &at_sources[s], &volume[s]};
            for (int v = 0; v < 4; ++v)
                moved[v]->x = (const char *)moved[v]->x + first * moved[v]->stride;
            /* the first set has the targets' first as sources: part of neither */
            sphg_geometry apart = sphg_targets_apart(targets, n, place, s ? n - half : half);
            apart.precision = type;
            sources[s].neighbors = setup_search(on.context, &on.scheme, &apart);
        }
        const setup_array sums = setup_output(type, n, d);
        const sphg_field field = {.shape = SPHG_VECTOR,
                                  .form = of.form,
                                  .at_sources = at_sources,
                                  .at_targets = setup_view(&values),
                                  .value = setup_view(&sums),
                                  .value_volume = of.volume ? volume : NULL,
                                  .shepard = of.shepard};
        const sphg_request request = {.sources = sources,
                                      .fields = &field,
                                      .set_count = 2,
                                      .field_count = 1,
                                      .target_volume = setup_view(&on.volume)};
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
        setup_require_close(&whole, &sums, "two sets"); /* i itself is a pair of r = 0 */
    }
}

/* Classic: weights that sum to 1, so that the sum of differences is value minus A_i; order 2 has
 * the same weights as order 1. */
static void classic_differences_are_values_less_ones_own(const test_case *test)
{
    const comparison on = block_of(test);
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 11);
    const sum of = {SPHG_SCALAR, SPHG_DIFFERENCE, numbers, NULL, 0},
              direct = {SPHG_SCALAR, SPHG_DIRECT, numbers, NULL, 0};
    const setup_array difference = evaluate(&on, &of), value = evaluate(&on, &direct);
    for (int i = 0; i < on.points.count; ++i) {
        const double error = setup_get(&difference, i, 0) + numbers[i] - setup_get(&value, i, 0);
        TEST_REQUIRE(fabs(error) < 2e3 * test_unit_roundoff(test), "particle %d: %g", i, error);
    }
}

static void order_2_has_the_same_values(const test_case *test)
{
    const comparison on = block_of(test);
    comparison second = on;
    second.scheme.order = 2;
    const sum of = {SPHG_VECTOR, SPHG_DIFFERENCE, comparison_random_field(&on, SPHG_VECTOR, 12),
                    NULL, 0};
    const setup_array one = evaluate(&on, &of), two = evaluate(&second, &of);
    setup_require_close(&one, &two, "order 2");
}

/* ---- Contraction ----------------------------------------------------------------------------- */

/* J : T_i is what a host makes of J. */
static void contractions_are_those_of_the_jacobian(const test_case *test)
{
    const comparison on = block_of(test);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, d = test->dimension;
    const setup_array table = comparison_table(&on);
    const setup_array values =
                          setup_numbers(type, n, d, comparison_random_field(&on, SPHG_VECTOR, 13)),
                      tensors = setup_numbers(type, n, d * d,
                                              comparison_random_field(&on, SPHG_TENSOR, 14));
    const sphg_view at_sources = setup_view(&values);
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
        for (int order = 1; order <= 2; ++order) {
            const setup_array jacobian = setup_output(type, n, d * d),
                              found = setup_output(type, n, 1), alone = setup_output(type, n, 1);
            sphg_scheme scheme = on.scheme;
            scheme.order = order;
            const int linear = order == 1;
            if (!linear &&
                (form != SPHG_DIFFERENCE || test_is_classic(test) || test->method == SPHG_PLAIN))
                continue;
            sphg_sources sources = comparison_sources(&on);
            if (linear)
                sources.correction = comparison_table_view(&on, &table);
            sphg_field field = {.shape = SPHG_VECTOR, .form = (sphg_form)form};
            field.at_sources = &at_sources;
            field.tensor = setup_view(&tensors);
            field.contraction = setup_view(&alone);
            const sphg_request request = {
                .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
            SETUP_OK(on.context, sphg_evaluate(on.context, &scheme, &request));
            field.contraction = setup_view(&found);
            field.gradient = setup_view(&jacobian);
            SETUP_OK(on.context, sphg_evaluate(on.context, &scheme, &request));
            TEST_REQUIRE(setup_same_bits(&alone, &found), "alone, form %d", form);
            for (int i = 0; i < n; ++i) {
                double sum_of = 0, size = 0;
                for (int k = 0; k < d * d; ++k) {
                    const double term = setup_get(&jacobian, i, k) * setup_get(&tensors, i, k);
                    sum_of += term;
                    size += fabs(term);
                }
                TEST_WITHIN(contraction_sum,
                            fabs(setup_get(&found, i, 0) - sum_of) / size /
                                test_unit_roundoff(test),
                            test_text("particle %d, form %d", i, form));
            }
        }
}

/* ---- Refused --------------------------------------------------------------------------------- */

static void requires_words(const comparison *on, const sphg_field *field, sphg_result code,
                           const char *words)
{
    const sphg_sources sources = comparison_sources(on);
    const sphg_request request = {
        .sources = &sources, .fields = field, .set_count = 1, .field_count = 1};
    const sphg_result result = sphg_evaluate(on->context, &on->scheme, &request);
    TEST_REQUIRE(result == code && strstr(sphg_last_message(on->context), words),
                 "%d: %s, not \"%s\"", result, sphg_last_message(on->context), words);
}

static void what_has_no_meaning_is_refused(const test_case *test)
{
    comparison on = block_of(test);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, d = test->dimension;
    const setup_array values =
                          setup_numbers(type, n, d, comparison_random_field(&on, SPHG_VECTOR, 15)),
                      out = setup_output(type, n, d), number = setup_output(type, n, 1),
                      tensors = setup_numbers(type, n, d * d,
                                              comparison_random_field(&on, SPHG_TENSOR, 16));
    const sphg_view at_sources = setup_view(&values), absent = sphg_absent();
    sphg_field field = {.shape = SPHG_VECTOR, .at_sources = &at_sources};
    field.value = setup_view(&out);
    field.form = SPHG_ADJOINT;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "outside the difference and direct forms");
    field.form = SPHG_DIFFERENCE;
    field.shepard = 1;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "shepard outside the direct form");
    field.form = SPHG_DIRECT;
    on.scheme.method = SPHG_CMLS;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "weights sum to 1");
    field.shepard = 0;
    field.value_volume = &at_sources;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "value_volume");
    on.scheme.method = SPHG_KGC;
    field.value_volume = &absent;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "value_volume[0] is absent");
    field.value = absent;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "value is absent");
    field.value_volume = NULL;
    field.tensor = setup_view(&tensors);
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "contraction is absent");
    field.tensor = absent;
    field.contraction = setup_view(&number);
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "tensor is absent");
    field.tensor = setup_view(&tensors);
    field.shape = SPHG_SYM_TENSOR;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "contraction of what is no vector");
    field = (sphg_field){.shape = SPHG_VECTOR, .at_sources = &absent, .at_targets = at_sources};
    field.value = setup_view(&out);
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "at_sources[0] is absent");
}

static const test_entry entries[] = {
    TEST_ENTRY(results_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_MLS), 0),
    TEST_ENTRY(radii_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(shepard_keeps_constants, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC), TEST_ALL_KERNELS),
    TEST_ENTRY(tiny_weights_have_a_mean, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC), TEST_ALL_KERNELS),
    TEST_ENTRY(nobody_gives_nothing, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_RKPM), 0),
    TEST_ENTRY(fields_with_volumes_of_their_own_stand_beside_others, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(every_path_gives_the_same, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(classic_differences_are_values_less_ones_own, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, 0),
    TEST_ENTRY(order_2_has_the_same_values, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(contractions_are_those_of_the_jacobian, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(what_has_no_meaning_is_refused, TEST_BIT(TEST_F64), TEST_2D, 0, 0),
};
TEST_MAIN(entries)
