#include "subject.h"
#include <math.h>
#include <string.h>

enum { CANARY = 0xA5, OUTPUT_ITEM = 16 };

static void close_subject(void *object)
{
    subject *own = object;
    sphg_neighbors_destroy(own->built);
    sphg_neighbors_destroy(own->blank);
    sphg_neighbors_destroy(own->lone);
    sphg_neighbors_destroy(own->narrow);
    sphg_context_destroy(own->context);
    hooks_close(own->host);
}

static sphg_view input(subject *own, int slot, int width, double low, double high)
{
    random_state random = random_seeded(7 + (uint64_t)slot);
    double numbers[SUBJECT_COUNT * 9];
    for (int k = 0; k < SUBJECT_COUNT * width; k++)
        numbers[k] = random_between(&random, low, high);
    const fixture_array array =
        fixture_numbers(test_field_type(own->test), SUBJECT_COUNT, width, numbers);
    own->input_memory[slot] = array.data;
    return fixture_view(&array);
}

/* The k-th quarter of the output memory, as items of the given width. */
static sphg_view output(const subject *own, int quarter, int width)
{
    const size_t size = test_field_type(own->test) == SPHG_F64 ? sizeof(double) : sizeof(float);
    sphg_view view = {own->outputs + (size_t)quarter * own->output_bytes / 4, NULL, NULL, 0,
                      test_field_type(own->test)};
    view.stride = (ptrdiff_t)((size_t)width * size);
    return view;
}

static void make_arrays(subject *own)
{
    const int d = own->test->dimension;
    own->output_bytes = 4 * SUBJECT_COUNT * OUTPUT_ITEM * sizeof(double);
    own->outputs = test_memory(own->output_bytes);
    own->positions = input(own, 0, d, 0, 2);
    own->scalars = input(own, 1, 1, -1, 1);
    own->volumes = input(own, 2, 1, 0.1, 0.2);
    own->tensors = input(own, 3, d * d, -1, 1);
    own->table = input(own, 4, d * (d + 1) / 2, 0.9, 1.1);
    own->scalars_out = output(own, 0, 1);
    own->vectors_out = output(own, 1, d);
    own->tensors_out = output(own, 2, d * d);
    own->table_out = output(own, 3, d * (d + 1) / 2);
    own->ranks_out = sphg_view_u8(own->outputs + own->output_bytes - SUBJECT_COUNT, 1);
    own->offsets = test_memory((SUBJECT_COUNT + 1) * sizeof(int64_t));
    own->indices = test_memory(SUBJECT_COUNT * SUBJECT_COUNT * sizeof(int32_t));
    for (int k = 0; k < SUBJECT_COUNT * SUBJECT_COUNT; k++)
        own->indices[k] = k % SUBJECT_COUNT;
}

static void build(subject *own, sphg_neighbors **neighbors)
{
    FIXTURE_OK(own->context, sphg_neighbors_create(own->context, neighbors));
    FIXTURE_OK(own->context,
               sphg_neighbors_search(own->context, *neighbors, &own->scheme, &own->geometry));
}

static void reset_build(subject *own)
{
    own->scheme = fixture_scheme(own->test, 1);
    memset(&own->geometry, 0, sizeof own->geometry);
    own->geometry.sources = own->positions;
    own->geometry.source_count = own->geometry.target_count = SUBJECT_COUNT;
    memset(&own->lists, 0, sizeof own->lists);
    own->lists.offsets = own->offsets;
    own->lists.indices = own->indices;
}

/* Everything at once that goes together: gradient, correction, rank. */
static void reset_request(subject *own)
{
    memset(own->sources, 0, sizeof own->sources);
    own->sources[0].neighbors = own->built;
    own->sources[0].volume = own->volumes;
    memset(&own->field, 0, sizeof own->field);
    own->field.shape = SPHG_SCALAR;
    own->field.at_sources = own->at_sources;
    own->field.gradient = own->vectors_out;
    own->at_sources[0] = own->at_sources[1] = own->scalars;
    memset(&own->request, 0, sizeof own->request);
    own->request.sources = own->sources;
    own->request.set_count = 1;
    own->request.fields = &own->field;
    own->request.field_count = 1;
    own->request.correction = own->table_out;
    own->request.rank = own->ranks_out;
    memset(&own->subset, 0, sizeof own->subset);
    own->subset.end = SUBJECT_COUNT;
    own->request.subset = &own->subset;
}

static void reset_rest(subject *own)
{
    memset(&own->pairs, 0, sizeof own->pairs);
    own->pairs.gradient = output(own, 1, own->test->dimension);
    own->pairs.capacity = 4 * SUBJECT_COUNT; /* of four targets, see the calls */
    memset(&own->inversion, 0, sizeof own->inversion);
    own->inversion.correction = own->table_out;
    own->inversion.rank = own->ranks_out;
    own->dimension = own->test->dimension;
    own->count = SUBJECT_COUNT;
}

static void set_arguments(subject *own)
{
    reset_build(own);
    reset_request(own);
    reset_rest(own);
    own->neighbors = own->built;
    own->scheme_given = &own->scheme;
    own->geometry_given = &own->geometry;
    own->lists_given = &own->lists;
    own->request_given = &own->request;
    own->sources_given = own->sources;
    own->pairs_given = &own->pairs;
    own->inversion_given = &own->inversion;
}

static void set_offsets(subject *own)
{
    for (int k = 0; k <= SUBJECT_COUNT; k++)
        own->offsets[k] = k * (int64_t)SUBJECT_COUNT;
}

void subject_reset(subject *own)
{
    *own = *own->valid;
    set_offsets(own);
    own->host->log_count = 0;
    memset(own->outputs, CANARY, own->output_bytes);
}

subject *subject_create(const test_case *test)
{
    subject *own = test_memory(sizeof *own);
    own->test = test;
    own->host = test_memory(sizeof *own->host);
    hooks_open(own->host);
    test_at_end(close_subject, own);
    const sphg_config config = hooks_config(own->host, 2);
    FIXTURE_OK(NULL, sphg_context_create(SPHG_VERSION, &config, &own->context));
    make_arrays(own);
    FIXTURE_OK(own->context, sphg_neighbors_create(own->context, &own->blank));
    reset_build(own);
    build(own, &own->built);
    own->geometry.targets = own->positions;
    build(own, &own->lone);
    own->geometry.targets = sphg_absent();
    own->scheme.support_radius /= 2;
    build(own, &own->narrow);
    set_arguments(own);
    own->valid = test_memory(sizeof *own);
    *own->valid = *own;
    own->valid->valid = own->valid;
    subject_reset(own);
    return own;
}

void subject_require(subject *own, sphg_result result, int expected, const char *words,
                     const char *change)
{
    const char *message = sphg_last_message(own->context);
    TEST_REQUIRE(expected == SUBJECT_REFUSED ? result > 0 : (int)result == expected,
                 "%s: %s, not %s (%s)", change, sphg_result_string(result),
                 expected == SUBJECT_REFUSED ? "refused"
                                             : sphg_result_string((sphg_result)expected),
                 message);
    TEST_REQUIRE(own->host->log_count == 1, "%s: the log heard %d failures", change,
                 own->host->log_count);
    TEST_REQUIRE(own->host->log_result == result, "%s: the log heard another code", change);
    TEST_REQUIRE(strcmp(own->host->log_message, message) == 0, "%s: the log heard '%s', not '%s'",
                 change, own->host->log_message, message);
    TEST_REQUIRE(strstr(message, words) != NULL, "%s: '%s' does not name '%s'", change, message,
                 words);
    for (size_t k = 0; k < own->output_bytes && result > 0; k++)
        TEST_REQUIRE(own->outputs[k] == CANARY, "%s: output byte %zu was written", change, k);
}
