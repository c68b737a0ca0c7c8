/* SPDX-License-Identifier: MIT */
/* Particles whose forces can be judged without a second run: a cube of unlike ones. */
#ifndef DISTRIBUTED_CLOUD_H
#define DISTRIBUTED_CLOUD_H
#include "domain.h"

struct cloud_particle {
    double x[3], volume, density, pressure, stress[6];
    int32_t name;
};

enum cloud_form { CLOUD_ADJOINT, CLOUD_SYMMETRIC, CLOUD_FORMS };

/* What came of a particle, in each form. */
struct cloud_forces {
    int32_t name;
    double of[CLOUD_FORMS][3];
};

/* A share of side^3 particles for each rank, wherever they are. */
void cloud_make(struct domain *domain, MPI_Comm ranks, int side);

/* What all forces, ordered by name, lack of what they must add up to; in units of what is added. */
struct cloud_errors {
    double momentum; /* sum f_i (adjoint), sum V_i f_i (symmetric): 0 */
    double work;     /* on a flow whose gradient is known: see cloud.c */
};
struct cloud_errors cloud_judge(const struct cloud_forces *forces, int side, enum cloud_form form);

/* The largest difference of a force from that of another run, in units of the largest force. */
double cloud_difference(const struct cloud_forces *a, const struct cloud_forces *b, int side,
                        enum cloud_form form);

#endif
