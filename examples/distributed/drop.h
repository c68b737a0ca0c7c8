/* SPDX-License-Identifier: MIT */
/* A drop of a fluid that turns and travels. Any two of its particles attract each other in
 * proportion to their distance, which holds the drop together and keeps momentum and angular
 * momentum. Flattened as it is, it turns like a rigid body for ever. */
#ifndef DISTRIBUTED_DROP_H
#define DISTRIBUTED_DROP_H
#include "domain.h"
#include <sphgrad/sphgrad.h>

struct drop_case {
    int layers; /* particles along the radius, which is 1 */
    int steps;
    int cut_every; /* steps */
    cutter *cut;
};

/* What changes owners: a particle. */
struct particle {
    double x[3];
    float v[3], pressure;
    int32_t name;
};

/* What ghosts need before the forces, in one message. */
struct second_message {
    float correction[6], stress[6];
};

struct drop {
    struct drop_case given;
    struct domain domain;
    struct transfer transfer;
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    double spacing, skin, time, time_step;
    float volume, speed_of_sound, viscosity;
    struct second_message *second; /* own and ghosts */
    float (*jacobian)[3][3], (*force)[3];
    /* What it took. */
    double seconds, waiting, settling;
    int settled; /* so often were ghosts chosen */
};

extern const double drop_spin, drop_velocity[3]; /* [1/s] about z; [radii/s] */

/* Each particle has a name from 0 to drop_count - 1, the same for any number of ranks. */
int drop_count(int layers);

/* Each share-th of the particles, from name `first` on, as they are at the beginning. Returns how
 * many these are; room may be NULL. */
int drop_fill(int layers, int first, int share, struct particle *room);

/* Collective. */
void drop_make(struct drop *drop, MPI_Comm ranks, const struct drop_case *given);
void drop_run(struct drop *drop);
void drop_free(struct drop *drop);

/* Pairs of the own particles that were found when ghosts were last chosen, those within the skin
 * included. */
int64_t drop_pairs(const struct drop *drop);

/* Where its middle is by now, and the mass of a particle. */
void drop_middle(const struct drop *drop, double middle[3]);
double drop_mass(const struct drop *drop);

#endif
