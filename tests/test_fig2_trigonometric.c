/* SPDX-License-Identifier: MIT */
/* The figures behind Figs. 2 and 4 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933, computed
 * by what `sphgrad-bench fields` runs and compared with those of an independent program. */
#include "support/test.h"
#include "../bench/fields/fig2_trigonometric_measure.h"
#include <math.h>

enum { SIZES = 3 };
static const int32_t sides[SIZES] = {40, 80, 160};

static void close_study(void *study)
{
    study_close(study);
}

static struct study *open_study(const test_case *test, int32_t side, double jitter)
{
    static const enum precision precisions[] = {
        [TEST_F32] = PRECISION_F32, [TEST_F64] = PRECISION_F64, [TEST_MIXED] = PRECISION_MIXED};
    const struct study_setting setting = {.dimension = 2,
                                          .side = side,
                                          .support = 2,
                                          .jitter = jitter,
                                          .kernel = test->kernel,
                                          .precision = precisions[test->precision]};
    struct study *study = test_memory(sizeof *study);
    *study = study_open(&setting);
    test_at_end(close_study, study);
    return study;
}

static struct study_errors errors_of(const test_case *test, int32_t side, double jitter,
                                     enum study_field field, sphg_method method)
{
    const struct study_way way = {.method = method};
    struct study *study = open_study(test, side, jitter);
    study_fill(study, field);
    study_derive(study, &way);
    return study_compare(study, NULL, NULL);
}

/* What a printed figure allows: half a unit of its last digit, and what rounding of the field
 * itself puts into a derivative over one spacing d = 2 / N. */
static void agrees(const test_case *test, int32_t side, double value, double printed, double digit,
                   const char *what)
{
    const double rounding = 4 * test_unit_roundoff(test) * side;
    TEST_REQUIRE(fabs(value - printed) <= 0.5 * digit + rounding, "%s at N = %d is %.6g, not %.6g",
                 what, side, value, printed);
}

static void rotation_error_of_plain_sph_is_known(const test_case *test)
{
    const struct study_errors errors = errors_of(test, 40, 0, FIELD_ROTATION, SPHG_PLAIN);
    agrees(test, 40, errors.most[STUDY_BOUNDARY], 0.7335, 1e-4, "boundary maximum");
    agrees(test, 40, errors.mean[STUDY_BOUNDARY], 0.3145, 1e-4, "boundary mean");
    agrees(test, 40, errors.most[STUDY_INSIDE], 0.01729, 1e-5, "inside maximum");
    agrees(test, 40, errors.curl_max, 1.024, 1e-3, "curl maximum");
}

/* In mixed precision v itself would be rounded, and that rounding be what is measured. */
static void rotation_is_exact_with(const test_case *test, double jitter)
{
    const double limit = test->precision == TEST_F64 ? 1e-12 : 1e-6;
    const struct study_errors errors = errors_of(test, 40, jitter, FIELD_ROTATION, test->method);
    const double most = fmax(errors.most[STUDY_BOUNDARY], errors.most[STUDY_INSIDE]);
    TEST_REQUIRE(most <= limit, "gradient error %.3g > %.3g", most, limit);
    TEST_REQUIRE(errors.curl_max <= limit, "curl error %.3g > %.3g", errors.curl_max, limit);
}

static void corrected_rotation_is_exact_on_the_lattice(const test_case *test)
{
    rotation_is_exact_with(test, 0);
}

static void corrected_rotation_is_exact_on_the_jittered_lattice(const test_case *test)
{
    rotation_is_exact_with(test, 0.2);
}

static void trigonometric_error_of_plain_sph_does_not_fall(const test_case *test)
{
    static const double printed[SIZES] = {1.973, 1.969, 1.968};
    for (int size = 0; size < SIZES; ++size) {
        const struct study_errors errors =
            errors_of(test, sides[size], 0, FIELD_TRIGONOMETRIC, SPHG_PLAIN);
        agrees(test, sides[size], errors.most[STUDY_BOUNDARY], printed[size], 1e-3,
               "boundary maximum");
    }
}

static void trigonometric_error_of_linearised_methods_is_known(const test_case *test)
{
    static const double kgc[SIZES] = {0.0893, 0.0445, 0.0222};
    static const double mls_and_rkpm[SIZES] = {0.0801, 0.0399, 0.0199};
    static const double inside[SIZES] = {0.01121, 0.002811, 0.000711};
    static const double inside_digit[SIZES] = {1e-5, 1e-6, 1e-6};
    const double *boundary = test->method == SPHG_KGC ? kgc : mls_and_rkpm;
    for (int size = 0; size < SIZES; ++size) {
        const struct study_errors errors =
            errors_of(test, sides[size], 0, FIELD_TRIGONOMETRIC, test->method);
        agrees(test, sides[size], errors.most[STUDY_BOUNDARY], boundary[size], 1e-4,
               "boundary maximum");
        agrees(test, sides[size], errors.most[STUDY_INSIDE], inside[size], inside_digit[size],
               "inside maximum");
    }
}

/* log2 of the ratio on halved spacings: on the boundary the error falls as d, or faster with the
 * classic methods on their way there; inside a lattice as d^2. */
static void trigonometric_error_falls_with_the_spacing(const test_case *test)
{
    const struct study_errors coarse = errors_of(test, 40, 0, FIELD_TRIGONOMETRIC, test->method);
    const struct study_errors fine = errors_of(test, 80, 0, FIELD_TRIGONOMETRIC, test->method);
    const double boundary = log2(coarse.most[STUDY_BOUNDARY] / fine.most[STUDY_BOUNDARY]);
    const double inside = log2(coarse.most[STUDY_INSIDE] / fine.most[STUDY_INSIDE]);
    const double fastest = test_is_classic(test) ? 1.25 : 1.05;
    TEST_REQUIRE(boundary >= 0.95 && boundary <= fastest, "boundary order is %.3f", boundary);
    TEST_REQUIRE(fabs(inside - 2) <= 0.05, "inside order is %.3f", inside);
}

/* With so few neighbours Wendland C6 leaves corner particles to the threshold. */
#define KERNELS_FOR_TWO_SPACINGS (TEST_ALL_KERNELS & ~TEST_BIT(SPHG_WENDLAND_C6))

static const test_entry entries[] = {
    TEST_ENTRY(rotation_error_of_plain_sph_is_known, TEST_ALL_PRECISIONS, TEST_2D, 0, 0),
    TEST_ENTRY(corrected_rotation_is_exact_on_the_lattice, TEST_SINGLE_AND_DOUBLE, TEST_2D,
               TEST_CORRECTED, 0),
    TEST_ENTRY(corrected_rotation_is_exact_on_the_jittered_lattice, TEST_SINGLE_AND_DOUBLE, TEST_2D,
               TEST_CORRECTED, KERNELS_FOR_TWO_SPACINGS),
    TEST_ENTRY(trigonometric_error_of_plain_sph_does_not_fall, TEST_ALL_PRECISIONS, TEST_2D, 0, 0),
    TEST_ENTRY(trigonometric_error_of_linearised_methods_is_known, TEST_ALL_PRECISIONS, TEST_2D,
               TEST_LINEARISED, 0),
    TEST_ENTRY(trigonometric_error_falls_with_the_spacing, TEST_SINGLE_AND_DOUBLE, TEST_2D,
               TEST_CORRECTED, 0),
};

TEST_MAIN(entries)
