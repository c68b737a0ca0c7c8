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

/* ---- Sums with one radius beside sums with both --------------------------------------------- */

/* Over mutual neighbours a request may have fields that see r < H_i and fields that see
 * r < max(H_i, H_j). What lies between reaches the latter alone. */

enum stage {
    IN_LISTS,
    WITHOUT_LISTS,
    IN_A_BOX,
    IN_TWO_SETS,
    FROM_APART,
    WITH_SKIN, /* particles have moved since pairs were found */
    SKIN_IN_A_BOX,
    STAGES
};
enum { ONE_SIDED = 3, KINDS = 7, OUTPUTS = 5, WALL = 60 };

typedef struct asked {
    sphg_field field;
    setup_array numbers, at_targets, volume;
    sphg_view views[2], volumes[2];
    setup_array found[OUTPUTS], clean[OUTPUTS];
    int outputs;
} asked;

typedef struct mixture {
    const test_case *test;
    enum stage stage;
    sphg_context *context;
    scene particles;
    sphg_scheme scheme;
    sphg_neighbors *neighbors[2];
    rows near, mutual; /* r < H_i, r < max(H_i, H_j) */
    setup_array volume, density, table, volume_at_targets, density_at_targets;
    asked kinds[KINDS];
    int32_t bad[BAD];
} mixture;

static const char *const kind_names[KINDS] = {
    "difference",       "direct",    "volumes' own", "adjoint of a tensor",
    "adjoint gradient", "symmetric", "diffusion"};

static double *radii_of(const mixture *m, int count, random_state *random)
{
    double *radii = test_memory((size_t)count * sizeof *radii);
    for (int k = 0; k < count; ++k)
        radii[k] = scene_rounded(&m->particles, 2.2 * pow(4, -random_between(random, 0, 1)));
    return radii;
}

static setup_array numbers_for(const mixture *m, int count, int width, double low, double high)
{
    static uint64_t seed = 700;
    random_state random = random_seeded(++seed);
    double *numbers = test_memory((size_t)(count * width) * sizeof *numbers);
    for (int k = 0; k < count * width; ++k)
        numbers[k] = random_between(&random, low, high);
    return setup_numbers(test_field_type(m->test), count, width, numbers);
}

/* Of the sources of a set: the second one's stand behind the first one's. */
static sphg_view of_set(const mixture *m, const setup_array *array, int set)
{
    sphg_view view = setup_view(array);
    if (set)
        view.x = (const char *)view.x + (ptrdiff_t)m->particles.target_count * view.stride;
    return view;
}

/* The smallest radius is .55, the largest 2.2: a particle may move by .05 and more. */
static void search_before(const mixture *m, sphg_neighbors *neighbors)
{
    scene before = m->particles;
    random_state random = random_seeded(650);
    before.sources = test_memory((size_t)(COUNT * before.dimension) * sizeof *before.sources);
    for (int k = 0; k < COUNT * before.dimension; ++k)
        before.sources[k] =
            scene_rounded(&before, m->particles.sources[k] + random_between(&random, -.025, .025));
    const sphg_geometry geometry = scene_geometry(&before);
    SETUP_OK(m->context, sphg_neighbors_search(m->context, neighbors, &m->scheme, &geometry));
}

static void search_set(mixture *m, int set)
{
    scene part = m->particles;
    m->neighbors[set] = brute_force_neighbors(m->context);
    if (m->stage == IN_TWO_SETS) {
        const int first = set ? part.target_count : 0;
        part.targets = set ? part.sources : NULL;
        part.target_support = set ? part.support : NULL;
        part.sources += first * part.dimension;
        part.support += first;
        part.source_count = set ? WALL : part.target_count;
    }
    if (m->stage >= WITH_SKIN)
        search_before(m, m->neighbors[set]);
    const sphg_geometry geometry = scene_geometry(&part);
    sphg_neighbors_info info;
    SETUP_OK(m->context,
             sphg_neighbors_search(m->context, m->neighbors[set], &m->scheme, &geometry));
    SETUP_OK(m->context, sphg_neighbors_get_info(m->context, m->neighbors[set], &info));
    assert_int_equal(info.rebuilt, m->stage < WITH_SKIN);
}

static setup_array output_of(mixture *m, asked *kind, int width, sphg_view *view)
{
    setup_array *array = &kind->found[kind->outputs++];
    *array = setup_output(test_field_type(m->test), m->particles.target_count, width);
    *view = setup_view(array);
    return *array;
}

static void ask(mixture *m, int k, sphg_shape shape, sphg_form form)
{
    const int d = m->test->dimension, width = setup_width(shape, d);
    asked *kind = &m->kinds[k];
    kind->field.shape = shape;
    kind->field.form = form;
    kind->numbers = numbers_for(m, m->particles.source_count, width, -1, 1);
    for (int set = 0; set < 2; ++set)
        kind->views[set] = of_set(m, &kind->numbers, m->stage == IN_TWO_SETS && set);
    kind->field.at_sources = kind->views;
    if (m->stage == FROM_APART) {
        kind->at_targets = numbers_for(m, m->particles.target_count, width, -1, 1);
        kind->field.at_targets = setup_view(&kind->at_targets);
    }
}

static void ask_for_all(mixture *m)
{
    const int d = m->test->dimension;
    asked *kind = m->kinds;
    ask(m, 0, SPHG_VECTOR, SPHG_DIFFERENCE);
    output_of(m, &kind[0], d * d, &kind[0].field.gradient);
    output_of(m, &kind[0], 1, &kind[0].field.divergence);
    output_of(m, &kind[0], d == 2 ? 1 : 3, &kind[0].field.curl);
    output_of(m, &kind[0], d, &kind[0].field.value);
    ask(m, 1, SPHG_SCALAR, SPHG_DIRECT);
    output_of(m, &kind[1], d, &kind[1].field.gradient);
    output_of(m, &kind[1], 1, &kind[1].field.square);
    output_of(m, &kind[1], 1, &kind[1].field.value);
    kind[1].field.shepard = !test_is_classic(m->test);
    ask(m, 2, SPHG_SCALAR, SPHG_DIRECT);
    output_of(m, &kind[2], 1, &kind[2].field.value);
    kind[2].volume = numbers_for(m, m->particles.source_count, 1, .1, .2);
    for (int set = 0; set < 2; ++set)
        kind[2].volumes[set] = of_set(m, &kind[2].volume, m->stage == IN_TWO_SETS && set);
    kind[2].field.value_volume = kind[2].volumes;
    ask(m, 3, SPHG_SYM_TENSOR, SPHG_ADJOINT);
    output_of(m, &kind[3], d, &kind[3].field.divergence);
    ask(m, 4, SPHG_VECTOR, SPHG_ADJOINT);
    output_of(m, &kind[4], d * d, &kind[4].field.gradient);
    output_of(m, &kind[4], 1, &kind[4].field.divergence);
    ask(m, 5, SPHG_SCALAR, SPHG_SYMMETRIC);
    output_of(m, &kind[5], d, &kind[5].field.gradient);
    ask(m, 6, SPHG_SCALAR, SPHG_ADJOINT);
    output_of(m, &kind[6], 1, &kind[6].field.laplacian);
}

static mixture mixture_of(const test_case *test, enum stage stage)
{
    random_state random = random_seeded(600 + (uint64_t)stage);
    const int d = test->dimension;
    const double side = d == 2 ? 9 : 5;
    mixture m = {.test = test, .stage = stage, .context = setup_context()};
    cloud points = cloud_random(d, COUNT, side, &random);
    m.particles = scene_of_cloud(test, &points);
    m.particles.mutual = 1;
    m.particles.support = radii_of(&m, COUNT, &random);
    m.particles.target_count = stage == IN_TWO_SETS ? COUNT - WALL : COUNT;
    m.particles.list_free = stage == WITHOUT_LISTS;
    m.particles.skin = stage >= WITH_SKIN ? .45 : 0;
    for (int a = 0; a < d && (stage == IN_A_BOX || stage == SKIN_IN_A_BOX); ++a)
        m.particles.period[a] = side + (stage == SKIN_IN_A_BOX);
    if (stage == FROM_APART) {
        cloud targets = cloud_random(d, COUNT, side, &random);
        m.particles.targets = scene_of_cloud(test, &targets).sources;
        m.particles.target_support = radii_of(&m, COUNT, &random);
    }
    m.scheme = setup_scheme(test, 1);
    m.near = m.mutual = rows_by_brute_force(&m.particles, 1);
    m.particles.mutual = 0;
    m.near = rows_by_brute_force(&m.particles, 1);
    m.particles.mutual = 1;
    for (int set = 0; set < (stage == IN_TWO_SETS ? 2 : 1); ++set)
        search_set(&m, set);
    const int width = sphg_correction_width(&m.scheme);
    m.volume = numbers_for(&m, COUNT, 1, .1, .2);
    m.density = numbers_for(&m, COUNT, 1, .5, 1.5);
    m.table = numbers_for(&m, COUNT, width ? width : 1, -1, 1);
    m.volume_at_targets = numbers_for(&m, COUNT, 1, .1, .2);
    m.density_at_targets = numbers_for(&m, COUNT, 1, .5, 1.5);
    for (int b = 0; b < BAD; ++b) /* of the largest, one in each third */
        for (int j = b * COUNT / BAD; j < (b + 1) * COUNT / BAD; ++j)
            if (!m.bad[b] || m.particles.support[j] > m.particles.support[m.bad[b]])
                m.bad[b] = j;
    return m;
}

/* The kinds that are wanted, a bit each. */
static void evaluate_mixture(const mixture *m, unsigned wanted)
{
    sphg_field fields[KINDS];
    sphg_sources sources[2] = {{0}};
    sphg_request request = {.sources = sources, .fields = fields};
    request.set_count = m->stage == IN_TWO_SETS ? 2 : 1;
    for (int set = 0; set < request.set_count; ++set) {
        sources[set].neighbors = m->neighbors[set];
        sources[set].volume = of_set(m, &m->volume, set);
        sources[set].density = of_set(m, &m->density, set);
        if (m->test->method != SPHG_PLAIN)
            sources[set].correction = of_set(m, &m->table, set);
    }
    for (int k = 0; k < KINDS; ++k)
        if (wanted >> k & 1)
            fields[request.field_count++] = m->kinds[k].field;
    if (m->stage == FROM_APART) {
        request.target_volume = setup_view(&m->volume_at_targets);
        request.target_density = setup_view(&m->density_at_targets);
    }
    SETUP_OK(m->context, sphg_evaluate(m->context, &m->scheme, &request));
}

static int is_among(const mixture *m, const rows *pairs, int32_t i)
{
    for (int b = 0; b < BAD; ++b) {
        if (m->bad[b] == i && !m->particles.targets)
            return 1;
        for (int64_t k = pairs->offsets[i]; k < pairs->offsets[i + 1]; ++k)
            if (pairs->indices[k] == m->bad[b])
                return 1;
    }
    return 0;
}

static void keep_clean(mixture *m, unsigned wanted)
{
    for (int k = 0; k < KINDS; ++k)
        for (int o = 0; wanted >> k & 1 && o < m->kinds[k].outputs; ++o) {
            const setup_array *found = &m->kinds[k].found[o];
            const size_t size = found->type == SPHG_F64 ? 8 : 4;
            setup_array *clean = &m->kinds[k].clean[o];
            *clean = *found;
            clean->data = test_memory((size_t)(found->count * found->width) * size);
            memcpy(clean->data, found->data, (size_t)(found->count * found->width) * size);
        }
}

/* reached: who may differ in fields of this kind; NULL: nobody but the bad ones themselves, or with
 * `at_all` not even these. */
static void require_same(const mixture *m, int k, const rows *reached, int at_all,
                         const char *where)
{
    for (int32_t i = 0; i < m->particles.target_count; ++i) {
        int may = reached && is_among(m, reached, i);
        for (int b = 0; b < BAD; ++b)
            may |= at_all && m->bad[b] == i && !m->particles.targets;
        for (int o = 0; o < m->kinds[k].outputs && !may; ++o)
            TEST_REQUIRE(same_item(&m->kinds[k].clean[o], &m->kinds[k].found[o], i),
                         "%s: target %d, result %d of %s", where, i, o, kind_names[k]);
    }
}

static void spoil(const mixture *m, setup_array *spoilt)
{
    static const double values[] = {NAN, INFINITY, -INFINITY};
    for (int b = 0; b < BAD; ++b)
        for (int c = 0; c < spoilt->width; ++c)
            setup_put(spoilt, m->bad[b] * spoilt->width + c, values[b]);
}

static void spoil_and_compare_kinds(mixture *m, unsigned wanted, setup_array *spoilt, int of_kind,
                                    const char *what)
{
    static const char *const stages[] = {"lists",         "no lists", "box",      "two sets",
                                         "targets apart", "skin",     "skin, box"};
    const char *where = test_text("%s, kinds %x, %s", what, wanted, stages[m->stage]);
    const size_t bytes =
        (size_t)(spoilt->count * spoilt->width) * (spoilt->type == SPHG_F64 ? 8 : 4);
    void *kept = memcpy(test_memory(bytes), spoilt->data, bytes);
    spoil(m, spoilt);
    evaluate_mixture(m, wanted);
    memcpy(spoilt->data, kept, bytes);
    for (int k = 0; k < KINDS; ++k) {
        const rows *reached = k < ONE_SIDED ? &m->near : &m->mutual;
        if (!(wanted >> k & 1))
            continue;
        if (of_kind >= 0) /* the fields of others do not change at all */
            require_same(m, k, k == of_kind ? reached : NULL, 0, where);
        else /* what all share: one-sided fields do not read it of others */
            require_same(m, k, k < ONE_SIDED ? NULL : reached, 1, where);
    }
}

static void require_contained_mixture(mixture *m, unsigned wanted)
{
    evaluate_mixture(m, wanted);
    keep_clean(m, wanted);
    for (int k = 0; k < KINDS; ++k)
        if (wanted >> k & 1)
            spoil_and_compare_kinds(m, wanted, &m->kinds[k].numbers, k, kind_names[k]);
    if (m->test->method != SPHG_PLAIN)
        spoil_and_compare_kinds(m, wanted, &m->table, -1, "table");
    spoil_and_compare_kinds(m, wanted, &m->density, -1, "density");
}

static void one_sided_fields_among_others_see_their_own_neighbours(const test_case *test)
{
    /* Classic methods have neither volumes of their own nor diffusion. */
    const unsigned all = test_is_classic(test) ? 0x3bu : 0x7fu;
    for (int stage = 0; stage < STAGES; ++stage) {
        if (!test_takes(test, stage, 2))
            continue;
        mixture m = mixture_of(test, (enum stage)stage);
        ask_for_all(&m);
        int between = 0;
        for (int32_t i = 0; i < m.particles.target_count; ++i)
            between += is_among(&m, &m.mutual, i) && !is_among(&m, &m.near, i);
        assert_true(between > 5);
        for (unsigned k = ONE_SIDED; k < KINDS; ++k) {
            if (!(all >> k & 1))
                continue;
            for (unsigned one = 0; one < ONE_SIDED; ++one)
                require_contained_mixture(&m, (1u << one & all) | 1u << k);
            require_contained_mixture(&m, (7u & all) | 1u << k);
        }
        require_contained_mixture(&m, all);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(not_a_number_reaches_neighbours_alone, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(one_sided_fields_among_others_see_their_own_neighbours, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
