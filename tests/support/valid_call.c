/* SPDX-License-Identifier: MIT */
#include "valid_call.h"
#include <string.h>

enum { CANARY = 0xA5 };

static void close_victim(void *object)
{
    valid_call *own = object;
    sphg_neighbors_destroy(own->built);
    sphg_neighbors_destroy(own->blank);
    sphg_neighbors_destroy(own->listed);
    sphg_neighbors_destroy(own->rebuilt);
    sphg_neighbors_destroy(own->lone);
    sphg_neighbors_destroy(own->narrow);
    sphg_context_destroy(own->living);
    fake_host_close(own->host);
}

static int number_size(const valid_call *own)
{
    return test_field_type(own->test) == SPHG_F64 ? 8 : 4;
}

/* ---- Arrays ------------------------------------------------------------------------------- */

static sphg_view input(const valid_call *own, int width, double low, double high)
{
    random_state random = random_seeded(11 + (uint64_t)width);
    double numbers[VALID_CALL_COUNT * 9];
    for (int k = 0; k < VALID_CALL_COUNT * width; ++k)
        numbers[k] = random_between(&random, low, high);
    const setup_array array =
        setup_numbers(test_field_type(own->test), VALID_CALL_COUNT, width, numbers);
    return setup_view(&array);
}

static sphg_view output(const valid_call *own, int slot, int width)
{
    sphg_view view = {own->outputs + slot * VALID_CALL_SLOT_BYTES,
                      NULL,
                      NULL,
                      (ptrdiff_t)width * number_size(own),
                      test_field_type(own->test),
                      SPHG_AS_SHAPE};
    return view;
}

void valid_call_put(sphg_view view, int item, double value)
{
    char *place = (char *)(uintptr_t)view.x + item * view.stride;
    if (view.type == SPHG_F64)
        *(double *)(void *)place = value;
    else
        *(float *)(void *)place = (float)value;
}

static void make_inputs(valid_call *own)
{
    const int d = own->test->dimension;
    own->position_view = input(own, d, 0, 2);
    own->volume_view = input(own, 1, 0.1, 0.2);
    own->radii = input(own, 1, 0.5, 1);
    own->target_radii = input(own, 1, 0.5, 1);
    own->scalars = input(own, 1, -1, 1);
    own->densities = input(own, 1, 0.5, 1.5);
    own->vectors = input(own, d, -1, 1);
    own->tensors = input(own, d * d, -1, 1);
    own->squares = input(own, 9, -1, 1); /* 3 x 3 in 2D as well */
    own->symmetric = input(own, d * (d + 1) / 2, 0.9, 1.1);
    own->table = input(own, d * (d + 1) / 2, 0.8, 1.2);
    own->target_correction = sphg_absent();
    own->offsets = test_memory((VALID_CALL_COUNT + 1) * sizeof *own->offsets);
    own->indices = test_memory(VALID_CALL_COUNT * VALID_CALL_COUNT * sizeof *own->indices);
    own->picked = test_memory(VALID_CALL_COUNT * sizeof *own->picked);
    own->mask = test_memory(VALID_CALL_COUNT);
}

static void make_outputs(valid_call *own)
{
    const int d = own->test->dimension, width = d * (d + 1) / 2;
    own->outputs = test_memory(VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES);
    own->scalar_out = output(own, 0, 1);
    own->vector_out = output(own, 1, d);
    own->tensor_out = output(own, 2, d * d);
    own->table_out = output(own, 3, width);
    own->lambda_out = output(own, 4, 1);
    own->rank_out = sphg_view_u8(own->outputs + 5 * VALID_CALL_SLOT_BYTES, 1);
    own->u = output(own, 6, 9);
    own->sigma = output(own, 7, 3);
    own->v = output(own, 8, 9);
    own->order = (int32_t *)(void *)(own->outputs + 9 * VALID_CALL_SLOT_BYTES);
    own->info = (sphg_neighbors_info *)(void *)(own->outputs + 10 * VALID_CALL_SLOT_BYTES);
    own->context_info = (sphg_context_info *)(void *)(own->info + 1);
    own->list_fault = (sphg_list_fault *)(void *)(own->context_info + 1);
    own->rebuild = (int32_t *)(void *)(own->list_fault + 1);
    own->request.stats = (sphg_stats *)(void *)(own->outputs + 11 * VALID_CALL_SLOT_BYTES);
    own->pairs.gradient = output(own, 12, d);
    own->pairs.offsets = (int64_t *)(void *)(own->outputs + 13 * VALID_CALL_SLOT_BYTES);
    own->pairs.indices = (int32_t *)(void *)(own->pairs.offsets + VALID_CALL_COUNT + 1);
}

/* ---- Arguments ---------------------------------------------------------------------------- */

static void set_build(valid_call *own)
{
    own->scheme = setup_scheme(own->test, 1);
    own->geometry.sources = own->position_view;
    own->geometry.source_count = own->geometry.target_count = VALID_CALL_COUNT;
    own->lists.offsets = own->offsets;
    own->lists.indices = own->indices;
}

/* Everything at once that goes together. */
static void set_request(valid_call *own)
{
    own->sources[0].neighbors = own->built;
    own->sources[0].volume = own->volume_view;
    own->sources[0].density = own->densities;
    own->field.shape = SPHG_SCALAR;
    own->field.at_sources = own->at_sources;
    own->field.at_targets = own->scalars;
    own->field.gradient = own->vector_out;
    own->at_sources[0] = own->at_sources[1] = own->scalars;
    own->request.sources = own->sources;
    own->request.fields = &own->field;
    own->request.set_count = own->request.field_count = 1;
    own->request.subset = &own->subset;
    own->request.correction = own->table_out;
    own->request.rank = own->rank_out;
    own->request.lambda_min = own->lambda_out;
    own->subset.end = VALID_CALL_COUNT;
}

static void set_rest(valid_call *own)
{
    own->pairs.capacity = 4 * VALID_CALL_COUNT; /* of four targets, see the calls */
    own->wanted.correction = own->table_out;
    own->wanted.rank = own->rank_out;
    own->wanted.lambda_min = own->lambda_out;
    own->wanted.stats = own->request.stats;
    own->config = fake_host_config(own->host, 2);
    own->version = SPHG_VERSION;
    own->dimension = own->test->dimension;
    own->count = VALID_CALL_COUNT;
    own->shape = SPHG_SCALAR;
    own->context_out = &own->made_context;
    own->neighbors_out = &own->made_neighbors;
    own->context = own->living;
    own->neighbors = own->rebuilt;
    own->config_given = &own->config;
    own->scheme_given = &own->scheme;
    own->geometry_given = &own->geometry;
    own->lists_given = &own->lists;
    own->request_given = &own->request;
    own->sources_given = own->sources;
    own->subset_given = &own->subset;
    own->pairs_given = &own->pairs;
    own->wanted_given = &own->wanted;
}

static void refill_lists(valid_call *own)
{
    for (int k = 0; k <= VALID_CALL_COUNT; ++k)
        own->offsets[k] = k * (int64_t)VALID_CALL_COUNT;
    for (int k = 0; k < VALID_CALL_COUNT * VALID_CALL_COUNT; ++k)
        own->indices[k] = k % VALID_CALL_COUNT;
    for (int k = 0; k < VALID_CALL_COUNT; ++k)
        own->picked[k] = k;
    memset(own->mask, 1, VALID_CALL_COUNT);
}

void valid_call_reset(valid_call *own)
{
    *own = *own->valid;
    refill_lists(own);
    own->host->log_count = 0;
    memset(own->outputs, CANARY, VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES);
}

/* From here on this is the valid call. */
static void keep(valid_call *own)
{
    *own->valid = *own;
    valid_call_reset(own);
}

int valid_call_outputs_are_untouched(const valid_call *own)
{
    const size_t size = VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES;
    return own->outputs[0] == CANARY && !memcmp(own->outputs, own->outputs + 1, size - 1);
}

valid_call *valid_call_create(const test_case *test, int trusted)
{
    valid_call *own = test_memory(sizeof *own);
    own->test = test;
    own->host = test_memory(sizeof *own->host);
    fake_host_open(own->host);
    test_at_end(close_victim, own);
    sphg_config config = fake_host_config(own->host, 2);
    config.trusted = trusted;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &own->living));
    make_inputs(own);
    make_outputs(own);
    refill_lists(own);
    sphg_neighbors **const all[] = {&own->built, &own->blank, &own->listed, &own->rebuilt};
    for (int k = 0; k < 4; ++k)
        SETUP_OK(own->living, sphg_neighbors_create(own->living, all[k]));
    set_build(own);
    for (int k = 0; k < 4; k += 3)
        SETUP_OK(own->living,
                 sphg_neighbors_search(own->living, *all[k], &own->scheme, &own->geometry));
    SETUP_OK(own->living, sphg_neighbors_use_lists(own->living, own->listed, &own->scheme,
                                                   &own->geometry, &own->lists));
    set_request(own);
    set_rest(own);
    own->valid = test_memory(sizeof *own);
    keep(own);
    return own;
}

static sphg_neighbors *search(const valid_call *own, const sphg_scheme *scheme,
                              const sphg_geometry *geometry)
{
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(own->living, sphg_neighbors_create(own->living, &neighbors));
    SETUP_OK(own->living, sphg_neighbors_search(own->living, neighbors, scheme, geometry));
    return neighbors;
}

valid_call *valid_call_create_plain(const test_case *test)
{
    valid_call *own = valid_call_create(test, 0);
    sphg_geometry apart = own->geometry;
    sphg_scheme half = own->scheme;
    apart.targets = own->position_view;
    half.support_radius /= 2;
    own->lone = search(own, &own->scheme, &apart);
    own->narrow = search(own, &half, &own->geometry);
    own->sources[0].density = own->field.at_targets = sphg_absent();
    own->request.lambda_min = own->wanted.lambda_min = sphg_absent();
    own->request.stats = own->wanted.stats = NULL;
    own->pairs.offsets = NULL;
    own->pairs.indices = NULL;
    keep(own);
    return own;
}

void valid_call_require(const valid_call *own, sphg_result result, int expected, const char *words,
                        const char *change)
{
    const char *message = sphg_last_message(own->context);
    TEST_REQUIRE(expected == VALID_CALL_REFUSED ? result > 0 : (int)result == expected,
                 "%s: %s, not %s (%s)", change, sphg_result_string(result),
                 expected == VALID_CALL_REFUSED ? "refused"
                                                : sphg_result_string((sphg_result)expected),
                 message);
    TEST_REQUIRE(own->host->log_count == 1, "%s: the log heard %d failures", change,
                 own->host->log_count);
    TEST_REQUIRE(own->host->log_result == result, "%s: the log heard another code", change);
    TEST_REQUIRE(strcmp(own->host->log_message, message) == 0, "%s: the log heard '%s', not '%s'",
                 change, own->host->log_message, message);
    TEST_REQUIRE(strstr(message, words) != NULL, "%s: '%s' does not name '%s'", change, message,
                 words);
    TEST_REQUIRE(result < 0 || valid_call_outputs_are_untouched(own), "%s: an output was written",
                 change);
}
