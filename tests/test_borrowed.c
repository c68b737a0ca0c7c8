/* SPDX-License-Identifier: MIT */
/* Curvature that is lent and borrowed: against the oracle, exact where order 2 alone is not,
 * continuous, and without a trace where nobody lends. */
#include "support/lattice_block.h"
#include "support/oracle_borrowed.h"
#include "support/scenes.h"
#include <string.h>

static second_order apply(const comparison *on, sphg_shape shape, const double *numbers,
                          second_order_how how)
{
    how.lends = 1;
    return second_order_apply(on, shape, numbers, how);
}

/* ---- The oracle ------------------------------------------------------------------------------ */

static void compare(const comparison *on, sphg_shape shape, const second_order *found,
                    const double *numbers, const double *lent, int i)
{
    const oracle_field field = {shape, SPHG_DIFFERENCE, numbers, NULL};
    const oracle_curved exact = oracle_apply_borrowed(on->reference, &field, lent, i);
    second_order_compare(on, found, &exact, i, TEST_TOLERANCE_borrowed_ratio);
}

/* What is lent, and who would borrow. */
static void compare_offer(const comparison *on, const second_order *found, const double *lent,
                          int i)
{
    oracle_second second;
    const oracle_point *point = oracle_at(on->reference, i);
    oracle_solve_second(&on->scene, point, &second);
    const oracle_offer offer = oracle_offer_of(&on->scene, point, &second);
    if (second.undecided || point->undecided)
        return;
    const int width = found->curvature.width;
    quad exact = offer.confidence, blur = offer.blur;
    if (lent) {
        exact = oracle_confidence_lent(point, exact, lent, width);
        blur += 256 * on->scene.unit;
    }
    const double off = setup_get(&found->curvature, i, 0) - (double)exact;
    TEST_WITHIN(borrowed_confidence, fabs(off) / ((double)blur + on->scene.unit),
                test_text("confidence of particle %d, %s", i, on->name));
    TEST_REQUIRE(!offer.sure || setup_get(&found->borrows, i, 0) == offer.open,
                 "particle %d borrows: %g, %s", i, setup_get(&found->borrows, i, 0), on->name);
}

/* What targets lend is c times their Hessian. */
static void compare_lent(const comparison *on, const second_order *found, int i)
{
    const double c = setup_get(&found->curvature, i, 0);
    for (int k = 0; k < found->hessian.width; ++k) {
        double product = c * setup_get(&found->hessian, i, k);
        if (test_field_type(on->test) == SPHG_F32)
            product = (double)(float)product;
        TEST_REQUIRE(setup_get(&found->curvature, i, 1 + k) == (c > 0 ? product : 0),
                     "particle %d lends %g of component %d, %s", i, product, k, on->name);
    }
}

static void results_match_the_oracle(const test_case *test)
{
    int borrowers = 0, lenders = 0;
    for (int s = 0; s < scenes_hard_count; ++s) {
        const comparison on = second_order_comparison(comparison_of_scene(test, &scenes_hard[s]));
        for (int shape = SPHG_SCALAR; shape <= (s ? SPHG_VECTOR : SPHG_TENSOR); ++shape) {
            const double *numbers = comparison_random_field(&on, (sphg_shape)shape, 3);
            const second_order first =
                apply(&on, (sphg_shape)shape, numbers, (second_order_how){0});
            const second_order found = apply(&on, (sphg_shape)shape, numbers,
                                             (second_order_how){.lent = &first.curvature});
            const double *lent = setup_doubles(&first.curvature);
            const int step = on.points.count < 6 ? 1 : on.points.count / 6;
            for (int i = 0; i < on.points.count; i += step) {
                compare(&on, (sphg_shape)shape, &found, numbers, lent, i);
                compare_offer(&on, &first, NULL, i);
                compare_offer(&on, &found, lent, i);
                compare_lent(&on, &first, i);
                compare_lent(&on, &found, i);
                borrowers += setup_get(&first.borrows, i, 0) == 1;
                lenders += setup_get(&first.curvature, i, 0) > 0;
            }
        }
    }
    TEST_REQUIRE(borrowers > 20 && lenders > 10, "%d borrow, %d lend", borrowers, lenders);
}

/* Lenders need not be what this cloud would lend: any numbers do. */
static void every_policy_and_instruction_set_matches_the_oracle(const test_case *test)
{
    static const int chosen[] = {0, 5, 10};
    for (int s = 0; s < 3; ++s)
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            const comparison made = comparison_of_scene(test, &scenes_hard[chosen[s]]);
            const comparison under =
                second_order_comparison(comparison_under(&made, (sphg_policy)policy, .0625));
            for (int isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
                comparison on = under; /* and its reference */
                on.context = setup_watched_context_on((sphg_isa)isa);
                if (!on.context)
                    continue;
                on.neighbors = setup_neighbors(on.context, test, &on.scheme, &on.points);
                const int n = on.points.count,
                          width = 1 + test->dimension * second_order_pairs(test->dimension);
                double *lent = test_memory((size_t)(n * width) * sizeof *lent);
                random_state random = random_seeded(8);
                for (int k = 0; k < n * width; ++k)
                    lent[k] = (double)(float)random_between(&random, k % width ? -9 : 0,
                                                            k % width ? 9 : 1);
                const setup_array given = setup_numbers(test_field_type(test), n, width, lent);
                const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 5);
                const second_order found =
                    apply(&on, SPHG_VECTOR, numbers, (second_order_how){.lent = &given});
                for (int i = 0; i < n; i += 1 + n / 4) {
                    compare(&on, SPHG_VECTOR, &found, numbers, lent, i);
                    compare_offer(&on, &found, lent, i);
                }
            }
        }
}

/* ---- Exactness ------------------------------------------------------------------------------- */

static double distance_from_exact(const comparison *on, const second_order *found, int i)
{
    const int d = on->points.dimension;
    double slope[3], square = 0;
    second_order_slope_at(&on->points, i, slope);
    for (int a = 0; a < d; ++a)
        square += pow(setup_get(&found->gradient, i, a) - slope[a], 2);
    for (int k = 0; k < second_order_pairs(d); ++k)
        square += pow(on->scheme.support_radius *
                          (setup_get(&found->hessian, i, k) - second_order_second[k]),
                      2);
    return sqrt(square);
}

static int exact_ones(const comparison *on, const second_order *found)
{
    int count = 0;
    for (int i = 0; i < on->points.count; ++i)
        count += distance_from_exact(on, found, i) < 1e-10;
    return count;
}

/* Who is exact alone: all inside; with lenders beside it: all but the corners of a corner; then
 * all. */
static void quadratic_fields_are_exact_where_lenders_are(const test_case *test)
{
    const int d = test->dimension, per_axis = d == 3 ? 12 : 16;
    const comparison on = lattice_block_of(test, per_axis, 2, 0);
    const double *numbers = second_order_polynomial(&on.points, 2);
    const second_order first = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const second_order second =
        apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &first.curvature});
    const second_order third =
        apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &second.curvature});
    const int counts[] = {exact_ones(&on, &first), exact_ones(&on, &second),
                          exact_ones(&on, &third)};
    const int all = on.points.count, before = d == 3 ? 1000 : 196, after = d == 3 ? 1720 : all;
    TEST_REQUIRE(counts[0] == before && counts[1] == after && counts[2] == all, "%d, %d, %d of %d",
                 counts[0], counts[1], counts[2], all);
}

/* Where particles are lost in a crowd of unlike neighbours, too. */
static void each_pass_makes_more_exact(const test_case *test)
{
    random_state random = random_seeded(3);
    const int d = test->dimension;
    const comparison on = second_order_comparison(
        comparison_of(test, "surface", cloud_free_surface(d, d == 2 ? 12 : 7, .25, &random), .5));
    const double *numbers = second_order_polynomial(&on.points, 2);
    second_order found = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    int before = exact_ones(&on, &found);
    const int first = before;
    for (int pass = 0; pass < 3; ++pass) {
        const second_order next =
            apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &found.curvature});
        const int now = exact_ones(&on, &next);
        TEST_REQUIRE(now >= before, "%d, then %d in pass %d", before, now, pass);
        before = now;
        found = next;
    }
    TEST_REQUIRE(before > first + on.points.count / 20, "%d, then %d of %d", first, before,
                 on.points.count);
}

static void linear_fields_are_left_alone(const test_case *test)
{
    random_state random = random_seeded(4);
    const int d = test->dimension;
    const comparison on = second_order_comparison(
        comparison_of(test, "jitter", cloud_jittered(d, d == 2 ? 9 : 6, .25, .2, &random), .5));
    const double *numbers = second_order_polynomial(&on.points, 1);
    const second_order first = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const second_order found =
        apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &first.curvature});
    for (int i = 0; i < on.points.count; ++i)
        for (int a = 0; a < d && setup_get(&found.rank, i, 0) >= d; ++a)
            TEST_WITHIN(linear_with_lenders,
                        fabs(setup_get(&found.gradient, i, a) - second_order_slopes[a]) /
                            on.scene.unit,
                        test_text("particle %d", i));
}

/* ---- Nobody, somebody ------------------------------------------------------------------------ */

/* Lenders without confidence, and clouds without lenders. */
static void who_is_lent_nothing_keeps_every_bit(const test_case *test)
{
    const int d = test->dimension;
    random_state random = random_seeded(6);
    const cloud clouds[] = {cloud_jittered(d, d == 2 ? 9 : 5, .25, .2, &random),
                            cloud_plane(d, d == 2 ? 8 : 5, .25),
                            cloud_line(d, 5, .125),
                            cloud_single(d),
                            cloud_pair(d, .3),
                            cloud_coincident(d, 3, 1, .25)};
    for (size_t c = 0; c < sizeof clouds / sizeof *clouds; ++c) {
        const comparison on = second_order_comparison(
            comparison_of(test, test_text("cloud %d", (int)c), clouds[c], .5));
        const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 11);
        const second_order first = apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
        const int width = first.curvature.width;
        double *lent = test_memory((size_t)(on.points.count * width) * sizeof *lent);
        for (int k = 0; k < on.points.count * width && c > 0; ++k)
            lent[k] = setup_get(&first.curvature, k / width, k % width);
        const setup_array given =
            setup_numbers(test_field_type(test), on.points.count, width, lent);
        const second_order found =
            apply(&on, SPHG_VECTOR, numbers, (second_order_how){.lent = &given});
        second_order_require_same_bits(&first, &found, on.name);
        for (int i = 0; i < on.points.count && c > 0; ++i)
            TEST_REQUIRE(setup_get(&found.curvature, i, 0) == 0 &&
                             setup_get(&found.borrows, i, 0) == 1,
                         "particle %d, %s", i, on.name);
    }
}

/* The mask is those who would borrow: others have the same results with lenders, to the bit. */
static void a_mask_of_borrowers_leaves_nothing_out(const test_case *test)
{
    random_state random = random_seeded(7);
    const int d = test->dimension;
    comparison on = second_order_comparison(
        comparison_of(test, "jitter", cloud_jittered(d, d == 2 ? 12 : 7, .25, .3, &random), .5));
    const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 12);
    const second_order first = apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
    const second_order all =
        apply(&on, SPHG_VECTOR, numbers, (second_order_how){.lent = &first.curvature});
    const sphg_subset open = sphg_masked(first.borrows.data, on.points.count);
    const second_order_how some = {.lent = &first.curvature, .subset = &open};
    const second_order masked = apply(&on, SPHG_VECTOR, numbers, some);
    const setup_array positions = setup_positions(test, &on.points);
    sphg_geometry geometry = setup_geometry(test, &on.points, &positions);
    geometry.list_free = 1;
    on.neighbors = setup_search(on.context, &on.scheme, &geometry);
    const second_order anew = apply(&on, SPHG_VECTOR, numbers, some);
    second_order_require_same_bits(&masked, &anew, "list-free");
    const int32_t chosen[] = {0, 7,
                              on.points.count - 1}; /* so few that rows are copied one by one */
    const sphg_subset few = sphg_listed(chosen, 3);
    const second_order apart = apply(&on, SPHG_VECTOR, numbers,
                                     (second_order_how){.lent = &first.curvature, .subset = &few});
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < all.hessian.width; ++c)
            TEST_REQUIRE(setup_get(&apart.hessian, chosen[k], c) ==
                             setup_get(&all.hessian, chosen[k], c),
                         "target %d", chosen[k]);
    int borrowers = 0;
    for (int i = 0; i < on.points.count; ++i) {
        const int borrows = (int)setup_get(&first.borrows, i, 0);
        borrowers += borrows;
        TEST_REQUIRE(borrows || setup_is_canary(&masked.gradient, i), "target %d is written", i);
        const second_order *expected = borrows ? &masked : &first;
        for (int k = 0; k < all.hessian.width; ++k)
            TEST_REQUIRE(setup_get(&all.hessian, i, k) == setup_get(&expected->hessian, i, k),
                         "Hessian of %d", i);
        for (int k = 0; k < all.gradient.width; ++k)
            TEST_REQUIRE(setup_get(&all.gradient, i, k) == setup_get(&expected->gradient, i, k),
                         "gradient of %d", i);
    }
    TEST_REQUIRE(borrowers > 10 && borrowers < on.points.count, "%d of %d borrow", borrowers,
                 on.points.count);
}

/* A call of several fields: one borrows, one does not, and a third has lenders of its own. */
static void fields_borrow_each_for_itself(const test_case *test)
{
    random_state random = random_seeded(9);
    const int d = test->dimension;
    const comparison on = second_order_comparison(
        comparison_of(test, "jitter", cloud_jittered(d, d == 2 ? 9 : 5, .25, .3, &random), .5));
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 13);
    const second_order first = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const second_order second =
        apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &first.curvature});
    const second_order third =
        apply(&on, SPHG_SCALAR, numbers, (second_order_how){.lent = &second.curvature});
    const second_order *const expected[] = {&second, &first, &third};
    const setup_array *const lent[] = {&first.curvature, NULL, &second.curvature};
    const setup_array values = setup_numbers(test_field_type(test), on.points.count, 1, numbers);
    const sphg_view at_sources = setup_view(&values);
    sphg_sources sources = comparison_sources(&on);
    sphg_field fields[3];
    sphg_view lenders[3];
    second_order found[3];
    for (int k = 0; k < 3; ++k) {
        found[k] = second_order_outputs(&on, SPHG_SCALAR, 1);
        fields[k] = (sphg_field){.shape = SPHG_SCALAR, .at_sources = &at_sources};
        second_order_ask(&found[k], &fields[k]);
        if (lent[k])
            lenders[k] = setup_view(lent[k]);
        fields[k].lenders = lent[k] ? &lenders[k] : NULL;
    }
    const sphg_request request = {
        .sources = &sources, .fields = fields, .set_count = 1, .field_count = 3};
    SETUP_OK(on.context, sphg_evaluate(on.context, &on.scheme, &request));
    for (int k = 0; k < 3; ++k)
        second_order_require_same_bits(expected[k], &found[k], test_text("field %d", k));
}

/* Particles [first, first + count) as sources of all, which stand apart. */
typedef struct part {
    sphg_sources set;
    sphg_view at_sources, lenders;
} part;

static sphg_view from(sphg_view view, int first)
{
    view.x = (const char *)view.x + first * view.stride;
    return view;
}

static part part_of(const comparison *on, const sphg_view *positions, const sphg_view *values,
                    const setup_array *lent, int first, int count)
{
    part made = {.at_sources = from(*values, first)};
    sphg_geometry geometry =
        sphg_targets_apart(*positions, on->points.count, from(*positions, first), count);
    geometry.precision = test_field_type(on->test);
    made.set.neighbors = setup_search(on->context, &on->scheme, &geometry);
    made.set.volume = from(setup_view(&on->volume), first);
    made.lenders = from(setup_view(lent), first);
    return made;
}

static second_order apply_parts(const comparison *on, const sphg_view *values, const part *parts,
                                int count)
{
    const second_order found = second_order_outputs(on, SPHG_SCALAR, 1);
    sphg_sources sets[2];
    sphg_view at_sources[2], lenders[2];
    for (int s = 0; s < count; ++s)
        sets[s] = parts[s].set, at_sources[s] = parts[s].at_sources, lenders[s] = parts[s].lenders;
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = at_sources, .lenders = lenders};
    second_order_ask(&found, &field);
    field.at_targets = *values;
    sphg_request request = {
        .sources = sets, .fields = &field, .set_count = count, .field_count = 1};
    request.target_volume = setup_view(&on->volume);
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

/* Relative to the largest number. */
static void require_alike(const setup_array *a, const setup_array *b, const char *where)
{
    double largest = 0;
    for (int k = 0; k < a->count * a->width; ++k)
        largest = fmax(largest, fabs(setup_get(a, k / a->width, k % a->width)));
    for (int k = 0; k < a->count * a->width; ++k)
        TEST_WITHIN(lent_by_two_sets,
                    fabs(setup_get(a, k / a->width, k % a->width) -
                         setup_get(b, k / a->width, k % a->width)) /
                        (largest * (a->type == SPHG_F64 ? 0x1p-53 : 0x1p-24)),
                    where);
}

/* Half of the particles each; where a view is absent, or says 0, its set lends nothing. */
static void source_sets_lend_each_for_itself(const test_case *test)
{
    random_state random = random_seeded(10);
    const int d = test->dimension;
    comparison on = second_order_comparison(
        comparison_of(test, "jitter", cloud_jittered(d, d == 2 ? 9 : 5, .25, .2, &random), .5));
    const int n = on.points.count, half = n / 2;
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 14);
    const second_order first = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const setup_array places = setup_positions(test, &on.points);
    const setup_array held = setup_numbers(test_field_type(test), n, 1, numbers);
    const sphg_view positions = setup_view(&places), values = setup_view(&held);
    second_order all[2];
    for (int lend = 0; lend < 2; ++lend) {
        double *lent = setup_doubles(&first.curvature);
        const int width = first.curvature.width;
        for (int k = half * width; k < n * width && !lend; ++k)
            lent[k] = 0;
        const setup_array given = setup_numbers(test_field_type(test), n, width, lent);
        const part whole = part_of(&on, &positions, &values, &given, 0, n);
        part parts[] = {part_of(&on, &positions, &values, &given, 0, half),
                        part_of(&on, &positions, &values, &given, half, n - half)};
        if (!lend)
            parts[1].lenders = sphg_absent();
        all[lend] = apply_parts(&on, &values, &whole, 1);
        const second_order found = apply_parts(&on, &values, parts, 2);
        require_alike(&all[lend].gradient, &found.gradient, "gradient of two sets");
        require_alike(&all[lend].hessian, &found.hessian, "Hessian of two sets");
        require_alike(&all[lend].curvature, &found.curvature, "what two sets lend");
    }
    TEST_REQUIRE(!setup_same_bits(&all[0].gradient, &all[1].gradient),
                 "the second set's loans are not read");
}

/* ---- Continuity ------------------------------------------------------------------------------ */

typedef struct slide {
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    cloud points;
    double (*gradient)[3], (*hessian)[6], (*lent[2])[7], *value;
} slide;

static slide slide_of(const test_case *test, int per_axis)
{
    random_state random = random_seeded(7);
    const int d = test->dimension;
    const cloud block = cloud_jittered(d, per_axis, 1, .15, &random);
    const size_t n = (size_t)block.count + 1;
    slide made = {.context = setup_context_of(1), .scheme = setup_scheme(test, 2)};
    made.scheme.order = 2;
    made.points = (cloud){.dimension = d, .count = (int)n, .spacing = 1};
    made.points.x = test_memory(n * (size_t)d * sizeof(double));
    memcpy(made.points.x, block.x, (n - 1) * (size_t)d * sizeof(double));
    made.gradient = test_memory(n * sizeof *made.gradient);
    made.hessian = test_memory(n * sizeof *made.hessian);
    made.lent[0] = test_memory(n * sizeof *made.lent[0]);
    made.lent[1] = test_memory(n * sizeof *made.lent[1]);
    made.value = test_memory(n * sizeof *made.value);
    SETUP_OK(made.context, sphg_neighbors_create(made.context, &made.neighbors));
    return made;
}

static void evaluate_slide(slide *on, int passes)
{
    const int d = on->points.dimension, n = on->points.count;
    const double one = 1;
    const sphg_sources sources = {.neighbors = on->neighbors, .volume = sphg_same_f64(&one)};
    const sphg_view at_sources = sphg_view_f64(on->value, 8);
    for (int i = 0; i < n; ++i) {
        const double *x = on->points.x + i * d, y = x[1], z = d == 3 ? x[2] : 0;
        on->value[i] = sin(1.3 * x[0]) + .5 * y * y + .3 * x[0] * y + .4 * z * z - .2 * y * z;
    }
    for (int pass = 0; pass <= passes; ++pass) {
        const sphg_view lenders = sphg_view_f64(on->lent[pass % 2][0], sizeof on->lent[0][0]);
        sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &at_sources};
        field.gradient = sphg_view_f64(on->gradient[0], sizeof on->gradient[0]);
        field.hessian = sphg_view_f64(on->hessian[0], sizeof on->hessian[0]);
        field.curvature = sphg_view_f64(on->lent[(pass + 1) % 2][0], sizeof on->lent[0][0]);
        field.lenders = pass ? &lenders : NULL;
        const sphg_request request = {
            .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
        SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    }
}

/* A particle passes through the block, or along its face; nobody's result may jump. Second
 * derivatives in the units of h, whose basis is some five times longer. */
static double largest_step(const test_case *test, int per_axis, int along, int passes, int steps)
{
    slide on = slide_of(test, per_axis);
    const int d = test->dimension, n = on.points.count, width = d + second_order_pairs(d);
    double(*before)[9] = test_memory((size_t)n * sizeof *before), worst = 0;
    const double h2 = on.scheme.support_radius * on.scheme.support_radius;
    for (int step = 0; step <= steps; ++step) {
        const double at = (double)step / steps;
        const double x[] = {along ? -1.9 : -3 + 3.4 * at, along ? -2.5 + (per_axis + 4) * at : 1.37,
                            .61};
        memcpy(on.points.x + (n - 1) * d, x, (size_t)d * sizeof *x);
        sphg_geometry geometry = sphg_all(sphg_view_f64(on.points.x, 8 * d), n);
        geometry.list_free = 1;
        SETUP_OK(on.context,
                 sphg_neighbors_search(on.context, on.neighbors, &on.scheme, &geometry));
        evaluate_slide(&on, passes);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < width; ++k) {
                const double now = k < d ? on.gradient[i][k] : h2 * on.hessian[i][k - d] / 5;
                if (step)
                    worst = test_larger(worst, fabs(now - before[i][k]));
                before[i][k] = now;
            }
    }
    sphg_neighbors_destroy(on.neighbors);
    return worst;
}

static void a_sliding_neighbour_makes_no_jump(const test_case *test)
{
    static const struct {
        int along, passes;
    } ways[] = {{0, 0}, {0, 1}, {1, 1}, {0, 2}};
    const int fewer = test_reference_stride() > 1 || test->method != SPHG_KGC;
    const int steps = TEST_SANITIZED ? 1000 : fewer ? 2000 : 20000;
    const double most = random_chosen() ? .02 : .01; /* another block: .014 */
    for (int k = 0; k < 4; ++k) {
        const int per_axis = test->dimension == 2 ? 5 : 3;
        const double once = largest_step(test, per_axis, ways[k].along, ways[k].passes, steps / 2);
        const double twice = largest_step(test, per_axis, ways[k].along, ways[k].passes, steps);
        TEST_REQUIRE(twice < most * 20000 / steps && twice < .6 * once, "%g, then %g, %d passes",
                     once, twice, ways[k].passes);
    }
}

/* ---- Degenerate ------------------------------------------------------------------------------ */

/* A plane bent to a parabola along its first axis. */
static cloud bent_sheet(int d, int per_axis, double spacing)
{
    cloud sheet = cloud_plane(d, per_axis, spacing);
    for (int i = 0; i < sheet.count; ++i)
        sheet.x[i * d + d - 1] += .5 * pow(sheet.x[i * d] - .5, 2);
    return sheet;
}

static void require_finite(const setup_array *found, const char *where)
{
    for (int k = 0; k < found->count * found->width; ++k)
        TEST_REQUIRE(isfinite(setup_get(found, k / found->width, k % found->width)), "%s", where);
}

/* All that order 1 is tried with, and a sheet that is curved, under every policy. */
static void nothing_is_ever_infinite(const test_case *test)
{
    random_state random = random_seeded(72);
    const int d = test->dimension, wide = d == 2 ? 12 : 5;
    const cloud clouds[] = {cloud_plane(d, wide, .25),
                            cloud_tilted_plane(d, wide, .25, &random),
                            cloud_line(d, 10, .25),
                            cloud_pair(d, .25),
                            cloud_single(d),
                            cloud_coincident(d, 3, 0, .25),
                            cloud_coincident(d, 3, 1, .25),
                            cloud_sheets(d, wide, .25, .002),
                            bent_sheet(d, wide, .25)};
    for (size_t c = 0; c < sizeof clouds / sizeof *clouds; ++c) {
        const comparison made = comparison_of(test, test_text("cloud %d", (int)c), clouds[c], .625);
        for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
            const comparison on =
                second_order_comparison(comparison_under(&made, (sphg_policy)policy, 0));
            const double *numbers = comparison_random_field(&on, SPHG_VECTOR, 11);
            const setup_array table = comparison_table(&on);
            require_finite(&table, on.name);
            second_order found = apply(&on, SPHG_VECTOR, numbers, (second_order_how){0});
            for (int pass = 0; pass < 3; ++pass) {
                const setup_array *arrays[] = {&found.gradient, &found.hessian, &found.laplacian,
                                               &found.curvature, &found.curl};
                for (int k = 0; k < 5; ++k)
                    require_finite(arrays[k], test_text("result %d of %s, policy %d, pass %d", k,
                                                        on.name, policy, pass));
                found =
                    apply(&on, SPHG_VECTOR, numbers, (second_order_how){.lent = &found.curvature});
            }
        }
    }
}

/* ---- What is refused ------------------------------------------------------------------------- */

static void require_refused(const comparison *on, const sphg_field *field,
                            const sphg_request *asked, const sphg_scheme *scheme, const char *words)
{
    sphg_request request = *asked;
    request.fields = field;
    request.field_count = field ? 1 : 0;
    const sphg_result result = sphg_evaluate(on->context, scheme, &request);
    const char *message = sphg_last_message(on->context);
    TEST_REQUIRE(result == SPHG_ERROR_UNSUPPORTED && strstr(message, words), "%d: %s", (int)result,
                 message);
}

static void what_cannot_be_borrowed_is_refused_by_name(const test_case *test)
{
    random_state random = random_seeded(15);
    const int d = test->dimension;
    const comparison on = second_order_comparison(
        comparison_of(test, "block", cloud_jittered(d, 4, .25, .2, &random), .5));
    const double *numbers = comparison_random_field(&on, SPHG_SCALAR, 16);
    const second_order found = apply(&on, SPHG_SCALAR, numbers, (second_order_how){0});
    const second_order out = second_order_outputs(&on, SPHG_SCALAR, 1);
    const setup_array values = setup_numbers(test_field_type(test), on.points.count, 1, numbers);
    const setup_array table = comparison_table(&on);
    const sphg_view at_sources = setup_view(&values), lenders = setup_view(&found.curvature);
    const sphg_sources sources = comparison_sources(&on);
    sphg_scheme first = on.scheme;
    first.order = 1;
    sphg_request request = {.sources = &sources, .set_count = 1};
    sphg_field lends = {.shape = SPHG_SCALAR, .at_sources = &at_sources};
    sphg_field borrows = lends;
    lends.curvature = setup_view(&out.curvature);
    borrows.gradient = setup_view(&out.gradient);
    borrows.lenders = &lenders;
    require_refused(&on, &lends, &request, &first, "fields[0].curvature needs scheme.order 2");
    require_refused(&on, &borrows, &request, &first, "fields[0].lenders needs scheme.order 2");
    request.target_correction = setup_view(&table);
    require_refused(&on, &lends, &request, &on.scheme, "curvature beside a table");
    require_refused(&on, &borrows, &request, &on.scheme, "lenders beside a table");
    request.target_correction = sphg_absent();
    const setup_array wanted_table =
        setup_output(test_field_type(test), on.points.count, table.width);
    request.correction = setup_view(&wanted_table);
    require_refused(&on, &borrows, &request, &on.scheme, "lenders beside a wanted correction");
    request.correction = sphg_absent();
    for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
        lends.form = borrows.form = (sphg_form)form;
        require_refused(&on, &lends, &request, &on.scheme, "difference form");
        require_refused(&on, &borrows, &request, &on.scheme, "difference form");
    }
    request.borrows = setup_view(&out.borrows);
    require_refused(&on, NULL, &request, &first, "borrows needs scheme.order 2");
}

static const test_entry entries[] = {
    TEST_ENTRY(results_match_the_oracle, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED,
               0),
    TEST_ENTRY(every_policy_and_instruction_set_matches_the_oracle, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(quadratic_fields_are_exact_where_lenders_are, TEST_BIT(TEST_F64),
               TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(each_pass_makes_more_exact, TEST_BIT(TEST_F64), TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(linear_fields_are_left_alone, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(who_is_lent_nothing_keeps_every_bit, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(a_mask_of_borrowers_leaves_nothing_out, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(fields_borrow_each_for_itself, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(source_sets_lend_each_for_itself, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(a_sliding_neighbour_makes_no_jump, 0, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM), 0),
    TEST_ENTRY(nothing_is_ever_infinite, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED,
               0),
    TEST_ENTRY(what_cannot_be_borrowed_is_refused_by_name, TEST_ALL_PRECISIONS, 0, 0, 0),
};
TEST_MAIN(entries)
