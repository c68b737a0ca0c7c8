/* Particles whose forces can be judged without a second run: a cube of unlike ones. */
#ifndef DISTRIBUTED_CLOUD_H
#define DISTRIBUTED_CLOUD_H
#include "domain.h"

struct cloud_particle {
    double x[3], volume, density, pressure, stress[6];
    int32_t name;
};

/* What came of a particle. */
struct cloud_forces {
    int32_t name;
    double adjoint[3], symmetric[3];
};

/* A share of side^3 particles for each rank, wherever they are. */
void cloud_make(struct domain *domain, MPI_Comm ranks, int side);

/* What all forces, ordered by name, lack of what they must add up to; in units of what is added. */
struct cloud_errors {
    double momentum; /* sum f_i (adjoint), sum V_i f_i (symmetric): 0 */
    double work;     /* on a flow whose gradient is known: see cloud.c */
};
struct cloud_errors cloud_judge_adjoint(const struct cloud_forces *forces, int side);
struct cloud_errors cloud_judge_symmetric(const struct cloud_forces *forces, int side);

/* The largest difference of one of the forces from that of another run, in units of the largest. */
double cloud_difference_of_adjoint(const struct cloud_forces *a, const struct cloud_forces *b,
                                   int side);
double cloud_difference_of_symmetric(const struct cloud_forces *a, const struct cloud_forces *b,
                                     int side);

#endif
