/* SPDX-License-Identifier: MIT */
/* Which targets of a subset, in the order in which a source set visits them. */
#ifndef SPHGI_SELECTION_H
#define SPHGI_SELECTION_H
#include "search/neighbors.h"

struct sphgi_selection {
    const sphg_subset *subset; /* NULL: all targets */
    int32_t target_count;
    int32_t begin, end;  /* of the items to look at: targets, or entries of indices */
    uint16_t *active;    /* by group in grid order: a bit for each target of it that is selected */
    int32_t *groups;     /* that hold an active target; NULL: all */
    int32_t group_count; /* of the list */
    int32_t active_count;
};

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count);

/* The target that item k stands for, -1: masked out. */
static inline int32_t sphgi_selected(const struct sphgi_selection *selection, int32_t k)
{
    const sphg_subset *subset = selection->subset;
    const int32_t target = subset && subset->indices ? subset->indices[k] : k;
    return subset && subset->mask && !subset->mask[target] ? -1 : target;
}

/* Lists the groups of a searched object that hold a selected target. Costs as much as is selected
 * where that is little, else a look at each place. False: out of memory. */
bool sphgi_selection_open(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *neighbors);
void sphgi_selection_close(struct sphgi_selection *selection);

#endif
