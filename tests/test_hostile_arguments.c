/* SPDX-License-Identifier: MIT */
/* Every function of the header, every argument, every class of bad value, in both precisions: the
 * right code, a message that names argument and value, nothing written, and the next call works.
 * The list of functions, parameters and members comes from the header: what is new there and has no
 * rows here does not compile or fails. */
#include "public_names.h"
#include "support/bad_argument_rows.h"
#include "support/public_calls.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static int begins_with(const char *path, const char *name, size_t length)
{
    return strncmp(path, name, length) == 0 && (path[length] == 0 || path[length] == '.');
}

static int has_row(const char *function, const char *name, size_t length)
{
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p)
            for (int a = 0; a < argument_functions[f].probes[p].count; ++a)
                if ((!function || strcmp(argument_functions[f].name, function) == 0) &&
                    begins_with(argument_functions[f].probes[p].arguments[a].path, name, length))
                    return 1;
    return 0;
}

static void every_parameter_has_a_row(const test_case *test)
{
    (void)test;
    for (int f = 0; f < argument_function_count; ++f)
        for (const char *word = argument_functions[f].parameters + 1; *word;) {
            const size_t length = strcspn(word, " ");
            TEST_REQUIRE(!length || has_row(argument_functions[f].name, word, length),
                         "%s: no rows for %.*s", argument_functions[f].name, (int)length, word);
            word += length + (word[length] == ' ');
        }
}

/* By which name the rows know a struct of the header; NULL: the library writes it, or, a view, it
 * is a kind of its own. */
static const struct {
    const char *structure, *prefix;
} prefixes[] = {
    {"sphg_view", NULL},          {"sphg_neighbors_info", NULL}, {"sphg_stats", NULL},
    {"sphg_config", "config"},    {"sphg_scheme", "scheme"},     {"sphg_geometry", "geometry"},
    {"sphg_lists", "lists"},      {"sphg_sources", "sources"},   {"sphg_subset", "subset"},
    {"sphg_field", "fields"},     {"sphg_request", "request"},   {"sphg_pairs", "pairs"},
    {"sphg_inversion", "wanted"}, {"sphg_context_info", NULL},   {"sphg_list_fault", NULL}};

static void require_row(const char *structure, const char *name)
{
    for (size_t k = 0; k < sizeof prefixes / sizeof *prefixes; ++k)
        if (strcmp(prefixes[k].structure, structure) == 0) {
            const char *path =
                test_text("%s.%s", prefixes[k].prefix ? prefixes[k].prefix : "", name);
            TEST_REQUIRE(!prefixes[k].prefix || has_row(NULL, path, strlen(path)), "no rows for %s",
                         path);
            return;
        }
    fail_msg("%s has no rows", structure);
}

static void every_member_has_a_row(const test_case *test)
{
    (void)test;
#define MEMBER(structure, name) require_row(#structure, name);
    PUBLIC_MEMBERS(MEMBER)
#undef MEMBER
}

/* ---- The property ------------------------------------------------------------------------- */

static long cells, complaints;

static const char *words_for(const trial *made, const argument *spoilt)
{
    const char *dot = strrchr(spoilt->path, '.');
    return made->words ? made->words : spoilt->said ? spoilt->said : dot ? dot + 1 : spoilt->path;
}

static int is_heard(const valid_call *own, const trial *made, const argument *spoilt)
{
    const char *message = own->host->log_message;
    return own->host->log_count == 1 && strstr(message, words_for(made, spoilt)) &&
           strstr(message, made->value);
}

/* All complaints are printed before the case fails. */
__attribute__((format(printf, 2, 3))) static void judge(int holds, const char *format, ...)
{
    va_list arguments;
    if (holds)
        return;
    ++complaints;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    putchar('\n');
}

static sphg_neighbors_info info_of(const valid_call *own)
{
    sphg_neighbors_info info;
    SETUP_OK(own->living, sphg_neighbors_get_info(own->living, own->rebuilt, &info));
    return info;
}

static void judge_refusal(const valid_call *own, const trial *made, const argument *spoilt,
                          sphg_result result, const char *where)
{
    const int expected = made->expected;
    judge(expected == ARGUMENT_REFUSED ? result > 0 : (int)result == expected,
          "%s: %d (%s), not %d", where, (int)result, own->host->log_message, expected);
    if (result == SPHG_OK)
        return;
    judge(spoilt->kind == ARGUMENT_HANDLE || is_heard(own, made, spoilt),
          "%s: '%s' (%d) lacks '%s' or '%s'", where, own->host->log_message, own->host->log_count,
          words_for(made, spoilt), made->value);
    judge(spoilt->kind == ARGUMENT_HANDLE || own->host->log_result == result,
          "%s: the log heard another code", where);
    judge(result < 0 || valid_call_outputs_are_untouched(own), "%s: an output was written", where);
}

static void prepare(valid_call *own, const probe *tested)
{
    valid_call_reset(own);
    if (tested->prepare)
        tested->prepare(own);
}

/* Member by member: between them there is padding. */
static int is_same(const sphg_neighbors_info *a, const sphg_neighbors_info *b)
{
    return a->pairs == b->pairs && a->bytes == b->bytes && a->target_count == b->target_count &&
           a->source_count == b->source_count && a->rebuilt == b->rebuilt &&
           memcmp(&a->skin_left, &b->skin_left, sizeof a->skin_left) == 0;
}

/* Spoils, calls, judges, and makes the valid call; 0: this argument has no such way. */
static int try_once(valid_call *own, const argument_function *function, const probe *tested, int a,
                    int number)
{
    const argument *spoilt = &tested->arguments[a];
    trial made;
    prepare(own, tested);
    if (!argument_spoil(own, tested, a, number, &made))
        return 0;
    if (made.expected == ARGUMENT_SKIPPED)
        return 1;
    const char *where = test_text("%s: %s %s", function->name, spoilt->path, made.what);
    memset(own->host->log_message, 0, sizeof own->host->log_message);
    const sphg_neighbors_info before = info_of(own);
    const sphg_result result = tested->call(own);
    const sphg_neighbors_info after = info_of(own);
    judge_refusal(own, &made, spoilt, result, where);
    judge(!result || is_same(&before, &after), "%s: the neighbours changed", where);
    argument_restore(&made);
    prepare(own, tested);
    judge(tested->call(own) == SPHG_OK, "after %s: %s", where, own->host->log_message);
    ++cells;
    return 1;
}

static void refuse_everywhere(const test_case *test, int trusted)
{
    valid_call *own = valid_call_create(test, trusted);
    cells = complaints = 0;
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p) {
            const probe *tested = &argument_functions[f].probes[p];
            if (!tested->call)
                continue;
            for (int a = 0; a < tested->count; ++a)
                for (int number = 0;
                     !(trusted && argument_is_about_numbers(tested->arguments[a].kind)) &&
                     try_once(own, &argument_functions[f], tested, a, number);
                     ++number)
                    ;
        }
    printf("%ld cells\n", cells);
    TEST_REQUIRE(cells > 1000 && complaints == 0, "%ld complaints in %ld cells", complaints, cells);
}

static void every_bad_argument_is_refused_and_named(const test_case *test)
{
    refuse_everywhere(test, 0);
}

/* What a context trusts are numbers, not arguments. */
static void trusted_contexts_refuse_the_same_arguments(const test_case *test)
{
    refuse_everywhere(test, 1);
}

/* ---- A context in use --------------------------------------------------------------------- */

typedef struct reentry {
    valid_call *own;
    const probe *tested;
    sphg_result inner;
    int untouched;
} reentry;

static int32_t row_that_calls_back(int32_t target, int32_t worker, const int32_t **indices,
                                   void *user)
{
    reentry *again = user;
    (void)worker;
    if (target == 0) {
        again->inner = again->tested->call(again->own);
        again->untouched = valid_call_outputs_are_untouched(again->own);
    }
    *indices = again->own->indices;
    return VALID_CALL_COUNT;
}

static int takes_a_context(const probe *tested)
{
    return tested->call && tested->call != call_create_context;
}

/* Every function, called from within another call on the same context. */
static void every_function_is_refused_while_the_context_is_busy(const test_case *test)
{
    valid_call *own = valid_call_create(test, 0);
    setup_array results = setup_output(test_field_type(test), VALID_CALL_COUNT, test->dimension);
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p) {
            reentry again = {own, &argument_functions[f].probes[p], SPHG_OK, 0};
            const sphg_lists lists = {.row = row_that_calls_back, .user = &again};
            if (!takes_a_context(again.tested))
                continue;
            prepare(own, again.tested);
            SETUP_OK(own->living, sphg_neighbors_use_lists(own->living, own->listed, &own->scheme,
                                                           &own->valid->geometry, &lists));
            const sphg_sources sources = {.neighbors = own->listed, .volume = own->volume_view};
            SETUP_OK(own->living, sphg_gradient(own->living, &own->scheme, &sources, NULL,
                                                own->scalars, setup_view(&results)));
            TEST_REQUIRE(again.inner == SPHG_ERROR_BUSY && again.untouched, "%s: %s",
                         argument_functions[f].name, sphg_result_string(again.inner));
        }
}

/* ---- Functions without a result ----------------------------------------------------------- */

static const sphg_scheme bad_schemes[] = {
    {.dimension = 1, .support_radius = 1},
    {.dimension = -1, .support_radius = 1},
    {.kernel = (sphg_kernel)-1, .support_radius = 1},
    {.kernel = (sphg_kernel)7, .support_radius = 1},
    {.support_radius = 0},
    {.support_radius = -1},
    {.support_radius = NAN},
    {.support_radius = INFINITY},
};
enum { BAD_SCHEMES = sizeof bad_schemes / sizeof *bad_schemes };

static void functions_without_a_result_are_harmless(const test_case *test)
{
    (void)test;
    const double x[3] = {.1, .2, .3};
    for (int k = -1; k < BAD_SCHEMES; ++k) {
        const sphg_scheme *scheme = k < 0 ? NULL : &bad_schemes[k];
        double a = 0, b = 0, gradient[3] = {0};
        sphg_kernel_value(scheme, .5, &a, &b);
        assert_true(isnan(a) && isnan(b));
        sphg_kernel_value(scheme, .5, NULL, NULL);
        sphg_kernel_constants(scheme, NULL, NULL);
        sphg_pair_gradient(scheme, x, 1, NULL, gradient);
        assert_true(isnan(gradient[0]) && isnan(gradient[1]));
        sphg_pair_gradient(scheme, x, 1, NULL, NULL);
    }
    const sphg_scheme good = {.support_radius = 1}, no_method = {.method = (sphg_method)6};
    double gradient[3] = {0}, w = 0;
    sphg_pair_gradient(&good, NULL, 1, NULL, gradient);
    assert_true(isnan(gradient[0]) && isnan(gradient[2]));
    sphg_kernel_value(&good, -1, &w, NULL);
    assert_true(isnan(w));
    sphg_kernel_value(&good, NAN, &w, NULL);
    assert_true(isnan(w));
    assert_int_equal(sphg_correction_width(NULL), 0);
    assert_int_equal(sphg_correction_width(&no_method), 0);
    assert_non_null(sphg_last_message(NULL));
    sphg_context_destroy(NULL);
    sphg_neighbors_destroy(NULL);
}

static const test_entry entries[] = {
    TEST_ONCE(every_parameter_has_a_row),
    TEST_ONCE(every_member_has_a_row),
    TEST_ENTRY(every_bad_argument_is_refused_and_named, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(trusted_contexts_refuse_the_same_arguments, TEST_SINGLE_AND_DOUBLE, TEST_3D, 0, 0),
    TEST_ENTRY(every_function_is_refused_while_the_context_is_busy, TEST_SINGLE_AND_DOUBLE, TEST_3D,
               0, 0),
    TEST_ONCE(functions_without_a_result_are_harmless),
};
TEST_MAIN(entries)
