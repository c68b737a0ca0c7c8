/* SPDX-License-Identifier: MIT */
/* Errors of order 2 and of lent curvature on lattices and disordered particles: those that an
 * independent program found, to the last digit that it printed. */
#include "support/lattice_block.h"
#include <math.h>
#include <string.h>

enum { PASSES = 3, LARGEST_RANK = 9 }; /* order 2 by itself, lent once, lent twice */

/* (cos 2x, cos y - sin 3x) in 2D, cos y - sin 3x + cos 2z in 3D. */
typedef struct wave {
    double value[2], slope[4], hessian[6], laplacian[2]; /* hessian in 2D alone */
} wave;

static wave wave_at(int d, const double *x)
{
    const double s = sin(3 * x[0]), c = 3 * cos(3 * x[0]);
    if (d == 2)
        return (wave){{cos(2 * x[0]), cos(x[1]) - s},
                      {-2 * sin(2 * x[0]), 0, -c, -sin(x[1])},
                      {-4 * cos(2 * x[0]), 0, 0, 9 * s, 0, -cos(x[1])},
                      {-4 * cos(2 * x[0]), 9 * s - cos(x[1])}};
    return (wave){.value = {cos(x[1]) - s + cos(2 * x[2])},
                  .slope = {-c, -sin(x[1]), -2 * sin(2 * x[2])},
                  .laplacian = {-cos(x[1]) + 9 * s - 4 * cos(2 * x[2])}};
}

/* The largest in the two outer layers and inside. */
typedef struct errors {
    double gradient[2], hessian[2], laplacian[2], mean;
    int ranks[LARGEST_RANK + 1];
} errors;

static void keep_larger(double *most, double found)
{
    *most = test_larger(*most, found);
}

static errors errors_of(const comparison *on, const second_order *found)
{
    const int d = on->points.dimension, n = on->points.count;
    errors made = {.mean = 0};
    for (int i = 0; i < n; ++i) {
        const wave exact = wave_at(d, on->points.x + i * d);
        const int inside = !lattice_block_is_boundary(on, i);
        double slope = 0, second = 0;
        for (int k = 0; k < found->gradient.width; ++k)
            slope += pow(setup_get(&found->gradient, i, k) - exact.slope[k], 2);
        for (int k = 0; k < found->hessian.width && d == 2; ++k)
            second +=
                pow(setup_get(&found->hessian, i, k) - exact.hessian[k], 2) * (k % 3 == 1 ? 2 : 1);
        keep_larger(&made.gradient[inside], sqrt(slope));
        keep_larger(&made.hessian[inside], sqrt(second));
        for (int c = 0; c < found->laplacian.width; ++c)
            keep_larger(&made.laplacian[inside],
                        fabs(setup_get(&found->laplacian, i, c) - exact.laplacian[c]));
        made.mean += sqrt(slope) / n;
        ++made.ranks[(int)setup_get(&found->rank, i, 0)];
    }
    return made;
}

/* The first call, and two that borrow: each targets that would, the others keep theirs. */
static void errors_after_each(const comparison *on, errors made[PASSES])
{
    const int d = on->points.dimension, n = on->points.count, width = d == 2 ? 2 : 1;
    const sphg_shape shape = d == 2 ? SPHG_VECTOR : SPHG_SCALAR;
    double *numbers = test_memory((size_t)(n * width) * sizeof *numbers);
    for (int i = 0; i < n; ++i)
        memcpy(numbers + i * width, wave_at(d, on->points.x + i * d).value,
               (size_t)width * sizeof *numbers);
    second_order found = second_order_apply(on, shape, numbers, (second_order_how){.lends = 1});
    const setup_array borrows = found.borrows;
    const sphg_subset open = sphg_masked(borrows.data, n);
    made[0] = errors_of(on, &found);
    for (int pass = 1; pass < PASSES; ++pass) {
        const second_order_how how = {.lends = 1, .lent = &found.curvature, .subset = &open};
        second_order next = second_order_apply(on, shape, numbers, how);
        const setup_array *from[] = {&found.gradient, &found.hessian, &found.laplacian,
                                     &found.curvature, &found.rank};
        setup_array *to[] = {&next.gradient, &next.hessian, &next.laplacian, &next.curvature,
                             &next.rank};
        for (int k = 0; k < 5; ++k)
            for (int i = 0; i < n; ++i)
                for (int c = 0; c < to[k]->width && setup_get(&borrows, i, 0) == 0; ++c)
                    setup_put(to[k], i * to[k]->width + c, setup_get(from[k], i, c));
        found = next;
        made[pass] = errors_of(on, &found);
    }
}

/* Within half of the last digit that is printed; NULL: not known. */
static void require_as_printed(double found, const char *printed, const char *what)
{
    if (!printed)
        return;
    const double digits = (double)strlen(strchr(printed, '.') + 1);
    TEST_REQUIRE(fabs(found - strtod(printed, NULL)) <= .51 * pow(10, -digits), "%s: %.7f, not %s",
                 what, found, printed);
}

/* Of three sizes; "gradient" is that of order 2 by itself, which needs no lenders inside. */
typedef struct gate {
    sphg_method method;
    double support;
    const char *gradient[3], *inside[3], *hessian[3], *hessian_inside[3], *laplacian[3],
        *laplacian_inside[3];
    const char *once[3], *twice[3], *laplacian_once[3], *laplacian_twice[3];
    const char *mean[PASSES]; /* of the second size */
    int full[3];              /* exact on quadratic fields; 0: all */
} gate;

static void check_size(const test_case *test, const gate *known, int size, int per_axis)
{
    const comparison on = lattice_block_of(test, per_axis, known->support, 0);
    const int d = test->dimension;
    errors found[PASSES];
    errors_after_each(&on, found);
    const struct {
        double found;
        const char *printed, *what;
    } rows[] = {{found[0].gradient[0], known->gradient[size], "gradient at the boundary"},
                {found[0].gradient[1], known->inside[size], "gradient inside"},
                {found[1].gradient[1], known->inside[size], "gradient inside, lent once"},
                {found[0].hessian[0], known->hessian[size], "Hessian at the boundary"},
                {found[0].hessian[1], known->hessian_inside[size], "Hessian inside"},
                {found[0].laplacian[0], known->laplacian[size], "Laplacian at the boundary"},
                {found[0].laplacian[1], known->laplacian_inside[size], "Laplacian inside"},
                {found[1].gradient[0], known->once[size], "gradient at the boundary, lent once"},
                {found[2].gradient[0], known->twice[size], "gradient at the boundary, lent twice"},
                {found[1].laplacian[0], known->laplacian_once[size], "Laplacian, lent once"},
                {found[2].laplacian[0], known->laplacian_twice[size], "Laplacian, lent twice"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
        require_as_printed(
            rows[k].found, rows[k].printed,
            test_text("%s, %d particles an axis, H %g", rows[k].what, per_axis, known->support));
    for (int pass = 0; pass < PASSES && size == 1; ++pass)
        require_as_printed(found[pass].mean, known->mean[pass],
                           test_text("mean, lent %d times", pass));
    const int full = known->full[size] ? known->full[size] : on.points.count;
    TEST_REQUIRE(found[0].ranks[d + second_order_pairs(d)] == full, "%d of %d are exact, not %d",
                 found[0].ranks[d + second_order_pairs(d)], on.points.count, full);
}

static void lattice_errors_are_the_known_ones_in_2d(const test_case *test)
{
    static const gate gates[] = {
        {.method = SPHG_KGC,
         .support = 2,
         .gradient = {"0.09080", "0.04527", "0.02259"},
         .inside = {"0.011212", "0.002811", "0.000711"},
         .hessian_inside = {"0.01694", "0.00424", "0.00106"},
         .laplacian = {"3.5942", "3.5738", "3.5678"},
         .once = {"0.02225", "0.00570", "0.00144"},
         .twice = {"0.02237", "0.00573", "0.00145"},
         .laplacian_once = {"1.3263", "0.6787", "0.3423"},
         .laplacian_twice = {"1.3661", "0.6998", "0.3531"},
         .full = {1444, 6084, 24964}},
        {.method = SPHG_KGC,
         .support = 2.5,
         .gradient = {"0.02228", "0.00571", "0.00144"},
         .inside = {"0.016812", "0.004323", "0.001107"},
         .hessian = {"1.3417", "0.6844", "0.3447"},
         .hessian_inside = {"0.05460", "0.02171", "0.01002"},
         .once = {"0.02282", "0.00585", "0.00148"},
         .twice = {"0.02282", "0.00585", "0.00148"},
         .laplacian_once = {"1.3533", "0.6930", "0.3496"}},
        {.method = SPHG_KGC,
         .support = 3,
         .gradient = {"0.02481", "0.00645", "0.00165"},
         .inside = {"0.023671", "0.006150", "0.001575"},
         .hessian = {"1.3422", "0.6847", "0.3448"},
         .hessian_inside = {"0.07277", "0.02912", "0.01349"},
         .laplacian = {"1.3263", "0.6787", "0.3423"},
         .laplacian_inside = {"0.05770", "0.02220", "0.01008"},
         .once = {"0.02481", "0.00645", "0.00165"},
         .twice = {"0.02481", "0.00645", "0.00165"},
         .laplacian_once = {"1.3614", "0.6974", "0.3518"}},
        {.method = SPHG_RKPM,
         .support = 2,
         .gradient = {"0.09077", "0.04526", "0.02258"},
         .inside = {"0.011212", "0.002811", "0.000711"},
         .hessian_inside = {"0.01694", "0.00424", "0.00106"},
         .once = {"0.02224", "0.00570", "0.00144"},
         .twice = {"0.02234", "0.00572", "0.00144"},
         .laplacian_once = {"1.3263", "0.6787", "0.3423"},
         .laplacian_twice = {"1.3606", "0.6969", "0.3516"},
         .full = {1444, 6084, 24964}},
        {.method = SPHG_RKPM,
         .support = 2.5,
         .gradient = {"0.02226", "0.00570", "0.00144"},
         .inside = {"0.014516", "0.003700", "0.000947"},
         .hessian = {"1.3416", "0.6844", "0.3447"},
         .hessian_inside = {"0.04356", "0.01712", "0.00787"}},
        {.method = SPHG_RKPM,
         .support = 3,
         .gradient = {"0.02303", "0.00599", "0.00153"},
         .inside = {"0.021837", "0.005678", "0.001454"},
         .hessian = {"1.3420", "0.6846", "0.3448"},
         .hessian_inside = {"0.07234", "0.02939", "0.01369"}},
        {.method = SPHG_MLS,
         .support = 2.5,
         .gradient = {"0.02226", "0.00570", "0.00144"},
         .inside = {"0.014516", "0.003642", "0.000922"},
         .hessian = {"1.3416", "0.6844", "0.3447"},
         .hessian_inside = {"0.03448", "0.00863", "0.00216"}},
        {.method = SPHG_MLS,
         .support = 3,
         .gradient = {"0.02309", "0.00580", "0.00147"},
         .inside = {"0.021838", "0.005484", "0.001388"},
         .hessian = {"1.3421", "0.6847", "0.3448"},
         .hessian_inside = {"0.05307", "0.01329", "0.00333"}},
    };
    for (size_t g = 0; g < sizeof gates / sizeof *gates; ++g)
        for (int size = 0; size < 3 && gates[g].method == test->method; ++size)
            check_size(test, &gates[g], size, 40 << size);
}

static void lattice_errors_are_the_known_ones_in_3d(const test_case *test)
{
    static const gate gates[] = {
        {.method = SPHG_KGC,
         .support = 2,
         .gradient = {"0.53061", "0.20425"},
         .inside = {"0.124337", "0.032273"},
         .once = {"0.19215", "0.05889"},
         .twice = {"0.19646", "0.06030"},
         .laplacian_once = {"4.7476", "2.7002"},
         .laplacian_twice = {"4.9529", "2.8323"},
         .mean = {"0.04035", "0.02361", "0.02364"},
         .full = {1000, 10648}},
        {.method = SPHG_KGC,
         .support = 2.5,
         .gradient = {"0.20406", "0.05959"},
         .inside = {"0.170676", "0.044750"},
         .once = {"0.20526", "0.06195"},
         .twice = {"0.20543", "0.06239"},
         .laplacian_once = {"5.0023", "2.8733"},
         .laplacian_twice = {"5.0208", "2.8904"}},
        {.method = SPHG_KGC,
         .support = 3,
         .gradient = {"0.2724", "0.0712"},
         .inside = {"0.2473", "0.0654"},
         .laplacian = {"4.863", "2.762"},
         .mean = {"0.0410", NULL, NULL}},
        {.method = SPHG_RKPM,
         .support = 2,
         .gradient = {"0.53055", "0.20417"},
         .inside = {"0.124337", "0.032273"},
         .once = {"0.19199", "0.05884"},
         .twice = {"0.19567", "0.06003"},
         .laplacian_once = {"4.7444", "2.6983"},
         .laplacian_twice = {"4.9208", "2.8070"},
         .full = {1000, 10648}},
    };
    for (size_t g = 0; g < sizeof gates / sizeof *gates; ++g)
        for (int size = 0; size < 2 && gates[g].method == test->method; ++size)
            check_size(test, &gates[g], size, 12 << size);
}

/* At H = 2 spacings a corner resolves one direction of curvature in 2D, an edge two; in 3D corners
 * three, edges four, faces five. */
static void surfaces_of_lattices_resolve_as_many_directions_as_they_should(const test_case *test)
{
    const int d = test->dimension;
    static const int square[] = {4, 152, 1444}, cube[] = {8, 120, 600, 1000};
    const comparison on = lattice_block_of(test, d == 2 ? 40 : 12, 2, 0);
    errors found[PASSES];
    errors_after_each(&on, found);
    for (int k = 0; k < (d == 2 ? 3 : 4); ++k) {
        const int rank = (d == 2 ? 3 : 6) + k;
        TEST_REQUIRE(found[0].ranks[rank] == (d == 2 ? square : cube)[k], "%d of rank %d",
                     found[0].ranks[rank], rank);
    }
}

/* H in spacings, inside and with surfaces, as theory.md has it. */
static void each_kernel_resolves_curvature_at_its_width(const test_case *test)
{
    static const double widths[][2] = {{2, 2.5},   {2, 3},   {2, 3},  {2.5, 3},
                                       {2.5, 3.5}, {2, 2.5}, {2, 2.5}};
    const int d = test->dimension, full = d + second_order_pairs(d);
    for (int surface = 0; surface < 2; ++surface) {
        const comparison on =
            lattice_block_of(test, d == 2 ? 30 : 14, widths[test->kernel][surface], .2);
        const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 3);
        const second_order found =
            second_order_apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
        int asked = 0, resolved = 0;
        for (int i = 0; i < on.points.count; ++i)
            if (surface || !lattice_block_is_boundary(&on, i)) {
                ++asked;
                resolved += setup_get(&found.rank, i, 0) == full;
            }
        const double least = !surface ? 1 : test->method == SPHG_KGC ? .999 : .98;
        TEST_REQUIRE(resolved >= least * asked, "%d of %d, H %g", resolved, asked,
                     widths[test->kernel][surface]);
    }
}

/* Disordered particles: the largest error falls like the square of the spacing. */
static void jitter_keeps_the_second_order(const test_case *test)
{
    static const struct {
        int per_axis;
        double alone, borrowed, mean;
    } known[] = {{24, .178, .078, .0209}, {36, .125, .0335, .0093}, {48, .090, .0185, .0052}};
    for (int k = 0; k < (test_is_shared() ? 2 : 3); ++k) {
        const comparison on = lattice_block_of(test, known[k].per_axis, 2, .2);
        errors found[PASSES];
        errors_after_each(&on, found);
        /* The largest of some ten thousand errors: another cloud has another. */
        TEST_REQUIRE(found[0].gradient[0] > .6 * known[k].alone &&
                         found[1].gradient[0] < 2.5 * known[k].borrowed &&
                         fabs(found[1].mean / known[k].mean - 1) < .02,
                     "%d: %.4f, then %.4f, mean %.4f", known[k].per_axis, found[0].gradient[0],
                     found[1].gradient[0], found[1].mean);
    }
}

/* ---- In time --------------------------------------------------------------------------------- */

enum { ONE, TWO, LENT, WAYS };

/* -u.grad A with u = (.8, .6). */
static void transport(const comparison *on, int way, const double *a, double *rate)
{
    const int n = on->points.count;
    comparison by = *on;
    by.scheme.order = way == ONE ? 1 : 2;
    double *gradient = test_memory((size_t)(2 * n) * sizeof *gradient),
           *lent = test_memory((size_t)(4 * n) * sizeof *lent);
    const sphg_view values = sphg_view_f64(a, sizeof *a),
                    lenders = sphg_view_f64(lent, 4 * sizeof *lent);
    const sphg_sources sources = comparison_sources(&by);
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &values};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    if (way == LENT) {
        field.curvature = lenders;
        SETUP_OK(on->context, sphg_evaluate(on->context, &by.scheme, &request));
        field.curvature = sphg_absent();
        field.lenders = &lenders;
    }
    field.gradient = sphg_view_f64(gradient, 2 * sizeof *gradient);
    SETUP_OK(on->context, sphg_evaluate(on->context, &by.scheme, &request));
    for (int i = 0; i < n; ++i)
        rate[i] = -.8 * gradient[2 * i] - .6 * gradient[2 * i + 1];
}

/* What is left of a field that was 1 at most, by the method of Runge and Kutta. */
static double largest_after(const comparison *on, int way, int steps)
{
    const int n = on->points.count;
    const double dt = .01;
    double *a = test_memory((size_t)n * sizeof *a), *at = test_memory((size_t)n * sizeof *at),
           *rate = test_memory((size_t)n * sizeof *rate), *sum = test_memory((size_t)n * sizeof *a);
    for (int i = 0; i < n; ++i)
        a[i] = cos(2 * on->points.x[2 * i]) * cos(3 * on->points.x[2 * i + 1]);
    for (int step = 0; step < steps; ++step) {
        memset(sum, 0, (size_t)n * sizeof *sum);
        memcpy(at, a, (size_t)n * sizeof *at);
        for (int stage = 0; stage < 4; ++stage) {
            transport(on, way, at, rate);
            for (int i = 0; i < n; ++i) {
                sum[i] += rate[i] * (stage % 3 ? 2 : 1) / 6;
                at[i] = a[i] + dt * rate[i] * (stage < 2 ? .5 : 1);
            }
        }
        for (int i = 0; i < n; ++i)
            a[i] += dt * sum[i];
    }
    double most = 0;
    for (int i = 0; i < n; ++i)
        most = test_larger(most, fabs(a[i]));
    return most;
}

/* How fast the fastest growing part grows, over |u| / spacing. At H = 2 spacings order 2 by itself
 * amplifies what it transports near surfaces; where curvature is lent it is as order 1 is. */
static void lent_curvature_does_not_grow_in_time(const test_case *test)
{
    const comparison on = lattice_block_of(test, 20, 2, .2);
    double growth[WAYS];
    for (int way = ONE; way < WAYS; ++way)
        growth[way] = .1 * log(largest_after(&on, way, 300) / largest_after(&on, way, 200));
    TEST_REQUIRE(growth[ONE] < 1.3 && growth[TWO] > 2.5 && growth[LENT] < 1.7,
                 "order 1 grows by %g, order 2 by %g, lent by %g", growth[ONE], growth[TWO],
                 growth[LENT]);
}

static const test_entry entries[] = {
    TEST_ENTRY(lattice_errors_are_the_known_ones_in_2d, TEST_BIT(TEST_F64), TEST_2D,
               TEST_LINEARISED, 0),
    TEST_ENTRY(lattice_errors_are_the_known_ones_in_3d, TEST_BIT(TEST_F64), TEST_3D,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM), 0),
    TEST_ENTRY(surfaces_of_lattices_resolve_as_many_directions_as_they_should, TEST_BIT(TEST_F64),
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(each_kernel_resolves_curvature_at_its_width, TEST_BIT(TEST_F64),
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, TEST_ALL_KERNELS),
    TEST_ENTRY(jitter_keeps_the_second_order, TEST_BIT(TEST_F64), TEST_3D, TEST_BIT(SPHG_KGC), 0),
    TEST_ENTRY(lent_curvature_does_not_grow_in_time, TEST_BIT(TEST_F64), TEST_2D,
               TEST_BIT(SPHG_KGC), 0),
};
TEST_MAIN(entries)
