/* SPDX-License-Identifier: MIT */
#include "setup.h"
#include <math.h>
#include <string.h>

void setup_ok(const sphg_context *context, sphg_result result, const char *call)
{
    if (result != SPHG_OK)
        fail_msg("%s: %s (%s)", call, sphg_result_string(result),
                 context ? sphg_last_message(context) : "no context");
}

/* ---- Context ------------------------------------------------------------------------------ */

static void destroy_context(void *context)
{
    sphg_context_destroy(context);
}

sphg_context *setup_context_with(const sphg_config *config)
{
    sphg_context *context = NULL;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, config, &context));
    test_at_end(destroy_context, context);
    return context;
}

sphg_context *setup_context_of(int threads)
{
    const sphg_config config = {.threads = threads, .isa = test_isa()};
    return setup_context_with(&config);
}

sphg_context *setup_context_on(sphg_isa isa)
{
    sphg_config config = {0};
    config.threads = 1;
    config.isa = isa;
    sphg_context *context = NULL;
    sphg_result result = sphg_context_create(SPHG_VERSION, &config, &context);
    if (result == SPHG_ERROR_UNSUPPORTED)
        return NULL;
    SETUP_OK(NULL, result);
    test_at_end(destroy_context, context);
    return context;
}

sphg_context *setup_watched_context_on(sphg_isa isa)
{
    const sphg_isa wanted = TEST_SANITIZED ? test_isa() : SPHG_ISA_BEST;
    return wanted != SPHG_ISA_BEST && isa != wanted ? NULL : setup_context_on(isa);
}

sphg_context *setup_context(void)
{
    return setup_context_of(2);
}

static void close_hooks(void *host)
{
    fake_host_close(host);
}

fake_host *setup_hooks(void)
{
    fake_host *host = test_memory(sizeof *host);
    fake_host_open(host);
    test_at_end(close_hooks, host);
    return host;
}

/* ---- Arrays ------------------------------------------------------------------------------- */

static size_t size_of(sphg_type type)
{
    return type == SPHG_F64 ? sizeof(double) : type == SPHG_F32 ? sizeof(float) : 1;
}

enum { canary = 0xA5 };

setup_array setup_output(sphg_type type, int count, int width)
{
    setup_array array = {NULL, type, count, width};
    size_t bytes = (size_t)count * (size_t)width * size_of(type);
    array.data = test_memory(bytes);
    memset(array.data, canary, bytes);
    return array;
}

setup_array setup_numbers(sphg_type type, int count, int width, const double *numbers)
{
    setup_array array = setup_output(type, count, width);
    for (int k = 0; k < count * width; ++k)
        numbers_set(&array, k / width, k % width, numbers[k]);
    return array;
}

double *setup_doubles(const setup_array *array)
{
    int total = array->count * array->width;
    double *numbers = test_memory((size_t)total * sizeof *numbers);
    for (int k = 0; k < total; ++k)
        numbers[k] = setup_get(array, k / array->width, k % array->width);
    return numbers;
}

int setup_same_bits(const setup_array *a, const setup_array *b)
{
    size_t bytes = (size_t)a->count * (size_t)a->width * size_of(a->type);
    return a->type == b->type && a->count == b->count && a->width == b->width &&
           memcmp(a->data, b->data, bytes) == 0;
}

void setup_require_close(const setup_array *a, const setup_array *b, const char *where)
{
    const double unit = a->type == SPHG_F64 ? 0x1p-53 : 0x1p-24;
    double largest = 0;
    for (int k = 0; k < a->count * a->width; ++k)
        largest = fmax(largest, fabs(setup_get(a, k / a->width, k % a->width)));
    for (int i = 0; i < a->count; ++i)
        for (int c = 0; c < a->width; ++c)
            TEST_WITHIN(order_of_summation,
                        fabs(setup_get(a, i, c) - setup_get(b, i, c)) / (largest * unit), where);
}

void setup_put(const setup_array *array, int number, double value)
{
    numbers_set(array, number / array->width, number % array->width, value);
}

int setup_is_canary(const setup_array *array, int item)
{
    size_t bytes = (size_t)array->width * size_of(array->type);
    const unsigned char *data = (const unsigned char *)array->data + (size_t)item * bytes;
    for (size_t k = 0; k < bytes; ++k)
        if (data[k] != canary)
            return 0;
    return 1;
}

/* ---- Scheme, geometry, neighbours --------------------------------------------------------- */

sphg_scheme setup_scheme(const test_case *test, double support_radius)
{
    sphg_scheme scheme = {0};
    scheme.dimension = test->dimension;
    scheme.method = test->method;
    scheme.kernel = test->kernel;
    scheme.support_radius = support_radius;
    return scheme;
}

setup_array setup_positions(const test_case *test, cloud *points)
{
    if (test_position_type(test) == SPHG_F32)
        cloud_round_to_single(points);
    return setup_numbers(test_position_type(test), points->count, points->dimension, points->x);
}

sphg_geometry setup_geometry(const test_case *test, const cloud *points,
                             const setup_array *positions)
{
    sphg_geometry geometry = {0};
    geometry.sources = setup_view(positions);
    geometry.source_count = points->count;
    geometry.target_count = points->count;
    geometry.precision = test_field_type(test);
    return geometry;
}

static void destroy_neighbors(void *neighbors)
{
    sphg_neighbors_destroy(neighbors);
}

static sphg_neighbors *created(sphg_context *context)
{
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    test_at_end(destroy_neighbors, neighbors);
    return neighbors;
}

sphg_neighbors *setup_search(sphg_context *context, const sphg_scheme *scheme,
                             const sphg_geometry *geometry)
{
    sphg_neighbors *neighbors = created(context);
    SETUP_OK(context, sphg_neighbors_search(context, neighbors, scheme, geometry));
    return neighbors;
}

sphg_neighbors *setup_lists(sphg_context *context, const sphg_scheme *scheme,
                            const sphg_geometry *geometry, const sphg_lists *lists)
{
    sphg_neighbors *neighbors = created(context);
    SETUP_OK(context, sphg_neighbors_use_lists(context, neighbors, scheme, geometry, lists));
    return neighbors;
}

sphg_neighbors *setup_neighbors(sphg_context *context, const test_case *test,
                                const sphg_scheme *scheme, cloud *points)
{
    setup_array positions = setup_positions(test, points);
    sphg_geometry geometry = setup_geometry(test, points, &positions);
    return setup_search(context, scheme, &geometry);
}

int setup_width(sphg_shape shape, int dimension)
{
    switch (shape) {
    case SPHG_SCALAR:
        return 1;
    case SPHG_VECTOR:
        return dimension;
    case SPHG_SYM_TENSOR:
        return dimension * (dimension + 1) / 2;
    default:
        return dimension * dimension;
    }
}
