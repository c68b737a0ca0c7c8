/* SPDX-License-Identifier: MIT */
#include "stop.h"
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

void stop(const char *why)
{
    fprintf(stderr, "distributed: %s\n", why);
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    exit(EXIT_FAILURE);
}

void *resized(void *memory, size_t count, size_t size)
{
    if (count > SIZE_MAX / 2 / size)
        stop("more items than memory can have");
    void *made = realloc(memory, count ? count * size : 1);
    if (!made)
        stop("out of memory");
    return made;
}
