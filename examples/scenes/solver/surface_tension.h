/* SPDX-License-Identifier: MIT */
/* Surface tension after He et al. 2014 (doi:10.1145/2682630), from the gradient of a colour field:
 * with plain SPH the paper's Eqs. (42) and (43), with a corrected method Eqs. (44) and (45). Both
 * live on the sum of the gradients G_ij, which vanishes inside and not at the surface: a heuristic,
 * not a consistent gradient. */
#ifndef SOLVER_SURFACE_TENSION_H
#define SOLVER_SURFACE_TENSION_H
#include "operators.h"

struct surface_tension {
    double strength;  /* kappa [N] */
    bool balanced;    /* takes away what Eq. (45) has and no free drop can have: a mean force, and a
                         torque, with which the drop would begin to spin */
    double net_share; /* of the last call: |sum force| / sum |force| */
    const struct operators *operators;
    double *colour, *squares; /* c_i, |grad c_i|^2 */
    vector *gradient, *surface, *force;
};

struct surface_tension surface_tension_new(const struct operators *operators, int32_t capacity);
void surface_tension_free(struct surface_tension *tension);
void surface_tension_add(struct surface_tension *tension, const struct particles *fluid,
                         vector *acceleration);
#endif
