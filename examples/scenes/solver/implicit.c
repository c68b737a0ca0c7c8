/* SPDX-License-Identifier: MIT */
#include "implicit.h"
#include "conjugate_gradient.h"
#include <stdlib.h>

enum { MOST_ITERATIONS = 500 };

struct implicit implicit_new(double tolerance, int32_t capacity)
{
    struct implicit made = {.tolerance = tolerance};
    made.momentum = array_new(capacity, sizeof *made.momentum);
    made.force = array_new(capacity, sizeof *made.force);
    made.work = array_new(capacity, 9 * sizeof *made.work);
    return made;
}

void implicit_free(struct implicit *implicit)
{
    free(implicit->momentum);
    free(implicit->force);
    free(implicit->work);
}

void implicit_begin(struct implicit *implicit, const struct particles *particles)
{
    for (int32_t i = 0; i < particles->count; ++i)
        for (int k = 0; k < 3; ++k)
            implicit->momentum[i][k] = particles->mass[i] * particles->v[i][k];
}

/* (mass - scale K) v */
static void apply(void *data, double *v, double *result)
{
    struct implicit *implicit = data;
    implicit->find_force(implicit->data, (vector *)v, implicit->force);
    for (int32_t i = 0; i < implicit->count; ++i)
        for (int k = 0; k < 3; ++k)
            result[3 * i + k] =
                implicit->mass[i] * v[3 * i + k] - implicit->scale * implicit->force[i][k];
}

void implicit_solve(struct implicit *implicit, struct particles *particles, double scale,
                    void (*find_force)(void *data, vector *v, vector *force), void *data)
{
    const struct conjugate_gradient system = {.apply = apply,
                                              .data = implicit,
                                              .count = 3 * particles->count,
                                              .tolerance = implicit->tolerance,
                                              .most_iterations = MOST_ITERATIONS,
                                              .work = implicit->work};
    implicit->find_force = find_force;
    implicit->data = data;
    implicit->mass = particles->mass;
    implicit->scale = scale;
    implicit->count = particles->count;
    implicit->iterations += conjugate_gradient(&system, implicit->momentum[0], particles->v[0]);
}
