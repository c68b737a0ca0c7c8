/* SPDX-License-Identifier: MIT */
/* Comparisons on lists that lack pairs, as hosts may hand them over. */
#ifndef TESTS_SUPPORT_INCOMPLETE_LISTS_H
#define TESTS_SUPPORT_INCOMPLETE_LISTS_H
#include "comparison.h"

typedef enum comparison_lack {
    COMPARISON_CUT_AT_BOTH_ENDS, /* a fifth of the pairs is missing */
    COMPARISON_HALF,             /* each pair stands at its lower end alone */
    COMPARISON_CUT,              /* of each list the first pairs are left */
    COMPARISON_LACKS
} comparison_lack;

/* The same particles; the oracle goes on believing in all pairs. */
comparison comparison_lacking(const comparison *made, comparison_lack lack);

#endif
