/* SPDX-License-Identifier: MIT */
/* The run loop of all tests: a property is a function of one test_case; the runner turns each
 * combination of the parameters it varies over into one named CMocka case. */
#ifndef TESTS_SUPPORT_TEST_H
#define TESTS_SUPPORT_TEST_H
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <sphgrad/sphgrad.h>
#include "tolerances.h"

typedef enum test_precision {
    TEST_F32,
    TEST_F64,
    TEST_MIXED /* f64 positions, f32 fields and results */
} test_precision;

typedef struct test_case {
    test_precision precision;
    int dimension;
    sphg_method method;
    sphg_kernel kernel;
} test_case;

/* What a property varies over: sets of bits, one per value. An axis left at 0 is not varied and
 * not named; the case then holds f64, 3D, KGC, cubic spline. */
#define TEST_BIT(value)        (1u << (value))
#define TEST_ALL_PRECISIONS    7u
#define TEST_SINGLE_AND_DOUBLE 3u
#define TEST_2D                TEST_BIT(2)
#define TEST_3D                TEST_BIT(3)
#define TEST_BOTH_DIMENSIONS   (TEST_2D | TEST_3D)
#define TEST_ALL_KERNELS       127u
#define TEST_LINEARISED        (TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_MLS) | TEST_BIT(SPHG_RKPM))
#define TEST_CLASSIC           (TEST_BIT(SPHG_CMLS) | TEST_BIT(SPHG_CRKPM))
#define TEST_CORRECTED         (TEST_LINEARISED | TEST_CLASSIC)
#define TEST_ALL_METHODS       (TEST_CORRECTED | TEST_BIT(SPHG_PLAIN))

typedef void test_property(const test_case *test);

typedef struct test_entry {
    const char *name;
    test_property *property;
    unsigned precisions, dimensions, methods, kernels;
} test_entry;

#define TEST_ENTRY(property, precisions, dimensions, methods, kernels)                             \
    {                                                                                              \
#property, property, precisions, dimensions, methods, kernels                              \
    }
/* A property without parameters. */
#define TEST_ONCE(property) TEST_ENTRY(property, 0, 0, 0, 0)

/* The instruction set that contexts of tests ask for: the best one, unless SPHG_TEST_ISA says base,
 * v3, v4 or neon and this machine has that; if it has not, the run says so. */
sphg_isa test_isa(void);

/* SPHG_TEST_SHARE=1/2 runs every second case of each property, and 2/2 the others; a property of
 * one case is always run. True when that is asked for: a case may then be smaller, too. */
int test_is_shared(void);

/* Of scenes that a case goes through, `of` of them or kinds of them: where the run is shared, each
 * case takes one; cases of other dimensions and methods take the others. */
int test_takes(const test_case *test, int scene, int of);

/* The larger; NaN if one is NaN, which fmax would pass over. */
static inline double test_larger(double a, double b)
{
    return a != a || a > b ? a : b;
}

/* Which of the targets that stand beside the reference are taken: each one; or, where the run is
 * shared or slowed by what watches it, every third. The reference is what takes the time, and it
 * says the same in each build. */
int test_reference_stride(void);

/* Runs everything, or what matches the pattern in argv[1] ('*' and '?' are wildcards), and prints
 * the worst value measured against each tolerance. Returns main's result. */
int test_run(int argc, char **argv, const test_entry *entries, size_t count);
#define TEST_MAIN(entries)                                                                         \
    int main(int argc, char **argv)                                                                \
    {                                                                                              \
        return test_run(argc, argv, entries, sizeof(entries) / sizeof *(entries));                 \
    }

/* Tolerances: fails where value (in units of u, or a ratio) exceeds the limit or is NaN, and
 * remembers the worst. `where` names the place in the failure message. */
#define TEST_X(name, limit, measured, reason) TEST_TOLERANCE_##name,
typedef enum test_tolerance { TEST_TOLERANCES(TEST_X) TEST_TOLERANCE_COUNT } test_tolerance;
#undef TEST_X
#define TEST_WITHIN(name, value, where) test_within(TEST_TOLERANCE_##name, value, where)
void test_within(test_tolerance tolerance, double value, const char *where);

/* fail_msg with the place only when the condition does not hold. */
#define TEST_REQUIRE(condition, ...)                                                               \
    do {                                                                                           \
        if (!(condition))                                                                          \
            fail_msg(__VA_ARGS__);                                                                 \
    } while (0)

/* Ends the case as skipped. */
void test_skip(void);

/* printf into a buffer that lives until the case ends: places in messages. */
const char *test_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Zeroed memory that the runner frees when the case ends, passed or failed. Who reads or writes
 * behind it ends the case: see page_guard.h. Aligned as its size is, to 16 at most. */
void *test_memory(size_t bytes);
/* Calls release(object) when the case ends, last registered first. */
void test_at_end(void (*release)(void *object), void *object);

double test_unit_roundoff(const test_case *test); /* u of fields and results */
sphg_type test_field_type(const test_case *test);
sphg_type test_position_type(const test_case *test);
int test_is_classic(const test_case *test);
const char *test_method_name(sphg_method method);
const char *test_kernel_name(sphg_kernel kernel);

#endif
