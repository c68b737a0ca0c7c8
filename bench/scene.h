/* SPDX-License-Identifier: MIT */
/* What a command measures on: particles, their neighbours, a field, arrays for results; and the
 * works that most commands time. */
#ifndef SPHGRAD_BENCH_SCENE_H
#define SPHGRAD_BENCH_SCENE_H
#include "library.h"

enum work {
    WORK_SEARCH,
    WORK_MATRICES,
    WORK_GRADIENT, /* with these matrices */
    WORK_FUSED,    /* matrices and gradient in one call */
    WORKS
};

/* Copies share the arrays: with another method, other neighbours or positions a scene is a copy
 * whose members have changed. All of it is held (numbers.h). */
struct scene {
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    sphg_geometry geometry; /* of a search */
    struct numbers positions;
    struct numbers volumes; /* one for each, or one for all */
    struct numbers field, corrections, jacobians;
    int32_t count;
    bool same_volumes; /* as in the sweep before, so that weights that were kept hold */
};

/* Of particles: the field is linear (errors.h), and nothing is searched for yet. The scheme's
 * method is the one with the widest corrections that is to come. */
struct scene scene_open(sphg_context *context, const sphg_scheme *scheme, struct numbers positions,
                        struct numbers volumes);

/* The same with neighbours of its own. */
struct scene scene_beside(const struct scene *scene);
/* ... which are found, and keep the weights of pairs of the last scheme that swept them. */
struct scene scene_keeping_weights(const struct scene *scene);
bool keeps_weights(sphg_method method); /* or none are formed that could be kept */

/* What is read of the particles: neighbours and volumes. */
sphg_sources scene_sources(const struct scene *scene);
sphg_view scene_corrections(const struct scene *scene); /* those of the method */
double scene_pairs(const struct scene *scene);          /* a particle, once they are found */

void scene_run(const struct scene *scene, enum work work);
void scene_use_lists(const struct scene *scene, const sphg_lists *lists); /* in place of a search */
void scene_correct(const struct scene *scene, uint8_t *ranks); /* where they go, or NULL */
void scene_evaluate(const struct scene *scene, const sphg_request *request);

/* V_j = 1 / sum_k W_jk, j itself included: volumes from the positions alone. */
struct numbers scene_volumes(const struct scene *scene);
#endif
