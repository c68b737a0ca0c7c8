/* SPDX-License-Identifier: MIT */
/* A block whose particles have radii of their own as targets, and halves of it as two source sets.
 */
#ifndef TESTS_SUPPORT_GRADED_HALVES_H
#define TESTS_SUPPORT_GRADED_HALVES_H
#include "graded.h"

enum { GRADED_SETS = 2 };

typedef struct graded_halves {
    sphg_sources sets[GRADED_SETS];
    sphg_view numbers[GRADED_SETS], at_targets;
    int first[GRADED_SETS];
} graded_halves;

/* on: as graded_stage_of() makes it of the same ratio, support and way. numbers: of the field. */
graded_halves graded_halves_of(const comparison *on, double ratio, double support, graded_way way,
                               const setup_array *table, const setup_array *numbers);
/* given: the targets have a table, too; else theirs comes in the same sweep. */
comparison_result graded_apply_to_halves(const comparison *on, const graded_halves *of,
                                         const comparison_field *field, const setup_array *table,
                                         int given);

#endif
