/* SPDX-License-Identifier: MIT */
/* Requests that cannot be served: refused with the right code and the argument's name, outputs
 * untouched, and the next call works. */
#include "support/public_calls.h"
#include <limits.h>
#include <math.h>
#include <string.h>

#define REFUSES(call, expected, words, change)                                                     \
    VALID_CALL_REFUSES(own, call, expected, words, change)

static sphg_type other_type(const valid_call *own)
{
    return own->position_view.type == SPHG_F32 ? SPHG_F64 : SPHG_F32;
}

static ptrdiff_t number_size(const valid_call *own)
{
    return own->position_view.type == SPHG_F32 ? 4 : 8;
}

static const void *moved(sphg_view view, ptrdiff_t bytes)
{
    return (const void *)((uintptr_t)view.x + (uintptr_t)bytes);
}

/* ---- sphg_evaluate ------------------------------------------------------------------------ */

static void evaluate_refuses_bad_schemes(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int enums[] = {-1, 7, INT_MAX, INT_MIN};
    for (int k = 0; k < 4; ++k) {
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "method",
                own->scheme.method = (sphg_method)enums[k]);
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "kernel",
                own->scheme.kernel = (sphg_kernel)enums[k]);
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "policy",
                own->scheme.policy = (sphg_policy)enums[k]);
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "dimension", own->scheme.dimension = enums[k]);
    }
    const double radii[] = {0, -1, NAN, INFINITY}, thresholds[] = {-1e-3, 1, NAN, INFINITY};
    for (int k = 0; k < 4; ++k) {
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "support_radius",
                own->scheme.support_radius = radii[k]);
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "threshold",
                own->scheme.threshold = thresholds[k]);
    }
    REFUSES(call_evaluate, SPHG_ERROR_SIZE, "sources[0].neighbors",
            own->scheme.dimension = 5 - test->dimension);
    REFUSES(call_evaluate, SPHG_ERROR_SIZE, "support_radius",
            own->scheme.support_radius = nextafter(1, 2));
    REFUSES(call_evaluate, SPHG_ERROR_SIZE, "support_radius",
            own->sources[0].neighbors = own->narrow);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "scheme", own->scheme_given = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "request", own->request_given = NULL);
    assert_int_equal(sphg_evaluate(NULL, &own->scheme, &own->request), SPHG_ERROR_ARGUMENT);
}

static void evaluate_refuses_bad_sources(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "sources", own->request.sources = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "set_count", own->request.set_count = 0);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "set_count", own->request.set_count = -1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "set_count", own->request.set_count = 4097);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "neighbors", own->sources[0].neighbors = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_STATE, "", own->sources[0].neighbors = own->blank);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "volume", own->sources[0].volume = sphg_absent());
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "volume",
            own->sources[0].volume.type = other_type(own));
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "volume", own->sources[0].volume.type = SPHG_U8);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "volume", own->sources[0].volume.stride += 1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "volume",
            own->sources[0].volume.x = moved(own->volume_view, 1));
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "correction", own->request.correction = sphg_absent();
            own->request.rank = sphg_absent(); own->sources[0].correction = own->table;
            own->sources[0].correction.type = other_type(own));
}

static void evaluate_refuses_bad_fields(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields", own->request.fields = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields is set, but field_count is 0",
            own->request.field_count = 0);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "nothing is asked for",
            own->field.value = sphg_absent();
            own->field.gradient = own->field.divergence = own->field.curl = own->field.square =
                sphg_absent();
            own->request.correction = own->request.rank = own->request.lambda_min = sphg_absent();
            own->request.stats = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "field_count", own->request.field_count = -1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "field_count", own->request.field_count = 4097);
    const int shapes[] = {0, 5, -1, INT_MAX}, forms[] = {-1, 4, INT_MIN, INT_MAX};
    for (int k = 0; k < 4; ++k) {
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "shape",
                own->field.shape = (sphg_shape)shapes[k]);
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "form", own->field.form = (sphg_form)forms[k]);
    }
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "at_sources", own->field.at_sources = NULL);
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "at_sources",
            own->at_sources[0].type = other_type(own));
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "at_sources", own->at_sources[0].stride += 1);
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "at_targets", own->field.at_targets = own->scalars;
            own->field.at_targets.type = other_type(own));
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "gradient", own->field.gradient.type = other_type(own));
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "gradient", own->field.gradient.type = SPHG_U8);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient", own->field.gradient.stride = 0);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient", own->field.gradient.stride += 1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient",
            own->field.gradient.x = moved(own->vector_out, 2));
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "at_targets",
            own->sources[0].neighbors = own->lone); /* nobody to look them up from */
}

/* What is absent stands for 0, which is no value to take a difference to; and a mirror needs what
 * it shows. */
static void evaluate_refuses_differences_to_what_is_absent(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields[0].at_sources[0] is absent",
            own->at_sources[0] = sphg_absent());
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields[0].at_sources[0] is absent",
            own->at_sources[0] = sphg_absent();
            own->field.at_targets = own->scalars);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields[0].at_sources[1] is absent",
            own->sources[1] = own->sources[0];
            own->request.set_count = 2; own->at_sources[1] = sphg_absent());
    for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form)
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "mirror", own->at_sources[0] = sphg_absent();
                own->field.form = (sphg_form)form; own->field.mirror = 1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "fields[0].at_targets is absent",
            own->at_sources[0] = sphg_absent();
            own->sources[0].neighbors = own->lone; own->field.form = SPHG_DIRECT;
            own->field.mirror = 1);
}

/* A mask or a list whose length was forgotten. */
static void evaluate_refuses_subsets_without_an_end(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    static const uint8_t mask[VALID_CALL_COUNT] = {1};
    static const int32_t some[] = {3};
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT,
            "subset.mask is set, but subset.end is 0; sphg_masked(mask, target_count) sets both",
            own->subset = (sphg_subset){.mask = mask});
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT,
            "subset.indices is set, but subset.end is 0; if nobody is meant, indices is NULL, as "
            "sphg_listed(indices, 0) makes it",
            own->subset = (sphg_subset){.indices = some});
    const sphg_subset empty[] = {sphg_listed(some, 0),
                                 sphg_range(0, 0),
                                 sphg_masked(NULL, 0),
                                 {.begin = 1, .end = 1, .indices = some},
                                 {.begin = 7, .end = 7, .mask = mask}};
    for (size_t k = 0; k < sizeof empty / sizeof *empty; ++k) {
        valid_call_reset(own);
        own->subset = empty[k];
        SETUP_OK(own->context, call_evaluate(own));
    }
}

static void evaluate_refuses_corrections_that_plain_has_not(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_stats stats;
#define NOTHING_OF_PLAIN                                                                           \
    own->scheme.method = SPHG_PLAIN;                                                               \
    own->request.correction = own->request.rank = own->request.lambda_min = sphg_absent();         \
    own->request.stats = NULL
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "PLAIN", NOTHING_OF_PLAIN;
            own->request.rank = own->rank_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "PLAIN", NOTHING_OF_PLAIN;
            own->request.lambda_min = own->scalar_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "PLAIN", NOTHING_OF_PLAIN;
            own->request.stats = &stats);
#undef NOTHING_OF_PLAIN
}

/* Which results a shape and a form have. */
static void evaluate_refuses_operators_that_a_shape_has_not(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "gradient", own->field.shape = SPHG_SYM_TENSOR;
            own->at_sources[0] = own->tensors);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "gradient", own->field.shape = SPHG_TENSOR;
            own->at_sources[0] = own->tensors);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "curl", own->field.gradient = sphg_absent();
            own->field.curl = own->vector_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "curl", own->field.gradient = sphg_absent();
            own->field.shape = SPHG_TENSOR; own->at_sources[0] = own->tensors;
            own->field.curl = own->vector_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "divergence",
            own->field.gradient = sphg_absent();
            own->field.divergence = own->vector_out);
    REFUSES(call_evaluate, VALID_CALL_REFUSED, "value", own->field.form = SPHG_ADJOINT;
            own->field.value = own->scalar_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "square", own->field.gradient = sphg_absent();
            own->field.square = own->scalar_out);
    REFUSES(call_evaluate, SPHG_ERROR_UNSUPPORTED, "square", own->field.gradient = sphg_absent();
            own->field.form = SPHG_DIRECT; own->field.shape = SPHG_TENSOR;
            own->at_sources[0] = own->tensors; own->field.square = own->scalar_out);
}

/* ADJOINT and SYMMETRIC read both ends of a pair. */
static void two_sided_forms_need_tables_and_densities(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    for (int form = SPHG_SYMMETRIC; form <= SPHG_ADJOINT; ++form) {
#define TWO_SIDED                                                                                  \
    own->field.form = (sphg_form)form;                                                             \
    own->request.correction = own->request.rank = sphg_absent();                                   \
    own->sources[0].density = own->volume_view
        REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "correction", TWO_SIDED);
#undef TWO_SIDED
    }
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "density", own->field.form = SPHG_SYMMETRIC;
            own->request.correction = own->request.rank = sphg_absent();
            own->sources[0].correction = own->table);
#define APART                                                                                      \
    own->sources[0].neighbors = own->lone;                                                         \
    own->sources[0].density = own->volume_view;                                                    \
    own->sources[0].correction = own->request.target_correction = own->table;                      \
    own->request.correction = own->request.rank = sphg_absent();                                   \
    own->field.at_targets = own->scalars
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "target_volume", APART;
            own->field.form = SPHG_ADJOINT);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "target_density", APART;
            own->field.form = SPHG_SYMMETRIC; own->request.target_volume = own->volume_view);
#undef APART
}

static void evaluate_refuses_bad_outputs_of_corrections(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "rank",
            own->request.rank.type = own->position_view.type);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "rank", own->request.rank.stride = 0);
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "lambda_min", own->request.lambda_min = own->scalar_out;
            own->request.lambda_min.type = SPHG_U8);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "correction", own->request.correction.stride = 0);
    REFUSES(call_evaluate, SPHG_ERROR_TYPE, "correction",
            own->request.correction.type = other_type(own));
    REFUSES(call_evaluate, VALID_CALL_REFUSED, "correction",
            own->sources[0].correction = own->table);
    REFUSES(call_evaluate, VALID_CALL_REFUSED, "correction",
            own->request.target_correction = own->table);
}

/* An output that overlaps an input or another output, by one byte, from either side. */
static void overlapping_outputs_are_refused(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const ptrdiff_t size = number_size(own),
                    items = (VALID_CALL_COUNT - 1) * own->vector_out.stride;
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient",
            own->request.correction.x = own->vector_out.x);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "",
            own->request.correction.x = moved(own->vector_out, items + size));
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "rank",
            own->request.rank = sphg_view_u8(moved(own->vector_out, items + 1), 1));
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient",
            own->at_sources[0].x = own->vector_out.x);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient",
            own->sources[0].volume.x = moved(own->vector_out, items));
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "gradient", own->field.at_targets = own->scalars;
            own->field.at_targets.x = moved(own->vector_out, size);
            own->field.at_targets.stride = 0);
}

/* Interleaved members of one record touch each other's span, but not each other. */
static void members_of_one_record_do_not_overlap(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const ptrdiff_t size = number_size(own), record = 12 * size;
    const int d = test->dimension;
    char *memory = test_memory(VALID_CALL_COUNT * 12 * sizeof(double));
    own->field.gradient.x = memory;
    own->request.correction.x = memory + d * size;
    own->request.rank = sphg_view_u8((uint8_t *)memory + 10 * size, record);
    own->field.gradient.stride = own->request.correction.stride = record;
    SETUP_OK(own->context, call_evaluate(own));
}

/* A single item has no stride to speak of: it overlaps a record only where it lies on a member. */
static void single_item_may_stand_inside_a_record(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const ptrdiff_t size = number_size(own), record = 12 * size;
    char *memory = memset(test_memory(VALID_CALL_COUNT * 12 * sizeof(double)), 0,
                          VALID_CALL_COUNT * 12 * sizeof(double));
    own->request.correction = own->request.rank = sphg_absent();
    own->field.gradient.x = memory;
    own->field.gradient.stride = record;
    own->geometry.targets = own->position_view;
    own->geometry.source_count = 1;
    SETUP_OK(own->context,
             sphg_neighbors_search(own->context, own->lone, &own->scheme, &own->geometry));
    own->sources[0].neighbors = own->lone;
    own->field.at_targets = own->scalars;
    for (ptrdiff_t at = 0; at < 24; ++at) { /* members 0 to d - 1 of records 0 and 1 are written */
        own->sources[0].volume.x = memory + at * size;
        own->sources[0].volume.stride = 5 * size;
        const sphg_result expected = at % 12 < test->dimension ? SPHG_ERROR_ARGUMENT : SPHG_OK;
        TEST_REQUIRE(call_evaluate(own) == expected, "at %d: %s", (int)at,
                     sphg_last_message(own->context));
    }
}

/* Of two sets the second takes part in the difference alone, which reads no corrections of it. */
static void set_needs_corrections_where_it_is_read_from_the_other_side(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_view adjoint_sources[2] = {own->scalars, sphg_absent()};
    sphg_field fields[2] = {own->field, own->field};
    fields[1].form = SPHG_ADJOINT;
    fields[1].at_sources = adjoint_sources;
    fields[1].gradient.x = own->tensor_out.x;
    own->sources[1] = own->sources[0];
    own->sources[0].correction = own->request.target_correction = own->table;
    own->request.correction = own->request.rank = sphg_absent();
    own->request.set_count = own->request.field_count = 2;
    own->request.fields = fields;
    SETUP_OK(own->context, call_evaluate(own));
    adjoint_sources[1] = own->scalars;
    assert_int_equal(call_evaluate(own), SPHG_ERROR_ARGUMENT);
    assert_non_null(strstr(sphg_last_message(own->context), "sources[1].correction"));
}

static void evaluate_refuses_bad_subsets(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int32_t picked[] = {3, 5, VALID_CALL_COUNT}, negative[] = {0, -1, 2};
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "subset is [-1", own->subset.begin = -1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "subset", own->subset.end = VALID_CALL_COUNT + 1);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "subset", own->subset.begin = 10;
            own->subset.end = 9);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "indices", own->subset.end = 3;
            own->subset.indices = picked);
    REFUSES(call_evaluate, SPHG_ERROR_ARGUMENT, "indices", own->subset.end = 3;
            own->subset.indices = negative);
}

static void several_sets_must_agree(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_neighbors *fewer = NULL;
    assert_int_equal(sphg_neighbors_create(own->context, &fewer), SPHG_OK);
    own->geometry.target_count = VALID_CALL_COUNT - 1;
    SETUP_OK(own->context,
             sphg_neighbors_search(own->context, fewer, &own->scheme, &own->geometry));
#define TWO_SETS                                                                                   \
    own->request.set_count = 2;                                                                    \
    own->sources[1] = own->sources[0]
    REFUSES(call_evaluate, SPHG_ERROR_SIZE, "59 targets", TWO_SETS;
            own->sources[1].neighbors = fewer);
    if (test->precision == TEST_F64) {
        own->geometry.precision = SPHG_F32;
        own->geometry.target_count = VALID_CALL_COUNT;
        SETUP_OK(own->context,
                 sphg_neighbors_search(own->context, fewer, &own->scheme, &own->geometry));
        REFUSES(call_evaluate, SPHG_ERROR_TYPE, "precision", TWO_SETS;
                own->sources[1].neighbors = fewer);
    }
#undef TWO_SETS
    sphg_neighbors_destroy(fewer);
}

/* ---- What shows only on the way ----------------------------------------------------------- */

static void bad_volumes_are_found_and_named(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const double bad[] = {-1, NAN, INFINITY, -1e-30, -1 - 0x1p-20};
    for (int k = 0; k < 5; ++k) {
        double numbers[VALID_CALL_COUNT];
        for (int i = 0; i < VALID_CALL_COUNT; ++i)
            numbers[i] = i == 41 ? bad[k] : 0.125;
        const setup_array volumes =
            setup_numbers(test_field_type(test), VALID_CALL_COUNT, 1, numbers);
        REFUSES(call_evaluate, SPHG_ERROR_VOLUME, "41",
                own->sources[0].volume = setup_view(&volumes));
        REFUSES(call_evaluate, SPHG_ERROR_VOLUME, k < 4 ? "is " : "is -1.0000009536743164",
                own->sources[0].volume = setup_view(&volumes));
    }
    const float negative = -1;
    const double negative_full = -1;
    REFUSES(call_evaluate, SPHG_ERROR_VOLUME, "volume", own->scheme.method = SPHG_MLS;
            own->request.target_volume = own->volume_view; own->request.target_volume.stride = 0;
            own->request.target_volume.x = test->precision == TEST_F64
                                               ? (const void *)&negative_full
                                               : (const void *)&negative);
}

static void bad_indices_are_found_where_operators_read_them(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int32_t bad[] = {-1, VALID_CALL_COUNT, INT32_MAX, INT32_MIN};
    for (int k = 0; k < 4; ++k) {
        const int place = 17 * VALID_CALL_COUNT + 5;
        SETUP_OK(own->context, sphg_neighbors_use_lists(own->context, own->built, &own->scheme,
                                                        &own->geometry, &own->lists));
        own->indices[place] = bad[k];
        assert_int_equal(call_evaluate(own), SPHG_ERROR_INDEX);
        assert_non_null(strstr(sphg_last_message(own->context), test_text("%d", bad[k])));
        own->indices[place] = 5;
        SETUP_OK(own->context, call_evaluate(own));
        valid_call_reset(own);
    }
}

/* Lists of a length that cannot be, and lists that are not there: the first is named. */
typedef struct bad_rows {
    const int32_t *rows[VALID_CALL_COUNT];
    int32_t lengths[VALID_CALL_COUNT];
} bad_rows;

static int32_t bad_row(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    const bad_rows *bad = user;
    (void)worker;
    *indices = bad->rows[target];
    return bad->lengths[target];
}

static void lists_of_no_length_are_found_where_operators_read_them(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    for (int k = 0; k < 6; ++k) {
        bad_rows bad;
        for (int i = 0; i < VALID_CALL_COUNT; ++i) {
            bad.rows[i] = own->indices;
            bad.lengths[i] = 3;
        }
        for (int i = 17; i < VALID_CALL_COUNT; i += 11) {
            bad.lengths[i] = k % 3 == 0 ? -1 : k % 3 == 1 ? INT32_MIN : 3;
            bad.rows[i] = k % 3 == 2 ? NULL : own->indices;
        }
        bad.rows[5] = NULL; /* nothing is read there */
        bad.lengths[5] = 0;
        const sphg_lists rows = {.rows = bad.rows, .lengths = bad.lengths},
                         function = {.row = bad_row, .user = &bad};
        SETUP_OK(own->context, sphg_neighbors_use_lists(own->context, own->lone, &own->scheme,
                                                        &own->geometry, k < 3 ? &rows : &function));
        own->sources[0].neighbors = own->lone;
        assert_int_equal(call_evaluate(own), SPHG_ERROR_INDEX);
        TEST_REQUIRE(strstr(sphg_last_message(own->context), "target 17 has"), "%s",
                     sphg_last_message(own->context));
    }
}

/* The first of the targets, in whatever order they are asked for. */
static void first_bad_list_is_named_in_any_order_of_targets(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int32_t picked[] = {50, 9, 30, 3, 40};
    bad_rows bad;
    for (int i = 0; i < VALID_CALL_COUNT; ++i) {
        bad.rows[i] = own->indices;
        bad.lengths[i] = i % 10 == 0 || i == 9 ? -1 : 3;
    }
    const sphg_lists rows = {.rows = bad.rows, .lengths = bad.lengths};
    SETUP_OK(own->context, sphg_neighbors_use_lists(own->context, own->lone, &own->scheme,
                                                    &own->geometry, &rows));
    own->sources[0].neighbors = own->lone;
    own->subset = (sphg_subset){0, 5, picked, NULL};
    own->request.subset = &own->subset;
    assert_int_equal(call_evaluate(own), SPHG_ERROR_INDEX);
    TEST_REQUIRE(strstr(sphg_last_message(own->context), "target 9 has"), "%s",
                 sphg_last_message(own->context));
}

/* ---- Hosts that know their numbers -------------------------------------------------------- */

static sphg_result invert(valid_call *own)
{
    return sphg_invert_moments(own->context, own->scheme_given, own->count, own->tensors,
                               own->volume_view, own->wanted_given);
}

/* A volume is bad: the context that looks says so, the one that trusts goes on. */
static void trusted_contexts_do_not_look_at_volumes(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    double numbers[VALID_CALL_COUNT];
    for (int i = 0; i < VALID_CALL_COUNT; ++i)
        numbers[i] = i == 41 ? -1 : 0.125;
    const setup_array volumes = setup_numbers(test_field_type(test), VALID_CALL_COUNT, 1, numbers);
    own->scheme.method = SPHG_MLS;
    own->volume_view = own->sources[0].volume = own->sources[1].volume = setup_view(&volumes);
    assert_int_equal(call_evaluate(own), SPHG_ERROR_VOLUME);
    assert_int_equal(invert(own), SPHG_ERROR_VOLUME);
    const sphg_config config = {.threads = 2, .isa = test_isa(), .trusted = 1};
    sphg_context *looking = own->context, *trusting = setup_context_with(&config);
    own->context = trusting;
    const sphg_result evaluated = call_evaluate(own), inverted = invert(own);
    own->context = looking;
    SETUP_OK(trusting, evaluated);
    SETUP_OK(trusting, inverted);
}

/* ---- Calls in calls ----------------------------------------------------------------------- */

typedef struct reentry {
    valid_call *own;
    const int32_t *row;
    sphg_result inner, refused;
} reentry;

static int32_t row_that_calls_back(int32_t target, int32_t worker, const int32_t **indices,
                                   void *user)
{
    reentry *call = user;
    valid_call *own = call->own;
    (void)worker;
    if (target == 0) {
        call->inner = sphg_eigen(own->context, own->dimension, own->count, own->table,
                                 own->vector_out, own->tensor_out);
        call->refused = sphg_gradient(own->context, &own->scheme, own->sources, NULL, sphg_absent(),
                                      own->vector_out);
    }
    *indices = call->row;
    return VALID_CALL_COUNT;
}

static void context_in_use_is_busy(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    reentry call = {own, own->indices, SPHG_OK, SPHG_OK};
    memset(&own->lists, 0, sizeof own->lists);
    own->lists.row = row_that_calls_back;
    own->lists.user = &call;
    SETUP_OK(own->context, sphg_neighbors_use_lists(own->context, own->lone, &own->scheme,
                                                    &own->geometry, &own->lists));
    own->sources[0].neighbors = own->lone;
    SETUP_OK(own->context, call_evaluate(own));
    assert_int_equal(call.inner, SPHG_ERROR_BUSY);
    assert_int_equal(call.refused, SPHG_ERROR_BUSY); /* before it looks at what is wrong */
    SETUP_OK(own->context, call_evaluate(own));
}

/* ---- Pairs and short ways ----------------------------------------------------------------- */

/* Of four targets, so that the arrays suffice. */
static sphg_result pair_gradients(valid_call *own)
{
    if (own->subset.end == VALID_CALL_COUNT)
        own->subset.end = 4;
    return sphg_pair_gradients(own->context, own->scheme_given, own->sources_given, &own->subset,
                               sphg_absent(), own->pairs_given);
}

static void pairs_refuse_bad_arguments(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "pairs", own->pairs_given = NULL);
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "sources", own->sources_given = NULL);
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "scheme", own->scheme_given = NULL);
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "capacity", own->pairs.capacity = -1);
    REFUSES(pair_gradients, SPHG_ERROR_TYPE, "gradient",
            own->pairs.gradient.type = other_type(own));
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "gradient", own->pairs.gradient.stride = 0);
    REFUSES(pair_gradients, SPHG_ERROR_ARGUMENT, "volume", own->sources[0].volume = sphg_absent());
    REFUSES(pair_gradients, SPHG_ERROR_STATE, "", own->sources[0].neighbors = own->blank);
}

static void pairs_report_the_capacity_they_need(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    SETUP_OK(own->context, pair_gradients(own));
    const int64_t needed = own->pairs.count;
    assert_true(needed > 4);
    for (int64_t capacity = 0; capacity < needed; capacity += needed - 1) {
        int64_t offsets[5] = {-7, -7, -7, -7, -7};
        valid_call_reset(own);
        own->pairs.capacity = capacity;
        own->pairs.offsets = offsets;
        valid_call_require(own, pair_gradients(own), SPHG_ERROR_CAPACITY, "capacity", "capacity");
        assert_int_equal(own->pairs.count, needed);
        for (int k = 0; k < 5; ++k)
            assert_int_equal(offsets[k], -7);
    }
    valid_call_reset(own);
    own->pairs.capacity = needed;
    SETUP_OK(own->context, pair_gradients(own));
}

static sphg_result correction(valid_call *own)
{
    return sphg_correction(own->context, own->scheme_given, own->sources_given, NULL,
                           own->table_out, own->rank_out);
}

static sphg_result gradient(valid_call *own)
{
    return sphg_gradient(own->context, own->scheme_given, own->sources_given, NULL, own->scalars,
                         own->vector_out);
}

static sphg_result force(valid_call *own)
{
    if (!own->sources[1].neighbors)
        own->sources[0].correction = own->table;
    return sphg_force(own->context, own->scheme_given, own->sources_given, NULL, SPHG_SCALAR,
                      own->scalars, own->vector_out);
}

static void short_ways_refuse_bad_arguments(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_result (*const calls[])(valid_call *) = {correction, gradient, force};
    for (int k = 0; k < 3; ++k) {
        REFUSES(calls[k], SPHG_ERROR_ARGUMENT, "scheme", own->scheme_given = NULL);
        REFUSES(calls[k], SPHG_ERROR_ARGUMENT, "sources", own->sources_given = NULL);
        REFUSES(calls[k], SPHG_ERROR_STATE, "", own->sources[0].neighbors = own->blank);
        if (calls[k] != correction) /* A_i is looked up in the set that the targets are part of */
            REFUSES(calls[k], SPHG_ERROR_ARGUMENT, "at_targets",
                    own->sources[0].neighbors = own->lone);
        REFUSES(calls[k], SPHG_ERROR_ARGUMENT, "volume", own->sources[0].volume = sphg_absent());
    }
    REFUSES(correction, VALID_CALL_REFUSED, "", own->scheme.method = SPHG_PLAIN);
    REFUSES(gradient, SPHG_ERROR_ARGUMENT, "", own->scalars = sphg_absent());
    REFUSES(gradient, SPHG_ERROR_ARGUMENT, "gradient", own->vector_out = sphg_absent());
    REFUSES(force, SPHG_ERROR_ARGUMENT, "correction", own->sources[1] = own->sources[0]);
}

#define EACH(property) TEST_ENTRY(property, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(evaluate_refuses_bad_schemes),
    EACH(evaluate_refuses_bad_sources),
    EACH(evaluate_refuses_bad_fields),
    EACH(evaluate_refuses_differences_to_what_is_absent),
    EACH(evaluate_refuses_subsets_without_an_end),
    EACH(evaluate_refuses_corrections_that_plain_has_not),
    EACH(evaluate_refuses_operators_that_a_shape_has_not),
    EACH(two_sided_forms_need_tables_and_densities),
    EACH(evaluate_refuses_bad_outputs_of_corrections),
    EACH(overlapping_outputs_are_refused),
    EACH(members_of_one_record_do_not_overlap),
    EACH(single_item_may_stand_inside_a_record),
    EACH(set_needs_corrections_where_it_is_read_from_the_other_side),
    EACH(evaluate_refuses_bad_subsets),
    EACH(several_sets_must_agree),
    EACH(bad_volumes_are_found_and_named),
    EACH(bad_indices_are_found_where_operators_read_them),
    EACH(lists_of_no_length_are_found_where_operators_read_them),
    EACH(first_bad_list_is_named_in_any_order_of_targets),
    EACH(trusted_contexts_do_not_look_at_volumes),
    EACH(context_in_use_is_busy),
    EACH(pairs_refuse_bad_arguments),
    EACH(pairs_report_the_capacity_they_need),
    EACH(short_ways_refuse_bad_arguments),
};
TEST_MAIN(entries)
