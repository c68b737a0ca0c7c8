/* SPDX-License-Identifier: MIT */
/* Lists of the host, read group by group as a search would find them. */
#ifndef SPHGI_COPY_H
#define SPHGI_COPY_H
#include "find.h"

struct sphgi_copier {
    const sphg_neighbors *neighbors;
    const sphg_lists *lists;
    const struct sphgi_passes *passes; /* for the positions */
    struct sphgi_find find;
    struct sphgi_cleaning cleaning;
    int32_t worker;
    uint32_t *ids;
    int64_t listed;     /* by the host, for the group or target that was last asked for */
    int32_t bad_target; /* lowest one whose list is wrong, INT32_MAX: none */
};

size_t sphgi_copier_size(void);
void sphgi_copier_open(struct sphgi_copier *copier, const sphg_context *context,
                       const sphg_neighbors *neighbors, const sphg_lists *lists, int32_t worker,
                       void *memory);

/* As sphgi_find_group and sphgi_find_target. What is no source, the target itself and, in lists of
 * up to SPHGI_CHUNK numbers, what is farther than H is left out; in longer ones the dummy takes its
 * place, so that chunks hold the same pairs as in the lists of the host. */
bool sphgi_copy_group(struct sphgi_copier *copier, int32_t group, const uint32_t **lists,
                      int32_t *lengths);
void sphgi_copy_target(struct sphgi_copier *copier, int32_t target, sphgi_take *take, void *data);

/* What is wrong with a target's list: its first number that is no source, or SPHGI_BAD_LENGTH. */
int64_t sphgi_fault_of_list(const sphg_neighbors *neighbors, const sphg_lists *lists,
                            int32_t target);

#endif
