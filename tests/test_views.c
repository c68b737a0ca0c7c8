/* SPDX-License-Identifier: MIT */
/* Views: the same numbers in any layout give the same bits, land where the view says, and leave
 * every other byte alone. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>

enum { COUNT = 150, CANARY = 0xA5 };

/* ---- Layouts ------------------------------------------------------------------------------ */

typedef enum layout {
    PACKED,         /* items one after another */
    RECORD,         /* inside larger items */
    REVERSED,       /* the last item first */
    SEPARATE,       /* components, or rows of a tensor, in arrays of their own */
    SEPARATE_BACK,  /* these, back to front */
    THREE_BY_THREE, /* rows three numbers apart: 2 x 2 results in 3 x 3 storage */
    BY_COLUMNS,     /* tensors column by column, symmetric ones and linear corrections in full */
    COLUMNS_APART,  /* columns of a tensor in arrays of their own, back to front */
    LAYOUTS
} layout;

static const char *const layout_names[LAYOUTS] = {"packed",     "record",         "reversed",
                                                  "separate",   "separate, back", "3 x 3",
                                                  "by columns", "columns apart"};

/* Memory of count items of height x columns numbers, and the view that finds them. */
typedef struct placed {
    sphg_view view;
    int height, columns;
    int side; /* of symmetric matrices, of which `columns` numbers count */
    unsigned char *memory;
    size_t bytes, size;
} placed;

static int has_rows(layout kind, int height)
{
    return kind >= SEPARATE && kind != BY_COLUMNS && height > 1;
}

static int is_full(layout kind, int side)
{
    return kind == BY_COLUMNS && side > 0;
}

/* Where the first item's row starts, in numbers, and how far apart items are. */
static ptrdiff_t row_start(layout kind, int row, int columns)
{
    return kind == THREE_BY_THREE ? 3 * row : (ptrdiff_t)row * COUNT * columns;
}

static ptrdiff_t item_step(layout kind, int height, int columns)
{
    if (has_rows(kind, height))
        return kind == THREE_BY_THREE ? 11 : columns;
    return kind == PACKED ? (ptrdiff_t)height * columns : (ptrdiff_t)height * columns + 3;
}

static placed place_matrix(sphg_type type, int height, int columns, int side, layout kind)
{
    placed own = {.height = height, .columns = columns, .side = side};
    own.size = type == SPHG_F64 ? 8 : type == SPHG_F32 ? 4 : 1;
    own.bytes = (size_t)COUNT * 20 * own.size;
    own.memory = memset(test_memory(own.bytes), CANARY, own.bytes);
    const int backwards = kind == REVERSED || kind == SEPARATE_BACK || kind == COLUMNS_APART;
    const int full = is_full(kind, side);
    const ptrdiff_t size = (ptrdiff_t)own.size;
    const ptrdiff_t step = item_step(kind, full ? side : height, full ? side : columns) * size;
    unsigned char *first = own.memory + size + (backwards ? (COUNT - 1) * step : 0);
    own.view = (sphg_view){first, NULL, NULL, backwards ? -step : step, type, SPHG_AS_SHAPE};
    if (has_rows(kind, height)) {
        const void *y = first + row_start(kind, 1, columns) * size;
        const void *z = height > 2 ? first + row_start(kind, 2, columns) * size : NULL;
        own.view = type == SPHG_F64 ? sphg_xyz_f64((const void *)first, y, z, own.view.stride)
                                    : sphg_xyz_f32((const void *)first, y, z, own.view.stride);
    }
    if (kind >= BY_COLUMNS && height > 1 && columns == height)
        own.view.layout = SPHG_COLUMN_MAJOR;
    if (full)
        own.view.layout = SPHG_FULL;
    return own;
}

static placed place(sphg_type type, int height, int columns, layout kind)
{
    return place_matrix(type, height, columns, 0, kind);
}

/* Number of the item, in its memory, that is this component of a symmetric matrix; mirrored: below
 * the diagonal. */
static int number_in_full(int component, int side, int mirrored)
{
    int row = 0;
    while (component >= side - row)
        component -= side - row++;
    return mirrored ? (row + component) * side + row : row * side + row + component;
}

static int number_of(const placed *own, int component, int mirrored)
{
    if (own->view.layout == SPHG_COLUMN_MAJOR)
        return component % own->columns * own->columns + component / own->columns;
    if (own->view.layout == SPHG_FULL)
        return number_in_full(component, own->side, mirrored);
    return component;
}

static unsigned char *address_of(const placed *own, int item, int component, int mirrored)
{
    const void *const starts[3] = {own->view.x, own->view.y, own->view.z};
    const int number = number_of(own, component, mirrored);
    const int row = own->view.y ? number / own->columns : 0;
    const int column = number - row * own->columns;
    return (unsigned char *)(uintptr_t)starts[row] + item * own->view.stride +
           (ptrdiff_t)own->size * column;
}

static unsigned char *address(const placed *own, int item, int component)
{
    return address_of(own, item, component, 0);
}

/* A copy of packed numbers in another layout. What a symmetric matrix holds below its diagonal is
 * not read. */
static sphg_view laid_out_matrix(const setup_array *array, int height, int side, layout kind)
{
    const placed own = place_matrix(array->type, height, array->width / height, side, kind);
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < array->width; ++k)
            memcpy(address(&own, i, k),
                   (const char *)array->data + (size_t)(i * array->width + k) * own.size, own.size);
    return own.view;
}

static sphg_view laid_out(const setup_array *array, int height, layout kind)
{
    return laid_out_matrix(array, height, 0, kind);
}

/* Equal to the packed results where the view points, canaries elsewhere. */
static void require_placed(const placed *found, const placed *packed, const char *where)
{
    const int width = found->height * found->columns;
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < width; ++k) {
            TEST_REQUIRE(memcmp(address(found, i, k), address(packed, i, k), found->size) == 0,
                         "%s: item %d, number %d", where, i, k);
            TEST_REQUIRE(memcmp(address_of(found, i, k, 1), address(packed, i, k), found->size) ==
                             0,
                         "%s: item %d, number %d below the diagonal", where, i, k);
        }
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < 2 * width; ++k)
            memset(address_of(found, i, k / 2, k % 2), CANARY, found->size);
    for (size_t k = 0; k < found->bytes; ++k)
        TEST_REQUIRE(found->memory[k] == CANARY, "%s: byte %zu is not part of the view", where, k);
}

/* ---- One evaluation in two layouts -------------------------------------------------------- */

typedef struct comparison {
    sphg_context *context;
    int dimension;
    sphg_scheme scheme;
    scene particles;
    setup_array positions, scalar, vector, symmetric, tensor, volume;
} comparison;

static setup_array numbers_of(const test_case *test, int width, double low, random_state *random)
{
    double *numbers = test_memory((size_t)(COUNT * width) * sizeof *numbers);
    for (int k = 0; k < COUNT * width; ++k)
        numbers[k] = random_between(random, low, 1);
    return setup_numbers(test_field_type(test), COUNT, width, numbers);
}

static comparison comparison_of(const test_case *test)
{
    const int d = test->dimension;
    random_state random = random_seeded(127);
    comparison own = {.context = setup_context(), .dimension = d};
    cloud points = cloud_random(d, COUNT, d == 2 ? 12 : 5, &random);
    own.particles = scene_of_cloud(test, &points);
    own.scheme = setup_scheme(test, 2);
    own.positions = setup_numbers(test_position_type(test), COUNT, d, points.x);
    own.scalar = numbers_of(test, 1, -1, &random);
    own.vector = numbers_of(test, d, -1, &random);
    own.tensor = numbers_of(test, d * d, -1, &random);
    own.symmetric = numbers_of(test, d * (d + 1) / 2, -1, &random);
    own.volume = numbers_of(test, 1, 0.5, &random);
    return own;
}

enum {
    GRADIENT,
    JACOBIAN,
    DIVERGENCE,
    CURL,
    TENSOR_DIVERGENCE,
    SYMMETRIC_DIVERGENCE,
    SYMMETRIC_VALUE,
    CORRECTION,
    LAMBDA,
    RANK,
    OUTPUTS
};

typedef struct outputs {
    placed of[OUTPUTS];
} outputs;

static outputs place_outputs(const comparison *own, layout kind)
{
    const int d = own->dimension, curl = d == 2 ? 1 : 3;
    const int width = sphg_correction_width(&own->scheme);
    const int linear = own->scheme.method <= SPHG_RKPM, whole = kind == BY_COLUMNS && linear;
    const sphg_type type = own->scalar.type;
    return (outputs){{place(type, d, 1, kind), place(type, d, d, kind), place(type, 1, 1, kind),
                      place(type, curl, 1, kind), place(type, d, 1, kind), place(type, d, 1, kind),
                      place_matrix(type, 1, d * (d + 1) / 2, d, kind),
                      place_matrix(type, 1, width, linear ? d : 0,
                                   kind == PACKED ? PACKED
                                   : whole        ? BY_COLUMNS
                                                  : RECORD),
                      place(type, 1, 1, kind), place(SPHG_U8, 1, 1, kind)}};
}

/* Inputs, positions included, in one layout and outputs in another. */
static outputs evaluate(const comparison *own, layout in, layout out)
{
    const int d = own->dimension;
    outputs found = place_outputs(own, out);
    const sphg_view scalar = laid_out(&own->scalar, 1, in), vector = laid_out(&own->vector, d, in);
    const sphg_view tensor = laid_out(&own->tensor, d, in);
    const sphg_view symmetric = laid_out_matrix(&own->symmetric, 1, d, in);
    sphg_geometry geometry = scene_geometry(&own->particles);
    geometry.sources = laid_out(&own->positions, d, in);
    sphg_sources sources = {0};
    sources.neighbors = setup_search(own->context, &own->scheme, &geometry);
    sources.volume = laid_out(&own->volume, 1, in);
    const sphg_field fields[] = {
        {.shape = SPHG_SCALAR, .at_sources = &scalar, .gradient = found.of[GRADIENT].view},
        {.shape = SPHG_VECTOR,
         .at_sources = &vector,
         .gradient = found.of[JACOBIAN].view,
         .divergence = found.of[DIVERGENCE].view,
         .curl = found.of[CURL].view},
        {.shape = SPHG_TENSOR,
         .at_sources = &tensor,
         .divergence = found.of[TENSOR_DIVERGENCE].view},
        {.shape = SPHG_SYM_TENSOR,
         .at_sources = &symmetric,
         .value = found.of[SYMMETRIC_VALUE].view,
         .divergence = found.of[SYMMETRIC_DIVERGENCE].view}};
    const sphg_request request = {.sources = &sources,
                                  .set_count = 1,
                                  .fields = fields,
                                  .field_count = 4,
                                  .correction = found.of[CORRECTION].view,
                                  .rank = found.of[RANK].view,
                                  .lambda_min = found.of[LAMBDA].view};
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    return found;
}

static void layouts_hold_the_same_bits(const test_case *test)
{
    const comparison own = comparison_of(test);
    const outputs packed = evaluate(&own, PACKED, PACKED);
    for (int in = 0; in < LAYOUTS; ++in)
        for (int out = 0; out < LAYOUTS; ++out) {
            const outputs found = evaluate(&own, (layout)in, (layout)out);
            for (int k = 0; k < OUTPUTS; ++k)
                require_placed(
                    &found.of[k], &packed.of[k],
                    test_text("%s to %s, output %d", layout_names[in], layout_names[out], k));
        }
}

/* ---- Layouts that mean nothing ------------------------------------------------------------ */

static void require_refused(const comparison *own, const sphg_request *request, const char *words)
{
    const sphg_result result = sphg_evaluate(own->context, &own->scheme, request);
    TEST_REQUIRE(result == SPHG_ERROR_ARGUMENT, "%s: %d", words, (int)result);
    TEST_REQUIRE(strstr(sphg_last_message(own->context), words), "'%s' does not say '%s'",
                 sphg_last_message(own->context), words);
}

static void layouts_without_a_meaning_are_refused(const test_case *test)
{
    const comparison own = comparison_of(test);
    const int d = test->dimension, linear = test->method <= SPHG_RKPM;
    const int width = sphg_correction_width(&own.scheme);
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_sources sources = {.neighbors = setup_search(own.context, &own.scheme, &geometry),
                                  .volume = setup_view(&own.volume)};
    setup_array result = setup_output(own.scalar.type, COUNT, 9);
    setup_array table = setup_output(own.scalar.type, COUNT, width < 9 ? 9 : width);
    sphg_view values = setup_view(&own.scalar);
    sphg_field field = {
        .shape = SPHG_SCALAR, .at_sources = &values, .gradient = setup_view(&result)};
    sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    field.gradient.layout = SPHG_COLUMN_MAJOR;
    require_refused(&own, &request, "fields[0].gradient.layout is COLUMN_MAJOR, but");
    field.gradient.layout = SPHG_FULL;
    require_refused(&own, &request, "fields[0].gradient.layout is FULL, but");
    field.shape = SPHG_VECTOR;
    values = setup_view(&own.vector);
    require_refused(&own, &request, "fields[0].gradient.layout is FULL, but");
    field.gradient.layout = (sphg_layout)3;
    require_refused(&own, &request, "fields[0].gradient.layout is 3");
    field.gradient.layout = SPHG_COLUMN_MAJOR;
    SETUP_OK(own.context, sphg_evaluate(own.context, &own.scheme, &request));
    field.gradient.stride = (d * d - 1) * setup_view(&own.scalar).stride;
    require_refused(&own, &request, "stride");
    request.fields = NULL, request.field_count = 0;
    request.correction = setup_view(&table);
    request.correction.layout = SPHG_COLUMN_MAJOR;
    require_refused(&own, &request, "correction.layout is COLUMN_MAJOR, but");
    request.correction.layout = SPHG_FULL;
    if (linear)
        SETUP_OK(own.context, sphg_evaluate(own.context, &own.scheme, &request));
    else
        require_refused(&own, &request, "correction.layout is FULL, but");
    request.correction.stride = (d * d - 1) * setup_view(&own.scalar).stride;
    require_refused(&own, &request, linear ? "stride" : "layout");
}

/* ---- Stride 0 ----------------------------------------------------------------------------- */

static setup_array repeated(const setup_array *first)
{
    double numbers[COUNT * 9];
    for (int k = 0; k < COUNT * first->width; ++k)
        numbers[k] = setup_get(first, 0, k % first->width);
    return setup_numbers(first->type, COUNT, first->width, numbers);
}

static sphg_view single(const setup_array *array)
{
    sphg_view view = setup_view(array);
    view.stride = 0;
    return view;
}

/* A wall: volume, density, table and stress given once for all. */
static setup_array force_of(const comparison *own, const sphg_neighbors *neighbors,
                            sphg_view volume, sphg_view density, sphg_view table, sphg_view stress)
{
    setup_array force = setup_output(own->scalar.type, COUNT, own->dimension);
    const sphg_sources sources = {
        .neighbors = neighbors, .volume = volume, .density = density, .correction = table};
    const sphg_field field = {.shape = SPHG_TENSOR,
                              .form = SPHG_SYMMETRIC,
                              .at_sources = &stress,
                              .divergence = setup_view(&force)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    return force;
}

static void stride_zero_is_one_item_for_all(const test_case *test)
{
    const comparison own = comparison_of(test);
    random_state random = random_seeded(131);
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &geometry);
    const setup_array table = numbers_of(test, sphg_correction_width(&own.scheme), 0.5, &random);
    const setup_array volumes = repeated(&own.volume), stresses = repeated(&own.tensor);
    setup_array tables = setup_output(table.type, COUNT, table.width);
    for (int i = 0; i < COUNT; ++i)
        memcpy((char *)tables.data + (size_t)i * (size_t)setup_view(&table).stride, table.data,
               (size_t)setup_view(&table).stride);
    const setup_array once = force_of(&own, neighbors, single(&volumes), single(&volumes),
                                      single(&table), single(&stresses));
    const setup_array each = force_of(&own, neighbors, setup_view(&volumes), setup_view(&volumes),
                                      setup_view(&tables), setup_view(&stresses));
    assert_true(setup_same_bits(&once, &each));
}

/* ---- Accumulation ------------------------------------------------------------------------- */

static void jacobian_into(const comparison *own, const sphg_neighbors *neighbors,
                          const sphg_subset *subset, int accumulate, sphg_layout laid_out,
                          const setup_array *result)
{
    const sphg_view vector = setup_view(&own->vector);
    sphg_sources sources = {0};
    sources.neighbors = neighbors;
    sources.volume = setup_view(&own->volume);
    sphg_field field = {.shape = SPHG_VECTOR,
                        .accumulate = accumulate,
                        .at_sources = &vector,
                        .gradient = setup_view(result)};
    field.gradient.layout = laid_out;
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1, .subset = subset};
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
}

/* One addition: out = fl(before + result), to a rounding of the result. */
static void accumulation_adds_to_what_is_there(const test_case *test)
{
    const comparison own = comparison_of(test);
    const int width = test->dimension * test->dimension;
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &geometry);
    const double unit = test_unit_roundoff(test);
    setup_array plain = setup_output(own.scalar.type, COUNT, width);
    const setup_array sum =
        setup_numbers(own.scalar.type, COUNT, width, setup_doubles(&own.tensor));
    jacobian_into(&own, neighbors, NULL, 0, SPHG_AS_SHAPE, &plain);
    jacobian_into(&own, neighbors, NULL, 1, SPHG_AS_SHAPE, &sum);
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < width; ++k) {
            const double before = setup_get(&own.tensor, i, k), added = setup_get(&plain, i, k);
            const double error = fabs(setup_get(&sum, i, k) - (before + added));
            TEST_WITHIN(one_addition, error / (unit * (fabs(before) + fabs(added))),
                        "one addition");
        }
}

/* Column by column what is added to is the transpose. */
static void accumulation_knows_the_layout(const test_case *test)
{
    const comparison own = comparison_of(test);
    const int d = test->dimension;
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &geometry);
    const setup_array by_rows =
        setup_numbers(own.scalar.type, COUNT, d * d, setup_doubles(&own.tensor));
    const setup_array by_columns = setup_output(own.scalar.type, COUNT, d * d);
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < d * d; ++k)
            setup_put(&by_columns, i * d * d + k % d * d + k / d, setup_get(&own.tensor, i, k));
    jacobian_into(&own, neighbors, NULL, 1, SPHG_AS_SHAPE, &by_rows);
    jacobian_into(&own, neighbors, NULL, 1, SPHG_COLUMN_MAJOR, &by_columns);
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < d * d; ++k)
            TEST_REQUIRE(setup_get(&by_columns, i, k % d * d + k / d) == setup_get(&by_rows, i, k),
                         "particle %d, number %d", i, k);
}

static void accumulation_leaves_unselected_targets_alone(const test_case *test)
{
    const comparison own = comparison_of(test);
    const int width = test->dimension * test->dimension;
    const sphg_geometry geometry = scene_geometry(&own.particles);
    const sphg_neighbors *neighbors = setup_search(own.context, &own.scheme, &geometry);
    const sphg_subset first = {0, 61, NULL, NULL}, rest = {61, COUNT, NULL, NULL};
    setup_array parts = setup_output(own.scalar.type, COUNT, width), whole = parts;
    whole.data = setup_output(own.scalar.type, COUNT, width).data;
    memset(whole.data, 0, (size_t)setup_view(&whole).stride * COUNT);
    memset(parts.data, 0, (size_t)setup_view(&parts).stride * 61);
    jacobian_into(&own, neighbors, &first, 1, SPHG_AS_SHAPE, &parts);
    for (int i = 61; i < COUNT; ++i)
        assert_true(setup_is_canary(&parts, i));
    memset(parts.data, 0, (size_t)setup_view(&parts).stride * COUNT);
    jacobian_into(&own, neighbors, &first, 1, SPHG_AS_SHAPE, &parts);
    jacobian_into(&own, neighbors, &rest, 1, SPHG_AS_SHAPE, &parts);
    jacobian_into(&own, neighbors, NULL, 1, SPHG_AS_SHAPE, &whole);
    assert_true(setup_same_bits(&parts, &whole));
}

/* ---- f64 positions beside f32 fields ------------------------------------------------------ */

/* Where f32 positions would have collapsed to a few points, differences still have all bits. */
static void wide_positions_keep_their_differences(const test_case *test)
{
    comparison own = comparison_of(test);
    const double step = 0x1p-20, far[3] = {0x1p31, -0x1p30, 0x1p29};
    cloud points = {test->dimension, COUNT, 1, own.particles.sources};
    cloud_snap(&points, step);
    own.positions = setup_numbers(SPHG_F64, COUNT, test->dimension, points.x);
    const outputs near = evaluate(&own, PACKED, PACKED);
    cloud_shift(&points, far);
    own.positions = setup_numbers(SPHG_F64, COUNT, test->dimension, points.x);
    const outputs shifted = evaluate(&own, PACKED, PACKED);
    const float *a = near.of[JACOBIAN].view.x, *b = shifted.of[JACOBIAN].view.x;
    float largest = 0;
    for (int k = 0; k < COUNT * test->dimension * test->dimension; ++k)
        largest = fmaxf(largest, fabsf(a[k]));
    for (int k = 0; k < COUNT * test->dimension * test->dimension; ++k)
        TEST_WITHIN(order_of_summation,
                    fabs((double)a[k] - (double)b[k]) / ((double)largest * 0x1p-24),
                    test_method_name(test->method));
}

/* ---- Many fields -------------------------------------------------------------------------- */

/* More than a word has bits. */
enum { FIELDS = 40 };

static void many_fields_have_the_bits_of_each_alone(const test_case *test)
{
    const sphg_type type = test_field_type(test);
    sphg_context *context = setup_context();
    random_state random = random_seeded(227);
    cloud points = cloud_random(test->dimension, COUNT, 4, &random);
    const sphg_scheme scheme = setup_scheme(test, 1);
    const setup_array volume = setup_numbers(type, COUNT, 1, cloud_volumes(&points, .2, &random));
    const sphg_sources sources = {.neighbors = setup_neighbors(context, test, &scheme, &points),
                                  .volume = setup_view(&volume)};
    sphg_view values[FIELDS];
    setup_array together[FIELDS], alone = setup_output(type, COUNT, test->dimension);
    sphg_field fields[FIELDS];
    for (int k = 0; k < FIELDS; ++k) {
        const setup_array numbers =
            setup_numbers(type, COUNT, 1, cloud_numbers(&points, -1, 1, &random));
        values[k] = setup_view(&numbers);
        together[k] = setup_output(type, COUNT, test->dimension);
        fields[k] = (sphg_field){
            .shape = SPHG_SCALAR, .at_sources = &values[k], .gradient = setup_view(&together[k])};
    }
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = fields, .field_count = FIELDS};
    SETUP_OK(context, sphg_evaluate(context, &scheme, &request));
    for (int k = 0; k < FIELDS; ++k) {
        SETUP_OK(context,
                 sphg_gradient(context, &scheme, &sources, NULL, values[k], setup_view(&alone)));
        TEST_REQUIRE(setup_same_bits(&together[k], &alone), "field %d", k);
    }
}

#define EACH(property, methods)                                                                    \
    TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, methods, 0)

static const test_entry entries[] = {
    EACH(layouts_hold_the_same_bits, TEST_CORRECTED),
    EACH(layouts_without_a_meaning_are_refused, TEST_CORRECTED),
    EACH(stride_zero_is_one_item_for_all, TEST_LINEARISED),
    EACH(accumulation_adds_to_what_is_there, TEST_ALL_METHODS),
    EACH(accumulation_knows_the_layout, TEST_ALL_METHODS),
    EACH(accumulation_leaves_unselected_targets_alone, TEST_ALL_METHODS),
    EACH(many_fields_have_the_bits_of_each_alone, TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS)),
    TEST_ENTRY(wide_positions_keep_their_differences, TEST_BIT(TEST_MIXED), TEST_BOTH_DIMENSIONS,
               TEST_CORRECTED, 0),
};
TEST_MAIN(entries)
