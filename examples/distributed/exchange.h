/* SPDX-License-Identifier: MIT */
/* Items of an array on their way to other ranks. A plan says which items go to whom. It is made
 * once and serves every array whose items are numbered alike: positions, fields, corrections. */
#ifndef DISTRIBUTED_EXCHANGE_H
#define DISTRIBUTED_EXCHANGE_H
#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

struct parcel {
    int32_t item;
    int rank; /* it goes to */
};

struct plan {
    MPI_Comm ranks;
    int rank_count;
    int *sent_to, *received_from; /* items, for each rank */
    int32_t *items;               /* those that are sent, ordered by rank */
    int sent, received;           /* all items */
};

/* Collective: tells each rank how many items it will receive. A plan that is all zero may be made,
 * and one that was made may be made again. */
void plan_make(struct plan *plan, MPI_Comm ranks, const struct parcel *parcels, int count);
void plan_free(struct plan *plan);

/* An exchange under way. Its buffers are kept for the next one. */
struct transfer {
    const struct plan *plan;
    char *outgoing, *incoming, *to;
    size_t size, stride;
    MPI_Request *requests;
    int request_count;
    int64_t bytes, messages; /* that this rank has sent with it so far */
};

/* Sends `size` bytes of each planned item; items stand `stride` bytes apart in `from`. The k-th
 * received one, counted through the ranks in turn, goes to `to` + k stride. Every rank starts its
 * transfers in the same order. Until transfer_finish leave `to` alone, and the plan; `from` may
 * change. */
void transfer_start(struct transfer *transfer, const struct plan *plan, const void *from, void *to,
                    size_t size, size_t stride);
void transfer_finish(struct transfer *transfer);
void transfer_free(struct transfer *transfer);

#endif
