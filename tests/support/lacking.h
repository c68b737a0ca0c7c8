/* Stages on lists that lack pairs, as hosts may hand them over. */
#ifndef TESTS_SUPPORT_LACKING_H
#define TESTS_SUPPORT_LACKING_H
#include "stage.h"

typedef enum stage_lack {
    STAGE_CUT_AT_BOTH_ENDS, /* a fifth of the pairs is missing */
    STAGE_HALF,             /* each pair stands at its lower end alone */
    STAGE_CUT,              /* of each list the first pairs are left */
    STAGE_LACKS
} stage_lack;

/* The same particles; the oracle goes on believing in all pairs. */
stage stage_lacking(const stage *made, stage_lack lack);

#endif
