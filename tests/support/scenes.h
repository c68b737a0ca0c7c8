/* SPDX-License-Identifier: MIT */
/* The scenes that accuracy tests run through, from easy to hard. */
#ifndef TESTS_SUPPORT_SCENES_H
#define TESTS_SUPPORT_SCENES_H
#include "comparison.h"

typedef struct scene_entry {
    const char *name;
    cloud (*make)(int dimension, random_state *random);
    double support; /* in spacings of the cloud */
} scene_entry;

extern const scene_entry scenes_hard[];
extern const int scenes_hard_count;

comparison comparison_of_scene(const test_case *test, const scene_entry *entry);

#endif
