/* SPDX-License-Identifier: MIT */
/* Lists of the host that are copied: the bits of borrowed ones, whatever is asked of them, and
 * nothing of the host's is read after the build. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <string.h>

enum { COUNT = 420, BIG = 270, OWN = 390, CHANCES = 2 };
/* A list of BIG takes more than one piece, and one of more than a chunk keeps its gaps. */

enum { WHOLE, OWN_AND_GHOSTS, APART, PERIODIC, RADII, RADII_APART, SCENES };
enum { CSR, ROWS, FUNCTION, SUPPLIES };

typedef struct world {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    scene particles;
    sphg_geometry geometry;
    setup_array volume, density, scalar, vector;
    int64_t *offsets; /* of a superset, flagged, shuffled, many with the target itself */
    int32_t *indices;
    const int32_t **rows;
    int32_t *lengths;
    int32_t *reused[2]; /* what the function returns, a worker each */
    int asked;
} world;

/* ---- Clouds and lists ----------------------------------------------------------------------- */

/* Crowds of all sizes, one of them BIG, and loners. */
static cloud crowds(int dimension, random_state *random)
{
    cloud made = {.dimension = dimension, .count = COUNT};
    made.x = test_memory((size_t)(COUNT * dimension) * sizeof *made.x);
    double centre[3] = {0};
    for (int i = 0, left = 0; i < COUNT; ++i, --left) {
        if (!left) {
            left = i ? 1 + random_index(random, 90) : BIG;
            for (int c = 0; c < dimension; ++c)
                centre[c] = random_between(random, 0, 9);
        }
        for (int c = 0; c < dimension; ++c)
            made.x[i * dimension + c] =
                centre[c] + random_between(random, -.7, .7) * (left > 20 ? .6 : 1);
    }
    return made;
}

/* Between an eighth and 1, any number of eighths; whose lists those of the largest hold, too. */
static double *radii_of_all(random_state *random)
{
    double *radii = test_memory(COUNT * sizeof *radii);
    for (int i = 0; i < COUNT; ++i)
        radii[i] = (1 + random_index(random, 8)) / 8.;
    return radii;
}

static void list_pairs(world *own, random_state *random)
{
    scene wide = own->particles;
    wide.support = wide.target_support = NULL;
    const rows near = rows_by_brute_force(&wide, 1.3);
    const int count = own->particles.target_count;
    int64_t next = 0;
    own->offsets = test_memory(((size_t)count + 1) * sizeof *own->offsets);
    own->indices =
        test_memory(((size_t)near.offsets[count] + (size_t)count) * sizeof *own->indices);
    own->rows = test_memory((size_t)count * sizeof *own->rows);
    own->lengths = test_memory((size_t)count * sizeof *own->lengths);
    for (int worker = 0; worker < 2; ++worker)
        own->reused[worker] = test_memory(COUNT * sizeof **own->reused);
    for (int i = 0; i < count; ++i) {
        int32_t *row = own->indices + next;
        for (int64_t k = near.offsets[i]; k < near.offsets[i + 1]; ++k)
            own->indices[next++] = near.indices[k];
        if (!own->particles.targets && i % 3)
            own->indices[next++] = i;
        for (int32_t k = (int32_t)(own->indices + next - row) - 1; k > 0; --k) {
            const int other = random_index(random, k + 1);
            const int32_t held = row[k];
            row[k] = row[other];
            row[other] = held;
        }
        for (int32_t *item = row; item < own->indices + next; ++item)
            *item |= random_index(random, 4) << 29;
        own->rows[i] = row;
        own->lengths[i] = (int32_t)(own->indices + next - row);
        own->offsets[i + 1] = next;
    }
}

static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    world *own = user;
    int32_t *to = own->reused[worker];
    memset(to, 0x7f, COUNT * sizeof *to); /* nobody may still look at the last one */
    for (int32_t k = 0; k < own->lengths[target]; ++k)
        to[k] = own->rows[target][k];
    *indices = to;
    return own->lengths[target];
}

static sphg_lists lists_of(world *own, int supply)
{
    sphg_lists given = {.index_mask = 0x1fffffff};
    if (supply == CSR) {
        given.offsets = own->offsets;
        given.indices = own->indices;
    } else if (supply == ROWS) {
        given.rows = own->rows;
        given.lengths = own->lengths;
    } else {
        given.row = row_of;
        given.user = own;
    }
    return given;
}

static world world_of(const test_case *test, sphg_isa isa, int kind)
{
    world own = {.test = test, .context = setup_context_on(isa)};
    random_state random = random_seeded(571 + (uint64_t)kind);
    const int d = test->dimension;
    cloud points = crowds(d, &random);
    own.scheme = setup_scheme(test, 1);
    own.particles = scene_of_cloud(test, &points);
    if (kind == OWN_AND_GHOSTS)
        own.particles.target_count = OWN;
    if (kind == APART || kind == RADII_APART) {
        cloud others = cloud_copy(&points);
        for (int k = 0; k < COUNT * d; ++k)
            others.x[k] += random_between(&random, -.3, .3);
        own.particles.targets = scene_of_cloud(test, &others).sources;
    }
    for (int axis = 0; axis < d && (kind == PERIODIC || kind == RADII_APART); ++axis)
        own.particles.period[axis] = 9;
    if (kind == RADII || kind == RADII_APART)
        own.particles.support = radii_of_all(&random);
    if (kind == RADII_APART)
        own.particles.target_support = radii_of_all(&random);
    own.particles.mutual = kind == RADII || test->method % 2;
    own.geometry = scene_geometry(&own.particles);
    if (test->precision == TEST_MIXED)
        own.geometry.precision = SPHG_F32;
    const sphg_type type = test_field_type(test);
    double numbers[3 * COUNT];
    for (int k = 0; k < 3 * COUNT; ++k)
        numbers[k] = random_between(&random, .5, 1.5);
    own.volume = setup_numbers(type, COUNT, 1, numbers);
    own.density = setup_numbers(type, COUNT, 1, numbers + COUNT);
    for (int k = 0; k < 3 * COUNT; ++k)
        numbers[k] = random_between(&random, -1, 1);
    own.scalar = setup_numbers(type, COUNT, 1, numbers + COUNT);
    own.vector = setup_numbers(type, COUNT, d, numbers);
    list_pairs(&own, &random);
    return own;
}

/* ---- What is asked -------------------------------------------------------------------------- */

enum { CORRECTION, RANK, GRADIENT, VALUE, SQUARE, DIVERGENCE, CURL, FORCE, SYMMETRIC, OUTPUTS };

typedef struct results {
    setup_array of[OUTPUTS];
} results;

static results outputs_for(const world *own)
{
    const int d = own->test->dimension, table = sphg_correction_width(&own->scheme);
    const int width[OUTPUTS] = {table ? table : 1, 1, d, 1, 1, 1, d == 2 ? 1 : 3, d, 1};
    results made;
    for (int k = 0; k < OUTPUTS; ++k)
        made.of[k] = setup_output(k == RANK ? SPHG_U8 : own->volume.type, COUNT, width[k]);
    return made;
}

/* The first request has what corrections are computed for; the second what reads a table of them.
 */
static results evaluate(const world *own, const sphg_neighbors *const *neighbors, int sets,
                        const sphg_subset *subset)
{
    results found = outputs_for(own);
    const sphg_view scalar = setup_view(&own->scalar), vector = setup_view(&own->vector);
    const sphg_view scalars[2] = {scalar, scalar}, vectors[2] = {vector, vector};
    sphg_sources sources[2] = {{.neighbors = neighbors[0]}, {.neighbors = neighbors[sets - 1]}};
    const setup_array *of = found.of;
    sphg_field fields[] = {{.shape = SPHG_SCALAR,
                            .at_sources = scalars,
                            .at_targets = scalar,
                            .gradient = setup_view(&of[GRADIENT])},
                           {.shape = SPHG_SCALAR,
                            .form = SPHG_DIRECT,
                            .at_sources = scalars,
                            .value = setup_view(&of[VALUE]),
                            .square = setup_view(&of[SQUARE])},
                           {.shape = SPHG_VECTOR,
                            .at_sources = vectors,
                            .at_targets = vector,
                            .divergence = setup_view(&of[DIVERGENCE]),
                            .curl = setup_view(&of[CURL])}};
    sphg_request request = {.sources = sources,
                            .fields = fields,
                            .set_count = sets,
                            .field_count = 3,
                            .subset = subset,
                            .target_volume = setup_view(&own->volume),
                            .target_density = setup_view(&own->density)};
    const int corrects = own->scheme.method != SPHG_PLAIN;
    if (corrects) {
        request.correction = setup_view(&of[CORRECTION]);
        request.rank = setup_view(&of[RANK]);
    }
    for (int k = 0; k < 2; ++k) {
        sources[k].volume = setup_view(&own->volume);
        sources[k].density = setup_view(&own->density);
    }
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    const sphg_field forces[] = {{.shape = SPHG_SCALAR,
                                  .form = SPHG_ADJOINT,
                                  .at_sources = scalars,
                                  .at_targets = scalar,
                                  .gradient = setup_view(&of[FORCE])},
                                 {.shape = SPHG_VECTOR,
                                  .form = SPHG_SYMMETRIC,
                                  .at_sources = vectors,
                                  .at_targets = vector,
                                  .divergence = setup_view(&of[SYMMETRIC])}};
    const setup_array table = setup_output(own->volume.type, COUNT, of[CORRECTION].width);
    if (own->particles.support && !own->particles.mutual)
        return found;                             /* G_ji is not among these pairs */
    for (int k = 0; k < COUNT * table.width; ++k) /* any: only bits are compared */
        setup_put(&table, k, .5 + .01 * (k % 17));
    request.fields = forces;
    request.field_count = 2;
    request.correction = request.rank = sphg_absent();
    for (int k = 0; k < 2 && corrects; ++k)
        sources[k].correction = setup_view(&table);
    request.target_correction = corrects ? setup_view(&table) : sphg_absent();
    SETUP_OK(own->context, sphg_evaluate(own->context, &own->scheme, &request));
    return found;
}

static void require_same(const results *a, const results *b, const char *how)
{
    for (int k = 0; k < OUTPUTS; ++k)
        TEST_REQUIRE(setup_same_bits(&a->of[k], &b->of[k]), "%s: result %d", how, k);
}

typedef struct exported {
    int64_t count;
    int64_t *offsets;
    int32_t *indices;
    setup_array gradients;
} exported;

static exported pairs_of(const world *own, const sphg_neighbors *neighbors)
{
    const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&own->volume)};
    exported found = {.offsets = test_memory((COUNT + 1) * sizeof *found.offsets)};
    const sphg_scheme plain = {.dimension = own->test->dimension,
                               .method = SPHG_PLAIN,
                               .support_radius = own->scheme.support_radius};
    sphg_pairs pairs = {.offsets = found.offsets, .any_order = 1};
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    found.count = pairs.capacity = pairs.count;
    pairs.indices = found.indices = test_memory((size_t)(pairs.count + 1) * sizeof(int32_t));
    found.gradients = setup_output(own->volume.type, (int)pairs.count, own->test->dimension);
    pairs.gradient = setup_view(&found.gradients);
    SETUP_OK(own->context,
             sphg_pair_gradients(own->context, &plain, &sources, NULL, sphg_absent(), &pairs));
    return found;
}

static void require_same_pairs(const exported *a, const exported *b, int targets, const char *how)
{
    TEST_REQUIRE(a->count == b->count, "%s: %lld pairs, not %lld", how, (long long)b->count,
                 (long long)a->count);
    for (int i = 0; i <= targets; ++i)
        TEST_REQUIRE(a->offsets[i] == b->offsets[i], "%s: list of target %d", how, i);
    for (int64_t k = 0; k < a->count; ++k)
        TEST_REQUIRE(a->indices[k] == b->indices[k], "%s: pair %lld", how, (long long)k);
    TEST_REQUIRE(setup_same_bits(&a->gradients, &b->gradients), "%s: gradients", how);
}

/* ---- Properties ----------------------------------------------------------------------------- */

/* What was asked of borrowed lists and is now asked of their copy. */
typedef struct answers {
    results all, both, some[CHANCES];
    exported pairs;
} answers;

static answers ask(const world *own, const sphg_neighbors *neighbors)
{
    const sphg_neighbors *const twice[2] = {neighbors, neighbors};
    uint8_t *mask = test_memory(COUNT);
    answers found = {.all = evaluate(own, twice, 1, NULL),
                     .both = evaluate(own, twice, 2, NULL),
                     .pairs = pairs_of(own, neighbors)};
    for (int k = 0; k < CHANCES; ++k) {
        random_state random = random_seeded(7 + (uint64_t)k);
        const sphg_subset subset = sphg_masked(mask, own->particles.target_count);
        for (int i = 0; i < COUNT; ++i)
            mask[i] = random_index(&random, 2 + 28 * k) == 0;
        found.some[k] = evaluate(own, twice, 1, &subset);
    }
    return found;
}

static void try_scene(const test_case *test, sphg_isa isa, int kind, int supply)
{
    world own = world_of(test, isa, kind);
    const char *how = test_text("path %d, scene %d, supply %d", (int)isa, kind, supply);
    sphg_lists given = lists_of(&own, supply);
    const sphg_neighbors *borrowed = setup_lists(own.context, &own.scheme, &own.geometry, &given);
    const answers expected = ask(&own, borrowed);
    given.copy = 1;
    const sphg_neighbors *copied = setup_lists(own.context, &own.scheme, &own.geometry, &given);
    const int targets = own.particles.target_count;
    memset(own.indices, 0x7f, (size_t)own.offsets[targets] * sizeof *own.indices);
    memset(own.offsets, 0x7f, ((size_t)targets + 1) * sizeof *own.offsets);
    memset(own.lengths, 0x7f, (size_t)targets * sizeof *own.lengths);
    memset(own.rows, 0x7f, (size_t)targets * sizeof *own.rows);
    const answers found = ask(&own, copied);
    require_same(&found.all, &expected.all, how);
    require_same(&found.both, &expected.both, test_text("%s, two sets", how));
    for (int k = 0; k < CHANCES; ++k)
        require_same(&found.some[k], &expected.some[k], test_text("%s, mask %d", how, k));
    require_same_pairs(&expected.pairs, &found.pairs, targets, how);
}

static void copies_give_the_bits_of_borrowed_lists(const test_case *test)
{
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        const int turn = (int)isa + (int)test->method; /* every second scene */
        for (int kind = turn % 2; kind < SCENES && setup_watched_context_on(isa); kind += 2)
            try_scene(test, isa, kind, (kind + turn) % SUPPLIES);
    }
}

/* A smaller radius later, and one object for one kind of neighbours after another. */
static void copies_take_their_turn(const test_case *test)
{
    world own = world_of(test, test_isa(), WHOLE);
    sphg_neighbors *turns = brute_force_neighbors(own.context);
    sphg_lists given = lists_of(&own, CSR);
    own.scheme.support_radius = .8;
    for (int k = 0; k < 9; ++k) {
        sphg_neighbors *alone = brute_force_neighbors(own.context);
        sphg_scheme wide = own.scheme;
        const sphg_neighbors *one[1] = {turns}, *other[1] = {alone};
        wide.support_radius = k % 2 ? 1 : .9;
        given.copy = k % 3 != 1;
        for (int n = 0; n < 2; ++n) {
            sphg_neighbors *built = n ? alone : turns;
            SETUP_OK(
                own.context,
                k % 3 ? sphg_neighbors_use_lists(own.context, built, &wide, &own.geometry, &given)
                      : sphg_neighbors_search(own.context, built, &wide, &own.geometry));
        }
        const results a = evaluate(&own, one, 1, NULL), b = evaluate(&own, other, 1, NULL);
        require_same(&a, &b, test_text("turn %d", k));
    }
}

/* The copy is the object's, is counted, and warm builds ask for no memory, however the same number
 * of pairs falls onto the targets: where they take more room side by side they stand apart. */
static void copies_are_counted_and_grow_with_counts_alone(const test_case *test)
{
    enum { EACH = 100 };
    fake_host *host = setup_hooks();
    const sphg_config config = fake_host_config(host, 2);
    world own = world_of(test, test_isa(), WHOLE);
    own.context = setup_context_with(&config);
    own.scheme.support_radius = 100; /* nobody is left out */
    sphg_neighbors *copied = brute_force_neighbors(own.context),
                   *borrowed = brute_force_neighbors(own.context);
    sphg_neighbors_info info;
    int64_t *offsets = test_memory((COUNT + 1) * sizeof *offsets);
    sphg_lists given = lists_of(&own, CSR);
    given.offsets = offsets;
    int64_t before = 0;
    assert_true(own.offsets[COUNT] > EACH * COUNT);
    for (int k = 0; k < 9; ++k) { /* the same on all, then piled up on ever fewer */
        for (int i = 0; i < COUNT; ++i)
            offsets[i] = EACH * (i >> k << k);
        offsets[COUNT] = EACH * COUNT;
        given.copy = 1;
        SETUP_OK(own.context,
                 sphg_neighbors_use_lists(own.context, copied, &own.scheme, &own.geometry, &given));
        TEST_REQUIRE(!k || host->allocations == before, "build %d asks for memory", k);
        SETUP_OK(own.context, sphg_neighbors_get_info(own.context, copied, &info));
        assert_int_equal(info.pairs, EACH * COUNT);
        assert_true(info.bytes > (EACH + 10) * COUNT * 4);
        given.copy = 0;
        SETUP_OK(own.context, sphg_neighbors_use_lists(own.context, borrowed, &own.scheme,
                                                       &own.geometry, &given));
        const sphg_neighbors *one[1] = {copied}, *other[1] = {borrowed};
        const results a = evaluate(&own, one, 1, NULL), b = evaluate(&own, other, 1, NULL);
        require_same(&a, &b, test_text("build %d", k));
        before = host->allocations;
    }
}

/* The lowest target whose list is wrong is named at once, whoever meets it; nothing was built then.
 */
static void wrong_lists_are_refused_when_they_are_copied(const test_case *test)
{
    for (int supply = 0; supply < SUPPLIES; ++supply) {
        world own = world_of(test, test_isa(), WHOLE);
        sphg_neighbors *neighbors = brute_force_neighbors(own.context);
        sphg_lists given = lists_of(&own, supply);
        given.copy = 1;
        own.indices[own.offsets[401]] = COUNT;
        own.indices[own.offsets[90] + 80] = -1;
        given.index_mask = 0;
        for (int64_t k = 0; k < own.offsets[COUNT]; ++k)
            own.indices[k] = own.indices[k] < 0 ? -1 : own.indices[k] & 0x1fffffff;
        own.indices[own.offsets[90] + 80] = INT32_MIN;
        const int64_t first = own.offsets[90] + 80;
        for (int64_t k = 0; k < first; ++k)
            own.indices[k] = own.indices[k] < 0 ? 0 : own.indices[k];
        assert_int_equal(
            sphg_neighbors_use_lists(own.context, neighbors, &own.scheme, &own.geometry, &given),
            SPHG_ERROR_INDEX);
        assert_string_equal(sphg_last_message(own.context),
                            "sphg_neighbors_use_lists: the list of target 90 holds -2147483648, "
                            "which is no source");
        const sphg_sources sources = {.neighbors = neighbors, .volume = setup_view(&own.volume)};
        const setup_array out = setup_output(own.volume.type, COUNT, test->dimension);
        assert_int_equal(sphg_gradient(own.context, &own.scheme, &sources, NULL,
                                       setup_view(&own.scalar), setup_view(&out)),
                         SPHG_ERROR_STATE);
        if (supply == CSR)
            continue;
        own.lengths[41] = -3;
        assert_int_equal(
            sphg_neighbors_use_lists(own.context, neighbors, &own.scheme, &own.geometry, &given),
            SPHG_ERROR_INDEX);
        assert_string_equal(sphg_last_message(own.context),
                            "sphg_neighbors_use_lists: the list of target 41 has a negative length "
                            "or is NULL");
    }
}

/* What the copy left out is not missed: one-sided lists are found like those of the host. */
static void copies_can_be_checked(const test_case *test)
{
    world own = world_of(test, test_isa(), WHOLE);
    sphg_lists given = lists_of(&own, CSR);
    given.copy = 1;
    sphg_neighbors *neighbors = setup_lists(own.context, &own.scheme, &own.geometry, &given);
    SETUP_OK(own.context, sphg_neighbors_check(own.context, &own.scheme, neighbors, NULL));
    const int64_t end = own.offsets[350];
    for (int i = 350; i < 360; ++i) /* lists of nobody */
        own.offsets[i] = end;
    SETUP_OK(own.context,
             sphg_neighbors_use_lists(own.context, neighbors, &own.scheme, &own.geometry, &given));
    sphg_list_fault fault;
    assert_int_equal(sphg_neighbors_check(own.context, &own.scheme, neighbors, &fault),
                     SPHG_ERROR_LISTS);
    assert_int_not_equal(fault.kind, SPHG_FAULT_NONE);
}

static const test_entry entries[] = {
    TEST_ENTRY(copies_give_the_bits_of_borrowed_lists, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_ALL_METHODS, 0),
    TEST_ENTRY(copies_take_their_turn, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_CMLS), 0),
    TEST_ENTRY(copies_are_counted_and_grow_with_counts_alone, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(wrong_lists_are_refused_when_they_are_copied, TEST_ALL_PRECISIONS,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(copies_can_be_checked, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
