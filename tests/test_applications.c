/* SPDX-License-Identifier: MIT */
/* Parts of the examples' solver, each by the property that its scenes rely on. */
#include "support/test.h"
#include "../examples/scenes/solver/conjugate_gradient.h"
#include "../examples/scenes/solver/metrics.h"
#include "../examples/scenes/solver/pressure.h"
#include "../examples/scenes/solver/rotation.h"
#include "../examples/scenes/solver/sampling.h"
#include <math.h>
#include <stdlib.h>

static const double unit_roundoff = 0x1p-53;

static void close_context(void *object)
{
    sph_close(object);
}

static struct sph *open_context(double support_radius, sphg_method method)
{
    struct sph *sph = test_memory(sizeof *sph);
    *sph = sph_open(1, 3, support_radius, method);
    test_at_end(close_context, sph);
    return sph;
}

/* ---- Pressure ----------------------------------------------------------------------------- */

/* A lattice that is too dense by a third, of two fluids in random order. */
static struct particles compressed_block(struct random *random)
{
    static const int32_t sides[3] = {7, 6, 5};
    struct particles block = particles_block(sides, 0.9, 0.05, 1000, random);
    block.rest_volume = 1;
    for (int32_t i = 0; i < block.count; ++i)
        particles_set_rest_density(&block, i, random_between(random, 0, 1) < 0.5 ? 1000 : 300);
    return block;
}

static void pressure_between_phases_keeps_momentum(const test_case *test)
{
    (void)test;
    struct random random = {3};
    struct sph *sph = open_context(2, SPHG_PLAIN);
    struct particles block = compressed_block(&random);
    struct pressure pressure = pressure_new(sph, NULL, block.count);
    vector momentum;
    double sum = 0;
    pressure_prepare(&pressure, &block);
    pressure_keep_density(&pressure, &block, 1e-3);
    particles_momentum(&block, momentum);
    for (int32_t i = 0; i < block.count; ++i)
        sum += block.mass[i] * sqrt(dot(block.v[i], block.v[i]));
    assert_true(sum > 0);
    TEST_WITHIN(linear_momentum, sqrt(dot(momentum, momentum)) / sum / unit_roundoff,
                "two fluids pushing each other");
    pressure_free(&pressure);
    particles_free(&block);
}

static void pressure_takes_compression_away(const test_case *test)
{
    (void)test;
    struct random random = {4};
    struct sph *sph = open_context(2, SPHG_PLAIN);
    struct particles block = compressed_block(&random);
    struct pressure pressure = pressure_new(sph, NULL, block.count);
    double before = 0, after = 0;
    for (int step = 0; step < 20; ++step) {
        pressure_prepare(&pressure, &block);
        after = 0;
        for (int32_t i = 0; i < block.count; ++i)
            after += fmax(0, pressure.compression[i] - 1) / block.count;
        before = step == 0 ? after : before;
        pressure_keep_density(&pressure, &block, 1e-3);
        for (int32_t i = 0; i < block.count; ++i)
            add_scaled(block.x[i], 1e-3, block.v[i]);
    }
    TEST_REQUIRE(before > 0.1 && after < 0.01 * before, "mean compression %g became %g", before,
                 after);
    pressure_free(&pressure);
    particles_free(&block);
}

/* ---- Walls -------------------------------------------------------------------------------- */

static void wall_is_felt_within_its_support_only(const test_case *test)
{
    (void)test;
    const double low[2] = {-3, -3}, high[2] = {3, 3};
    struct random random = {5};
    struct sph *sph = open_context(1, SPHG_KGC);
    struct particles fluid = particles_new(2, 1);
    vector *x;
    const int32_t count = sample_rectangle(&random, low, high, 0.3, &x);
    struct wall wall = wall_new(sph, count, x);
    struct contact contact = contact_new(sph, &wall, fluid.count);
    fluid.x[0][2] = 1.01;
    fluid.x[1][2] = 0.5;
    for (int32_t k = 0; k < count; ++k)
        wall.v[k][0] = 7;
    for (int32_t i = 0; i < fluid.count; ++i)
        particles_set_rest_density(&fluid, i, 1000);
    for (int repetition = 0; repetition < 2; ++repetition) { /* zeroes what an earlier call left */
        contact_update(sph, &contact, &fluid);
        const int far = repetition, near = 1 - repetition;
        assert_int_equal(contact.touching[far], 0);
        assert_true(contact.filling[far] == 0 && contact.drag[far][0] == 0);
        assert_true(dot(contact.slope[far], contact.slope[far]) == 0);
        assert_true(contact.touching[near] > 3 && contact.filling[near] > 0);
        fluid.x[0][2] = 0.5;
        fluid.x[1][2] = 1.01;
    }
    contact_friction(&contact, 1e9, &fluid);
    TEST_WITHIN(full_friction, fabs(fluid.v[0][0] / 7 - 1) / unit_roundoff, "beside the wall");
    assert_true(fluid.v[1][0] == 0);
    contact_free(&contact);
    particles_free(&fluid);
    wall_free(&wall);
}

static void samples_keep_their_distance(const test_case *test)
{
    (void)test;
    const double low[2] = {-1, 2}, high[2] = {1, 3}, distance = 0.1;
    struct random random = {6};
    vector *samples[2];
    const int32_t counts[2] = {sample_rectangle(&random, low, high, distance, &samples[0]),
                               sample_sphere(&random, 0.5, distance, &samples[1])};
    for (int kind = 0; kind < 2; ++kind) {
        const double area = kind ? 3.14159 : 2;
        /* discs of a Poisson-disk sample cover about 0.55 of the area */
        TEST_REQUIRE(counts[kind] > 0.6 * area / (distance * distance), "only %d samples",
                     (int)counts[kind]);
        for (int32_t i = 0; i < counts[kind]; ++i)
            for (int32_t j = 0; j < i; ++j) {
                vector apart = {0};
                add_scaled(apart, 1, samples[kind][i]);
                add_scaled(apart, -1, samples[kind][j]);
                assert_true(dot(apart, apart) >= distance * distance);
            }
        free(samples[kind]);
    }
}

/* ---- Linear algebra ----------------------------------------------------------------------- */

static void nearest_rotation_is_proper_even_of_reflections(const test_case *test)
{
    (void)test;
    enum { COUNT = 200 };
    static tensor matrices[COUNT], found[COUNT];
    struct random random = {7};
    struct sph *sph = open_context(1, SPHG_PLAIN);
    struct rotations rotations = rotations_new(COUNT);
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < 9; ++k)
            matrices[i][k] = random_between(&random, -1, 1);
    rotations_find(sph, &rotations, COUNT, matrices, found);
    for (int i = 0; i < COUNT; ++i) {
        const double *r = found[i];
        vector normal, product = {0};
        double worst = 0;
        cross(r + 3, r + 6, normal);
        worst = test_larger(worst, fabs(dot(r, normal) - 1)); /* det R = 1 */
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                worst = test_larger(worst, fabs(dot(r + 3 * a, r + 3 * b) - (a == b)));
        for (int a = 0; a < 3; ++a) /* F R^T is symmetric */
            product[a] = dot(matrices[i] + 3 * a, r + 3 * ((a + 1) % 3)) -
                         dot(matrices[i] + 3 * ((a + 1) % 3), r + 3 * a);
        worst = test_larger(worst, sqrt(dot(product, product)));
        TEST_WITHIN(solver_double, worst / unit_roundoff, "polar factor");
    }
    rotations_free(&rotations);
}

static void stretch(void *data, double *x, double *result)
{
    const int32_t count = *(const int32_t *)data;
    for (int32_t k = 0; k < count; ++k)
        result[k] = (1 + k % 3) * x[k];
}

static void conjugate_gradients_take_a_step_per_eigenvalue(const test_case *test)
{
    (void)test;
    int32_t count = 30;
    double b[30], x[30] = {0}, work[90];
    struct random random = {8};
    for (int32_t k = 0; k < count; ++k)
        b[k] = random_between(&random, -1, 1);
    const struct conjugate_gradient system = {stretch, &count, count, 1e-13, 50, work};
    assert_int_equal(conjugate_gradient(&system, b, x), 3);
    for (int32_t k = 0; k < count; ++k)
        TEST_WITHIN(exact_iterations, fabs((1 + k % 3) * x[k] - b[k]) / unit_roundoff, "A x - b");
    assert_int_equal(conjugate_gradient(&system, b, x), 0); /* from the solution */
}

/* ---- Gates -------------------------------------------------------------------------------- */

static void brief_runs_are_compared_with_what_they_measured(const test_case *test)
{
    (void)test;
    const struct options brief = {.scene = "test", .brief = true};
    const struct gate gates[] = {
        {"later", EACH_CORRECTED, AT_MOST, 1}, {"start", EACH_CORRECTED, AT_MOST, 1}, {0}};
    struct metrics runs[METHOD_COUNT] = {{0}};
    metrics_set(&runs[KGC], "other", 0);
    assert_false(gates_hold(&brief, gates, runs)); /* nothing to compare */
    metrics_set(&runs[KGC], "start", 1);
    assert_true(gates_hold(&brief, gates, runs));
    metrics_set(&runs[KGC], "later", 2);
    assert_false(gates_hold(&brief, gates, runs));
}

static bool holds(enum relation relation, double sph, double kgc, double bound)
{
    const struct options options = {.scene = "test"};
    const struct gate gates[] = {{"value", EACH_CORRECTED, relation, bound}, {0}};
    struct metrics runs[METHOD_COUNT] = {{0}};
    metrics_set(&runs[SPH], "value", sph);
    metrics_set(&runs[KGC], "value", kgc);
    return gates_hold(&options, gates, runs);
}

static void gates_fail_beyond_their_bound_and_on_nan(const test_case *test)
{
    (void)test;
    assert_true(holds(AT_MOST, 9, 1, 1) && !holds(AT_MOST, 0, 1.1, 1));
    assert_true(holds(AT_LEAST, 0, 1, 1) && !holds(AT_LEAST, 9, 0.9, 1));
    assert_true(holds(SHARE_OF_SPH, 6, 2, 0.5) && !holds(SHARE_OF_SPH, 6, 4, 0.5));
    assert_true(holds(TIMES_SPH, 2, 3, 1.5) && !holds(TIMES_SPH, 2, 2.9, 1.5));
    assert_true(holds(MORE_THAN_SPH, 2, 3, 1) && !holds(MORE_THAN_SPH, 2, 2, 1));
    assert_false(holds(AT_MOST, 0, NAN, 1) || holds(AT_LEAST, 0, NAN, 1));
    assert_false(holds(TIMES_SPH, NAN, 3, 1) || holds(SHARE_OF_SPH, NAN, 3, 1));
}

static const test_entry entries[] = {
    TEST_ONCE(pressure_between_phases_keeps_momentum),
    TEST_ONCE(pressure_takes_compression_away),
    TEST_ONCE(wall_is_felt_within_its_support_only),
    TEST_ONCE(samples_keep_their_distance),
    TEST_ONCE(nearest_rotation_is_proper_even_of_reflections),
    TEST_ONCE(conjugate_gradients_take_a_step_per_eigenvalue),
    TEST_ONCE(gates_fail_beyond_their_bound_and_on_nan),
    TEST_ONCE(brief_runs_are_compared_with_what_they_measured),
};
TEST_MAIN(entries)
