/* SPDX-License-Identifier: MIT */
#include "second_order.h"
#include <string.h>

comparison second_order_comparison(comparison on)
{
    on.scheme.order = 2;
    return on;
}

second_order second_order_outputs(const comparison *on, sphg_shape shape, int lends)
{
    const int n = on->points.count, d = on->points.dimension, width = setup_width(shape, d);
    const sphg_type type = test_field_type(on->test);
    const int tensor = shape >= SPHG_SYM_TENSOR, vector = shape == SPHG_VECTOR;
    return (second_order){
        .gradient = setup_output(type, n, tensor ? 0 : width * d),
        .divergence = setup_output(type, n, tensor ? d : vector),
        .curl = setup_output(type, n,
                             !vector  ? 0
                             : d == 2 ? 1
                                      : 3),
        .hessian = setup_output(type, n, tensor ? 0 : width * second_order_pairs(d)),
        .laplacian = setup_output(type, n, width),
        .curvature = setup_output(type, n, lends ? 1 + width * second_order_pairs(d) : 0),
        .rank = setup_output(SPHG_U8, n, 1),
        .borrows = setup_output(SPHG_U8, n, lends ? 1 : 0),
        .table = setup_output(type, n, lends ? 0 : sphg_correction_width(&on->scheme)),
    };
}

static sphg_view wanted(const setup_array *array)
{
    return array->width ? setup_view(array) : sphg_absent();
}

void second_order_ask(const second_order *outputs, sphg_field *field)
{
    field->gradient = wanted(&outputs->gradient);
    field->divergence = wanted(&outputs->divergence);
    field->curl = wanted(&outputs->curl);
    field->hessian = wanted(&outputs->hessian);
    field->laplacian = wanted(&outputs->laplacian);
    field->curvature = wanted(&outputs->curvature);
}

second_order second_order_apply(const comparison *on, sphg_shape shape, const double *numbers,
                                second_order_how how)
{
    const int width = setup_width(shape, on->points.dimension);
    second_order found = second_order_outputs(on, shape, how.lends);
    const setup_array values =
        setup_numbers(test_field_type(on->test), on->points.count, width, numbers);
    const sphg_view at_sources = setup_view(&values);
    const sphg_view lenders = how.lent ? setup_view(how.lent) : sphg_absent();
    const sphg_sources sources = comparison_sources(on);
    sphg_field field = {.shape = shape, .at_sources = &at_sources};
    second_order_ask(&found, &field);
    field.lenders = how.lent ? &lenders : NULL;
    sphg_request request = {.sources = &sources, .fields = &field, .set_count = 1};
    request.field_count = 1;
    request.subset = how.subset;
    request.borrows = wanted(&found.borrows);
    if (how.table) {
        request.target_correction = setup_view(how.table);
    } else if (!how.no_table) {
        request.correction = wanted(&found.table);
        request.rank = setup_view(&found.rank);
        request.stats = &found.stats;
    }
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}

void second_order_require_same_bits(const second_order *a, const second_order *b, const char *where)
{
    TEST_REQUIRE(setup_same_bits(&a->gradient, &b->gradient), "gradient, %s", where);
    TEST_REQUIRE(setup_same_bits(&a->divergence, &b->divergence), "divergence, %s", where);
    TEST_REQUIRE(setup_same_bits(&a->curl, &b->curl), "curl, %s", where);
    TEST_REQUIRE(setup_same_bits(&a->hessian, &b->hessian), "Hessian, %s", where);
    TEST_REQUIRE(setup_same_bits(&a->laplacian, &b->laplacian), "Laplacian, %s", where);
    TEST_REQUIRE(setup_same_bits(&a->curvature, &b->curvature), "curvature, %s", where);
}

double second_order_ratio(const setup_array *found, int i, const quad *exact, quad bound)
{
    double numbers[27];
    for (int k = 0; k < found->width; ++k)
        numbers[k] = setup_get(found, i, k);
    return oracle_ratio(found->width, numbers, exact, bound);
}

void second_order_compare(const comparison *on, const second_order *found,
                          const oracle_curved *exact, int i, test_tolerance tolerance)
{
    const struct {
        const char *what;
        const setup_array *array;
        const quad *numbers;
        quad bound;
    } rows[] = {{"gradient", &found->gradient, exact->gradient, exact->gradient_bound},
                {"divergence", &found->divergence, exact->divergence, exact->gradient_bound},
                {"curl", &found->curl, exact->curl, exact->gradient_bound},
                {"Hessian", &found->hessian, exact->hessian, exact->hessian_bound},
                {"Laplacian", &found->laplacian, exact->laplacian, exact->hessian_bound}};
    for (int k = 0; k < 5 && !exact->undecided; ++k)
        test_within(tolerance, second_order_ratio(rows[k].array, i, rows[k].numbers, rows[k].bound),
                    test_text("%s of particle %d, %s, %s", rows[k].what, i, on->name,
                              test_method_name(on->test->method)));
}

const double second_order_slopes[3] = {3, -2, 1}, second_order_second[6] = {2, -4, 6, 4, -2, 8};

double *second_order_polynomial(const cloud *points, int degree)
{
    const int d = points->dimension;
    double *numbers = test_memory((size_t)points->count * sizeof *numbers);
    for (int i = 0; i < points->count; ++i) {
        const double *x = points->x + i * d;
        for (int a = 0, k = 0; a < d; ++a) {
            numbers[i] += second_order_slopes[a] * x[a];
            for (int b = a; degree == 2 && b < d; ++b, ++k)
                numbers[i] += second_order_second[k] * x[a] * x[b] * (a == b ? .5 : 1);
        }
    }
    return numbers;
}

void second_order_slope_at(const cloud *points, int i, double *gradient)
{
    const int d = points->dimension;
    const double *x = points->x + i * d;
    memcpy(gradient, second_order_slopes, (size_t)d * sizeof *gradient);
    for (int a = 0, k = 0; a < d; ++a)
        for (int b = a; b < d; ++b, ++k) {
            gradient[a] += second_order_second[k] * x[b];
            gradient[b] += a == b ? 0 : second_order_second[k] * x[a];
        }
}

void second_order_require_table_has_all(const comparison *on)
{
    const double *numbers = comparison_random_field(on, SPHG_VECTOR, 6);
    const second_order fused =
        second_order_apply(on, SPHG_VECTOR, numbers, (second_order_how){.no_table = 1});
    const second_order found = second_order_apply(on, SPHG_VECTOR, numbers, (second_order_how){0});
    const second_order read =
        second_order_apply(on, SPHG_VECTOR, numbers, (second_order_how){.table = &found.table});
    second_order_require_same_bits(&fused, &found, on->name);
    second_order_require_same_bits(&found, &read, on->name);
}
