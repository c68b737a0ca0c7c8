/* SPDX-License-Identifier: MIT */
/* The particles of one rank: its own, those in its box, and behind them ghosts, copies of others'
 * particles that its own may reach. */
#ifndef DISTRIBUTED_DOMAIN_H
#define DISTRIBUTED_DOMAIN_H
#include "boxes.h"
#include "exchange.h"

struct domain {
    MPI_Comm ranks;
    int rank, rank_count;
    struct box *boxes; /* of all ranks */
    char *items;       /* structs of `size` bytes that begin with the position, double x[3] */
    size_t size;
    int own, ghosts;
    struct plan plan; /* from the owners of particles to the ghosts */
    /* Own particles by whether they are sent to anybody. Who is not has no ghost among its
       neighbours: a ghost within reach of it would have brought it to the ghost's owner. */
    int32_t *inner, *outer;
    int inner_count, outer_count;
    int64_t moved; /* particles that this rank has sent to a new owner */
    /* Kept for the next time. */
    struct parcels {
        struct parcel *list;
        int count, room;
    } parcels;
    int *near; /* ranks whose boxes are within reach of this one's */
    int near_count;
    struct plan home;
    struct transfer moving;
    char *spare;
};

/* With `count` particles that stand anywhere: they find their owners when the domain is settled. */
void domain_make(struct domain *domain, MPI_Comm ranks, const void *items, size_t size, int count);
void domain_free(struct domain *domain);

/* Collective: cuts space anew, if it is told how, sends each particle to the rank whose box it is
 * in, and chooses and brings the ghosts: all particles within reach of a box. */
void domain_settle(struct domain *domain, double reach, cutter *cut);

/* Brings `size` bytes of each ghost, which begin at `from` in the first item of an array with such
 * items: own ones first and room for the ghosts behind them. */
void domain_start(const struct domain *domain, struct transfer *transfer, void *from, size_t size,
                  size_t stride);

#endif
