/* SPDX-License-Identifier: MIT */
/* First-order exactness: linear fields have their exact gradient at every particle of full rank,
 * wherever it lies. Positions are multiples of 2^-10 and fields have small integer slopes, so
 * that fields are exact in f32 too and all error is the library's own. */
#include "support/incomplete_lists.h"

/* ---- Scenes ---------------------------------------------------------------------------------- */

typedef struct exact_scene {
    const char *name;
    int kind;
    double support;   /* in spacings */
    double full_rank; /* the least share of particles that must have it */
} exact_scene;

enum { lattice, jittered, scattered, free_surface, corner };

/* Smooth kernels weigh the outer half of the support so little that ranks fall early. */
static const exact_scene exact_scenes[] = {
    {"lattice", lattice, 2, .85},    {"jittered", jittered, 2.5, .85},
    {"random", scattered, 2.5, .35}, {"free surface", free_surface, 2.5, .5},
    {"corner", corner, 3, .8},
};
enum { exact_scene_count = sizeof exact_scenes / sizeof *exact_scenes };

static cloud make_cloud(const exact_scene *scene, int d)
{
    random_state random = random_seeded(99);
    int per_axis = d == 2 ? 8 : 5;
    switch (scene->kind) {
    case lattice:
        return cloud_lattice(d, per_axis, .25);
    case jittered:
        return cloud_jittered(d, per_axis, .25, .2, &random);
    case scattered:
        return cloud_random(d, 100, d == 2 ? 2.5 : 1.125, &random);
    case free_surface:
        return cloud_free_surface(d, per_axis, .25, &random);
    default:
        return cloud_corner(d, .25, &random);
    }
}

static comparison make_stage(const test_case *test, const exact_scene *scene)
{
    cloud points = make_cloud(scene, test->dimension);
    cloud_snap(&points, 0x1p-10);
    return comparison_of(test, scene->name, points, scene->support * .25);
}

/* v(x) = v0 + J x. */
static double *linear_vectors(const cloud *points, const double *v0, const double *jacobian)
{
    int d = points->dimension;
    double *numbers = test_memory((size_t)(points->count * d) * sizeof *numbers);
    for (int i = 0; i < points->count; ++i)
        for (int a = 0; a < d; ++a) {
            numbers[i * d + a] = v0 ? v0[a] : 0;
            for (int b = 0; b < d; ++b)
                numbers[i * d + a] += jacobian[a * d + b] * points->x[i * d + b];
        }
    return numbers;
}

static double size_of(const double *numbers, int count)
{
    double square = 0;
    for (int k = 0; k < count; ++k)
        square += numbers[k] * numbers[k];
    return sqrt(square);
}

/* ---- Where the rank is full ------------------------------------------------------------------ */

typedef struct quality {
    setup_array rank, lambda;
    int full; /* how many */
} quality;

static quality judge(const comparison *on)
{
    quality found = {setup_output(SPHG_U8, on->points.count, 1),
                     setup_output(test_field_type(on->test), on->points.count, 1), 0};
    sphg_sources sources = comparison_sources(on);
    sphg_request request = {.sources = &sources, .set_count = 1};
    request.rank = setup_view(&found.rank);
    request.lambda_min = setup_view(&found.lambda);
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    for (int i = 0; i < on->points.count; ++i)
        found.full += setup_get(&found.rank, i, 0) == on->points.dimension;
    return found;
}

/* |found - exact| in units of u |scale| / lambda_min; negative where the rank is not full. */
static double error_of(const comparison *on, const quality *good, const setup_array *found, int i,
                       const double *exact, double scale)
{
    if (setup_get(&good->rank, i, 0) != on->points.dimension)
        return -1;
    double error[9];
    for (int k = 0; k < found->width; ++k)
        error[k] = setup_get(found, i, k) - exact[k];
    return size_of(error, found->width) * setup_get(&good->lambda, i, 0) / (scale * on->scene.unit);
}

static void require_exact(const comparison *on, const quality *good, const setup_array *found,
                          const double *exact, double scale, const char *what)
{
    const char *where = test_text("%s, %s, %s", what, on->name, test_method_name(on->test->method));
    for (int i = 0; i < on->points.count; ++i)
        TEST_WITHIN(linear_exactness, error_of(on, good, found, i, exact, scale), where);
}

static int is_smooth(sphg_kernel kernel)
{
    return kernel == SPHG_QUINTIC_SPLINE || kernel == SPHG_WENDLAND_C4 ||
           kernel == SPHG_WENDLAND_C6;
}

static void require_full_ranks(const comparison *on, const quality *good, const exact_scene *scene)
{
    double least = scene->full_rank * (is_smooth(on->test->kernel) ? .3 : 1);
    TEST_REQUIRE(good->full >= least * on->points.count, "only %d of %d have full rank: %s",
                 good->full, on->points.count, scene->name);
}

/* ---- Linear fields --------------------------------------------------------------------------- */

static const double jacobians[2][9] = {{2, -1, 3, -2}, {2, -1, 0, 3, -2, 1, 1, 0, 3}};
static const double start[] = {1, -2, .5};

static void check_linear(const comparison *on, const quality *good, sphg_form form)
{
    int d = on->points.dimension;
    const double *j = jacobians[d - 2];
    double size = size_of(j, d * d), trace = d == 2 ? j[0] + j[3] : j[0] + j[4] + j[8];
    double curl[3] = {j[2] - j[1], 0, 0};
    if (d == 3)
        curl[0] = j[7] - j[5], curl[1] = j[2] - j[6], curl[2] = j[3] - j[1];
    comparison_field field = {SPHG_VECTOR, form, linear_vectors(&on->points, start, j)};
    comparison_result found = comparison_apply(on, &field, NULL);
    /* The direct form cancels the constant part: sum |A_j| / H instead of |J|. */
    double scale = form == SPHG_DIRECT ? 16 * size : size;
    require_exact(on, good, &found.gradient, j, scale, "gradient");
    require_exact(on, good, &found.divergence, &trace, scale, "divergence");
    require_exact(on, good, &found.curl, curl, scale, "curl");
}

static void linear_fields_are_exact(const test_case *test)
{
    for (int s = 0; s < exact_scene_count; ++s) {
        comparison on = make_stage(test, &exact_scenes[s]);
        quality good = judge(&on);
        require_full_ranks(&on, &good, &exact_scenes[s]);
        check_linear(&on, &good, SPHG_DIFFERENCE);
        if (test_is_classic(test))
            check_linear(&on, &good, SPHG_DIRECT);
    }
}

/* Corrections come from the lists that are summed: what is missing costs rank, not exactness. */
static void linear_fields_are_exact_on_lists_that_lack_pairs(const test_case *test)
{
    const comparison whole = make_stage(test, &exact_scenes[jittered]);
    for (int lack = 0; lack < COMPARISON_LACKS; ++lack) {
        const comparison on = comparison_lacking(&whole, (comparison_lack)lack);
        const quality good = judge(&on);
        TEST_REQUIRE(good.full >= .7 * on.points.count, "only %d: %s", good.full, on.name);
        check_linear(&on, &good, SPHG_DIFFERENCE);
        if (test_is_classic(test))
            check_linear(&on, &good, SPHG_DIRECT);
    }
}

static void corrections_of_other_lists_are_far_from_exact(const test_case *test)
{
    const comparison whole = make_stage(test, &exact_scenes[jittered]);
    const double *j = jacobians[test->dimension - 2];
    const setup_array table = comparison_table(&whole);
    const comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                                    linear_vectors(&whole.points, start, j)};
    for (int lack = 0; lack < COMPARISON_LACKS; ++lack) {
        const comparison on = comparison_lacking(&whole, (comparison_lack)lack);
        const comparison_result found = comparison_apply(&on, &field, &table);
        double worst = 0;
        for (int i = 0; i < on.points.count; ++i)
            worst = test_larger(worst, fabs(setup_get(&found.gradient, i, 0) - j[0]));
        TEST_REQUIRE(worst > .2, "off by %g only: %s", worst, on.name);
    }
}

static void linear_scalars_and_tensors_are_exact(const test_case *test)
{
    int d = test->dimension;
    static const double slope[] = {3, -2, 1};
    for (int s = 0; s < exact_scene_count; ++s) {
        comparison on = make_stage(test, &exact_scenes[s]);
        quality good = judge(&on);
        double *scalars = test_memory((size_t)on.points.count * sizeof *scalars);
        double *tensors = test_memory((size_t)(on.points.count * d * d) * sizeof *tensors);
        for (int i = 0; i < on.points.count; ++i) {
            for (int b = 0; b < d; ++b)
                scalars[i] += slope[b] * on.points.x[i * d + b];
            for (int k = 0; k < d * d; ++k)
                tensors[i * d * d + k] = (k + 1) * scalars[i];
        }
        comparison_field field = {SPHG_SCALAR, SPHG_DIFFERENCE, scalars};
        comparison_result found = comparison_apply(&on, &field, NULL);
        require_exact(&on, &good, &found.gradient, slope, size_of(slope, d), "scalar gradient");
        double divergence[3] = {0};
        for (int k = 0; k < d * d; ++k)
            divergence[k / d] += (k + 1) * slope[k % d];
        field = (comparison_field){SPHG_TENSOR, SPHG_DIFFERENCE, tensors};
        found = comparison_apply(&on, &field, NULL);
        require_exact(&on, &good, &found.divergence, divergence, 20 * size_of(slope, d),
                      "tensor divergence");
    }
}

/* ---- Rigid rotation -------------------------------------------------------------------------- */

static void rotation_gives_no_strain_and_twice_the_angular_velocity(const test_case *test)
{
    int d = test->dimension;
    static const double spins[2][9] = {{0, -2, 2, 0}, {0, -3, 1, 3, 0, -2, -1, 2, 0}};
    const double *spin = spins[d - 2], none = 0;
    double curl[3] = {4, 2, 6}, size = size_of(spin, d * d);
    for (int s = 0; s < exact_scene_count; ++s) {
        comparison on = make_stage(test, &exact_scenes[s]);
        quality good = judge(&on);
        comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE,
                                  linear_vectors(&on.points, NULL, spin)};
        comparison_result found = comparison_apply(&on, &field, NULL);
        double *numbers = setup_doubles(&found.gradient), zeros[9] = {0};
        for (int i = 0; i < on.points.count; ++i)
            for (int a = 0; a < d; ++a)
                for (int b = a; b < d; ++b) {
                    double *left = &numbers[i * d * d + a * d + b];
                    double *right = &numbers[i * d * d + b * d + a];
                    *left = *right = (*left + *right) / 2;
                }
        setup_array strain = setup_numbers(SPHG_F64, on.points.count, d * d, numbers);
        require_exact(&on, &good, &strain, zeros, size, "strain");
        require_exact(&on, &good, &found.divergence, &none, size, "divergence");
        require_exact(&on, &good, &found.curl, curl, size, "curl");
    }
}

/* ---- Constants ------------------------------------------------------------------------------- */

static void require_zero(const setup_array *found, const char *what)
{
    for (int k = 0; k < found->count * found->width; ++k)
        TEST_REQUIRE(setup_get(found, k / found->width, k % found->width) == 0, "%s, number %d",
                     what, k);
}

static void constants_have_exactly_no_derivative(const test_case *test)
{
    for (int s = 0; s < exact_scene_count; ++s) {
        comparison on = make_stage(test, &exact_scenes[s]);
        int total = on.points.count * on.points.dimension;
        double *field = test_memory((size_t)total * sizeof *field);
        for (int k = 0; k < total; ++k)
            field[k] = .1 + k % on.points.dimension;
        comparison_field constant = {SPHG_VECTOR, SPHG_DIFFERENCE, field};
        comparison_result found = comparison_apply(&on, &constant, NULL);
        require_zero(&found.gradient, "gradient");
        require_zero(&found.divergence, "divergence");
        require_zero(&found.curl, "curl");
    }
}

/* ---- The measure itself: what must not pass
 * -------------------------------------------------------- */

static void plain_sph_is_far_from_exact(const test_case *test)
{
    comparison on = make_stage(test, &exact_scenes[lattice]);
    int d = test->dimension;
    const double *j = jacobians[d - 2];
    comparison_field field = {SPHG_VECTOR, SPHG_DIFFERENCE, linear_vectors(&on.points, start, j)};
    comparison_result found = comparison_apply(&on, &field, NULL);
    double worst = 0;
    for (int i = 0; i < on.points.count; ++i) {
        double error[9];
        for (int k = 0; k < d * d; ++k)
            error[k] = setup_get(&found.gradient, i, k) - j[k];
        worst = test_larger(worst, size_of(error, d * d) / size_of(j, d * d));
    }
    TEST_REQUIRE(worst > .3, "the error at corners is only %g", worst);
}

static const test_entry entries[] = {
    TEST_ENTRY(linear_fields_are_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_CORRECTED,
               TEST_ALL_KERNELS),
    TEST_ENTRY(linear_fields_are_exact_on_lists_that_lack_pairs, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(corrections_of_other_lists_are_far_from_exact, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, 0),
    TEST_ENTRY(linear_scalars_and_tensors_are_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
    TEST_ENTRY(rotation_gives_no_strain_and_twice_the_angular_velocity, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_CORRECTED, TEST_ALL_KERNELS),
    TEST_ENTRY(constants_have_exactly_no_derivative, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, TEST_ALL_KERNELS),
    TEST_ENTRY(plain_sph_is_far_from_exact, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_PLAIN), 0),
};
TEST_MAIN(entries)
