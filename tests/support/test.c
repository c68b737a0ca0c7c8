/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "page_guard.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Names ------------------------------------------------------------------------------ */

static const char *const precision_names[] = {"f32", "f64", "mixed"};
static const char *const method_names[] = {"KGC", "MLS", "RKPM", "CMLS", "CRKPM", "PLAIN"};
static const char *const kernel_names[] = {"cubic",       "quintic", "wendland_c2", "wendland_c4",
                                           "wendland_c6", "poly6",   "spiky"};

const char *test_method_name(sphg_method method)
{
    return method_names[method];
}

const char *test_kernel_name(sphg_kernel kernel)
{
    return kernel_names[kernel];
}

double test_unit_roundoff(const test_case *test)
{
    return test->precision == TEST_F64 ? 0x1p-53 : 0x1p-24;
}

sphg_type test_field_type(const test_case *test)
{
    return test->precision == TEST_F64 ? SPHG_F64 : SPHG_F32;
}

sphg_type test_position_type(const test_case *test)
{
    return test->precision == TEST_F32 ? SPHG_F32 : SPHG_F64;
}

int test_is_classic(const test_case *test)
{
    return test->method == SPHG_CMLS || test->method == SPHG_CRKPM;
}

/* ---- Memory of one case ------------------------------------------------------------------- */

typedef struct owned {
    struct owned *next;
    void (*release)(void *object);
    void *object;
} owned;

static owned *owned_by_case;

static void *required(void *memory)
{
    if (!memory) {
        fputs("the tests ran out of memory\n", stderr);
        abort();
    }
    return memory;
}

void test_at_end(void (*release)(void *object), void *object)
{
    owned *entry = required(malloc(sizeof *entry));
    entry->next = owned_by_case;
    entry->release = release;
    entry->object = object;
    owned_by_case = entry;
}

void *test_memory(size_t bytes)
{
    void *memory = required(page_guard_create(bytes));
    test_at_end(page_guard_destroy, memory);
    return memory;
}

static void release_all(void)
{
    while (owned_by_case) {
        owned *entry = owned_by_case;
        owned_by_case = entry->next;
        entry->release(entry->object);
        free(entry);
    }
}

static bool is_here(sphg_isa isa)
{
    const sphg_config config = {.threads = 1, .isa = isa};
    sphg_context *context = NULL;
    const bool here = sphg_context_create(SPHG_VERSION, &config, &context) == SPHG_OK;
    sphg_context_destroy(context);
    return here;
}

static sphg_isa wanted_isa(void)
{
    static const struct {
        const char *name;
        sphg_isa isa;
    } known[] = {{"base", SPHG_ISA_BASE},
                 {"v3", SPHG_ISA_X86_V3},
                 {"v4", SPHG_ISA_X86_V4},
                 {"neon", SPHG_ISA_NEON}};
    const char *wanted = getenv("SPHG_TEST_ISA");
    for (size_t k = 0; wanted && k < sizeof known / sizeof known[0]; ++k)
        if (strcmp(wanted, known[k].name) == 0 && is_here(known[k].isa))
            return known[k].isa;
    if (wanted && *wanted)
        printf("instruction set %s: not here, the best one instead\n", wanted);
    return SPHG_ISA_BEST;
}

static sphg_isa chosen_isa; /* before any thread may ask */

sphg_isa test_isa(void)
{
    return chosen_isa;
}

const char *test_text(const char *format, ...)
{
    enum { length = 256 };
    char *text = test_memory(length);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, length, format, arguments);
    va_end(arguments);
    return text;
}

/* ---- Tolerances --------------------------------------------------------------------------- */

#define TEST_X(name, limit, measured, reason) {#name, limit},
static const struct {
    const char *name;
    double limit;
} tolerances[] = {TEST_TOLERANCES(TEST_X)};
#undef TEST_X

static struct {
    double value;
    char where[256];
    int used;
} worst[TEST_TOLERANCE_COUNT];

void test_within(test_tolerance tolerance, double value, const char *where)
{
    if (!worst[tolerance].used || value > worst[tolerance].value) {
        worst[tolerance].value = value;
        snprintf(worst[tolerance].where, sizeof worst[tolerance].where, "%s", where);
    }
    worst[tolerance].used = 1;
    if (!(value <= tolerances[tolerance].limit))
        fail_msg("%s: %.9g exceeds %g at %s", tolerances[tolerance].name, value,
                 tolerances[tolerance].limit, where);
}

static void print_worst(void)
{
    for (int t = 0; t < TEST_TOLERANCE_COUNT; ++t)
        if (worst[t].used)
            printf("%-28s measured %-10.3g limit %-8g at %s\n", tolerances[t].name, worst[t].value,
                   tolerances[t].limit, worst[t].where);
}

/* ---- Run loop ----------------------------------------------------------------------------- */

typedef struct named_case {
    test_case test;
    test_property *property;
    char name[128];
} named_case;

static bool ended_well; /* the last case; CMocka leaves one that fails by longjmp */

static void run_case(void **state)
{
    const named_case *running = *state;
    ended_well = false;
    running->property(&running->test);
    ended_well = true;
}

void test_skip(void)
{
    ended_well = true;
    skip();
}

/* SPHG_TEST_ENDS_AT_FAILURE=1: for those who only ask whether there is one. */
static int end_case(void **state)
{
    const char *ends = getenv("SPHG_TEST_ENDS_AT_FAILURE");
    (void)state;
    release_all();
    if (!ended_well && ends && ends[0] == '1')
        exit(1);
    return 0;
}

static void add_parameter(char *name, size_t size, const char *value)
{
    size_t used = strlen(name);
    snprintf(name + used, size - used, "%s%s", strchr(name, '[') ? "," : "[", value);
}

static named_case name_case(const test_entry *entry, const test_case *test)
{
    named_case named = {*test, entry->property, ""};
    size_t size = sizeof named.name;
    snprintf(named.name, size, "%s", entry->name);
    if (entry->precisions)
        add_parameter(named.name, size, precision_names[test->precision]);
    if (entry->dimensions)
        add_parameter(named.name, size, test->dimension == 2 ? "2D" : "3D");
    if (entry->methods)
        add_parameter(named.name, size, method_names[test->method]);
    if (entry->kernels)
        add_parameter(named.name, size, kernel_names[test->kernel]);
    if (strchr(named.name, '['))
        strcat(named.name, "]");
    return named;
}

static int is_in(unsigned set, unsigned fallback, int value)
{
    return ((set ? set : TEST_BIT(fallback)) & TEST_BIT(value)) != 0;
}

static int is_of_entry(const test_entry *entry, const test_case *test)
{
    return is_in(entry->precisions, TEST_F64, (int)test->precision) &&
           is_in(entry->dimensions, 3, test->dimension) &&
           is_in(entry->methods, SPHG_KGC, (int)test->method) &&
           is_in(entry->kernels, SPHG_CUBIC_SPLINE, (int)test->kernel);
}

static struct {
    int part, parts;
} share = {1, 1};

static void read_share(void)
{
    const char *wanted = getenv("SPHG_TEST_SHARE");
    if (!wanted || !*wanted)
        return;
    char behind;
    if (sscanf(wanted, "%d/%d%c", &share.part, &share.parts, &behind) != 2 || share.part < 1 ||
        share.part > share.parts) {
        fprintf(stderr, "SPHG_TEST_SHARE is %s, not a part and a number of parts, as in 1/2\n",
                wanted);
        exit(1);
    }
}

int test_is_shared(void)
{
    return share.parts > 1;
}

int test_takes(const test_case *test, int scene, int of)
{
    return !test_is_shared() || scene % of == (test->dimension + (int)test->method) % of;
}

int test_reference_stride(void)
{
    return TEST_SLOWED || test_is_shared() ? 3 : 1;
}

static int has_several(unsigned set)
{
    return (set & (set - 1)) != 0;
}

/* Like the fields of one colour on a chessboard: of two parameters each value stays. `number` keeps
 * properties of one parameter from losing all the same one; who has one case keeps it. */
static int is_of_share(const test_entry *entry, const test_case *test, size_t number)
{
    if (!has_several(entry->precisions) && !has_several(entry->dimensions) &&
        !has_several(entry->methods) && !has_several(entry->kernels))
        return 1;
    const int colour = (int)test->precision + test->dimension + (int)test->method +
                       (int)test->kernel + (int)(number % (size_t)share.parts);
    return colour % share.parts == share.part % share.parts;
}

/* Writes the cases of an entry, the number-th (counts only where cases is NULL). */
static size_t expand(const test_entry *entry, size_t number, named_case *cases)
{
    enum { all = 3 * 4 * 6 * 7 };
    size_t count = 0;
    for (int k = 0; k < all; ++k) {
        const test_case test = {(test_precision)(k / 168), k / 42 % 4, (sphg_method)(k / 7 % 6),
                                (sphg_kernel)(k % 7)};
        if (!is_of_entry(entry, &test) || !is_of_share(entry, &test, number))
            continue;
        if (cases)
            cases[count] = name_case(entry, &test);
        ++count;
    }
    return count;
}

int test_run(int argc, char **argv, const test_entry *entries, size_t count)
{
    size_t total = 0, used = 0;
    chosen_isa = wanted_isa();
    read_share();
    for (size_t e = 0; e < count; ++e)
        total += expand(&entries[e], e, NULL);
    named_case *cases = required(calloc(total + 1, sizeof *cases));
    struct CMUnitTest *tests = required(calloc(total + 1, sizeof *tests));
    for (size_t e = 0; e < count; ++e)
        used += expand(&entries[e], e, cases + used);
    const int only_lists = argc > 1 && strcmp(argv[1], "--list") == 0;
    for (size_t k = 0; k < used; ++k) {
        if (only_lists)
            puts(cases[k].name);
        struct CMUnitTest unit = {cases[k].name, run_case, NULL, end_case, &cases[k]};
        tests[k] = unit;
    }
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    int failed = 0;
    if (!only_lists) {
        failed = _cmocka_run_group_tests(argv[0], tests, used, NULL, NULL);
        print_worst();
    }
    free(tests);
    free(cases);
    return failed != 0;
}
