/* Which targets of a subset, in the order in which a source set visits them. */
#ifndef SPHGI_SELECTION_H
#define SPHGI_SELECTION_H
#include "neighbors.h"

struct sphgi_selection {
    const sphg_subset *subset; /* NULL: all targets */
    int32_t target_count;
    int32_t begin, end; /* of the items to look at: targets, or entries of indices */
    uint8_t *active;    /* by place in grid order; NULL: all */
    int32_t *blocks;    /* with an active target; NULL: all */
    int32_t block_count;
};

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count);

/* The target that item k stands for, -1: masked out. */
static inline int32_t sphgi_selected(const struct sphgi_selection *selection, int32_t k)
{
    const sphg_subset *subset = selection->subset;
    const int32_t target = subset && subset->indices ? subset->indices[k] : k;
    return subset && subset->mask && !subset->mask[target] ? -1 : target;
}

/* Marks places and blocks of a searched object's grid; costs as much as is selected. False: out of
 * memory. Marks are taken back by sphgi_selection_unmark(). */
bool sphgi_selection_mark(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *neighbors);
void sphgi_selection_unmark(struct sphgi_selection *selection, const sphg_neighbors *neighbors);

#endif
