/* SPDX-License-Identifier: MIT */
#include "comparison.h"
#include <math.h>
#include <string.h>

/* Until the test case ends. */
void *oracle_memory(size_t bytes)
{
    return test_memory(bytes);
}

/* All but the neighbours, volumes and the reference. */
static comparison set_up(const test_case *test, const char *name, cloud points, double support,
                         random_state *random)
{
    comparison made = {.test = test, .name = name, .points = points};
    made.scheme = setup_scheme(test, support);
    made.context = setup_context();
    oracle_scene *scene = &made.scene;
    scene->scheme = made.scheme;
    scene->unit = test_unit_roundoff(test);
    scene->single_positions = test_position_type(test) == SPHG_F32;
    scene->source_count = scene->target_count = points.count;
    scene->sources = made.points.x;
    double *density = cloud_numbers(&points, .5, 1.5, random);
    scene->density = density;
    made.density = setup_numbers(test_field_type(test), points.count, 1, density);
    return made;
}

comparison comparison_of(const test_case *test, const char *name, cloud points, double support)
{
    random_state random = random_seeded(77);
    comparison made = set_up(test, name, points, cloud_rounded(support), &random);
    made.neighbors = setup_neighbors(made.context, test, &made.scheme, &made.points);
    return comparison_with_volumes(&made, cloud_volumes(&points, .2, &random));
}

comparison comparison_of_radii(const test_case *test, const char *name, cloud points, double *radii,
                               int mutual)
{
    random_state random = random_seeded(78);
    comparison made = set_up(test, name, points, 0, &random);
    double *volume = cloud_volumes(&points, .2, &random);
    for (int i = 0; i < points.count; ++i) {
        radii[i] = cloud_rounded(radii[i]);
        volume[i] = cloud_rounded(volume[i] * pow(radii[i] / points.spacing, points.dimension));
    }
    setup_array positions = setup_positions(test, &made.points);
    setup_array supports = setup_numbers(test_position_type(test), points.count, 1, radii);
    sphg_geometry geometry = setup_geometry(test, &made.points, &positions);
    geometry.source_support = setup_view(&supports);
    geometry.mutual = mutual;
    made.neighbors = setup_search(made.context, &made.scheme, &geometry);
    made.scene.support = radii;
    made.scene.mutual = mutual;
    return comparison_with_volumes(&made, volume);
}

comparison comparison_with_volumes(const comparison *made, const double *volume)
{
    comparison other = *made;
    other.scene.volume = volume;
    other.volume = setup_numbers(test_field_type(made->test), made->points.count, 1, volume);
    other.reference = oracle_of(&other.scene);
    return other;
}

comparison comparison_under(const comparison *made, sphg_policy policy, double threshold)
{
    comparison other = *made;
    other.scheme.policy = policy;
    other.scheme.threshold = threshold;
    other.scene.scheme = other.scheme;
    other.reference = oracle_of(&other.scene);
    return other;
}

sphg_sources comparison_sources(const comparison *on)
{
    sphg_sources sources = {0};
    sources.neighbors = on->neighbors;
    sources.volume = setup_view(&on->volume);
    sources.density = setup_view(&on->density);
    return sources;
}

setup_array comparison_table(const comparison *on)
{
    int width = sphg_correction_width(&on->scheme);
    setup_array table = setup_output(test_field_type(on->test), on->points.count, width);
    sphg_sources sources = comparison_sources(on);
    if (width > 0)
        SETUP_OK(on->context, sphg_correction(on->context, &on->scheme, &sources, NULL,
                                              setup_view(&table), sphg_absent()));
    return table;
}

sphg_view comparison_table_view(const comparison *on, const setup_array *table)
{
    return table && on->scheme.method != SPHG_PLAIN ? setup_view(table) : sphg_absent();
}

double *comparison_random_field(const comparison *on, sphg_shape shape, uint64_t seed)
{
    int total = on->points.count * setup_width(shape, on->points.dimension);
    double *numbers = test_memory((size_t)total * sizeof *numbers);
    random_state random = random_seeded(seed);
    for (int k = 0; k < total; ++k)
        numbers[k] = (double)(float)random_between(&random, -1, 1);
    return numbers;
}

/* ---- Evaluation ----------------------------------------------------------------------------- */

static int gradient_width(sphg_shape shape, int d)
{
    return shape == SPHG_SCALAR ? d : shape == SPHG_VECTOR ? d * d : 0;
}

static int divergence_width(sphg_shape shape, int d)
{
    return shape == SPHG_SCALAR ? 0 : shape == SPHG_VECTOR ? 1 : d;
}

static int curl_width(sphg_shape shape, int d)
{
    return shape == SPHG_VECTOR ? (d == 2 ? 1 : 3) : 0;
}

static sphg_view wanted(const setup_array *array)
{
    return array->width ? setup_view(array) : sphg_absent();
}

comparison_result comparison_outputs(const comparison *on, const comparison_field *field,
                                     int targets)
{
    int n = targets, d = on->points.dimension;
    sphg_type type = test_field_type(on->test);
    int value_width = field->form == SPHG_DIRECT ? setup_width(field->shape, d) : 0;
    int square_width = field->form == SPHG_DIRECT && field->shape == SPHG_SCALAR;
    comparison_result result = {setup_output(type, n, gradient_width(field->shape, d)),
                                setup_output(type, n, divergence_width(field->shape, d)),
                                setup_output(type, n, curl_width(field->shape, d)),
                                setup_output(type, n, value_width),
                                setup_output(type, n, square_width)};
    return result;
}

void comparison_ask_for(const comparison_result *outputs, sphg_field *asked)
{
    asked->gradient = wanted(&outputs->gradient);
    asked->divergence = wanted(&outputs->divergence);
    asked->curl = wanted(&outputs->curl);
    asked->value = wanted(&outputs->value);
    asked->square = wanted(&outputs->square);
}

/* asks: a bit per result */
static comparison_result evaluate(const comparison *on, const comparison_field *field,
                                  const setup_array *table, const sphg_subset *subset,
                                  unsigned asks)
{
    int width = setup_width(field->shape, on->points.dimension);
    setup_array numbers =
        setup_numbers(test_field_type(on->test), on->points.count, width, field->numbers);
    sphg_view at_sources = setup_view(&numbers);
    comparison_result result = comparison_outputs(on, field, on->points.count);
    sphg_sources sources = comparison_sources(on);
    sources.correction = comparison_table_view(on, table);
    sphg_field asked = {.shape = field->shape, .form = field->form, .at_sources = &at_sources};
    comparison_ask_for(&result, &asked);
    sphg_view *const views[] = {&asked.gradient, &asked.divergence, &asked.curl, &asked.value,
                                &asked.square};
    for (int k = 0; k < 5; ++k)
        if (!(asks >> k & 1))
            *views[k] = sphg_absent();
    sphg_request request = {.sources = &sources, .fields = &asked, .set_count = 1};
    request.field_count = 1;
    request.subset = subset;
    request.target_correction = sources.correction;
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return result;
}

comparison_result comparison_apply_to(const comparison *on, const comparison_field *field,
                                      const setup_array *table, const sphg_subset *subset)
{
    return evaluate(on, field, table, subset, ~0u);
}

comparison_result comparison_apply_alone(const comparison *on, const comparison_field *field,
                                         const setup_array *table, int which)
{
    return evaluate(on, field, table, NULL, 1u << which);
}

comparison_result comparison_apply(const comparison *on, const comparison_field *field,
                                   const setup_array *table)
{
    return comparison_apply_to(on, field, table, NULL);
}

int comparison_results_have_same_bits(const comparison_result *a, const comparison_result *b)
{
    return setup_same_bits(&a->gradient, &b->gradient) &&
           setup_same_bits(&a->divergence, &b->divergence) && setup_same_bits(&a->curl, &b->curl) &&
           setup_same_bits(&a->value, &b->value) && setup_same_bits(&a->square, &b->square);
}

/* ---- Comparison ------------------------------------------------------------------------------ */

double comparison_ratio(const setup_array *found, int item, const quad *exact, quad bound)
{
    double numbers[16];
    for (int k = 0; k < found->width; ++k)
        numbers[k] = setup_get(found, item, k);
    return oracle_ratio(found->width, numbers, exact, bound);
}

static void gate(const comparison *on, const char *what, double ratio, int touched, int i)
{
    const test_case *test = on->test;
    const char *where = test_text("%s of particle %d, %s, %s %dD %s", what, i, on->name,
                                  test_method_name(test->method), test->dimension,
                                  test->precision == TEST_F32   ? "f32"
                                  : test->precision == TEST_F64 ? "f64"
                                                                : "mixed");
    if (touched)
        TEST_WITHIN(oracle_ratio_touched, ratio, where);
    else
        TEST_WITHIN(oracle_ratio_full, ratio, where);
}

void comparison_compare(const comparison *on, const comparison_field *field,
                        const comparison_result *found, int i)
{
    oracle_field asked = {field->shape, field->form, field->numbers, NULL};
    oracle_result exact = oracle_apply(on->reference, &asked, i);
    if (exact.undecided)
        return;
    static const char *const forms[] = {"difference", "direct", "symmetric", "adjoint"};
    const struct {
        const char *what;
        const setup_array *array;
        const quad *numbers;
        quad bound;
    } rows[] = {{"gradient", &found->gradient, exact.gradient, exact.bound},
                {"divergence", &found->divergence, exact.divergence, exact.bound},
                {"curl", &found->curl, exact.curl, exact.bound},
                {"value", &found->value, exact.value, exact.value_bound},
                {"square", &found->square, &exact.square, exact.square_bound}};
    for (int k = 0; k < 5; ++k)
        if (rows[k].array->width > 0)
            gate(on, test_text("%s %s", forms[field->form], rows[k].what),
                 comparison_ratio(rows[k].array, i, rows[k].numbers, rows[k].bound), exact.touched,
                 i);
}
