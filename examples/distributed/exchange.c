/* SPDX-License-Identifier: MIT */
#include "exchange.h"
#include "stop.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- Plans ----------------------------------------------------------------------------------- */

/* Sorts the items by rank; those of one rank keep their order. */
static void sort_parcels(struct plan *plan, const struct parcel *parcels, int count)
{
    int *next = resized(NULL, (size_t)plan->rank_count, sizeof *next);
    for (int rank = 0, first = 0; rank < plan->rank_count; first += plan->sent_to[rank], ++rank)
        next[rank] = first;
    for (int k = 0; k < count; ++k)
        plan->items[next[parcels[k].rank]++] = parcels[k].item;
    free(next);
}

void plan_make(struct plan *plan, MPI_Comm ranks, const struct parcel *parcels, int count)
{
    plan->ranks = ranks;
    MPI_Comm_size(ranks, &plan->rank_count);
    const size_t rank_count = (size_t)plan->rank_count;
    plan->sent_to = resized(plan->sent_to, rank_count, sizeof(int));
    plan->received_from = resized(plan->received_from, rank_count, sizeof(int));
    plan->items = resized(plan->items, (size_t)count, sizeof(int32_t));
    memset(plan->sent_to, 0, rank_count * sizeof(int));
    for (int k = 0; k < count; ++k)
        ++plan->sent_to[parcels[k].rank];
    sort_parcels(plan, parcels, count);
    MPI_Alltoall(plan->sent_to, 1, MPI_INT, plan->received_from, 1, MPI_INT, ranks);
    int64_t received = 0;
    for (int rank = 0; rank < plan->rank_count; ++rank)
        received += plan->received_from[rank];
    if (received > INT_MAX)
        stop("a rank would receive more items than it can count");
    plan->sent = count;
    plan->received = (int)received;
}

void plan_free(struct plan *plan)
{
    free(plan->sent_to);
    free(plan->received_from);
    free(plan->items);
    *plan = (struct plan){0};
}

/* ---- Transfers ------------------------------------------------------------------------------- */

static int bytes_of(int items, size_t size)
{
    if (size && (size_t)items > INT_MAX / size)
        stop("a message would be longer than MPI can count");
    return (int)((size_t)items * size);
}

static void pack(struct transfer *transfer, const char *from)
{
    const struct plan *plan = transfer->plan;
    for (int k = 0; k < plan->sent; ++k)
        memcpy(transfer->outgoing + (size_t)k * transfer->size,
               from + (size_t)plan->items[k] * transfer->stride, transfer->size);
}

static void post_receives(struct transfer *transfer)
{
    const struct plan *plan = transfer->plan;
    char *place = transfer->incoming;
    for (int rank = 0; rank < plan->rank_count; ++rank) {
        const int bytes = bytes_of(plan->received_from[rank], transfer->size);
        if (bytes)
            MPI_Irecv(place, bytes, MPI_BYTE, rank, 0, plan->ranks,
                      &transfer->requests[transfer->request_count++]);
        place += bytes;
    }
}

static void post_sends(struct transfer *transfer)
{
    const struct plan *plan = transfer->plan;
    const char *place = transfer->outgoing;
    for (int rank = 0; rank < plan->rank_count; ++rank) {
        const int bytes = bytes_of(plan->sent_to[rank], transfer->size);
        if (bytes) {
            MPI_Isend(place, bytes, MPI_BYTE, rank, 0, plan->ranks,
                      &transfer->requests[transfer->request_count++]);
            transfer->bytes += bytes;
            ++transfer->messages;
        }
        place += bytes;
    }
}

void transfer_start(struct transfer *transfer, const struct plan *plan, const void *from, void *to,
                    size_t size, size_t stride)
{
    transfer->plan = plan;
    transfer->to = to;
    transfer->size = size;
    transfer->stride = stride;
    transfer->outgoing = resized(transfer->outgoing, (size_t)plan->sent, size);
    transfer->incoming = resized(transfer->incoming, (size_t)plan->received, size);
    transfer->requests =
        resized(transfer->requests, 2 * (size_t)plan->rank_count, sizeof(MPI_Request));
    transfer->request_count = 0;
    post_receives(transfer);
    pack(transfer, from);
    post_sends(transfer);
}

void transfer_finish(struct transfer *transfer)
{
    MPI_Waitall(transfer->request_count, transfer->requests, MPI_STATUSES_IGNORE);
    for (int k = 0; k < transfer->plan->received; ++k)
        memcpy(transfer->to + (size_t)k * transfer->stride,
               transfer->incoming + (size_t)k * transfer->size, transfer->size);
}

void transfer_free(struct transfer *transfer)
{
    free(transfer->outgoing);
    free(transfer->incoming);
    free(transfer->requests);
    *transfer = (struct transfer){0};
}
