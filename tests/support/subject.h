/* One valid call of everything, to be spoilt one argument at a time. */
#ifndef TESTS_SUPPORT_SUBJECT_H
#define TESTS_SUPPORT_SUBJECT_H
#include "fixture.h"
#include "hooks.h"

enum { SUBJECT_COUNT = 60, SUBJECT_REFUSED = 1000 /* any positive code */ };

/* Arguments as they are passed; pointers lead to the members below, and may be set to NULL. */
typedef struct subject {
    const test_case *test;
    hooks *host;
    struct subject *valid; /* as it was made: what a reset goes back to */
    sphg_context *context;
    sphg_neighbors *built, *blank, *lone, *narrow; /* lone: targets of their own; narrow: half H */

    sphg_neighbors *neighbors;
    const sphg_scheme *scheme_given;
    const sphg_geometry *geometry_given;
    const sphg_lists *lists_given;
    const sphg_request *request_given;
    const sphg_sources *sources_given;
    sphg_pairs *pairs_given;
    const sphg_inversion *inversion_given;

    sphg_scheme scheme;
    sphg_geometry geometry;
    sphg_lists lists;
    sphg_request request;
    sphg_sources sources[2];
    sphg_field field;
    sphg_view at_sources[2];
    sphg_subset subset;
    sphg_pairs pairs;
    sphg_inversion inversion;
    sphg_view positions, scalars, volumes, tensors, table; /* inputs */
    sphg_view vectors_out, scalars_out, tensors_out, table_out, ranks_out;
    int32_t dimension, count;

    int64_t *offsets;
    int32_t *indices;
    void *input_memory[8];
    unsigned char *outputs; /* all that may be written, in one piece of canaries */
    size_t output_bytes;
} subject;

subject *subject_create(const test_case *test);
/* Back to the valid call. */
void subject_reset(subject *own);

/* Fails unless the result is `expected`, the message has `words` in it, the log heard it and, for
 * positive codes, no output byte was written. */
void subject_require(subject *own, sphg_result result, int expected, const char *words,
                     const char *change);

/* Spoils the valid call by `change`, expects the code, then makes the valid call. */
#define SUBJECT_REFUSES(own, call, expected, words, change)                                        \
    do {                                                                                           \
        subject_reset(own);                                                                        \
        change;                                                                                    \
        subject_require(own, call(own), expected, words, #change);                                 \
        subject_reset(own);                                                                        \
        TEST_REQUIRE(call(own) == SPHG_OK, "after %s: %s", #change,                                \
                     sphg_last_message((own)->context));                                           \
    } while (0)

#endif
