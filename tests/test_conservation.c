/* SPDX-License-Identifier: MIT */
/* What the two-sided forms conserve and what they do not (docs/theory.md, forms). Sums are taken
 * in double over forces that the library stored, relative to the sum of their sizes. */
#include "support/graded.h"
#include "support/incomplete_lists.h"

/* A sum that should vanish, beside the sum of the sizes of its terms. */
typedef struct balance {
    double sum[3], size;
} balance;

static double imbalance(const balance *sums)
{
    return sqrt(sums->sum[0] * sums->sum[0] + sums->sum[1] * sums->sum[1] +
                sums->sum[2] * sums->sum[2]) /
           sums->size;
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

/* Every particle of full rank; kernel and support as the case has them. */
static comparison full_rank_stage(const test_case *test)
{
    random_state random = random_seeded(31);
    int d = test->dimension;
    cloud points = cloud_jittered(d, d == 2 ? 8 : 5, .25, .15, &random);
    return comparison_of(test, "block", points, .75);
}

/* Two layers so near that their normal is dropped or blended at every particle. */
static comparison thin_stage(const test_case *test)
{
    random_state random = random_seeded(32);
    int d = test->dimension;
    cloud points = cloud_sheets(d, d == 2 ? 16 : 6, .25, .05);
    for (int k = 0; k < points.count * d; ++k)
        if (k % d < d - 1)
            points.x[k] += random_between(&random, -.05, .05);
    return comparison_of(test, "thin sheets", points, .625);
}

static comparison at_equal_density(comparison on)
{
    double *density = test_memory((size_t)on.points.count * sizeof *density);
    for (int i = 0; i < on.points.count; ++i)
        density[i] = 1.25;
    on.density = setup_numbers(test_field_type(on.test), on.points.count, 1, density);
    on.scene.density = density;
    return on;
}

static int has_full_rank(const comparison *on)
{
    setup_array rank = setup_output(SPHG_U8, on->points.count, 1);
    setup_array table = comparison_table(on);
    sphg_sources sources = comparison_sources(on);
    SETUP_OK(on->context, sphg_correction(on->context, &on->scheme, &sources, NULL,
                                          setup_view(&table), setup_view(&rank)));
    for (int i = 0; i < on->points.count; ++i)
        if (setup_get(&rank, i, 0) != on->points.dimension)
            return 0;
    return 1;
}

static void require_full_rank(const comparison *on)
{
    assert_true(has_full_rank(on));
}

/* ---- Momentum -------------------------------------------------------------------------------- */

/* V_i^weigh times the vector result of a form; weigh = 1 turns a SYMMETRIC or DIFFERENCE
 * derivative into a force. */
static double *forces_of(const comparison *on, sphg_shape shape, sphg_form form)
{
    int d = on->points.dimension;
    setup_array table = comparison_table(on);
    comparison_field field = {shape, form, comparison_random_field(on, shape, 17)};
    comparison_result found = comparison_apply(on, &field, form == SPHG_DIFFERENCE ? NULL : &table);
    double *force = setup_doubles(shape == SPHG_SCALAR ? &found.gradient : &found.divergence);
    for (int k = 0; k < on->points.count * d && form != SPHG_ADJOINT; ++k)
        force[k] *= on->scene.volume[k / d];
    return force;
}

static double linear_imbalance(const comparison *on, const double *force)
{
    int d = on->points.dimension;
    balance sums = {{0}, 0};
    for (int i = 0; i < on->points.count; ++i) {
        double square = 0;
        for (int k = 0; k < d; ++k) {
            sums.sum[k] += force[i * d + k];
            square += force[i * d + k] * force[i * d + k];
        }
        sums.size += sqrt(square);
    }
    return imbalance(&sums);
}

static double angular_imbalance(const comparison *on, const double *force)
{
    int d = on->points.dimension;
    balance sums = {{0}, 0};
    for (int i = 0; i < on->points.count; ++i) {
        const double *x = on->points.x + i * d, *f = force + i * d;
        double torque[3] = {x[0] * f[1] - x[1] * f[0], 0, 0}, lever = x[0] * x[0] + x[1] * x[1];
        double size = f[0] * f[0] + f[1] * f[1];
        if (d == 3) {
            torque[1] = x[1] * f[2] - x[2] * f[1];
            torque[2] = x[2] * f[0] - x[0] * f[2];
            lever += x[2] * x[2];
            size += f[2] * f[2];
        }
        for (int k = 0; k < 3; ++k)
            sums.sum[k] += torque[k];
        sums.size += sqrt(lever * size);
    }
    return imbalance(&sums);
}

static void require_linear(const comparison *on, sphg_shape shape, sphg_form form, const char *what)
{
    double error = linear_imbalance(on, forces_of(on, shape, form)) / on->scene.unit;
    TEST_WITHIN(linear_momentum, error, test_text("%s, %s", what, on->name));
}

static void require_angular(const comparison *on, sphg_shape shape, sphg_form form,
                            const char *what)
{
    double error = angular_imbalance(on, forces_of(on, shape, form)) / on->scene.unit;
    TEST_WITHIN(angular_momentum, error, test_text("%s, %s", what, on->name));
}

static const double visible = 2e-5; /* far above rounding in f32, far below what is lost */

static void require_angular_lost(const comparison *on, sphg_shape shape, sphg_form form)
{
    double error = angular_imbalance(on, forces_of(on, shape, form));
    TEST_REQUIRE(error > visible, "angular momentum off by %g only: %s", error, on->name);
}

static void adjoint_conserves_linear_momentum(const test_case *test)
{
    comparison stages[] = {full_rank_stage(test), thin_stage(test)};
    for (int s = 0; s < 2; ++s) {
        require_linear(&stages[s], SPHG_SCALAR, SPHG_ADJOINT, "scalar");
        require_linear(&stages[s], SPHG_SYM_TENSOR, SPHG_ADJOINT, "symmetric");
        require_linear(&stages[s], SPHG_TENSOR, SPHG_ADJOINT, "tensor");
    }
}

static void symmetric_conserves_linear_momentum(const test_case *test)
{
    comparison stages[] = {full_rank_stage(test), thin_stage(test)};
    for (int s = 0; s < 2; ++s) {
        require_linear(&stages[s], SPHG_SCALAR, SPHG_SYMMETRIC, "scalar");
        require_linear(&stages[s], SPHG_TENSOR, SPHG_SYMMETRIC, "tensor");
    }
}

static void difference_conserves_nothing(const test_case *test)
{
    comparison on = full_rank_stage(test);
    double *force = forces_of(&on, SPHG_SCALAR, SPHG_DIFFERENCE);
    TEST_REQUIRE(linear_imbalance(&on, force) > 1e-3, "linear momentum kept");
    TEST_REQUIRE(angular_imbalance(&on, force) > 1e-3, "angular momentum kept");
}

/* ---- Angular momentum
 * ----------------------------------------------------------------------------- */

static void adjoint_of_scalars_conserves_angular_momentum(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_angular(&on, SPHG_SCALAR, SPHG_ADJOINT, "scalar");
    if (test_is_classic(test))
        return;
    on = thin_stage(test);
    require_angular(&on, SPHG_SCALAR, SPHG_ADJOINT, "scalar");
}

static void
adjoint_of_symmetric_tensors_conserves_angular_momentum_at_full_rank(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_full_rank(&on);
    require_angular(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT, "symmetric tensor");
    on = thin_stage(test);
    require_angular_lost(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT);
}

static void plain_adjoint_of_symmetric_tensors_loses_angular_momentum(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_angular_lost(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT);
}

static void unsymmetric_tensors_lose_angular_momentum(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_angular_lost(&on, SPHG_TENSOR, SPHG_ADJOINT);
}

static void symmetric_form_loses_angular_momentum_at_unequal_density(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_angular_lost(&on, SPHG_SCALAR, SPHG_SYMMETRIC);
}

static void plain_symmetric_form_of_scalars_conserves_angular_momentum(const test_case *test)
{
    comparison on = full_rank_stage(test);
    require_angular(&on, SPHG_SCALAR, SPHG_SYMMETRIC, "scalar");
}

/* At equal density V_i times the symmetric form is the adjoint form. */
static void symmetric_is_adjoint_at_equal_density(const test_case *test)
{
    comparison on = at_equal_density(full_rank_stage(test));
    double *symmetric = forces_of(&on, SPHG_SCALAR, SPHG_SYMMETRIC);
    double *adjoint = forces_of(&on, SPHG_SCALAR, SPHG_ADJOINT);
    require_angular(&on, SPHG_SCALAR, SPHG_SYMMETRIC, "scalar, equal density");
    double largest = 0, error = 0;
    for (int k = 0; k < on.points.count * test->dimension; ++k) {
        largest = fmax(largest, fabs(adjoint[k]));
        error = fmax(error, fabs(symmetric[k] - adjoint[k]));
    }
    TEST_WITHIN(adjointness, error / largest / on.scene.unit, "symmetric against adjoint");
}

/* ---- Adjointness ----------------------------------------------------------------------------- */

/* <S, grad w> with volumes, and <w, f>: their sum vanishes for every S and w. */
static double work_imbalance(const comparison *on, sphg_shape shape)
{
    int n = on->points.count, d = on->points.dimension;
    setup_array table = comparison_table(on);
    comparison_field motion = {SPHG_VECTOR, SPHG_DIFFERENCE,
                               comparison_random_field(on, SPHG_VECTOR, 41)};
    comparison_field stress = {shape, SPHG_ADJOINT, comparison_random_field(on, shape, 42)};
    comparison_result rate = comparison_apply(on, &motion, &table),
                      push = comparison_apply(on, &stress, &table);
    const setup_array *force = shape == SPHG_SCALAR ? &push.gradient : &push.divergence;
    double work = 0, size = 0;
    for (int i = 0; i < n; ++i) {
        const double *s = stress.numbers + i * setup_width(shape, d);
        for (int k = 0; k < d * d; ++k) {
            double share = shape == SPHG_TENSOR ? s[k] : k % (d + 1) == 0 ? s[0] : 0;
            double term = on->scene.volume[i] * share * setup_get(&rate.gradient, i, k);
            work += term;
            size += fabs(term);
        }
        for (int k = 0; k < d; ++k)
            work += motion.numbers[i * d + k] * setup_get(force, i, k);
    }
    return fabs(work) / size;
}

static void adjoint_is_the_negative_adjoint_of_difference(const test_case *test)
{
    comparison stages[] = {full_rank_stage(test), thin_stage(test)};
    for (int s = 0; s < 2; ++s) {
        double u = stages[s].scene.unit;
        TEST_WITHIN(adjointness, work_imbalance(&stages[s], SPHG_SCALAR) / u, stages[s].name);
        TEST_WITHIN(adjointness, work_imbalance(&stages[s], SPHG_TENSOR) / u, stages[s].name);
    }
}

/* The same for the gradient of a scalar and the adjoint divergence of a vector. */
static void adjoint_divergence_of_vectors_is_the_adjoint_of_the_gradient(const test_case *test)
{
    comparison on = thin_stage(test);
    int d = test->dimension;
    setup_array table = comparison_table(&on);
    comparison_field phi = {SPHG_SCALAR, SPHG_DIFFERENCE,
                            comparison_random_field(&on, SPHG_SCALAR, 43)};
    comparison_field flux = {SPHG_VECTOR, SPHG_ADJOINT,
                             comparison_random_field(&on, SPHG_VECTOR, 44)};
    comparison_result slope = comparison_apply(&on, &phi, &table),
                      outflow = comparison_apply(&on, &flux, &table);
    double work = 0, size = 0;
    for (int i = 0; i < on.points.count; ++i) {
        for (int k = 0; k < d; ++k) {
            double term =
                on.scene.volume[i] * flux.numbers[i * d + k] * setup_get(&slope.gradient, i, k);
            work += term;
            size += fabs(term);
        }
        work += phi.numbers[i] * setup_get(&outflow.divergence, i, 0);
    }
    TEST_WITHIN(adjointness, fabs(work) / size / on.scene.unit, "flux");
}

/* ---- Order 2 --------------------------------------------------------------------------------- */

/* Its tables are symmetric, and M2 P + M3 Q^T = M2 C: what order 1 conserves, it does. */
static void order_2_conserves_what_order_1_does(const test_case *test)
{
    const comparison whole = full_rank_stage(test);
    comparison stages[] = {whole, thin_stage(test),
                           comparison_lacking(&whole, COMPARISON_CUT_AT_BOTH_ENDS)};
    for (int s = 0; s < 3; ++s) {
        comparison *on = &stages[s];
        on->scheme.order = 2;
        for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
            require_linear(on, SPHG_SCALAR, (sphg_form)form, "scalar");
            require_linear(on, SPHG_TENSOR, (sphg_form)form, "tensor");
        }
        require_angular(on, SPHG_SCALAR, SPHG_ADJOINT, "scalar");
        TEST_WITHIN(adjointness, work_imbalance(on, SPHG_SCALAR) / on->scene.unit, on->name);
        TEST_WITHIN(adjointness, work_imbalance(on, SPHG_TENSOR) / on->scene.unit, on->name);
    }
    require_angular(&stages[0], SPHG_SYM_TENSOR, SPHG_ADJOINT, "symmetric tensor");
    require_angular_lost(&stages[0], SPHG_TENSOR, SPHG_ADJOINT);
    require_angular_lost(&stages[1], SPHG_SYM_TENSOR, SPHG_ADJOINT);
}

/* ---- Lists that lack pairs ------------------------------------------------------------------- */

static void lists_cut_at_both_ends_conserve(const test_case *test)
{
    const comparison whole = full_rank_stage(test);
    const comparison on = comparison_lacking(&whole, COMPARISON_CUT_AT_BOTH_ENDS);
    for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
        require_linear(&on, SPHG_SCALAR, (sphg_form)form, "scalar");
        require_linear(&on, SPHG_TENSOR, (sphg_form)form, "tensor");
    }
    require_angular(&on, SPHG_SCALAR, SPHG_ADJOINT, "scalar");
    TEST_WITHIN(adjointness, work_imbalance(&on, SPHG_TENSOR) / on.scene.unit, on.name);
    if (test->method == SPHG_PLAIN)
        return;
    if (!random_chosen()) /* other numbers may leave a particle too few */
        require_full_rank(&on);
    if (has_full_rank(&on))
        require_angular(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT, "symmetric tensor");
}

/* Half lists, and lists that are cut at one end. */
static void one_sided_lists_conserve_nothing(const test_case *test)
{
    const comparison whole = full_rank_stage(test);
    for (int lack = COMPARISON_HALF; lack <= COMPARISON_CUT; ++lack) {
        const comparison on = comparison_lacking(&whole, (comparison_lack)lack);
        for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
            const double *force = forces_of(&on, SPHG_SCALAR, (sphg_form)form);
            const double linear = linear_imbalance(&on, force);
            const double angular = angular_imbalance(&on, force);
            TEST_REQUIRE(linear > 1e-4 && angular > 1e-4, "off by %g, %g only: %s", linear, angular,
                         on.name);
        }
        const double work = work_imbalance(&on, SPHG_TENSOR);
        TEST_REQUIRE(work > 1e-5, "work off by %g only: %s", work, on.name);
    }
}

/* Particles with radii of their own, twice as large at the far end: each half of a pair has its
 * own. Lists may hold more than those pairs; what goes around has no angular momentum. */
static void radii_keep_what_one_radius_keeps(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        const comparison on = graded_stage_of(test, 2, 3.5, (graded_way)way);
        const int full = test->method == SPHG_PLAIN || has_full_rank(&on);
        assert_true(full || way || random_chosen());
        TEST_WITHIN(adjointness, work_imbalance(&on, SPHG_SCALAR) / on.scene.unit, on.name);
        TEST_WITHIN(adjointness, work_imbalance(&on, SPHG_TENSOR) / on.scene.unit, on.name);
        require_linear(&on, SPHG_TENSOR, SPHG_ADJOINT, "adjoint");
        require_linear(&on, SPHG_SYM_TENSOR, SPHG_SYMMETRIC, "symmetric");
        if (way & GRADED_AROUND)
            continue;
        if (full || !test_is_classic(test))
            require_angular(&on, SPHG_SCALAR, SPHG_ADJOINT, "scalar");
        if (full && test->method != SPHG_PLAIN)
            require_angular(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT, "symmetric tensor");
        require_angular_lost(&on, SPHG_TENSOR, SPHG_ADJOINT);
    }
}

static void require_small(const comparison *on, double imbalance, const char *what)
{
    TEST_WITHIN(second_over_radii, imbalance / on->scene.unit, test_text("%s, %s", what, on->name));
}

static void radii_keep_what_order_2_keeps(const test_case *test)
{
    for (int way = 0; way < GRADED_WAYS; ++way) {
        comparison on = graded_stage_of(test, 2, 3.5, (graded_way)way);
        const int full = has_full_rank(&on);
        on.scheme.order = 2;
        require_small(&on, work_imbalance(&on, SPHG_SCALAR), "work");
        require_small(&on, work_imbalance(&on, SPHG_TENSOR), "work of a tensor");
        for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form)
            require_small(&on, linear_imbalance(&on, forces_of(&on, SPHG_TENSOR, (sphg_form)form)),
                          "linear momentum");
        if (way & GRADED_AROUND)
            continue;
        require_small(&on, angular_imbalance(&on, forces_of(&on, SPHG_SCALAR, SPHG_ADJOINT)),
                      "angular momentum");
        if (full)
            require_small(&on,
                          angular_imbalance(&on, forces_of(&on, SPHG_SYM_TENSOR, SPHG_ADJOINT)),
                          "angular momentum of a symmetric tensor");
        require_angular_lost(&on, SPHG_TENSOR, SPHG_ADJOINT);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(adjoint_conserves_linear_momentum, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(symmetric_conserves_linear_momentum, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(difference_conserves_nothing, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(adjoint_of_scalars_conserves_angular_momentum, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(adjoint_of_symmetric_tensors_conserves_angular_momentum_at_full_rank,
               TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(plain_adjoint_of_symmetric_tensors_loses_angular_momentum, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(unsymmetric_tensors_lose_angular_momentum, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(symmetric_form_loses_angular_momentum_at_unequal_density, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(plain_symmetric_form_of_scalars_conserves_angular_momentum, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(symmetric_is_adjoint_at_equal_density, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(adjoint_is_the_negative_adjoint_of_difference, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(adjoint_divergence_of_vectors_is_the_adjoint_of_the_gradient, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
    TEST_ENTRY(order_2_conserves_what_order_1_does, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(radii_keep_what_one_radius_keeps, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(radii_keep_what_order_2_keeps, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(lists_cut_at_both_ends_conserve, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(one_sided_lists_conserve_nothing, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
