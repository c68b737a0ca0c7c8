/* SPDX-License-Identifier: MIT */
/* A NaN or an infinity in a field, a density or a table reaches its own particle and the targets
 * that have it as neighbour, and nobody else: whatever the host lists, whatever skin and padding
 * hold. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>

/* ---- Ways to supply neighbours ------------------------------------------------------------ */

typedef enum supply { KEPT, SKIN, LIST_FREE, SUPERSET, CLUMP, CLUMP_LIST_FREE, SUPPLIES } supply;

static const char *const supply_names[] = {"kept",     "skin",  "list-free",
                                           "superset", "clump", "clump, list-free"};

enum { COUNT = 260, CROWD = 70000, CROWD_TARGETS = 40, BAD = 3 };

typedef struct scenery {
    const test_case *test;
    supply way;
    sphg_context *context;
    scene particles;
    sphg_scheme scheme;
    sphg_neighbors *neighbors;
    rows pairs; /* who may be reached */
    setup_array volume, density, table, field;
    int32_t bad[BAD];
} scenery;

static setup_array random_numbers(const scenery *own, int width, double low, double high)
{
    const int count = own->particles.source_count;
    random_state random = random_seeded(500 + (uint64_t)width);
    double *numbers = test_memory((size_t)(count * width) * sizeof *numbers);
    for (int k = 0; k < count * width; ++k)
        numbers[k] = random_between(&random, low, high);
    return setup_numbers(test_field_type(own->test), count, width, numbers);
}

/* All sources for every target: some far beyond H, and each target itself. */
static sphg_lists everybody(int targets, int sources)
{
    int64_t *offsets = test_memory((size_t)(targets + 1) * sizeof *offsets);
    int32_t *indices = test_memory((size_t)(targets * sources) * sizeof *indices);
    for (int i = 0; i <= targets; ++i)
        offsets[i] = (int64_t)i * sources;
    for (int k = 0; k < targets * sources; ++k)
        indices[k] = k % sources;
    return (sphg_lists){.offsets = offsets, .indices = indices};
}

static void build(scenery *own)
{
    const sphg_geometry geometry = scene_geometry(&own->particles);
    SETUP_OK(own->context,
             sphg_neighbors_search(own->context, own->neighbors, &own->scheme, &geometry));
}

/* Within the skin: the lists stay those of the first positions. */
static void move_a_little(scenery *own)
{
    random_state random = random_seeded(503);
    sphg_neighbors_info info;
    for (int k = 0; k < own->particles.source_count * own->test->dimension; ++k) {
        const double x = own->particles.sources[k] + random_between(&random, -.1, .1);
        own->particles.sources[k] = own->particles.is_double ? x : (double)(float)x;
    }
    build(own);
    SETUP_OK(own->context, sphg_neighbors_get_info(own->context, own->neighbors, &info));
    assert_int_equal(info.rebuilt, 0);
}

static void supply_neighbors(scenery *own)
{
    own->neighbors = brute_force_neighbors(own->context);
    own->particles.list_free = own->way == LIST_FREE || own->way == CLUMP_LIST_FREE;
    own->particles.skin = own->way == SKIN ? .5 : 0;
    if (own->way == SUPERSET) {
        const sphg_geometry geometry = scene_geometry(&own->particles);
        const sphg_lists lists =
            everybody(own->particles.target_count, own->particles.source_count);
        SETUP_OK(own->context, sphg_neighbors_use_lists(own->context, own->neighbors, &own->scheme,
                                                        &geometry, &lists));
        return;
    }
    build(own);
    if (own->way == SKIN)
        move_a_little(own);
}

static scenery scenery_of(const test_case *test, supply way)
{
    random_state random = random_seeded(499);
    const int d = test->dimension, is_clump = way >= CLUMP;
    scenery own = {.test = test, .way = way, .context = setup_context()};
    const double side = is_clump ? 3 : d == 2 ? 9 : 5;
    cloud points = cloud_random(d, is_clump ? CROWD : COUNT, side, &random);
    own.particles = scene_of_cloud(test, &points);
    own.particles.target_count = is_clump ? CROWD_TARGETS : COUNT - 20; /* 20 ghosts */
    own.scheme = setup_scheme(test, is_clump ? .25 : 1.5);
    supply_neighbors(&own);
    own.pairs = rows_by_brute_force(&own.particles, own.scheme.support_radius);
    const int width = sphg_correction_width(&own.scheme);
    own.volume = random_numbers(&own, 1, .1, .2);
    own.density = random_numbers(&own, 1, .5, 1.5);
    own.field = random_numbers(&own, d, -1, 1);
    own.table = random_numbers(&own, width ? width : 1, -1, 1);
    own.bad[0] = 7;
    own.bad[1] = own.pairs.count - 1;
    own.bad[2] = own.pairs.offsets[4] ? own.pairs.indices[own.pairs.offsets[4] - 1] : 9;
    return own;
}

/* ---- Results ------------------------------------------------------------------------------ */

typedef struct results {
    setup_array gradient, divergence, curl, value;
} results;

static results evaluate(const scenery *own, sphg_form form)
{
    const int d = own->test->dimension, n = own->particles.target_count;
    const sphg_type type = test_field_type(own->test);
    const int two_sided = form >= SPHG_SYMMETRIC && own->test->method != SPHG_PLAIN;
    results found = {setup_output(type, n, d * d), setup_output(type, n, 1),
                     setup_output(type, n, d == 2 ? 1 : 3), setup_output(type, n, d)};
    const sphg_view at_sources = setup_view(&own->field);
    sphg_field field = {.shape = SPHG_VECTOR, .form = form, .at_sources = &at_sources};
    sphg_sources sources = {.neighbors = own->neighbors};
    sources.volume = setup_view(&own->volume);
    sources.density = setup_view(&own->density);
    sources.correction = two_sided ? setup_view(&own->table) : sphg_absent();
    field.gradient = setup_view(&found.gradient);
    field.divergence = setup_view(&found.divergence);
    field.curl = setup_view(&found.curl);
    field.value = form == SPHG_DIRECT ? setup_view(&found.value) : sphg_absent();
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    return found;
}

static int same_item(const setup_array *a, const setup_array *b, int i)
{
    const size_t bytes = (size_t)a->width * (a->type == SPHG_F64 ? 8 : 4);
    return memcmp((const char *)a->data + (size_t)i * bytes,
                  (const char *)b->data + (size_t)i * bytes, bytes) == 0;
}

static int is_reached(const scenery *own, int32_t i)
{
    for (int b = 0; b < BAD; ++b) {
        if (own->bad[b] == i)
            return 1;
        for (int64_t k = own->pairs.offsets[i]; k < own->pairs.offsets[i + 1]; ++k)
            if (own->pairs.indices[k] == own->bad[b])
                return 1;
    }
    return 0;
}

static int is_finite(const setup_array *found, int i)
{
    for (int k = 0; k < found->width; ++k)
        if (!isfinite(setup_get(found, i, k)))
            return 0;
    return 1;
}

/* Returns how many targets were reached and show it. */
static int require_contained(const scenery *own, const results *clean, const results *found,
                             const char *where)
{
    int shown = 0;
    for (int32_t i = 0; i < own->particles.target_count; ++i) {
        if (is_reached(own, i)) {
            shown += !is_finite(&found->gradient, i);
            continue;
        }
        TEST_REQUIRE(same_item(&clean->gradient, &found->gradient, i) &&
                         same_item(&clean->divergence, &found->divergence, i) &&
                         same_item(&clean->curl, &found->curl, i) &&
                         same_item(&clean->value, &found->value, i),
                     "%s: target %d has no bad neighbour", where, i);
    }
    return shown;
}

/* Spoils all three particles in one array, evaluates, and puts the array back. */
static void spoil_and_compare(scenery *own, setup_array *spoilt, sphg_form form,
                              const results *clean, const char *what)
{
    static const double values[] = {NAN, INFINITY, -INFINITY};
    const size_t size = spoilt->type == SPHG_F64 ? 8 : 4;
    const size_t bytes = (size_t)(spoilt->count * spoilt->width) * size;
    void *kept = memcpy(test_memory(bytes), spoilt->data, bytes);
    const char *where = test_text("%s, form %d, %s", what, (int)form, supply_names[own->way]);
    for (int b = 0; b < BAD; ++b)
        for (int k = b % spoilt->width; k < spoilt->width; k += 2) {
            const int place = own->bad[b] * spoilt->width + k;
            if (size == 8)
                ((double *)spoilt->data)[place] = values[b];
            else
                ((float *)spoilt->data)[place] = (float)values[b];
        }
    const results found = evaluate(own, form);
    const int shown = require_contained(own, clean, &found, where);
    TEST_REQUIRE(shown > 0, "%s: nobody noticed", where);
    memcpy(spoilt->data, kept, bytes);
}

static void not_a_number_reaches_neighbours_alone(const test_case *test)
{
    /* Clumps are large, and only who supplies their pairs is new: a method of either kind. */
    const int with_clumps =
        test->method == SPHG_KGC || (test->method == SPHG_CRKPM && test->precision == TEST_F32);
    for (int way = 0; way < (with_clumps ? SUPPLIES : CLUMP); ++way) {
        scenery own = scenery_of(test, (supply)way);
        for (int form = SPHG_DIFFERENCE; form <= SPHG_ADJOINT; ++form) {
            const results clean = evaluate(&own, (sphg_form)form);
            spoil_and_compare(&own, &own.field, (sphg_form)form, &clean, "field");
            if (form >= SPHG_SYMMETRIC && test->method != SPHG_PLAIN)
                spoil_and_compare(&own, &own.table, (sphg_form)form, &clean, "table");
            if (form == SPHG_SYMMETRIC)
                spoil_and_compare(&own, &own.density, SPHG_SYMMETRIC, &clean, "density");
        }
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(not_a_number_reaches_neighbours_alone, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
