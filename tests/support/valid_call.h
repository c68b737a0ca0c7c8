/* SPDX-License-Identifier: MIT */
/* One valid call of every public function, with each of its arguments as a member that can be
 * spoilt: bad_arguments.h knows how. */
#ifndef TESTS_SUPPORT_VALID_CALL_H
#define TESTS_SUPPORT_VALID_CALL_H
#include "setup.h"
#include "fake_host.h"

enum { VALID_CALL_REFUSED = 1000 /* any positive code */ };
enum {
    VALID_CALL_COUNT = 60,
    VALID_CALL_SLOTS = 14,
    VALID_CALL_SLOT_BYTES = VALID_CALL_COUNT * 16 * 8
};

typedef struct valid_call {
    const test_case *test;
    struct valid_call *valid; /* as it was made: what a reset goes back to */
    fake_host *host;
    sphg_context *living;
    sphg_neighbors *built, *blank, *listed; /* listed: by lists of the host, indices below */
    sphg_neighbors *rebuilt;                /* by the calls that build */
    sphg_neighbors *lone, *narrow;          /* plain ones: targets of their own; half of H */

    /* Arguments as they are passed. */
    sphg_context *context;
    int32_t version, count, dimension;
    const sphg_config *config_given;
    sphg_context **context_out;
    sphg_neighbors *neighbors, **neighbors_out;
    sphg_neighbors_info *info;
    sphg_context_info *context_info;
    sphg_list_fault *list_fault;
    int32_t *order, *rebuild;
    const sphg_scheme *scheme_given;
    const sphg_geometry *geometry_given;
    const sphg_lists *lists_given;
    const sphg_request *request_given;
    const sphg_sources *sources_given;
    const sphg_subset *subset_given;
    sphg_pairs *pairs_given;
    const sphg_inversion *wanted_given;
    sphg_shape shape;

    /* What they point to. */
    sphg_config config;
    sphg_scheme scheme;
    sphg_geometry geometry;
    sphg_lists lists;
    sphg_request request;
    sphg_sources sources[2];
    sphg_field field;
    sphg_view at_sources[2], lenders[2], coefficient[2], volumes[2];
    sphg_subset subset;
    sphg_pairs pairs;
    sphg_inversion wanted;
    sphg_view scalars, vectors, tensors, symmetric, squares, densities, table; /* inputs */
    sphg_view target_correction;
    sphg_view radii, target_radii; /* of the type of positions */
    sphg_view scalar_out, vector_out, tensor_out, table_out, rank_out, lambda_out;
    sphg_view u, sigma, v;
    sphg_context *made_context;
    sphg_neighbors *made_neighbors;

    sphg_view position_view, volume_view;
    int64_t *offsets;
    int32_t *indices, *picked;
    uint8_t *mask;
    unsigned char *outputs; /* all that may be written, in one piece of canaries */
} valid_call;

valid_call *valid_call_create(const test_case *test, int trusted);
/* A request of a gradient, correction and rank alone, and the neighbours of plain ones. */
valid_call *valid_call_create_plain(const test_case *test);
/* Back to the valid call: arguments, inputs, canaries. */
void valid_call_reset(valid_call *own);
int valid_call_outputs_are_untouched(const valid_call *own);
/* Sets item `item` (its first number) of an input of floating point numbers. */
void valid_call_put(sphg_view view, int item, double value);

/* Fails unless the result is `expected`, the message has `words` in it, the log heard it and, for
 * positive codes, no output byte was written. */
void valid_call_require(const valid_call *own, sphg_result result, int expected, const char *words,
                        const char *change);

/* Spoils the valid call by `change`, expects the code, then makes the valid call. */
#define VALID_CALL_REFUSES(own, call, expected, words, change)                                     \
    do {                                                                                           \
        valid_call_reset(own);                                                                     \
        change;                                                                                    \
        valid_call_require(own, call(own), expected, words, #change);                              \
        valid_call_reset(own);                                                                     \
        TEST_REQUIRE(call(own) == SPHG_OK, "after %s: %s", #change,                                \
                     sphg_last_message((own)->context));                                           \
    } while (0)

#endif
