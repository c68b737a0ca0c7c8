/* SPDX-License-Identifier: MIT */
/* Walls of particles (Akinci et al. 2012, doi:10.1145/2185520.2185558), and what a fluid feels of
 * them through shape functions of the wall's particles alone. */
#ifndef SOLVER_WALL_H
#define SOLVER_WALL_H
#include "library.h"
#include "particles.h"

struct wall {
    int32_t count;
    vector *x, *v;  /* the scene moves them */
    double *volume; /* V_k = 1 / sum W, over the wall itself */
};

/* Takes over x. */
struct wall wall_new(const struct sph *sph, int32_t count, vector *x);
void wall_free(struct wall *wall);

enum {
    UPDATES_PER_WEIGHING = 8 /* in one of so many it is measured what the matrices cost */
};

/* Sums over the wall's particles k, one per fluid particle i. */
struct contact {
    const struct wall *wall;
    double
        skin; /* [L] pairs are looked for this much farther, so that not every step must: H / 4 */
    double threshold;  /* of the matrices: 1e-9. Below it a particle is not corrected at all */
    double *filling;   /* sum V_k W_ik: how much of the surroundings the wall fills */
    vector *slope;     /* sum G_ik. Its negative points away from the wall; on a plane, with a
                          corrected method, exactly so (but for particles at the rim of H) */
    double *approach;  /* sum v_k . G_ik */
    vector *drag;      /* sum V_k v_k W_ik */
    int32_t *touching; /* number of k; where there are none, all of the above is zero */
    sphg_neighbors *neighbors;
    double *correction;
    double *target_volume; /* one number, stands for all */
    int64_t updates;
    int64_t *offsets;
    int32_t *near; /* particles that touch the wall: mostly few of many */
    int32_t near_count;
};

struct contact contact_new(const struct sph *sph, const struct wall *wall, int32_t capacity);
void contact_free(struct contact *contact);
void contact_update(const struct sph *sph, struct contact *contact, const struct particles *fluid);

/* Friction with the wall: v is drawn to the wall's by a share `strength` of what XSPH would do. */
void contact_friction(const struct contact *contact, double strength, struct particles *fluid);
#endif
