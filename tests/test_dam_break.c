/* SPDX-License-Identifier: MIT */
/* A moment of a real dam break, with its sheets, strings and droplets: how many particles can be
 * corrected how far, and that nothing else comes out than finite numbers and exact derivatives.
 * Needs dam_break_splash.csv in the folder that the environment variable SPHG_TEST_DATA names, or
 * in ../shared/data beside the checkout; skips where there is none. */
#include "support/setup.h"
#include "tables/csv.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double support_radius = 0.05;  /* [m] */
static const double particle_mass = 0.0125; /* [kg] */

typedef struct splash {
    sphg_context *context;
    sphg_neighbors *neighbors;
    setup_array positions, velocities, volumes;
    int count;
} splash;

static const char *data_path(void)
{
    const char *folder = getenv("SPHG_TEST_DATA");
    return test_text("%s/dam_break_splash.csv", folder ? folder : "../shared/data");
}

/* Read once for all cases. Skips the case where the file is not there, fails where it is not
 * readable. */
static const struct csv *read_table(void)
{
    static struct csv table;
    const char *path = data_path();
    if (table.row_count)
        return &table;
    FILE *file = fopen(path, "r");
    if (!file) {
        printf("skipped: there is no %s\n", path);
        test_skip();
    }
    fclose(file);
    TEST_REQUIRE(csv_open(&table, path) && csv_read(&table), "%s", table.message);
    for (int quantity = QUANTITY_X; quantity <= QUANTITY_DENSITY; ++quantity)
        TEST_REQUIRE(table.columns[quantity] >= 0, "%s lacks a column", path);
    return &table;
}

/* Columns of the file as an array of the type; mass / value for volumes. */
static setup_array columns(const struct csv *table, sphg_type type, int width, enum quantity first,
                           int invert)
{
    double *numbers = test_memory((size_t)(table->row_count * width) * sizeof *numbers);
    for (int k = 0; k < width; ++k) {
        for (int i = 0; i < table->row_count; ++i) {
            const double value = table->values[i][(int)first + k];
            numbers[i * width + k] = invert ? particle_mass / value : value;
        }
    }
    return setup_numbers(type, table->row_count, width, numbers);
}

static splash open_splash(const test_case *test)
{
    const struct csv *table = read_table();
    splash data = {.context = setup_context(), .count = table->row_count};
    data.positions = columns(table, test_position_type(test), 3, QUANTITY_X, 0);
    data.velocities = columns(table, test_field_type(test), 3, QUANTITY_VX, 0);
    data.volumes = columns(table, test_field_type(test), 1, QUANTITY_DENSITY, 1);
    const sphg_scheme scheme = setup_scheme(test, support_radius);
    const sphg_geometry geometry = {.sources = setup_view(&data.positions),
                                    .source_count = data.count,
                                    .target_count = data.count,
                                    .precision = test_field_type(test)};
    data.neighbors = setup_search(data.context, &scheme, &geometry);
    return data;
}

/* What is asked for beside the Jacobians; NULL: not. */
typedef struct wanted {
    uint8_t *ranks;
    const setup_array *lambdas;
    sphg_stats *stats;
} wanted;

static void evaluate(const splash *data, const sphg_scheme *scheme, const setup_array *field,
                     const setup_array *jacobians, wanted beside)
{
    const sphg_view at_sources = setup_view(field);
    const sphg_sources sources = {.neighbors = data->neighbors,
                                  .volume = setup_view(&data->volumes)};
    const sphg_field jacobian = {
        .shape = SPHG_VECTOR, .at_sources = &at_sources, .gradient = setup_view(jacobians)};
    const sphg_request request = {
        .sources = &sources,
        .set_count = 1,
        .fields = &jacobian,
        .field_count = 1,
        .rank = beside.ranks ? sphg_view_u8(beside.ranks, 1) : sphg_absent(),
        .lambda_min = beside.lambdas ? setup_view(beside.lambdas) : sphg_absent(),
        .stats = beside.stats};
    SETUP_OK(data->context, sphg_evaluate(data->context, scheme, &request));
}

/* Positions in f32 may decide a few particles beside a threshold otherwise. */
static void ranks_are(const test_case *test, sphg_policy policy, const int64_t expected[4])
{
    const splash data = open_splash(test);
    const int64_t allowed = test->precision == TEST_F64 ? 0 : 5;
    sphg_scheme scheme = setup_scheme(test, support_radius);
    scheme.policy = policy;
    sphg_stats stats = {0};
    int64_t counted[4] = {0};
    uint8_t *ranks = test_memory((size_t)data.count);
    const setup_array jacobians = setup_output(test_field_type(test), data.count, 9);
    evaluate(&data, &scheme, &data.velocities, &jacobians, (wanted){ranks, NULL, &stats});
    for (int i = 0; i < data.count; ++i)
        counted[ranks[i] < 4 ? ranks[i] : 0]++;
    for (int rank = 0; rank < 4; ++rank) {
        TEST_REQUIRE(llabs(counted[rank] - expected[rank]) <= allowed, "%lld of rank %d, not %lld",
                     (long long)counted[rank], rank, (long long)expected[rank]);
        assert_int_equal(counted[rank], stats.rank[rank]);
    }
}

static void ranks_under_blend_are_known(const test_case *test)
{
    static const int64_t expected[4] = {61, 186, 2476, 39559};
    ranks_are(test, SPHG_BLEND, expected);
}

static void ranks_under_replace_are_known(const test_case *test)
{
    static const int64_t expected[4] = {56, 121, 1380, 40725};
    ranks_are(test, SPHG_REPLACE, expected);
}

static void nothing_is_nan_or_infinite(const test_case *test)
{
    const splash data = open_splash(test);
    for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
        sphg_scheme scheme = setup_scheme(test, support_radius);
        scheme.policy = (sphg_policy)policy;
        const setup_array jacobians = setup_output(test_field_type(test), data.count, 9);
        evaluate(&data, &scheme, &data.velocities, &jacobians, (wanted){NULL, NULL, NULL});
        for (int i = 0; i < data.count; ++i)
            for (int k = 0; k < 9; ++k)
                TEST_REQUIRE(isfinite(setup_get(&jacobians, i, k)),
                             "policy %d, particle %d, component %d", policy, i, k);
    }
}

/* v = (-y, x, 2z) of the positions as stored: exact in f32 too. In mixed precision the field is
 * rounded, and its rounding would be what is measured. */
static setup_array linear_field(const test_case *test, const splash *data)
{
    double *numbers = test_memory((size_t)(data->count * 3) * sizeof *numbers);
    for (int i = 0; i < data->count; ++i) {
        numbers[3 * i] = -setup_get(&data->positions, i, 1);
        numbers[3 * i + 1] = setup_get(&data->positions, i, 0);
        numbers[3 * i + 2] = 2 * setup_get(&data->positions, i, 2);
    }
    return setup_numbers(test_field_type(test), data->count, 3, numbers);
}

/* |J_i - J|_F / |J|_F of that field. */
static double relative_error(const setup_array *jacobians, int i)
{
    static const double expected[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2};
    double sum = 0;
    for (int k = 0; k < 9; ++k)
        sum += pow(setup_get(jacobians, i, k) - expected[k], 2);
    return sqrt(sum / 6);
}

static void linear_fields_are_exact_where_rank_is_full(const test_case *test)
{
    const splash data = open_splash(test);
    const sphg_scheme scheme = setup_scheme(test, support_radius);
    const setup_array field = linear_field(test, &data);
    const setup_array jacobians = setup_output(test_field_type(test), data.count, 9);
    const setup_array lambdas = setup_output(test_field_type(test), data.count, 1);
    uint8_t *ranks = test_memory((size_t)data.count);
    evaluate(&data, &scheme, &field, &jacobians, (wanted){ranks, &lambdas, NULL});
    double worst = 0;
    int where = 0, full = 0;
    for (int i = 0; i < data.count; ++i) {
        const double scaled = relative_error(&jacobians, i) * setup_get(&lambdas, i, 0);
        full += ranks[i] == 3;
        if (ranks[i] == 3 && !(scaled <= worst)) {
            worst = scaled;
            where = i;
        }
    }
    TEST_REQUIRE(full > data.count / 2, "only %d of full rank", full);
    TEST_WITHIN(linear_exactness, worst / test_unit_roundoff(test),
                test_text("particle %d", where));
}

/* ---- Second order ---------------------------------------------------------------------------- */

enum { RESOLVED, TOUCHED, DEFICIENT, GROUPS }; /* by the rank of order 2: 9, 3 to 8, less */

/* sin 4x + z cos 5y, and its gradient. */
static double smooth(const double x[3], double gradient[3])
{
    gradient[0] = 4 * cos(4 * x[0]);
    gradient[1] = -5 * sin(5 * x[1]) * x[2];
    gradient[2] = cos(5 * x[1]);
    return sin(4 * x[0]) + x[2] * cos(5 * x[1]);
}

static void mean_errors(const splash *data, const setup_array *found, const uint8_t *ranks,
                        double means[GROUPS], int counts[GROUPS])
{
    memset(means, 0, GROUPS * sizeof *means);
    memset(counts, 0, GROUPS * sizeof *counts);
    for (int i = 0; i < data->count; ++i) {
        const int group = ranks[i] == 9 ? RESOLVED : ranks[i] >= 3 ? TOUCHED : DEFICIENT;
        double x[3], exact[3], square = 0;
        for (int k = 0; k < 3; ++k)
            x[k] = setup_get(&data->positions, i, k);
        smooth(x, exact);
        for (int k = 0; k < 3; ++k)
            square += pow(setup_get(found, i, k) - exact[k], 2);
        means[group] += sqrt(square);
        ++counts[group];
    }
    for (int group = 0; group < GROUPS; ++group)
        means[group] /= counts[group];
}

/* The figures of an independent program, with all volumes alike: order 1, order 2, and with
 * curvature that is lent once. It tells the groups apart by eigenvalues, which moves a few. */
static void errors_of_a_smooth_field_are_known(const test_case *test)
{
    static const double known[3][GROUPS] = {
        {.1559, .1595, 1.226}, {.0072, .0788, 1.201}, {.0066, .0519, 1.198}};
    splash data = open_splash(test);
    const sphg_type type = test_field_type(test);
    const double volume = 0.025 * 0.025 * 0.025;
    double *numbers = test_memory((size_t)data.count * sizeof *numbers), means[GROUPS], unused[3];
    int counts[GROUPS];
    for (int i = 0; i < data.count; ++i) {
        const double x[3] = {setup_get(&data.positions, i, 0), setup_get(&data.positions, i, 1),
                             setup_get(&data.positions, i, 2)};
        numbers[i] = smooth(x, unused);
    }
    const setup_array field_values = setup_numbers(type, data.count, 1, numbers),
                      alike = setup_numbers(type, 1, 1, &volume),
                      lent = setup_output(type, data.count, 7),
                      found = setup_output(type, data.count, 3);
    uint8_t *ranks = test_memory((size_t)data.count);
    const sphg_view at_sources = setup_view(&field_values), lenders = setup_view(&lent);
    sphg_sources sources = {.neighbors = data.neighbors, .volume = setup_view(&alike)};
    sources.volume.stride = 0;
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &at_sources};
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    sphg_scheme scheme = setup_scheme(test, support_radius);
    scheme.order = 2;
    field.curvature = lenders;
    request.rank = sphg_view_u8(ranks, 1);
    SETUP_OK(data.context, sphg_evaluate(data.context, &scheme, &request));
    field.curvature = request.rank = sphg_absent();
    field.gradient = setup_view(&found);
    for (int way = 0; way < 3; ++way) {
        scheme.order = way > 0 ? 2 : 1;
        field.lenders = way == 2 ? &lenders : NULL;
        SETUP_OK(data.context, sphg_evaluate(data.context, &scheme, &request));
        mean_errors(&data, &found, ranks, means, counts);
        for (int group = 0; group < GROUPS; ++group)
            TEST_REQUIRE(fabs(means[group] / known[way][group] - 1) < .01,
                         "way %d, group %d: mean error %.5f, not %.4f", way, group, means[group],
                         known[way][group]);
    }
    const double share = (double)counts[RESOLVED] / data.count;
    TEST_REQUIRE(fabs(share - .6994) < 1e-4, "%.5f resolve curvature", share);
}

/* Heat flows from every 97th particle to those around, and nowhere from cold to warm: the smallest
 * sum of L_ij over the warm ones is not negative. */
static void heat_flows_to_the_cold_alone(const test_case *test)
{
    const splash data = open_splash(test);
    const sphg_type type = test_field_type(test);
    const sphg_scheme scheme = setup_scheme(test, support_radius);
    double *numbers = test_memory((size_t)data.count * sizeof *numbers), sum = 0, size = 0;
    for (int i = 0; i < data.count; i += 97)
        numbers[i] = 1;
    const setup_array warm = setup_numbers(type, data.count, 1, numbers),
                      flow = setup_output(type, data.count, 1),
                      table = setup_output(type, data.count, 6);
    const sphg_view at_sources = setup_view(&warm);
    sphg_sources sources = {.neighbors = data.neighbors, .volume = setup_view(&data.volumes)};
    SETUP_OK(data.context, sphg_correction(data.context, &scheme, &sources, NULL,
                                           setup_view(&table), sphg_absent()));
    sources.correction = setup_view(&table);
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_ADJOINT,
                              .at_sources = &at_sources,
                              .laplacian = setup_view(&flow)};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(data.context, sphg_evaluate(data.context, &scheme, &request));
    for (int i = 0; i < data.count; ++i) {
        const double into = setup_get(&flow, i, 0);
        TEST_REQUIRE(i % 97 ? into >= 0 : into <= 0, "%g flows into particle %d", into, i);
        sum += into;
        size += fabs(into);
    }
    TEST_REQUIRE(size > 0, "nothing flows");
    TEST_WITHIN(diffusion_sum, fabs(sum) / size / test_unit_roundoff(test), "splash");
}

static const test_entry entries[] = {
    TEST_ENTRY(ranks_under_blend_are_known, TEST_ALL_PRECISIONS, 0, 0, 0),
    TEST_ENTRY(ranks_under_replace_are_known, TEST_ALL_PRECISIONS, 0, 0, 0),
    TEST_ENTRY(nothing_is_nan_or_infinite, TEST_ALL_PRECISIONS, 0, TEST_ALL_METHODS, 0),
    TEST_ENTRY(linear_fields_are_exact_where_rank_is_full, TEST_SINGLE_AND_DOUBLE, 0,
               TEST_CORRECTED, 0),
    TEST_ENTRY(errors_of_a_smooth_field_are_known, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
    TEST_ENTRY(heat_flows_to_the_cold_alone, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
};

TEST_MAIN(entries)
