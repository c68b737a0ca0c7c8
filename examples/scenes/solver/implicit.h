/* SPDX-License-Identifier: MIT */
/* Steps of v that are implicit in a force linear in v: (mass - scale K) v = momentum, solved by
 * conjugate gradients. */
#ifndef SOLVER_IMPLICIT_H
#define SOLVER_IMPLICIT_H
#include "particles.h"

struct implicit {
    double tolerance;   /* |momentum - (mass - scale K) v| <= tolerance |momentum| */
    int64_t iterations; /* in all steps */
    vector *momentum;   /* of implicit_begin; the caller may add to it */
    vector *force;      /* room for the caller between solves */

    /* Private */
    void (*find_force)(void *data, vector *v, vector *force); /* force = K v */
    void *data;
    const double *mass;
    double scale;
    int32_t count;
    double *work;
};

struct implicit implicit_new(double tolerance, int32_t capacity);
void implicit_free(struct implicit *implicit);

/* momentum = mass v */
void implicit_begin(struct implicit *implicit, const struct particles *particles);

/* Changes v; the solve starts with the v that it finds. */
void implicit_solve(struct implicit *implicit, struct particles *particles, double scale,
                    void (*find_force)(void *data, vector *v, vector *force), void *data);
#endif
