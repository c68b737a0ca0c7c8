/* SPDX-License-Identifier: MIT */
/* What all ranks know of their own particles, together on rank 0. */
#ifndef DISTRIBUTED_GATHER_H
#define DISTRIBUTED_GATHER_H
#include <mpi.h>
#include <stddef.h>

/* Collective. A row of `size` bytes for each own particle; each begins with the particle's name,
 * int32_t, from 0 to all - 1. Rank 0 has all of them, ordered by name; NULL elsewhere. A particle
 * that is missing or there twice stops the program. */
void *gather_by_name(MPI_Comm ranks, const void *rows, size_t size, int own, int all);

#endif
