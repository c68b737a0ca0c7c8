/* SPDX-License-Identifier: MIT */
/* sphg_neighbors_check(): complete lists pass, however they are handed over and whatever else they
 * hold; of others the first fault is named. Who is near whom is decided by brute force. */
#include "support/setup.h"
#include "support/brute_force.h"
#include <math.h>
#include <string.h>

enum { COUNT = 240, TARGETS = 160, ROOM = 8 /* indices that a test may add to a list */ };

/* ---- Places -------------------------------------------------------------------------------- */

enum { OWN, PART, APART, PERIODIC, PLACES };

static const char *const place_names[] = {"own", "part", "apart", "periodic"};

typedef struct place {
    sphg_context *context;
    scene particles;
    sphg_scheme scheme;
    sphg_geometry geometry;
    rows near;
    const char *name;
} place;

static place place_of(const test_case *test, int kind)
{
    random_state random = random_seeded(61);
    cloud points = cloud_random(test->dimension, COUNT, 4, &random);
    cloud others = cloud_random(test->dimension, TARGETS, 4, &random);
    place own = {.context = setup_context(), .name = place_names[kind]};
    own.particles = scene_of_cloud(test, &points);
    if (kind == APART)
        own.particles.targets = scene_of_cloud(test, &others).sources;
    if (kind == PART || kind == APART)
        own.particles.target_count = TARGETS;
    for (int axis = 0; kind == PERIODIC && axis < test->dimension; ++axis)
        own.particles.period[axis] = 4;
    own.scheme = setup_scheme(test, test->dimension == 2 ? .75 : 1.25);
    own.geometry = scene_geometry(&own.particles);
    own.near = rows_by_brute_force(&own.particles, own.scheme.support_radius);
    return own;
}

static int near_count(const place *own, int target)
{
    return (int)(own->near.offsets[target + 1] - own->near.offsets[target]);
}

static int near_at(const place *own, int target, int k)
{
    return own->near.indices[own->near.offsets[target] + k];
}

static double distance_between(const place *own, int target, int source)
{
    const int d = own->particles.dimension;
    const double *x = own->particles.targets ? own->particles.targets : own->particles.sources;
    double square = 0;
    for (int a = 0; a < d; ++a) {
        double step = fabs(x[target * d + a] - own->particles.sources[source * d + a]);
        if (own->particles.period[a] > 0)
            step = fmin(step, own->particles.period[a] - step);
        square += step * step;
    }
    return sqrt(square);
}

/* ---- Lists that can be spoilt --------------------------------------------------------------- */

typedef struct draft {
    int count;
    int32_t **rows;
    int32_t *lengths;
    int64_t *offsets; /* of the copy as CSR */
    int32_t *indices;
    int32_t mask;
} draft;

static draft draft_of(const rows *complete)
{
    const size_t targets = (size_t)complete->count, room = targets * ROOM;
    draft made = {complete->count,
                  test_memory((targets + 1) * sizeof(int32_t *)),
                  test_memory((targets + 1) * sizeof(int32_t)),
                  test_memory((targets + 1) * sizeof(int64_t)),
                  NULL,
                  0};
    const size_t pairs = (size_t)complete->offsets[targets] + room;
    int32_t *next = test_memory(pairs * sizeof *next);
    made.indices = test_memory((pairs + 1) * sizeof *next);
    for (int i = 0; i < made.count; ++i) {
        made.rows[i] = next;
        made.lengths[i] = (int32_t)(complete->offsets[i + 1] - complete->offsets[i]);
        for (int k = 0; k < made.lengths[i]; ++k)
            next[k] = complete->indices[complete->offsets[i] + k];
        next += made.lengths[i] + ROOM;
    }
    return made;
}

static void add(draft *lists, int target, int32_t source)
{
    lists->rows[target][lists->lengths[target]++] = source;
}

static void drop(draft *lists, int target, int32_t source)
{
    int32_t *row = lists->rows[target];
    int kept = 0;
    for (int k = 0; k < lists->lengths[target]; ++k)
        if (row[k] != source)
            row[kept++] = row[k];
    assert_int_equal(kept, lists->lengths[target] - 1);
    lists->lengths[target] = kept;
}

/* Ends first, and what the mask hides. */
static void disguise(draft *lists)
{
    lists->mask = 0x1fffffff;
    for (int i = 0; i < lists->count; ++i)
        for (int a = 0, b = lists->lengths[i] - 1; a <= b; ++a, b--) {
            const int32_t first = lists->rows[i][a];
            lists->rows[i][a] = lists->rows[i][b] | (a % 4) << 29;
            lists->rows[i][b] = first | 1 << 30;
        }
}

enum { CSR, POINTERS, FUNCTION, GROUPS };

static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    const draft *lists = user;
    *indices = lists->rows[target];
    return worker < 0 ? -1 : lists->lengths[target];
}

static void copy_as_csr(draft *lists)
{
    for (int i = 0; i < lists->count; ++i) {
        const size_t length = lists->lengths[i] > 0 ? (size_t)lists->lengths[i] : 0;
        lists->offsets[i + 1] = lists->offsets[i] + lists->lengths[i];
        if (length)
            memcpy(lists->indices + lists->offsets[i], lists->rows[i], length * sizeof(int32_t));
    }
}

static sphg_lists group_of(draft *lists, int group)
{
    if (group == POINTERS)
        return (sphg_lists){.rows = (const int32_t *const *)lists->rows,
                            .lengths = lists->lengths,
                            .index_mask = lists->mask};
    if (group == FUNCTION)
        return (sphg_lists){.row = row_of, .user = lists, .index_mask = lists->mask};
    copy_as_csr(lists);
    return (sphg_lists){
        .offsets = lists->offsets, .indices = lists->indices, .index_mask = lists->mask};
}

/* ---- Requirements --------------------------------------------------------------------------- */

static void require_passed(const place *own, const sphg_neighbors *neighbors, double radius,
                           const char *where)
{
    sphg_scheme scheme = own->scheme;
    scheme.support_radius = radius;
    sphg_list_fault fault = {SPHG_FAULT_INDEX, 1, 1, 1, 1};
    const sphg_result result = sphg_neighbors_check(own->context, &scheme, neighbors, &fault);
    TEST_REQUIRE(!result, "%s, %s: %s", own->name, where, sphg_last_message(own->context));
    assert_int_equal(fault.kind, SPHG_FAULT_NONE);
    assert_int_equal(fault.target, -1);
    assert_int_equal(fault.source, -1);
    assert_int_equal(fault.faulty, 0);
    assert_true(fault.distance == 0);
    SETUP_OK(own->context, sphg_neighbors_check(own->context, &scheme, neighbors, NULL));
}

static void require_lists_pass(const place *own, draft *lists, const char *where)
{
    for (int group = 0; group < GROUPS; ++group) {
        const sphg_lists given = group_of(lists, group);
        const sphg_neighbors *brought =
            setup_lists(own->context, &own->scheme, &own->geometry, &given);
        require_passed(own, brought, own->scheme.support_radius, where);
    }
}

static void require_message(const place *own, const sphg_list_fault *fault, const char *where)
{
    const char *message = sphg_last_message(own->context);
    const int named = fault->kind != SPHG_FAULT_LENGTH;
    TEST_REQUIRE(strstr(message, test_text("target %d ", fault->target)) &&
                     (!named || strstr(message, test_text(" %d", fault->source))),
                 "%s: '%s'", where, message);
}

static void require_found(const place *own, draft *lists, const sphg_list_fault *expected,
                          int group)
{
    const char *where = test_text("%s, group %d, fault %d", own->name, group, (int)expected->kind);
    const sphg_lists given = group_of(lists, group);
    const sphg_neighbors *brought = setup_lists(own->context, &own->scheme, &own->geometry, &given);
    sphg_list_fault found = {SPHG_FAULT_NONE, 0, 0, 0, 0};
    const sphg_result result = sphg_neighbors_check(own->context, &own->scheme, brought, &found);
    const int is_index = expected->kind == SPHG_FAULT_LENGTH || expected->kind == SPHG_FAULT_INDEX;
    TEST_REQUIRE(result == (is_index ? SPHG_ERROR_INDEX : SPHG_ERROR_LISTS), "%s: %d", where,
                 (int)result);
    TEST_REQUIRE(found.kind == expected->kind && found.target == expected->target &&
                     found.source == expected->source && found.faulty == expected->faulty,
                 "%s: kind %d, target %d (%d), source %d (%d), %d faulty (%d)", where,
                 (int)found.kind, found.target, expected->target, found.source, expected->source,
                 found.faulty, expected->faulty);
    const double distance =
        is_index ? 0 : distance_between(own, expected->target, expected->source);
    TEST_REQUIRE(fabs(found.distance - distance) <= 1e-6 * distance, "%s: %.17g, not %.17g", where,
                 found.distance, distance);
    require_message(own, &found, where);
    assert_int_equal(sphg_neighbors_check(own->context, &own->scheme, brought, NULL), result);
}

/* ---- Complete lists ------------------------------------------------------------------------- */

/* What is no neighbour may be named twice. */
static void add_far_again(const place *own, draft *lists, int target)
{
    for (int k = lists->lengths[target]; k-- > 0;)
        if (distance_between(own, target, lists->rows[target][k]) >
            1.01 * own->scheme.support_radius) {
            add(lists, target, lists->rows[target][k]);
            return;
        }
}

/* Also with pairs further apart than H, twice, the target itself, in another order, masked. */
static void complete_lists_pass(const test_case *test)
{
    for (int kind = 0; kind < PLACES; ++kind) {
        const place own = place_of(test, kind);
        const rows wide = rows_by_brute_force(&own.particles, 1.4 * own.scheme.support_radius);
        draft exact = draft_of(&own.near), more = draft_of(&wide);
        require_lists_pass(&own, &exact, "exact");
        for (int i = 0; i < more.count; ++i) {
            add_far_again(&own, &more, i);
            for (int k = 0; kind != APART && k < i % 3; ++k)
                add(&more, i, i);
        }
        require_lists_pass(&own, &more, "more");
        disguise(&more);
        require_lists_pass(&own, &more, "disguised");
    }
}

/* Wider than the scheme: what is further away may be missing. */
static void lists_need_no_more_than_the_scheme_asks(const test_case *test)
{
    const place own = place_of(test, OWN);
    const double narrow = .6 * own.scheme.support_radius;
    const rows few = rows_by_brute_force(&own.particles, narrow);
    draft lists = draft_of(&few);
    const sphg_lists given = group_of(&lists, CSR);
    const sphg_neighbors *brought = setup_lists(own.context, &own.scheme, &own.geometry, &given);
    require_passed(&own, brought, narrow, "narrow");
    assert_int_equal(sphg_neighbors_check(own.context, &own.scheme, brought, NULL),
                     SPHG_ERROR_LISTS);
}

static void lists_of_the_library_pass(const test_case *test)
{
    for (int kind = 0; kind < PLACES; ++kind)
        for (int way = 0; way < 3; ++way) {
            place own = place_of(test, kind);
            const double H = own.scheme.support_radius;
            own.geometry.list_free = way == 1;
            own.geometry.skin = way == 2 ? .2 * H : 0;
            sphg_neighbors *searched = setup_search(own.context, &own.scheme, &own.geometry);
            require_passed(&own, searched, H, test_text("way %d", way));
            require_passed(&own, searched, .7 * H, test_text("way %d, narrow", way));
            if (way < 2 || kind == APART)
                continue;
            for (int k = 0; k < COUNT * test->dimension; ++k)
                own.particles.sources[k] += k % 2 ? 0x1p-5 : -0x1p-5;
            const sphg_geometry moved = scene_geometry(&own.particles);
            own.geometry.sources = moved.sources;
            SETUP_OK(own.context,
                     sphg_neighbors_search(own.context, searched, &own.scheme, &own.geometry));
            require_passed(&own, searched, H, "kept by the skin");
        }
}

/* Between looking at an object and looking again nothing changed. */
static void neighbours_stay_as_they_are(const test_case *test)
{
    const place own = place_of(test, PERIODIC);
    const sphg_neighbors *searched = setup_search(own.context, &own.scheme, &own.geometry);
    sphg_neighbors_info before, after;
    SETUP_OK(own.context, sphg_neighbors_get_info(own.context, searched, &before));
    require_passed(&own, searched, own.scheme.support_radius, "searched");
    SETUP_OK(own.context, sphg_neighbors_get_info(own.context, searched, &after));
    assert_true(before.pairs == after.pairs && before.bytes == after.bytes);
    const rows found = rows_listed(own.context, searched, &own.scheme, NULL);
    rows_require_equal(&found, &own.near, "after the check");
}

static void empty_sets_pass(const test_case *test)
{
    place own = place_of(test, OWN);
    const sphg_view none = {NULL, NULL, NULL, 0, test_position_type(test), SPHG_AS_SHAPE};
    static const int64_t zeros[COUNT + 1] = {0};
    static const int32_t nothing[1] = {0};
    const sphg_lists lists = {.offsets = zeros, .indices = nothing};
    const sphg_view there = own.geometry.sources;
    const sphg_geometry empty[] = {
        {.sources = none},
        {.sources = there, .source_count = COUNT},
        {.sources = none, .targets = there, .target_count = COUNT},
        {.sources = there, .source_count = 1, .target_count = 1},
    };
    for (int k = 0; k < 4; ++k) {
        const double H = own.scheme.support_radius;
        const char *where = test_text("empty %d", k);
        require_passed(&own, setup_search(own.context, &own.scheme, &empty[k]), H, where);
        require_passed(&own, setup_lists(own.context, &own.scheme, &empty[k], &lists), H, where);
    }
}

/* ---- One fault ------------------------------------------------------------------------------ */

/* From `start` on the first target with a neighbour of a higher number, below `limit`: that. */
static int partner_of(const place *own, int *start, int limit)
{
    for (; *start < own->particles.target_count; ++*start)
        for (int k = near_count(own, *start); k-- > 0;)
            if (near_at(own, *start, k) > *start && near_at(own, *start, k) < limit)
                return near_at(own, *start, k);
    fail_msg("%s: no pair to spoil", own->name);
    return -1;
}

/* Spoils a list at or behind `target`, and says by what it should be found. */
static sphg_list_fault spoil(const place *own, draft *lists, sphg_fault kind, int target)
{
    const int targets = own->particles.target_count, sources = own->particles.source_count;
    const int mutual = !own->particles.targets;
    const int other = partner_of(own, &target, kind == SPHG_FAULT_ONE_SIDED ? targets : sources);
    sphg_list_fault fault = {kind, target, other, 1, 0};
    switch (kind) {
    case SPHG_FAULT_LENGTH:
        lists->lengths[target] = -1;
        fault.source = -1;
        break;
    case SPHG_FAULT_INDEX:
        fault.source = target % 2 ? -1 : sources;
        add(lists, target, fault.source);
        break;
    case SPHG_FAULT_DOUBLED:
        add(lists, target, other);
        break;
    case SPHG_FAULT_MISSING:
        if (mutual && other < targets) {
            drop(lists, other, target);
            fault.faulty = 2;
        }
        drop(lists, target, other);
        break;
    default:
        drop(lists, target, other);
    }
    return fault;
}

static void each_kind_of_fault_is_named(const test_case *test)
{
    for (int kind = 0; kind < PLACES; ++kind)
        for (int fault = SPHG_FAULT_LENGTH; fault <= SPHG_FAULT_MISSING; ++fault)
            for (int group = 0; group < GROUPS; ++group) {
                const place own = place_of(test, kind);
                draft lists = draft_of(&own.near);
                if ((kind == APART && fault == SPHG_FAULT_ONE_SIDED) ||
                    (group == CSR && fault == SPHG_FAULT_LENGTH))
                    continue;
                const sphg_list_fault expected =
                    spoil(&own, &lists, (sphg_fault)fault, 20 + 7 * fault);
                require_found(&own, &lists, &expected, group);
            }
}

/* The lowest target comes first, whatever the others' faults are; they are counted. */
static void the_lowest_target_is_named_and_all_are_counted(const test_case *test)
{
    for (int kind = 0; kind < PLACES; ++kind)
        for (int fault = SPHG_FAULT_LENGTH; fault <= SPHG_FAULT_MISSING; ++fault) {
            const place own = place_of(test, kind);
            draft lists = draft_of(&own.near);
            if (kind == APART && fault == SPHG_FAULT_ONE_SIDED)
                continue;
            sphg_list_fault expected = spoil(&own, &lists, (sphg_fault)fault, 3);
            const int last = fault == SPHG_FAULT_DOUBLED ? SPHG_FAULT_INDEX : SPHG_FAULT_DOUBLED;
            for (int target = 50; target < 53; ++target) {
                const int other = near_count(&own, target) ? near_at(&own, target, 0) : -1;
                const int spoilt = other >= 0 && expected.source != target;
                if (spoilt)
                    add(&lists, target, last == SPHG_FAULT_INDEX ? COUNT + 5 : other);
                expected.faulty += spoilt;
            }
            assert_true(expected.faulty > 1);
            require_found(&own, &lists, &expected, FUNCTION);
            require_found(&own, &lists, &expected, POINTERS);
        }
}

/* Offsets that fall, changed after the build. */
static void require_falling_offsets_found(const place *own, draft *lists, int target)
{
    const sphg_lists given = group_of(lists, CSR);
    const sphg_neighbors *brought = setup_lists(own->context, &own->scheme, &own->geometry, &given);
    sphg_list_fault found = {SPHG_FAULT_NONE, 0, 0, 0, 0};
    lists->offsets[target + 1] = lists->offsets[target] - 1;
    assert_int_equal(sphg_neighbors_check(own->context, &own->scheme, brought, &found),
                     SPHG_ERROR_INDEX);
    assert_int_equal(found.kind, SPHG_FAULT_LENGTH);
    assert_int_equal(found.target, target);
}

/* No list where there should be one. */
static void lists_that_are_none_are_named(const test_case *test)
{
    const place own = place_of(test, OWN);
    draft lists = draft_of(&own.near);
    int target = 30;
    partner_of(&own, &target, COUNT);
    const sphg_list_fault expected = {SPHG_FAULT_LENGTH, target, -1, 1, 0};
    int32_t *kept = lists.rows[target];
    lists.rows[target] = NULL;
    require_found(&own, &lists, &expected, POINTERS);
    require_found(&own, &lists, &expected, FUNCTION);
    lists.rows[target] = kept;
    require_falling_offsets_found(&own, &lists, target);
}

/* ---- What solvers have ---------------------------------------------------------------------- */

/* Each pair at its lower end only. */
static void half_lists_are_found(const test_case *test)
{
    for (int kind = 0; kind < PLACES; kind += PERIODIC) {
        const place own = place_of(test, kind);
        draft lists = draft_of(&own.near);
        sphg_list_fault expected = {SPHG_FAULT_ONE_SIDED, -1, -1, 0, 0};
        for (int i = 0; i < COUNT; ++i) {
            const int32_t lowest = near_count(&own, i) ? near_at(&own, i, 0) : COUNT;
            if (lowest < i && expected.target < 0)
                expected.target = i, expected.source = lowest;
            expected.faulty += lowest < i;
            for (int k = 0; k < near_count(&own, i); ++k)
                if (near_at(&own, i, k) < i)
                    drop(&lists, i, near_at(&own, i, k));
        }
        for (int group = 0; group < GROUPS; ++group)
            require_found(&own, &lists, &expected, group);
    }
}

/* No more than so many in a list. */
static void lists_cut_at_a_maximum_are_found(const test_case *test)
{
    enum { MOST = 9 };
    for (int kind = 0; kind < PLACES; ++kind) {
        const place own = place_of(test, kind);
        draft lists = draft_of(&own.near);
        sphg_list_fault expected = {SPHG_FAULT_MISSING, -1, -1, 0, 0};
        for (int i = own.particles.target_count; i-- > 0;) {
            if (near_count(&own, i) <= MOST)
                continue;
            lists.lengths[i] = MOST;
            expected.target = i, expected.source = near_at(&own, i, MOST);
            ++expected.faulty;
        }
        assert_true(expected.target >= 0);
        const int there = kind != APART && expected.source < lists.count;
        for (int k = 0; there && k < lists.lengths[expected.source]; ++k)
            if (lists.rows[expected.source][k] == expected.target)
                expected.kind = SPHG_FAULT_ONE_SIDED;
        for (int group = 0; group < GROUPS; ++group)
            require_found(&own, &lists, &expected, group);
    }
}

/* ---- Whoever works -------------------------------------------------------------------------- */

static void the_answer_does_not_depend_on_threads(const test_case *test)
{
    enum { MANY = 1500 };
    random_state random = random_seeded(67);
    cloud points = cloud_random(test->dimension, MANY, 8, &random);
    const scene particles = scene_of_cloud(test, &points);
    const sphg_scheme scheme = setup_scheme(test, 1.5);
    const sphg_geometry geometry = scene_geometry(&particles);
    const rows near = rows_by_brute_force(&particles, 1.5);
    draft lists = draft_of(&near);
    for (int i = 600; i < MANY; i += 1 + random_index(&random, 5))
        if (lists.lengths[i] > 0)
            --lists.lengths[i];
    const sphg_lists given = group_of(&lists, FUNCTION);
    fake_host *host = setup_hooks();
    sphg_config reversed = fake_host_config(host, 4), in_turn = fake_host_config(host, 4);
    reversed.parallel_for = fake_host_reversed;
    in_turn.parallel_for = fake_host_odd_splits;
    sphg_context *const contexts[] = {setup_context_of(1), setup_context_of(2), setup_context_of(7),
                                      setup_context_with(&reversed), setup_context_with(&in_turn)};
    sphg_list_fault first = {SPHG_FAULT_NONE, 0, 0, 0, 0};
    for (int k = 0; k < 5; ++k) {
        const sphg_neighbors *brought = setup_lists(contexts[k], &scheme, &geometry, &given);
        sphg_list_fault found = {SPHG_FAULT_NONE, 0, 0, 0, 0};
        assert_int_equal(sphg_neighbors_check(contexts[k], &scheme, brought, &found),
                         SPHG_ERROR_LISTS);
        first = k ? first : found;
        assert_true(found.kind == first.kind && found.target == first.target &&
                    found.source == first.source && found.faulty == first.faulty &&
                    found.distance == first.distance);
        assert_string_equal(sphg_last_message(contexts[k]), sphg_last_message(contexts[0]));
    }
    assert_true(first.target >= 600 && first.faulty > 200);
}

/* ---- Refused -------------------------------------------------------------------------------- */

static void questions_that_make_no_sense_are_refused(const test_case *test)
{
    const place own = place_of(test, OWN);
    const sphg_neighbors *searched = setup_search(own.context, &own.scheme, &own.geometry);
    sphg_neighbors *blank = brute_force_neighbors(own.context);
    sphg_list_fault fault;
    memset(&fault, 0x5a, sizeof fault);
    const sphg_list_fault untouched = fault;
    sphg_scheme wide = own.scheme, other = own.scheme;
    wide.support_radius *= 1.5;
    other.dimension = 5 - own.scheme.dimension;
    const struct {
        const sphg_scheme *scheme;
        const sphg_neighbors *neighbors;
        sphg_result expected;
        const char *words;
    } asked[] = {{&own.scheme, NULL, SPHG_ERROR_ARGUMENT, "neighbors is NULL"},
                 {NULL, searched, SPHG_ERROR_ARGUMENT, "scheme is NULL"},
                 {&own.scheme, blank, SPHG_ERROR_STATE, "never built"},
                 {&wide, searched, SPHG_ERROR_SIZE, "scheme.support_radius"},
                 {&other, searched, SPHG_ERROR_SIZE, "built in"}};
    for (size_t k = 0; k < sizeof asked / sizeof *asked; ++k) {
        const sphg_result result =
            sphg_neighbors_check(own.context, asked[k].scheme, asked[k].neighbors, &fault);
        TEST_REQUIRE(result == asked[k].expected &&
                         strstr(sphg_last_message(own.context), asked[k].words),
                     "%d, %s", (int)result, sphg_last_message(own.context));
        assert_memory_equal(&fault, &untouched, sizeof fault);
    }
    assert_int_equal(sphg_neighbors_check(NULL, &own.scheme, searched, &fault),
                     SPHG_ERROR_ARGUMENT);
}

static const test_entry entries[] = {
    TEST_ENTRY(complete_lists_pass, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(lists_need_no_more_than_the_scheme_asks, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(lists_of_the_library_pass, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(neighbours_stay_as_they_are, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(empty_sets_pass, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(each_kind_of_fault_is_named, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(the_lowest_target_is_named_and_all_are_counted, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(lists_that_are_none_are_named, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(half_lists_are_found, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0, 0),
    TEST_ENTRY(lists_cut_at_a_maximum_are_found, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS, 0,
               0),
    TEST_ENTRY(the_answer_does_not_depend_on_threads, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               0, 0),
    TEST_ENTRY(questions_that_make_no_sense_are_refused, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
