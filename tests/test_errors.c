/* SPDX-License-Identifier: MIT */
/* Every way to say no: contexts, neighbours and small matrices refuse bad arguments with the right
 * code and a message that names the argument, write nothing, and work on the next call. */
#include "support/public_calls.h"
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Codes -------------------------------------------------------------------------------- */

static void every_result_has_a_text_of_its_own(const test_case *test)
{
    (void)test;
#define CODE(name, value, text) {SPHG_##name, value, text},
    static const struct {
        sphg_result result;
        int value;
        const char *text;
    } codes[] = {SPHG_RESULT_LIST(CODE)};
#undef CODE
    for (size_t k = 0; k < sizeof codes / sizeof *codes; ++k) {
        assert_int_equal(codes[k].result, codes[k].value);
        assert_string_equal(sphg_result_string(codes[k].result), codes[k].text);
    }
    const int unknown[] = {-100, -4, 10, 1000, INT_MAX, INT_MIN};
    for (int k = 0; k < 6; ++k) {
        const char *text = sphg_result_string((sphg_result)unknown[k]);
        assert_true(text && text[0] != 0);
    }
    assert_int_equal(sphg_version(), SPHG_VERSION);
}

/* ---- Context ------------------------------------------------------------------------------ */

static void expect_no_context(int32_t version, const sphg_config *config, int expected)
{
    sphg_context *context = (sphg_context *)(uintptr_t)64;
    const sphg_result result = sphg_context_create(version, config, &context);
    TEST_REQUIRE((int)result == expected, "create: %s", sphg_result_string(result));
    assert_null(context);
}

static void *no_memory(size_t size, size_t alignment, void *user)
{
    (void)size, (void)alignment, (void)user;
    return NULL;
}

static void no_release(void *memory, size_t size, void *user)
{
    (void)memory, (void)size, (void)user;
}

static void no_executor(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    (void)task, (void)data, (void)count, (void)grain, (void)user;
}

static void context_refuses_bad_configurations(const test_case *test)
{
    (void)test;
    const sphg_config good = {0};
    sphg_config config = good;
    assert_int_equal(sphg_context_create(SPHG_VERSION, &good, NULL), SPHG_ERROR_ARGUMENT);
    const int32_t versions[] = {0, -1, SPHG_VERSION + 1000000, INT32_MAX, INT32_MIN};
    for (int k = 0; k < 5; ++k)
        expect_no_context(versions[k], &good, SPHG_ERROR_VERSION);
    const int32_t threads[] = {-1, INT32_MIN};
    for (int k = 0; k < 2; ++k) {
        config.threads = threads[k];
        expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_ARGUMENT);
    }
    config = good;
    const int isas[] = {-1, 5, INT_MAX};
    for (int k = 0; k < 3; ++k) {
        config.isa = (sphg_isa)isas[k];
        expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_ARGUMENT);
    }
    config = good;
    config.parallel_for = no_executor; /* of how many workers? */
    expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_ARGUMENT);
    config = good;
    config.allocate = no_memory;
    expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_ARGUMENT);
    config.allocate = NULL;
    config.release = no_release;
    expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_ARGUMENT);
    config.allocate = no_memory;
    expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_MEMORY);
}

#ifdef __x86_64__
static void require_path(sphg_isa isa, int expected, const char *name)
{
    TEST_REQUIRE((setup_context_on(isa) != NULL) == expected, "%s is %s", name,
                 expected ? "refused" : "accepted");
}
#endif

/* All that the library was built with and the processor has, and no other. */
static void each_path_of_the_processor_can_be_asked_for(const test_case *test)
{
    (void)test;
    assert_non_null(setup_context_on(SPHG_ISA_BEST));
#ifdef __x86_64__
    const int built = !getenv("SPHG_TEST_BASELINE_ALONE"); /* another library in its place */
    const int v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                   __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const int v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
    require_path(SPHG_ISA_BASE, 1, "the baseline");
    require_path(SPHG_ISA_X86_V3, built && TEST_LIBRARY_HAS_V3 && v3, "x86-64-v3");
    require_path(SPHG_ISA_X86_V4, built && TEST_LIBRARY_HAS_V4 && v3 && v4, "x86-64-v4");
    require_path(SPHG_ISA_NEON, 0, "NEON");
#endif
}

static void no_configuration_is_the_default(const test_case *test)
{
    (void)test;
    sphg_context *context = NULL;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, NULL, &context));
    const double matrix[6] = {2, 0, 0, 1, 0, 3}, sorted[3] = {3, 2, 1};
    double values[3];
    SETUP_OK(context, sphg_eigen(context, 3, 1, sphg_view_f64(matrix, sizeof matrix),
                                 sphg_view_f64(values, sizeof values), sphg_absent()));
    assert_memory_equal(values, sorted, sizeof sorted);
    sphg_context_destroy(context);
}

/* On any machine one of the two foreign instruction sets is missing. */
static void context_refuses_the_instruction_set_of_another_machine(const test_case *test)
{
    (void)test;
    sphg_config config = {0};
#if defined(__x86_64__) || defined(_M_X64)
    config.isa = SPHG_ISA_NEON;
#else
    config.isa = SPHG_ISA_X86_V3;
#endif
    expect_no_context(SPHG_VERSION, &config, SPHG_ERROR_UNSUPPORTED);
}

static void null_handles_are_refused_and_nothing_is_destroyed_twice(const test_case *test)
{
    (void)test;
    sphg_context *context = setup_context();
    sphg_neighbors *neighbors = NULL;
    sphg_context_destroy(NULL);
    sphg_neighbors_destroy(NULL);
    assert_non_null(sphg_last_message(NULL));
    assert_non_null(sphg_last_message(context));
    assert_int_equal(sphg_neighbors_create(NULL, &neighbors), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_neighbors_create(context, NULL), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_neighbors_create(context, &neighbors), SPHG_OK);
    sphg_neighbors_destroy(neighbors);
}

/* ---- Builds ------------------------------------------------------------------------------- */

#define REFUSES(call, expected, words, change)                                                     \
    VALID_CALL_REFUSES(own, call, expected, words, change)

static void *shifted(const void *memory, ptrdiff_t bytes)
{
    return (void *)((uintptr_t)memory + (uintptr_t)bytes);
}

typedef sphg_result victim_call(valid_call *own);

/* What search and use_lists have in common. */
static void refuse_bad_geometry(valid_call *own, victim_call *call)
{
    const sphg_type other = own->position_view.type == SPHG_F32 ? SPHG_F64 : SPHG_F32;
    REFUSES(call, SPHG_ERROR_ARGUMENT, "scheme", own->scheme_given = NULL);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "geometry", own->geometry_given = NULL);
    const int dimensions[] = {1, 4, -1, INT_MAX, INT_MIN};
    for (int k = 0; k < 5; ++k)
        REFUSES(call, SPHG_ERROR_ARGUMENT, "dimension", own->scheme.dimension = dimensions[k]);
    const double radii[] = {0, -0.0, -1, NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 6; ++k)
        REFUSES(call, SPHG_ERROR_ARGUMENT, "support_radius", own->scheme.support_radius = radii[k]);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "source_count", own->geometry.source_count = -1);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "target_count", own->geometry.target_count = -1);
    REFUSES(call, VALID_CALL_REFUSED, "target_count", own->geometry.source_count = 10);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "sources", own->geometry.sources.x = NULL);
    REFUSES(call, VALID_CALL_REFUSED, "sources", own->geometry.sources.type = SPHG_U8);
    REFUSES(call, VALID_CALL_REFUSED, "sources", own->geometry.sources.type = (sphg_type)0);
    REFUSES(call, VALID_CALL_REFUSED, "sources", own->geometry.sources.type = (sphg_type)17);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "sources", own->geometry.sources.stride += 1);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "sources",
            own->geometry.sources.x = shifted(own->geometry.sources.x, 1));
    REFUSES(call, SPHG_ERROR_ARGUMENT, "sources.stride is 0", own->geometry.sources.stride = 0);
    REFUSES(call, SPHG_ERROR_ARGUMENT, "targets.stride is 0",
            own->geometry.targets = own->position_view;
            own->geometry.targets.stride = 0);
    REFUSES(call, SPHG_ERROR_TYPE, "targets", own->geometry.targets = own->position_view;
            own->geometry.targets.type = other);
    REFUSES(call, VALID_CALL_REFUSED, "precision", own->geometry.precision = SPHG_U8);
    REFUSES(call, VALID_CALL_REFUSED, "precision", own->geometry.precision = (sphg_type)-1);
    const int d = own->test->dimension, single = own->test->precision == TEST_F32;
    /* H and H^2 are in range, H^-d is not */
    REFUSES(call, SPHG_ERROR_ARGUMENT, "support_radius",
            own->scheme.support_radius =
                d == 3 ? (single ? 1e-13 : 1e-110) : (single ? 1.5e19 : 1.2e154));
    for (int part = 1; part < 3 && d == 3; ++part) /* one component of three is not aligned */
        REFUSES(call, SPHG_ERROR_ARGUMENT, "sources",
                own->geometry.sources.y = (const char *)own->position_view.x + (part == 1);
                own->geometry.sources.z = (const char *)own->position_view.x + (part == 2));
    if (single)
        REFUSES(call, SPHG_ERROR_TYPE, "precision", own->geometry.precision = SPHG_F64);
    const double periods[] = {-4, NAN, INFINITY, 1.5};
    for (int k = 0; k < 4; ++k)
        REFUSES(call, SPHG_ERROR_ARGUMENT, "period", own->geometry.period[1] = periods[k]);
}

static void builds_refuse_bad_geometry(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    refuse_bad_geometry(own, call_search);
    refuse_bad_geometry(own, call_would_rebuild);
    refuse_bad_geometry(own, call_use_lists);
    const double skins[] = {-0.25, NAN, INFINITY};
    for (int k = 0; k < 3; ++k) {
        REFUSES(call_search, SPHG_ERROR_ARGUMENT, "skin", own->geometry.skin = skins[k]);
        REFUSES(call_would_rebuild, SPHG_ERROR_ARGUMENT, "skin", own->geometry.skin = skins[k]);
    }
    REFUSES(call_search, SPHG_ERROR_ARGUMENT, "skin",
            own->geometry.skin = own->geometry.list_free = 1);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "skin", own->geometry.skin = 0.25);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "list_free", own->geometry.list_free = 1);
    REFUSES(call_search, SPHG_ERROR_ARGUMENT, "neighbors", own->neighbors = NULL);
    REFUSES(call_would_rebuild, SPHG_ERROR_ARGUMENT, "neighbors", own->neighbors = NULL);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "neighbors", own->neighbors = NULL);
    assert_int_equal(sphg_neighbors_search(NULL, own->built, &own->scheme, &own->geometry),
                     SPHG_ERROR_ARGUMENT);
    assert_int_equal(
        sphg_neighbors_use_lists(NULL, own->built, &own->scheme, &own->geometry, &own->lists),
        SPHG_ERROR_ARGUMENT);
}

static void put(valid_call *own, int item, double value)
{
    const int k = item * own->test->dimension + item % own->test->dimension;
    if (own->position_view.type == SPHG_F64)
        ((double *)(uintptr_t)own->position_view.x)[k] = value;
    else
        ((float *)(uintptr_t)own->position_view.x)[k] = (float)value;
}

static double get(const valid_call *own, int item)
{
    const int k = item * own->test->dimension + item % own->test->dimension;
    return own->position_view.type == SPHG_F64
               ? ((const double *)(uintptr_t)own->position_view.x)[k]
               : (double)((const float *)(uintptr_t)own->position_view.x)[k];
}

/* The first bad particle is named; targets of their own are looked at as well. */
static void builds_refuse_positions_that_are_not_finite(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int items[] = {0, 31, VALID_CALL_COUNT - 1};
    const double values[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 9; ++k) {
        const int item = items[k % 3];
        const double kept = get(own, item), last = get(own, VALID_CALL_COUNT - 1);
        const char *name = test_text("[%d]", item);
        for (int lists = 0; lists < 2; ++lists) {
            valid_call_reset(own);
            put(own, VALID_CALL_COUNT - 1, NAN);
            put(own, item, values[k / 3]);
            valid_call_require(own, lists ? call_use_lists(own) : call_search(own),
                               SPHG_ERROR_NOT_FINITE, name, "position");
            put(own, item, kept);
            put(own, VALID_CALL_COUNT - 1, last);
            assert_int_equal(lists ? call_use_lists(own) : call_search(own), SPHG_OK);
        }
    }
    setup_array bad = setup_output(own->position_view.type, 3, test->dimension);
    memset(bad.data, 0xff, (size_t)(3 * test->dimension) * (test->precision == TEST_F64 ? 8 : 4));
    REFUSES(call_search, SPHG_ERROR_NOT_FINITE, "targets", own->geometry.targets = setup_view(&bad);
            own->geometry.target_count = 3);
}

static void trusted_contexts_still_check_arguments(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_config config = {.isa = test_isa()};
    config.trusted = 1;
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    assert_int_equal(sphg_context_create(SPHG_VERSION, &config, &context), SPHG_OK);
    assert_int_equal(sphg_neighbors_create(context, &neighbors), SPHG_OK);
    own->scheme.support_radius = -1;
    assert_int_equal(sphg_neighbors_search(context, neighbors, &own->scheme, &own->geometry),
                     SPHG_ERROR_ARGUMENT);
    own->scheme.support_radius = 1;
    assert_int_equal(sphg_neighbors_search(context, neighbors, &own->scheme, &own->geometry),
                     SPHG_OK);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
}

static int32_t no_row(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    (void)target, (void)worker, (void)user;
    *indices = NULL;
    return 0;
}

static void lists_are_refused_unless_one_group_is_whole(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const int32_t *rows[VALID_CALL_COUNT] = {0};
    const int32_t lengths[VALID_CALL_COUNT] = {0};
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "lists", own->lists_given = NULL);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "lists",
            memset(&own->lists, 0, sizeof own->lists));
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "", own->lists.row = no_row);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "", own->lists.rows = rows;
            own->lists.lengths = lengths);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "indices", own->lists.indices = NULL);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "offsets", own->lists.offsets = NULL);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "lengths",
            memset(&own->lists, 0, sizeof own->lists);
            own->lists.rows = rows);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "rows", memset(&own->lists, 0, sizeof own->lists);
            own->lists.lengths = lengths);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "offsets", own->offsets[0] = 1);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "offsets", own->offsets[0] = -1);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "offsets", own->offsets[9] = own->offsets[8] - 1);
    REFUSES(call_use_lists, SPHG_ERROR_ARGUMENT, "offsets", own->offsets[VALID_CALL_COUNT] = 0);
}

static void reports_refuse_bad_handles(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    sphg_neighbors_info info = {0};
    sphg_context_info context_info = {0};
    int32_t order[VALID_CALL_COUNT];
    assert_int_equal(sphg_context_get_info(own->context, NULL), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_context_get_info(NULL, &context_info), SPHG_ERROR_ARGUMENT);
    REFUSES(call_get_info, SPHG_ERROR_ARGUMENT, "neighbors", own->neighbors = NULL);
    REFUSES(call_get_order, SPHG_ERROR_ARGUMENT, "neighbors", own->neighbors = NULL);
    REFUSES(call_get_order, SPHG_ERROR_STATE, "", own->neighbors = own->blank);
    assert_int_equal(sphg_neighbors_get_info(own->context, own->built, NULL), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_neighbors_get_order(own->context, own->built, NULL), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_neighbors_get_info(NULL, own->built, &info), SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_neighbors_get_order(NULL, own->built, order), SPHG_ERROR_ARGUMENT);
}

/* ---- Small matrices ----------------------------------------------------------------------- */

static void inversion_refuses_bad_arguments(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const sphg_type other = own->position_view.type == SPHG_F32 ? SPHG_F64 : SPHG_F32;
    const double thresholds[] = {-0.01, 1, 2, NAN, INFINITY};
    for (int k = 0; k < 5; ++k)
        REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "threshold",
                own->scheme.threshold = thresholds[k]);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "scheme", own->scheme_given = NULL);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "", own->wanted_given = NULL);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "count", own->count = -1);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "moments", own->symmetric.x = NULL);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "moments", own->symmetric.stride += 1);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "correction",
            own->wanted.correction.stride = 0);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "overlaps",
            own->wanted.correction = own->symmetric;
            own->wanted.correction.stride *= 2; own->count /= 2);
    REFUSES(call_invert_moments, SPHG_ERROR_TYPE, "correction",
            own->wanted.correction.type = other);
    REFUSES(call_invert_moments, SPHG_ERROR_TYPE, "rank", own->wanted.rank.type = other);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "dimension", own->scheme.dimension = 4);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "policy",
            own->scheme.policy = (sphg_policy)4);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "method",
            own->scheme.method = (sphg_method)6);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "kernel",
            own->scheme.kernel = (sphg_kernel)7);
    REFUSES(call_invert_moments, SPHG_ERROR_ARGUMENT, "support_radius",
            own->scheme.support_radius = NAN);
    REFUSES(call_invert_moments, SPHG_ERROR_UNSUPPORTED, "method", own->scheme.method = SPHG_CMLS);
    REFUSES(call_invert_moments, SPHG_ERROR_UNSUPPORTED, "method", own->scheme.method = SPHG_CRKPM);
    REFUSES(call_invert_moments, SPHG_ERROR_UNSUPPORTED, "method", own->scheme.method = SPHG_PLAIN);
    const float bad_single[] = {-1, NAN, INFINITY};
    const double bad[] = {-1, NAN, INFINITY};
    for (int k = 0; k < 3; ++k)
        REFUSES(call_invert_moments, SPHG_ERROR_VOLUME, "volume", own->scheme.method = SPHG_MLS;
                own->volume_view.stride = 0;
                own->volume_view.x = own->volume_view.type == SPHG_F64
                                         ? (const void *)&bad[k]
                                         : (const void *)&bad_single[k]);
}

static void eigen_and_svd_refuse_bad_arguments(const test_case *test)
{
    valid_call *own = valid_call_create_plain(test);
    const sphg_type other = own->position_view.type == SPHG_F32 ? SPHG_F64 : SPHG_F32;
    const int dimensions[] = {1, 4, -1, INT_MAX};
    for (int k = 0; k < 4; ++k)
        REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "dimension", own->dimension = dimensions[k]);
    REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "count", own->count = -1);
    REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "matrices", own->symmetric.x = NULL);
    REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "values", own->vector_out.stride = 0);
    REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "vectors", own->tensor_out.stride -= 1);
    REFUSES(call_eigen, SPHG_ERROR_ARGUMENT, "vectors",
            own->tensor_out.x = shifted(own->tensor_out.x, 2));
    REFUSES(call_eigen, SPHG_ERROR_TYPE, "values", own->vector_out.type = other);
    if (test->dimension == 2)
        return;
    REFUSES(call_svd, SPHG_ERROR_ARGUMENT, "count", own->count = -1);
    REFUSES(call_svd, SPHG_ERROR_ARGUMENT, "matrices", own->squares.x = NULL);
    REFUSES(call_svd, SPHG_ERROR_ARGUMENT, "sigma", own->sigma.stride = 0);
    REFUSES(call_svd, SPHG_ERROR_TYPE, "u", own->u.type = other);
    assert_int_equal(sphg_eigen(NULL, 3, 1, own->symmetric, own->vector_out, own->tensor_out),
                     SPHG_ERROR_ARGUMENT);
    assert_int_equal(sphg_svd(NULL, 1, own->squares, own->u, own->sigma, own->v),
                     SPHG_ERROR_ARGUMENT);
}

/* ---- Numbers in messages ------------------------------------------------------------------ */

/* The number behind `words` in a message, which has a decimal point in every locale. */
static double number_behind(const char *message, const char *words)
{
    const char *at = strstr(message, words);
    TEST_REQUIRE(at, "no '%s': %s", words, message);
    const char *locale = test_text("%s", setlocale(LC_NUMERIC, NULL));
    setlocale(LC_NUMERIC, "C");
    const double value = strtod(at + strlen(words), NULL);
    setlocale(LC_NUMERIC, locale);
    return value;
}

static void require_number(valid_call *own, const char *words, double value)
{
    const char *message = sphg_last_message(own->context);
    TEST_REQUIRE(number_behind(message, words) == value, "not %.17g: %s", value, message);
}

#define SHOWS(call, name, value)                                                                   \
    do {                                                                                           \
        REFUSES(call, VALID_CALL_REFUSED, "", own->name = value);                                  \
        own->name = value;                                                                         \
        assert_int_not_equal(call(own), SPHG_OK);                                                  \
        require_number(own, #name " is ", value);                                                  \
        valid_call_reset(own);                                                                     \
    } while (0)

/* A value beyond its limit by a rounding is not printed as the limit, in the host's locale either
 * (checks/messages_in_a_locale.sh names one with decimal commas). */
static void messages_print_numbers_that_read_back(const test_case *test)
{
    const char *locale = getenv("SPHG_TEST_LOCALE");
    if (locale) {
        assert_non_null(setlocale(LC_NUMERIC, locale));
        assert_string_not_equal(localeconv()->decimal_point, ".");
    }
    valid_call *own = valid_call_create_plain(test);
    const double above_one[] = {1, nextafter(1, 2), 1.0000000001, 1.1, 1e300};
    const double below_zero[] = {-5e-324, -1e-9, -0.1, -1.0 / 3, -123456789};
    for (int k = 0; k < 5; ++k) {
        SHOWS(call_search, scheme.threshold, above_one[k]);
        SHOWS(call_search, scheme.threshold, below_zero[k]);
        SHOWS(call_search, scheme.support_radius, below_zero[k]);
        SHOWS(call_search, geometry.skin, below_zero[k]);
        SHOWS(call_search, geometry.period[0], below_zero[k]);
        SHOWS(call_use_lists, geometry.skin, -below_zero[k]);
    }
    SHOWS(call_search, geometry.period[1], 2 * own->scheme.support_radius * (1 - 1e-6));
    own->geometry.period[1] = 2 * own->scheme.support_radius * (1 - 1e-6);
    call_search(own);
    require_number(own, "(H + skin) = ", 2 * own->scheme.support_radius);
    valid_call_reset(own);
    SHOWS(call_search, scheme.support_radius,
          test->precision == TEST_F32 ? 1.0000000001e20 : 1.1e200);
    setlocale(LC_NUMERIC, "C");
}

/* ---- Widths ------------------------------------------------------------------------------- */

/* A scheme that cannot be asked has no width. */
static void correction_width_is_that_of_the_method(const test_case *test)
{
    const int32_t classic = test->dimension == 2 ? 9 : 16, linear = test->dimension == 2 ? 3 : 6;
    for (int method = 0; method < 6; ++method) {
        sphg_scheme scheme = setup_scheme(test, 1);
        scheme.method = (sphg_method)method;
        const int32_t expected = method == SPHG_PLAIN                          ? 0
                                 : method == SPHG_CMLS || method == SPHG_CRKPM ? classic
                                                                               : linear;
        assert_int_equal(sphg_correction_width(&scheme), expected);
    }
}

#define EACH(property) TEST_ENTRY(property, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    TEST_ONCE(every_result_has_a_text_of_its_own),
    TEST_ONCE(context_refuses_bad_configurations),
    TEST_ONCE(no_configuration_is_the_default),
    TEST_ONCE(context_refuses_the_instruction_set_of_another_machine),
    TEST_ONCE(each_path_of_the_processor_can_be_asked_for),
    TEST_ONCE(null_handles_are_refused_and_nothing_is_destroyed_twice),
    EACH(builds_refuse_bad_geometry),
    EACH(builds_refuse_positions_that_are_not_finite),
    EACH(trusted_contexts_still_check_arguments),
    EACH(lists_are_refused_unless_one_group_is_whole),
    EACH(reports_refuse_bad_handles),
    EACH(inversion_refuses_bad_arguments),
    EACH(eigen_and_svd_refuse_bad_arguments),
    EACH(messages_print_numbers_that_read_back),
    EACH(correction_width_is_that_of_the_method),
};
TEST_MAIN(entries)
