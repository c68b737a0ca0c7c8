/* SPDX-License-Identifier: MIT */
/* The k-th allocation of a call fails, once or from then on, for every k and every public function,
 * each on a context as cold as it can be: a clean code, nothing leaked, and the next call gives the
 * bits that it would have given. */
#include "support/bad_argument_rows.h"
#include "support/public_calls.h"
#include <string.h>

enum { BYTES = VALID_CALL_SLOTS * VALID_CALL_SLOT_BYTES };

/* ---- Calls that the table of functions lacks ---------------------------------------------- */

static void prepare_list_free(valid_call *own)
{
    own->geometry.list_free = 1;
}

static void prepare_skin(valid_call *own)
{
    own->geometry.skin = .25;
}

static void prepare_skin_of_targets(valid_call *own)
{
    own->geometry.targets = own->vectors;
    own->geometry.skin = .25;
}

static void prepare_weights(valid_call *own)
{
    own->geometry.keep_weights = 1;
}

static void prepare_targets_of(valid_call *own)
{
    own->geometry.target_count = 0;
    own->geometry.targets_of = own->built;
}

static void prepare_periodic(valid_call *own)
{
    own->geometry.period[0] = own->geometry.period[1] = 3;
}

static void prepare_lists(valid_call *own)
{
    own->sources[0].neighbors = own->listed;
}

static void prepare_copies(valid_call *own)
{
    own->lists.copy = 1;
}

static void prepare_copies_for_targets(valid_call *own)
{
    own->geometry.targets = own->vectors;
    own->lists.copy = 1;
}

static void prepare_two_sets(valid_call *own)
{
    own->sources[1] = own->sources[0];
    own->sources[1].neighbors = own->listed;
    own->request.set_count = 2;
}

static void prepare_classic(valid_call *own)
{
    own->scheme.method = SPHG_CRKPM;
    own->request.correction = sphg_absent();
}

static void prepare_classic_sets(valid_call *own)
{
    prepare_two_sets(own);
    prepare_classic(own);
}

static void prepare_pairs_with_indices(valid_call *own)
{
    prepare_of_four_targets(own);
    own->target_correction = sphg_absent();
}

static void prepare_gradients_of_pairs_alone(valid_call *own)
{
    prepare_pairs_with_indices(own);
    own->pairs.indices = NULL;
    own->pairs.offsets = NULL;
}

static const probe extra[] = {
    {prepare_listed, call_get_order, NULL, 0},
    {prepare_list_free, call_search, NULL, 0},
    {prepare_skin, call_search, NULL, 0},
    {prepare_skin, call_would_rebuild, NULL, 0},
    {prepare_skin_of_targets, call_search, NULL, 0},
    {prepare_weights, call_search, NULL, 0},
    {prepare_targets_of, call_search, NULL, 0},
    {prepare_copies, call_use_lists, NULL, 0},
    {prepare_copies_for_targets, call_use_lists, NULL, 0},
    {prepare_periodic, call_search, NULL, 0},
    {prepare_lists, call_evaluate, NULL, 0},
    {prepare_two_sets, call_evaluate, NULL, 0},
    {prepare_classic, call_evaluate, NULL, 0},
    {prepare_classic_sets, call_evaluate, NULL, 0},
    {prepare_pairs_with_indices, call_pair_gradients, NULL, 0},
    {prepare_gradients_of_pairs_alone, call_pair_gradients, NULL, 0},
};
enum { EXTRA = sizeof extra / sizeof *extra };

/* ---- The property ------------------------------------------------------------------------- */

typedef struct cold {
    valid_call *own;
    sphg_context *context;
    sphg_neighbors *neighbors;
} cold;

static void require_ok(sphg_result result)
{
    assert_int_equal(result, SPHG_OK);
}

/* The valid call on a context and an object that have not worked before. */
static cold cold_call(valid_call *own, const probe *tested)
{
    cold made = {own, NULL, NULL};
    valid_call_reset(own);
    const sphg_config config = fake_host_config(own->host, 2);
    require_ok(sphg_context_create(SPHG_VERSION, &config, &made.context));
    require_ok(sphg_neighbors_create(made.context, &made.neighbors));
    own->context = made.context;
    own->neighbors = made.neighbors;
    if (tested->call == call_get_order || tested->call == call_check)
        own->neighbors = own->built;
    if (tested->prepare)
        tested->prepare(own);
    return made;
}

static void forget(const cold *made)
{
    sphg_neighbors_destroy(made->neighbors);
    sphg_context_destroy(made->context);
}

/* What a build leaves is seen by an operator. */
static void look(const cold *made, const probe *tested)
{
    valid_call *own = made->own;
    const sphg_sources sources = {.neighbors = made->neighbors, .volume = own->volume_view};
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .at_sources = &own->scalars,
                              .at_targets = own->scalars,
                              .gradient = own->vector_out};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    if (tested->call == call_search || tested->call == call_use_lists)
        require_ok(sphg_evaluate(made->context, &own->scheme, &request));
}

static int64_t failures;

/* 0: the call has fewer than k allocations. */
static int fail_at(valid_call *own, const probe *tested, int64_t k, int64_t until,
                   const unsigned char *expected, const char *name)
{
    const cold made = cold_call(own, tested);
    const int64_t blocks = own->host->live_blocks;
    fake_host_fail(own->host, k, until);
    const sphg_result result = tested->call(own);
    const int failed = own->host->allocations >= k;
    fake_host_fail(own->host, 0, 0);
    TEST_REQUIRE(result == (failed ? SPHG_ERROR_MEMORY : SPHG_OK), "%s, allocation %lld: %s", name,
                 (long long)k, sphg_result_string(result));
    TEST_REQUIRE(!failed || strstr(own->host->log_message, "the allocator returned NULL"),
                 "%s: '%s'", name, own->host->log_message);
    memset(own->outputs, 0xA5, BYTES);
    TEST_REQUIRE(tested->call(own) == SPHG_OK, "%s: no recovery after %lld", name, (long long)k);
    look(&made, tested);
    TEST_REQUIRE(memcmp(own->outputs, expected, BYTES) == 0, "%s: other bits after %lld", name,
                 (long long)k);
    forget(&made);
    TEST_REQUIRE(own->host->live_blocks <= blocks && own->host->faults == 0,
                 "%s: %lld blocks more, %lld faults", name,
                 (long long)(own->host->live_blocks - blocks), (long long)own->host->faults);
    failures += failed;
    return failed;
}

static void fail_everywhere(valid_call *own, const probe *tested, const char *name)
{
    unsigned char *expected = test_memory(BYTES);
    const cold made = cold_call(own, tested);
    TEST_REQUIRE(tested->call(own) == SPHG_OK, "%s: %s", name, sphg_last_message(made.context));
    look(&made, tested);
    memcpy(expected, own->outputs, BYTES);
    forget(&made);
    for (int64_t k = 1; fail_at(own, tested, k, k + 1, expected, name); ++k)
        ;
    for (int64_t k = 1; fail_at(own, tested, k, INT64_MAX, expected, name); ++k)
        ;
}

static void any_allocation_of_any_function_may_fail(const test_case *test)
{
    valid_call *own = valid_call_create(test, 0);
    failures = 0;
    const int64_t blocks = own->host->live_blocks;
    for (int f = 0; f < argument_function_count; ++f)
        for (int p = 0; p < argument_functions[f].count; ++p)
            if (argument_functions[f].probes[p].call)
                fail_everywhere(own, &argument_functions[f].probes[p], argument_functions[f].name);
    for (int k = 0; k < EXTRA; ++k)
        fail_everywhere(own, &extra[k], test_text("extra call %d", k));
    TEST_REQUIRE(own->host->live_blocks == blocks, "%lld blocks leaked",
                 (long long)(own->host->live_blocks - blocks));
    print_message("%lld failed allocations\n", (long long)failures);
    TEST_REQUIRE(failures > 100, "only %lld failures", (long long)failures);
}

static const test_entry entries[] = {
    TEST_ENTRY(any_allocation_of_any_function_may_fail, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, 0, 0),
};
TEST_MAIN(entries)
