/* SPDX-License-Identifier: MIT */
/* The Laplacian of the adjoint form: against the oracle, symmetric, never uphill, conservative, the
 * same by every path; PLAIN is Brookshaw's; solutions of heat problems have the errors they should.
 */
#include "support/oracle_diffusion.h"
#include "support/scenes.h"
#include <math.h>
#include <string.h>

#define METHODS (TEST_LINEARISED | TEST_BIT(SPHG_PLAIN))

/* ---- Asking ---------------------------------------------------------------------------------- */

typedef struct flow {
    sphg_shape shape;
    const double *numbers, *coefficient; /* NULL: 1 */
} flow;

static sphg_result ask(const comparison *on, const flow *of, const setup_array *table,
                       const sphg_subset *subset, setup_array *result)
{
    const sphg_type type = test_field_type(on->test);
    const int width = setup_width(of->shape, on->points.dimension), n = on->points.count;
    const setup_array numbers = setup_numbers(type, n, width, of->numbers);
    const sphg_view at_sources = setup_view(&numbers);
    setup_array k = {.width = 0};
    if (of->coefficient)
        k = setup_numbers(type, n, 1, of->coefficient);
    const sphg_view coefficient = of->coefficient ? setup_view(&k) : sphg_absent();
    *result = setup_output(type, n, width);
    sphg_sources sources = comparison_sources(on);
    sources.correction = comparison_table_view(on, table);
    sphg_field field = {.shape = of->shape, .form = SPHG_ADJOINT, .at_sources = &at_sources};
    field.coefficient = of->coefficient ? &coefficient : NULL;
    field.laplacian = setup_view(result);
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1, .subset = subset};
    return sphg_evaluate(on->context, &on->scheme, &request);
}

static setup_array diffuse(const comparison *on, const flow *of, const setup_array *table)
{
    setup_array result;
    SETUP_OK(on->context, ask(on, of, table, NULL, &result));
    return result;
}

static double *coefficients(const comparison *on, uint64_t seed)
{
    random_state random = random_seeded(seed);
    double *k = cloud_numbers(&on->points, .01, 10, &random);
    for (int i = 0; i < on->points.count; i += 7)
        k[i] = 0;
    return k;
}

static comparison blocat(const test_case *test, double jitter)
{
    random_state random = random_seeded(41);
    const int d = test->dimension;
    return comparison_of(test, "block", cloud_jittered(d, d == 2 ? 9 : 5, .125, jitter, &random),
                         .27);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void compare(const comparison *on, const flow *of, int targets)
{
    const setup_array table = comparison_table(on), found = diffuse(on, of, &table);
    const oracle_field field = {of->shape, SPHG_ADJOINT, of->numbers, NULL};
    const int step = test_reference_stride() * (1 + on->points.count / targets);
    for (int i = 0; i < on->points.count; i += step) {
        const oracle_flow exact = oracle_diffuse(on->reference, &field, of->coefficient, i);
        const double ratio = comparison_ratio(&found, i, exact.sum, exact.bound);
        const char *where =
            test_text("particle %d, %s, %s", i, on->name, test_method_name(on->test->method));
        if (!exact.undecided && exact.touched)
            TEST_WITHIN(diffusion_ratio_touched, ratio, where);
        else if (!exact.undecided)
            TEST_WITHIN(diffusion_ratio_full, ratio, where);
        TEST_REQUIRE(exact.least > -1e-20, "uphill by %g, %s", (double)exact.least, where);
    }
}

static void results_match_the_oracle(const test_case *test)
{
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = comparison_of_scene(test, &scenes_hard[s]);
        const sphg_shape shape = s % 4 == 3 ? SPHG_TENSOR : (sphg_shape)(1 + s % 3);
        flow of = {shape, comparison_random_field(&on, shape, 3), NULL};
        compare(&on, &of, 4);
        of.coefficient = coefficients(&on, 5);
        compare(&on, &of, 4);
    }
}

static comparison graded_stage(const test_case *test, double ratio, int mutual)
{
    random_state random = random_seeded(5);
    const int d = test->dimension, per_axis = d == 2 ? 9 : 5;
    cloud points = cloud_jittered(d, per_axis, .125, .2, &random);
    double *radii = test_memory((size_t)points.count * sizeof *radii);
    for (int i = 0; i < points.count; ++i) {
        double *x = points.x + i * d;
        const double wide = exp(log(ratio) * x[0] / (.125 * (per_axis - 1)));
        radii[i] = 2.5 * points.spacing * wide;
        for (int a = 0; a < d; ++a)
            x[a] = (x[a] + .5) * wide;
    }
    return comparison_of_radii(test, "graded block", points, radii, mutual);
}

static void radii_match_the_oracle(const test_case *test)
{
    static const double ratios[] = {1.5, 8, 64};
    for (int k = 0; k < 3; ++k) {
        const comparison on = graded_stage(test, ratios[k], 1);
        flow of = {SPHG_VECTOR, comparison_random_field(&on, SPHG_VECTOR, 3), NULL};
        compare(&on, &of, 5);
        of.coefficient = coefficients(&on, 6);
        compare(&on, &of, 5);
    }
}

static void kernels_and_policies_match_the_oracle(const test_case *test)
{
    for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
        const comparison made = comparison_of_scene(test, &scenes_hard[5]);
        const comparison on = comparison_under(&made, (sphg_policy)policy, .0625);
        const flow of = {SPHG_SCALAR, comparison_random_field(&on, SPHG_SCALAR, 3), NULL};
        compare(&on, &of, 6);
    }
}

/* ---- PLAIN ----------------------------------------------------------------------------------- */

/* Brookshaw's sum as a host writes it: 2 V_i V_j k_ij (A_j - A_i) (-W'/r). */
static void plain_is_brookshaw(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const int d = test->dimension, n = on.points.count;
    const flow of = {SPHG_SCALAR, comparison_random_field(&on, SPHG_SCALAR, 8),
                     coefficients(&on, 9)};
    const setup_array found = diffuse(&on, &of, NULL);
    for (int i = 0; i < n; ++i) {
        double sum = 0, size = 0;
        for (int j = 0; j < n; ++j) {
            double square = 0, slope;
            for (int a = 0; a < d; ++a)
                square += pow(on.points.x[i * d + a] - on.points.x[j * d + a], 2);
            sphg_kernel_value(&on.scheme, sqrt(square), NULL, &slope);
            const double a = of.coefficient[i], b = of.coefficient[j];
            const double mean = a + b > 0 ? 2 * a * b / (a + b) : 0;
            const double term = j == i ? 0
                                       : -2 * on.scene.volume[i] * on.scene.volume[j] * slope *
                                             mean * (of.numbers[j] - of.numbers[i]);
            sum += term;
            size += fabs(term);
        }
        if (size > 0)
            TEST_WITHIN(brookshaw,
                        fabs(setup_get(&found, i, 0) - sum) / size / test_unit_roundoff(test),
                        test_text("particle %d", i));
    }
}

/* ---- Properties ------------------------------------------------------------------------------ */

/* Row i of L by the answer to a field that is 1 at one particle. */
static void pairs_are_symmetric_and_never_uphill(const test_case *test)
{
    for (int s = 0; s < 3; ++s) {
        const comparison on = s == 0   ? comparison_of_scene(test, &scenes_hard[5])
                              : s == 1 ? blocat(test, .4)
                                       : graded_stage(test, 8, 1);
        const setup_array table = comparison_table(&on);
        const int n = on.points.count < 60 ? on.points.count : 60;
        double *unit = test_memory((size_t)on.points.count * sizeof *unit);
        double *matrix = test_memory((size_t)n * (size_t)n * sizeof *matrix);
        const double *k = coefficients(&on, 12);
        for (int j = 0; j < n; ++j) {
            unit[j] = 1;
            const flow of = {SPHG_SCALAR, unit, k};
            const setup_array found = diffuse(&on, &of, &table);
            unit[j] = 0;
            for (int i = 0; i < n; ++i)
                matrix[i * n + j] = setup_get(&found, i, 0);
        }
        int pairs = 0;
        double largest = 0;
        for (int at = 0; at < n * n; ++at)
            if (at % n != at / n)
                largest = test_larger(largest, matrix[at]);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < i; ++j) {
                const double a = matrix[i * n + j], b = matrix[j * n + i];
                TEST_REQUIRE(a >= 0 && b >= 0, "from %d to %d flows %g, back %g, %s", j, i, a, b,
                             on.name);
                pairs += a > 0;
                /* One kernel for both ends has the same digits near its rim; two have not. */
                if (a > 0 || b > 0)
                    TEST_WITHIN(diffusion_symmetry,
                                fabs(a - b) / (s == 2 ? largest : fmax(a, b)) /
                                    test_unit_roundoff(test),
                                test_text("pair %d, %d, %s", i, j, on.name));
            }
        TEST_REQUIRE(pairs > n, "only %d pairs, %s", pairs, on.name);
    }
}

static void nothing_is_lost_and_constants_stay(const test_case *test)
{
    for (int s = 0; s < 3; ++s) {
        const comparison on = s == 2 ? graded_stage(test, 8, 1) : blocat(test, s ? .4 : 0);
        const setup_array table = comparison_table(&on);
        const int n = on.points.count;
        const double *k = coefficients(&on, 14), *a = comparison_random_field(&on, SPHG_SCALAR, 15),
                     *b = comparison_random_field(&on, SPHG_SCALAR, 16);
        const flow of_a = {SPHG_SCALAR, a, k}, of_b = {SPHG_SCALAR, b, k};
        const setup_array fa = diffuse(&on, &of_a, &table), fb = diffuse(&on, &of_b, &table);
        double sum = 0, size = 0, both = 0, loss = 0;
        for (int i = 0; i < n; ++i) {
            const double one = setup_get(&fa, i, 0), other = setup_get(&fb, i, 0);
            sum += one;
            size += fabs(one);
            both += b[i] * one - a[i] * other;
            loss += a[i] * one;
        }
        TEST_WITHIN(diffusion_sum, fabs(sum) / size / test_unit_roundoff(test), on.name);
        TEST_WITHIN(diffusion_sum, fabs(both) / size / test_unit_roundoff(test), on.name);
        TEST_REQUIRE(loss < 0, "differences grow, %s", on.name);
        double *same = test_memory((size_t)n * sizeof *same);
        for (int i = 0; i < n; ++i)
            same[i] = (double)(float).3;
        const flow of_same = {SPHG_SCALAR, same, k};
        const setup_array still = diffuse(&on, &of_same, &table);
        for (int i = 0; i < n; ++i)
            assert_true(setup_get(&still, i, 0) == 0);
    }
}

/* In the middle of a full lattice V div(k grad A) of A = |x|^2 / 2 is k V d. */
static void it_is_a_laplacian_inside(const test_case *test)
{
    const int d = test->dimension;
    comparison on = comparison_of(test, "lattice", cloud_lattice(d, 9, .125), .25 * 1.0001);
    double *volume = test_memory((size_t)on.points.count * sizeof *volume);
    double *numbers = test_memory((size_t)on.points.count * sizeof *numbers);
    for (int i = 0; i < on.points.count; ++i) {
        volume[i] = pow(.125, d);
        for (int a = 0; a < d; ++a)
            numbers[i] += pow(on.points.x[i * d + a] - .5, 2) / 2;
        numbers[i] = cloud_rounded(numbers[i]);
    }
    on = comparison_with_volumes(&on, volume);
    const setup_array table = comparison_table(&on);
    const double k = 3;
    double *same = test_memory((size_t)on.points.count * sizeof *same);
    for (int i = 0; i < on.points.count; ++i)
        same[i] = k;
    const flow of = {SPHG_SCALAR, numbers, same};
    const setup_array found = diffuse(&on, &of, &table);
    const double value = setup_get(&found, cloud_middle(&on.points), 0) / volume[0];
    TEST_REQUIRE(fabs(value / (k * d) - 1) < (test->method == SPHG_PLAIN ? .05 : 1e-4),
                 "div(k grad) is %g, not %g", value, k * d);
}

/* ---- Paths ----------------------------------------------------------------------------------- */

static void same_bits(const comparison *one, const comparison *other, const char *where)
{
    const flow of = {SPHG_VECTOR, comparison_random_field(one, SPHG_VECTOR, 21),
                     coefficients(one, 22)};
    const setup_array table = comparison_table(one), second = comparison_table(other);
    const setup_array a = diffuse(one, &of, &table), b = diffuse(other, &of, &second);
    TEST_REQUIRE(setup_same_bits(&a, &b), "%s", where);
}

static void every_path_gives_the_same_bits(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const setup_array x = setup_positions(test, (cloud *)&on.points);
    for (int way = 0; way < 2; ++way) {
        comparison other = on;
        sphg_geometry geometry = setup_geometry(test, &on.points, &x);
        geometry.list_free = way == 0;
        geometry.keep_weights = way == 1;
        other.neighbors = setup_search(on.context, &on.scheme, &geometry);
        for (int again = 0; again < 2; ++again)
            same_bits(&on, &other, way ? "kept weights" : "list-free");
    }
    comparison alone = on;
    alone.context = setup_context_of(1);
    alone.neighbors = setup_neighbors(alone.context, test, &alone.scheme, &alone.points);
    same_bits(&on, &alone, "one thread");
    const flow of = {SPHG_SCALAR, comparison_random_field(&on, SPHG_SCALAR, 23), NULL};
    const setup_array table = comparison_table(&on), whole = diffuse(&on, &of, &table);
    uint8_t *mask = test_memory((size_t)on.points.count);
    for (int i = 0; i < on.points.count; ++i)
        mask[i] = i % 5 == 1 || i % 31 > 20;
    const sphg_subset subset = sphg_masked(mask, on.points.count);
    setup_array some;
    SETUP_OK(on.context, ask(&on, &of, &table, &subset, &some));
    for (int i = 0; i < on.points.count; ++i)
        TEST_REQUIRE(mask[i] ? setup_get(&some, i, 0) == setup_get(&whole, i, 0)
                             : setup_is_canary(&some, i),
                     "target %d of a mask", i);
}

static void lists_of_the_host_give_the_same(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const int n = on.points.count;
    const setup_array x = setup_positions(test, (cloud *)&on.points);
    const sphg_geometry geometry = setup_geometry(test, &on.points, &x);
    int64_t *offsets = test_memory(((size_t)n + 1) * sizeof *offsets);
    int32_t *indices = test_memory((size_t)n * (size_t)n * sizeof *indices);
    for (int i = 0; i < n; ++i) { /* every particle, so most are too far */
        offsets[i + 1] = offsets[i] + n;
        for (int j = 0; j < n; ++j)
            indices[offsets[i] + j] = j;
    }
    const flow of = {SPHG_SYM_TENSOR, comparison_random_field(&on, SPHG_SYM_TENSOR, 24),
                     coefficients(&on, 25)};
    const setup_array table = comparison_table(&on), found = diffuse(&on, &of, &table);
    setup_array listed[2];
    for (int copy = 0; copy < 2; ++copy) {
        comparison other = on;
        const sphg_lists lists = {.offsets = offsets, .indices = indices, .copy = copy};
        other.neighbors = setup_lists(on.context, &on.scheme, &geometry, &lists);
        listed[copy] = diffuse(&other, &of, &table);
        setup_require_close(&found, &listed[copy], copy ? "copied lists" : "lists");
    }
    TEST_REQUIRE(setup_same_bits(&listed[0], &listed[1]), "copied lists");
}

static void every_instruction_set_gives_the_same(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const flow of = {SPHG_TENSOR, comparison_random_field(&on, SPHG_TENSOR, 26),
                     coefficients(&on, 27)};
    const setup_array table = comparison_table(&on), found = diffuse(&on, &of, &table);
    for (int isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        comparison other = on;
        other.context = setup_context_on((sphg_isa)isa);
        if (!other.context)
            continue;
        other.neighbors = setup_neighbors(other.context, test, &other.scheme, &other.points);
        const setup_array here = diffuse(&other, &of, &table);
        setup_require_close(&found, &here, "another instruction set");
    }
}

/* Two sets and targets apart, whose C_i are computed in the same call, or in one before. */
static void sets_add_up(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, half = n / 3, d = test->dimension;
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 28),
                 *k = coefficients(&on, 29);
    const flow of = {SPHG_VECTOR, numbers, k};
    const setup_array table = comparison_table(&on), whole = diffuse(&on, &of, &table);
    const setup_array x = setup_positions(test, (cloud *)&on.points);
    const setup_array values = setup_numbers(type, n, d, numbers),
                      ks = setup_numbers(type, n, 1, k);
    sphg_sources sources[2] = {{0}};
    sphg_view at_sources[2], coefficient[2];
    for (int s = 0; s < 2; ++s) {
        const ptrdiff_t first = s ? half : 0;
        sphg_view place = setup_view(&x), all = setup_view(&x);
        sphg_view *const moved[] = {&place, &sources[s].volume, &sources[s].correction,
                                    &at_sources[s], &coefficient[s]};
        sources[s].volume = setup_view(&on.volume);
        sources[s].correction = comparison_table_view(&on, &table);
        at_sources[s] = setup_view(&values);
        coefficient[s] = setup_view(&ks);
        for (int v = 0; v < 5; ++v)
            if (moved[v]->x)
                moved[v]->x = (const char *)moved[v]->x + first * moved[v]->stride;
        sphg_geometry geometry = sphg_targets_apart(all, n, place, s ? n - half : half);
        geometry.precision = type;
        sources[s].neighbors = setup_search(on.context, &on.scheme, &geometry);
    }
    for (int given = 0; given < 2; ++given) {
        const setup_array found = setup_output(type, n, d);
        sphg_field field = {.shape = SPHG_VECTOR,
                            .form = SPHG_ADJOINT,
                            .at_sources = at_sources,
                            .at_targets = setup_view(&values),
                            .laplacian = setup_view(&found),
                            .coefficient = coefficient,
                            .coefficient_at_targets = setup_view(&ks)};
        sphg_request request = {.sources = sources,
                                .fields = &field,
                                .set_count = 2,
                                .field_count = 1,
                                .target_volume = setup_view(&on.volume)};
        if (given)
            request.target_correction = comparison_table_view(&on, &table);
        SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
        setup_require_close(&whole, &found, given ? "two sets" : "two sets, C in the same call");
    }
    /* One set of targets apart, C of the sweep's own first round. */
    const sphg_view place = setup_view(&x);
    sphg_geometry geometry = sphg_targets_apart(place, n, place, n);
    geometry.precision = type;
    sphg_sources one = comparison_sources(&on);
    one.correction = comparison_table_view(&on, &table);
    one.neighbors = setup_search(on.context, &on.scheme, &geometry);
    const setup_array found = setup_output(type, n, d);
    const sphg_view all_values = setup_view(&values), all_ks = setup_view(&ks);
    const sphg_field field = {.shape = SPHG_VECTOR,
                              .form = SPHG_ADJOINT,
                              .at_sources = &all_values,
                              .at_targets = all_values,
                              .laplacian = setup_view(&found),
                              .coefficient = &all_ks,
                              .coefficient_at_targets = all_ks};
    const sphg_request request = {.sources = &one,
                                  .fields = &field,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .target_volume = setup_view(&on.volume)};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    setup_require_close(&whole, &found, "targets apart");
}

/* Beside a force, and added to what is there. */
static void it_stands_beside_other_results(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count, d = test->dimension;
    const setup_array table = comparison_table(&on);
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 31);
    const flow of = {SPHG_VECTOR, numbers, NULL};
    const comparison_field alone = {SPHG_VECTOR, SPHG_ADJOINT, numbers};
    const setup_array flows = diffuse(&on, &of, &table);
    const comparison_result forces = comparison_apply(&on, &alone, &table);
    const setup_array values = setup_numbers(type, n, d, numbers);
    const sphg_view at_sources = setup_view(&values);
    const setup_array both = setup_output(type, n, d), divergence = setup_output(type, n, 1);
    sphg_sources sources = comparison_sources(&on);
    sources.correction = comparison_table_view(&on, &table);
    sphg_field field = {.shape = SPHG_VECTOR, .form = SPHG_ADJOINT, .at_sources = &at_sources};
    field.laplacian = setup_view(&both);
    field.divergence = setup_view(&divergence);
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    TEST_REQUIRE(setup_same_bits(&both, &flows), "flows beside a divergence");
    setup_require_close(&divergence, &forces.divergence, "divergence beside flows");
    field.accumulate = 1;
    field.divergence = sphg_absent();
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    for (int i = 0; i < n * d; ++i)
        assert_true(setup_get(&both, i / d, i % d) == 2 * setup_get(&flows, i / d, i % d));
}

/* ---- Degenerate ------------------------------------------------------------------------------ */

static void coincident_particles_exchange(const test_case *test)
{
    const int d = test->dimension;
    const comparison on = comparison_of(test, "coincident", cloud_coincident(d, 2, 1, .125), .5);
    const double numbers[3] = {1, 0, 0};
    const flow of = {SPHG_SCALAR, numbers, NULL};
    const setup_array table = comparison_table(&on), found = diffuse(&on, &of, &table);
    TEST_REQUIRE(on.points.count == 3, "%d particles", on.points.count);
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += setup_get(&found, i, 0);
    TEST_REQUIRE(setup_get(&found, 1, 0) > 0 && fabs(sum) < 1e-5 * fabs(setup_get(&found, 0, 0)),
                 "flows %g %g %g", setup_get(&found, 0, 0), setup_get(&found, 1, 0),
                 setup_get(&found, 2, 0));
    const comparison one = comparison_of(test, "one", cloud_single(d), .5);
    const setup_array nothing = comparison_table(&one), still = diffuse(&one, &of, &nothing);
    assert_true(setup_get(&still, 0, 0) == 0);
}

static void what_is_no_number_spoils_its_neighbours_alone(const test_case *test)
{
    const comparison on = blocat(test, .2);
    const int n = on.points.count, d = test->dimension, bad = cloud_middle(&on.points);
    double *numbers = comparison_random_field(&on, SPHG_SCALAR, 33), *k = coefficients(&on, 34);
    const setup_array table = comparison_table(&on);
    for (int which = 0; which < 2; ++which) {
        double *spoiled = which ? k : numbers;
        const double before = spoiled[bad];
        spoiled[bad] = NAN;
        const flow of = {SPHG_SCALAR, numbers, k};
        const setup_array found = diffuse(&on, &of, &table);
        spoiled[bad] = before;
        for (int i = 0; i < n; ++i) {
            double square = 0;
            for (int a = 0; a < d; ++a)
                square += pow(on.points.x[i * d + a] - on.points.x[bad * d + a], 2);
            const int near = sqrt(square) < on.scheme.support_radius * (1 - 1e-6);
            const double value = setup_get(&found, i, 0);
            TEST_REQUIRE(near == isnan(value), "particle %d: %g", i, value);
        }
    }
}

/* Lengths times 2^5, with volumes to match: flows times 2^(5 (d - 2)), to the bit. */
static void scaling_by_a_power_of_two_changes_no_digit(const test_case *test)
{
    const comparison on = blocat(test, .3);
    cloud points = cloud_copy(&on.points);
    const int d = test->dimension, n = points.count;
    double *volume = test_memory((size_t)n * sizeof *volume);
    for (int k = 0; k < n * d; ++k)
        points.x[k] *= 32;
    for (int i = 0; i < n; ++i)
        volume[i] = on.scene.volume[i] * pow(32, d);
    comparison made = comparison_of(test, "larger", points, on.scheme.support_radius * 32);
    made = comparison_with_volumes(&made, volume);
    const flow of = {SPHG_SCALAR, comparison_random_field(&on, SPHG_SCALAR, 35),
                     coefficients(&on, 36)};
    const setup_array table = comparison_table(&on), larger = comparison_table(&made);
    const setup_array a = diffuse(&on, &of, &table), b = diffuse(&made, &of, &larger);
    for (int i = 0; i < n; ++i)
        TEST_REQUIRE(setup_get(&b, i, 0) == setup_get(&a, i, 0) * pow(32, d - 2),
                     "particle %d: %g and %g", i, setup_get(&a, i, 0), setup_get(&b, i, 0));
}

/* Turned by 3-4-5 in the first two axes, which is exact where coordinates are multiples of 5 / 2^k,
 * and under other names: other roundings, the same flows. */
static void turning_and_renaming_change_nothing(const test_case *test)
{
    const int d = test->dimension;
    random_state random = random_seeded(43);
    cloud points = cloud_jittered(d, d == 2 ? 9 : 5, 1, .3, &random);
    const int n = points.count;
    int *from = test_memory((size_t)n * sizeof *from);
    cloud_snap(&points, 0x1p-8);
    for (int k = 0; k < n * d; ++k)
        points.x[k] *= 5;
    const comparison on = comparison_of(test, "block", points, 11.25);
    cloud turned = cloud_copy(&points);
    for (int i = 0; i < n; ++i) {
        const int k = random_index(&random, i + 1);
        from[i] = from[k];
        from[k] = i;
    }
    double *volume = test_memory((size_t)n * sizeof *volume),
           *b = test_memory((size_t)n * sizeof *b), *kb = test_memory((size_t)n * sizeof *kb);
    const double *a = comparison_random_field(&on, SPHG_SCALAR, 44), *ka = coefficients(&on, 45);
    for (int i = 0; i < n; ++i) {
        const double *x = points.x + from[i] * d;
        turned.x[i * d] = (3 * x[0] - 4 * x[1]) / 5;
        turned.x[i * d + 1] = (4 * x[0] + 3 * x[1]) / 5;
        if (d == 3)
            turned.x[i * d + 2] = x[2];
        volume[i] = on.scene.volume[from[i]];
        b[i] = a[from[i]];
        kb[i] = ka[from[i]];
    }
    comparison other = comparison_of(test, "turned", turned, 11.25);
    other = comparison_with_volumes(&other, volume);
    const flow of_a = {SPHG_SCALAR, a, ka}, of_b = {SPHG_SCALAR, b, kb};
    const oracle_field field = {SPHG_SCALAR, SPHG_ADJOINT, a, NULL};
    const setup_array table = comparison_table(&on), second = comparison_table(&other);
    const setup_array found = diffuse(&on, &of_a, &table), there = diffuse(&other, &of_b, &second);
    for (int i = 0; i < n; i += 9 * test_reference_stride()) {
        const quad moved = setup_get(&there, i, 0);
        const oracle_flow exact = oracle_diffuse(on.reference, &field, ka, from[i]);
        if (!exact.undecided)
            TEST_WITHIN(equal_within_bound, comparison_ratio(&found, from[i], &moved, exact.bound),
                        test_text("particle %d, %s", i, test_method_name(test->method)));
    }
}

/* Of walls that carry the values of whoever looks at them nothing flows, whatever they conduct. */
static void mirrored_sets_exchange_nothing(const test_case *test)
{
    const comparison on = blocat(test, .3);
    const sphg_type type = test_field_type(test);
    const int n = on.points.count;
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 37),
                 *k = coefficients(&on, 38);
    const flow of = {SPHG_SCALAR, numbers, k};
    const setup_array table = comparison_table(&on), alone = diffuse(&on, &of, &table);
    const setup_array x = setup_positions(test, (cloud *)&on.points);
    const setup_array values = setup_numbers(type, n, 1, numbers),
                      ks = setup_numbers(type, n, 1, k), found = setup_output(type, n, 1);
    sphg_geometry wall =
        sphg_targets_apart(setup_view(&x), n, setup_view(&x), n); /* a wall in the fluid */
    wall.precision = type;
    sphg_sources sources[2] = {comparison_sources(&on), comparison_sources(&on)};
    sources[0].correction = sources[1].correction = comparison_table_view(&on, &table);
    sources[1].neighbors = setup_search(on.context, &on.scheme, &wall);
    const sphg_view at_sources[2] = {setup_view(&values), sphg_absent()},
                    coefficient[2] = {setup_view(&ks), sphg_absent()};
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_ADJOINT,
                              .at_sources = at_sources,
                              .mirror = 1,
                              .laplacian = setup_view(&found),
                              .coefficient = coefficient};
    const sphg_request request = {
        .sources = sources, .fields = &field, .set_count = 2, .field_count = 1};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    setup_require_close(&alone, &found, "beside a mirrored set");
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
    comparison on = blocat(test, 0);
    const sphg_type type = test_field_type(test);
    const setup_array values =
        setup_numbers(type, on.points.count, 1, comparison_random_field(&on, SPHG_SCALAR, 39));
    const setup_array out = setup_output(type, on.points.count, 1);
    const sphg_view at_sources = setup_view(&values), absent = sphg_absent();
    sphg_field field = {.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &at_sources};
    field.laplacian = setup_view(&out);
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "sources[0].correction is absent");
    on.scheme.order = 2;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "has order 1");
    on.scheme.order = 0;
    on.scheme.method = SPHG_CRKPM;
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "not for classic methods");
    on.scheme.method = SPHG_PLAIN;
    field.at_sources = &absent;
    field.at_targets = at_sources;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "fields[0].at_sources[0] is absent");
    field.at_sources = &at_sources;
    field.coefficient = &absent;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "fields[0].coefficient[0] is absent");
    field.mirror = 1; /* of the targets' own set, which then still has their coefficients */
    field.at_sources = &absent;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "fields[0].coefficient[0] is absent");
    field.mirror = 0;
    field.at_sources = &at_sources;
    field.coefficient = NULL;
    field.coefficient_at_targets = at_sources;
    requires_words(&on, &field, SPHG_ERROR_ARGUMENT, "coefficient is NULL");
    field.coefficient = &at_sources;
    field.coefficient_at_targets = absent;
    for (int form = SPHG_DIFFERENCE; form <= SPHG_SYMMETRIC; ++form) {
        field.form = (sphg_form)form;
        field.laplacian = absent;
        requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "is for the laplacian of the adjoint");
        field.coefficient = NULL;
        field.laplacian = setup_view(&out);
        requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "laplacian");
        field.coefficient = &at_sources;
    }
}

static void radii_must_be_mutual(const test_case *test)
{
    const comparison on = graded_stage(test, 8, 0);
    const setup_array values = setup_numbers(test_field_type(test), on.points.count, 1,
                                             comparison_random_field(&on, SPHG_SCALAR, 39));
    const setup_array out = setup_output(test_field_type(test), on.points.count, 1);
    const sphg_view at_sources = setup_view(&values);
    sphg_field field = {.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &at_sources};
    field.laplacian = setup_view(&out);
    requires_words(&on, &field, SPHG_ERROR_UNSUPPORTED, "not mutual");
}

static const test_entry entries[] = {
    TEST_ENTRY(results_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(radii_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(kernels_and_policies_match_the_oracle, TEST_SINGLE_AND_DOUBLE, TEST_2D,
               TEST_BIT(SPHG_RKPM), TEST_ALL_KERNELS),
    TEST_ENTRY(plain_is_brookshaw, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_BIT(SPHG_PLAIN),
               TEST_ALL_KERNELS),
    TEST_ENTRY(pairs_are_symmetric_and_never_uphill, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(nothing_is_lost_and_constants_stay, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(it_is_a_laplacian_inside, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(every_path_gives_the_same_bits, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS,
               0),
    TEST_ENTRY(lists_of_the_host_give_the_same, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS,
               0),
    TEST_ENTRY(every_instruction_set_gives_the_same, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(sets_add_up, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(it_stands_beside_other_results, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(coincident_particles_exchange, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, METHODS,
               0),
    TEST_ENTRY(what_is_no_number_spoils_its_neighbours_alone, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(scaling_by_a_power_of_two_changes_no_digit, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, METHODS, 0),
    TEST_ENTRY(turning_and_renaming_change_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(mirrored_sets_exchange_nothing, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               METHODS, 0),
    TEST_ENTRY(what_has_no_meaning_is_refused, TEST_BIT(TEST_F64), TEST_2D, 0, 0),
    TEST_ENTRY(radii_must_be_mutual, TEST_BIT(TEST_F64), TEST_2D, 0, 0),
};
TEST_MAIN(entries)
