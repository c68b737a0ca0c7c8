/* SPDX-License-Identifier: MIT */
/* Lists of the host that are borrowed: the same bits from arrays, rows and a function, for all
 * targets and for each alone; nothing is read behind a list's end; and what is no source is named,
 * wherever it stands. */
#include "support/setup.h"
#include <string.h>

enum { CSR, ROWS, FUNCTION, SUPPLIES };

typedef struct host {
    sphg_context *context;
    sphg_scheme scheme;
    sphg_geometry geometry;
    setup_array volume, field;
    int32_t targets, sources;
    int64_t *offsets;
    int32_t *indices;
    const int32_t **rows; /* each in memory of its own, which ends where the list does */
    int32_t *lengths;
    int32_t *reused[2];
} host;

/* ---- Lists ---------------------------------------------------------------------------------- */

/* Neighbours and others, one after the other from anywhere on; many hold the target itself. */
static void make_lists(host *own, const int32_t *lengths, random_state *random)
{
    const size_t count = (size_t)own->targets;
    own->offsets = test_memory((count + 1) * sizeof *own->offsets);
    own->rows = test_memory(count * sizeof *own->rows);
    own->lengths = test_memory(count * sizeof *own->lengths);
    for (int32_t i = 0; i < own->targets; ++i) {
        own->lengths[i] = lengths[i];
        own->offsets[i + 1] = own->offsets[i] + lengths[i];
    }
    own->indices = test_memory((size_t)own->offsets[own->targets] * sizeof *own->indices);
    for (int32_t i = 0; i < own->targets; ++i) {
        const size_t bytes = (size_t)lengths[i] * sizeof *own->indices;
        const int32_t first = i % 2 ? i : random_index(random, own->sources);
        int32_t *row = test_memory(bytes);
        for (int32_t k = 0; k < lengths[i]; ++k)
            row[k] = (first + k) % own->sources;
        own->rows[i] = row;
        if (bytes)
            memcpy(own->indices + own->offsets[i], row, bytes);
    }
    for (int worker = 0; worker < 2; ++worker)
        own->reused[worker] = test_memory((size_t)own->sources * sizeof **own->reused);
}

/* The end of an array is used anew for each target: nobody may still look at the last one. */
static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    host *own = user;
    const int32_t length = own->lengths[target];
    int32_t *to = own->reused[worker] + own->sources - length;
    memset(own->reused[worker], 0x7f, (size_t)own->sources * sizeof *to);
    if (length)
        memcpy(to, own->rows[target], (size_t)length * sizeof *to);
    *indices = to;
    return length;
}

static sphg_neighbors *neighbors_by(host *own, int supply)
{
    sphg_lists given = {.row = row_of, .user = own};
    if (supply == CSR)
        given = (sphg_lists){.offsets = own->offsets, .indices = own->indices};
    if (supply == ROWS)
        given = (sphg_lists){.rows = own->rows, .lengths = own->lengths};
    return setup_lists(own->context, &own->scheme, &own->geometry, &given);
}

static host host_of(const test_case *test, sphg_isa isa, int32_t sources, const int32_t *lengths,
                    int32_t targets)
{
    random_state random = random_seeded(631);
    const int d = test->dimension;
    host own = {.context = setup_context_on(isa), .targets = targets, .sources = sources};
    cloud points = cloud_random(d, sources, 4, &random);
    own.scheme = setup_scheme(test, 1.9);
    const setup_array positions = setup_positions(test, &points);
    own.geometry = setup_geometry(test, &points, &positions);
    own.geometry.target_count = targets;
    own.volume = setup_output(test_field_type(test), sources, 1);
    own.field = setup_output(test_field_type(test), sources, d);
    for (int k = 0; k < sources; ++k)
        setup_put(&own.volume, k, random_between(&random, .5, 1.5));
    for (int k = 0; k < sources * d; ++k)
        setup_put(&own.field, k, random_between(&random, -1, 1));
    make_lists(&own, lengths, &random);
    return own;
}

/* ---- Results -------------------------------------------------------------------------------- */

static sphg_result jacobian_of(const host *own, const sphg_neighbors *neighbors,
                               const sphg_subset *subset, const setup_array *out)
{
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&own->volume)};
    return sphg_jacobian(own->context, &own->scheme, &sources, subset, setup_view(&own->field),
                         setup_view(out));
}

static setup_array all_jacobians(const host *own, const sphg_neighbors *neighbors)
{
    const int d = own->field.width;
    const setup_array out = setup_output(own->field.type, own->targets, d * d);
    SETUP_OK(own->context, jacobian_of(own, neighbors, NULL, &out));
    return out;
}

static setup_array one_by_one(const host *own, const sphg_neighbors *neighbors)
{
    const int d = own->field.width;
    const setup_array out = setup_output(own->field.type, own->targets, d * d);
    for (int32_t i = 0; i < own->targets; ++i) {
        const sphg_subset subset = sphg_range(i, i + 1);
        SETUP_OK(own->context, jacobian_of(own, neighbors, &subset, &out));
    }
    return out;
}

static void require_same_bits(host *own, const char *where)
{
    const setup_array expected = all_jacobians(own, neighbors_by(own, CSR));
    for (int supply = 0; supply < SUPPLIES; ++supply) {
        const sphg_neighbors *neighbors = neighbors_by(own, supply);
        const setup_array all = all_jacobians(own, neighbors), each = one_by_one(own, neighbors);
        TEST_REQUIRE(setup_same_bits(&all, &expected), "%s, supply %d", where, supply);
        TEST_REQUIRE(setup_same_bits(&each, &expected), "%s, supply %d, one by one", where, supply);
    }
}

/* ---- Properties ----------------------------------------------------------------------------- */

/* All lengths up to three chunks, short beside long, and some of nobody. */
static void arrays_rows_and_functions_give_the_same_bits(const test_case *test)
{
    enum { TARGETS = 200, SOURCES = 230 };
    int32_t lengths[TARGETS];
    for (int32_t i = 0; i < TARGETS; ++i)
        lengths[i] = i % 9 == 4 ? 0 : i * 73 % TARGETS;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        if (!setup_watched_context_on(isa))
            continue;
        host own = host_of(test, isa, SOURCES, lengths, TARGETS);
        require_same_bits(&own, test_text("path %d", (int)isa));
    }
}

/* What a function hands out waits, as far as there is room for it. */
static void long_lists_of_a_function_are_summed_whole(const test_case *test)
{
    enum { SOURCES = 40000 };
    static const int32_t lengths[] = {12,    20000, 30000, 3, 32768, 32769, 0, 32767, 1,
                                      40000, 40000, 700,   0, 16384, 16384, 1, 16385, 16384};
    const int32_t targets = (int32_t)(sizeof lengths / sizeof lengths[0]);
    host own = host_of(test, test_isa(), SOURCES, lengths, targets);
    require_same_bits(&own, "long lists");
}

/* The lowest target is named, with the first number of its list that is no source. */
static void what_is_no_source_is_named_wherever_it_stands(const test_case *test)
{
    enum { TARGETS = 40, SOURCES = 150, LENGTH = 131 };
    static const int32_t places[] = {0, 1, 15, 16, 31, 63, 64, 65, 127, 128, LENGTH - 1};
    static const int32_t bad[] = {SOURCES, -1, INT32_MAX, INT32_MIN};
    int32_t lengths[TARGETS];
    for (int32_t i = 0; i < TARGETS; ++i)
        lengths[i] = LENGTH;
    host own = host_of(test, test_isa(), SOURCES, lengths, TARGETS);
    const setup_array out =
        setup_output(own.field.type, TARGETS, test->dimension * test->dimension);
    for (size_t k = 0; k < sizeof places / sizeof places[0]; ++k)
        for (int supply = 0; supply < SUPPLIES; ++supply) {
            const int32_t target = (int32_t)(k * 7 + (size_t)supply) % TARGETS;
            const int32_t number = bad[(k + (size_t)supply) % 4], later = (target + 3) % TARGETS;
            const int32_t first = later < target ? later : target;
            int32_t *row = (int32_t *)(uintptr_t)own.rows[target] + places[k];
            int32_t *other = (int32_t *)(uintptr_t)own.rows[later];
            const int32_t kept = *row, kept_other = *other;
            *row = number;
            *other = first == later ? number : SOURCES + 5;
            own.indices[own.offsets[target] + places[k]] = *row;
            own.indices[own.offsets[later]] = *other;
            const sphg_neighbors *neighbors = neighbors_by(&own, supply);
            assert_int_equal(jacobian_of(&own, neighbors, NULL, &out), SPHG_ERROR_INDEX);
            assert_string_equal(
                sphg_last_message(own.context),
                test_text("sphg_jacobian: the list of target %d holds %d, which is no source",
                          (int)first, (int)number));
            *row = own.indices[own.offsets[target] + places[k]] = kept;
            *other = own.indices[own.offsets[later]] = kept_other;
            SETUP_OK(own.context, jacobian_of(&own, neighbors, NULL, &out));
        }
}

static const test_entry entries[] = {
    TEST_ENTRY(arrays_rows_and_functions_give_the_same_bits, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS), 0),
    TEST_ENTRY(long_lists_of_a_function_are_summed_whole, TEST_ALL_PRECISIONS, TEST_3D,
               TEST_BIT(SPHG_MLS) | TEST_BIT(SPHG_CRKPM), 0),
    TEST_ENTRY(what_is_no_source_is_named_wherever_it_stands, TEST_ALL_PRECISIONS, TEST_3D,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS), 0),
};
TEST_MAIN(entries)
