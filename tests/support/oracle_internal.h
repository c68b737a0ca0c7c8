/* SPDX-License-Identifier: MIT */
/* What the parts of the oracle share. */
#ifndef TESTS_SUPPORT_ORACLE_INTERNAL_H
#define TESTS_SUPPORT_ORACLE_INTERNAL_H
#include "oracle.h"

static inline int oracle_is_classic(sphg_method method)
{
    return method == SPHG_CMLS || method == SPHG_CRKPM;
}

static inline const double *oracle_target(const oracle_scene *scene, int i)
{
    const double *x = scene->targets ? scene->targets : scene->sources;
    return x + i * scene->scheme.dimension;
}

const oracle_scene *oracle_scene_of(const oracle *reference);
void oracle_solve(const oracle_scene *scene, int i, oracle_point *point);
void oracle_weigh(const oracle_scene *scene, double support, quad volume, oracle_pair *pair);
rough oracle_filter_error(const oracle_point *point, int width, const rough *b);

#endif
