/* SPDX-License-Identifier: MIT */
#include "gather.h"
#include "exchange.h"
#include "stop.h"
#include <stdlib.h>
#include <string.h>

static int32_t name_of(const char *row)
{
    int32_t name;
    memcpy(&name, row, sizeof name);
    return name;
}

static char *sorted(const char *rows, size_t size, int count)
{
    char *by_name = resized(NULL, (size_t)count, size);
    char *seen = resized(NULL, (size_t)count, 1);
    memset(seen, 0, (size_t)count);
    for (int k = 0; k < count; ++k) {
        const char *row = rows + (size_t)k * size;
        const int32_t name = name_of(row);
        if (name < 0 || name >= count || seen[name]++)
            stop("a particle is there twice, and another is missing");
        memcpy(by_name + (size_t)name * size, row, size);
    }
    free(seen);
    return by_name;
}

/* A plan by which everything goes to rank 0. */
void *gather_by_name(MPI_Comm ranks, const void *rows, size_t size, int own, int all)
{
    int rank;
    MPI_Comm_rank(ranks, &rank);
    struct parcel *parcels = resized(NULL, (size_t)own, sizeof *parcels);
    struct transfer transfer = {0};
    struct plan plan = {0};
    for (int k = 0; k < own; ++k)
        parcels[k] = (struct parcel){k, 0};
    plan_make(&plan, ranks, parcels, own);
    if (rank == 0 && plan.received != all)
        stop("particles are missing, or there twice");
    char *received = resized(NULL, (size_t)plan.received, size);
    transfer_start(&transfer, &plan, rows, received, size, size);
    transfer_finish(&transfer);
    char *by_name = rank == 0 ? sorted(received, size, all) : NULL;
    transfer_free(&transfer);
    plan_free(&plan);
    free(received);
    free(parcels);
    return by_name;
}
