/* SPDX-License-Identifier: MIT */
/* Batches of small matrices of the host: what is done with them goes from group to group of lanes.
 */
#ifndef SPHGI_MATRIX_BATCH_H
#define SPHGI_MATRIX_BATCH_H
#include "core/check.h"
#include "core/view.h"
#include "passes/passes.h"

enum { SPHGI_BATCH_GRAIN = 16 /* groups */ };

struct sphgi_matrix_batch {
    const struct sphgi_passes *passes;
    sphg_type type;
    int32_t count, dimension;
    struct sphgi_columns in, out[3];
};

/* Room for so many numbers of each lane of a group, of either type. */
#define SPHGI_LANES_BUFFER(name, numbers)                                                          \
    unsigned char name[(numbers)*SPHGI_WIDTH * sizeof(double)]                                     \
        __attribute__((aligned(SPHGI_ALIGNMENT)))

/* Their type is that of the batch. */
sphg_result sphgi_begin_batch(struct sphgi_checker checker, const sphg_view *matrices,
                              const char *name, int32_t count, struct sphgi_matrix_batch *batch);

int32_t sphgi_batch_groups(const struct sphgi_matrix_batch *batch);
/* Items of a group; returns how many. */
int32_t sphgi_batch_items(const struct sphgi_matrix_batch *batch, int32_t group, int32_t *items);

#endif
