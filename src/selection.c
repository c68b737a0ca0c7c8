#include "selection.h"
#include <string.h>

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count)
{
    struct sphgi_selection selection = {.subset = subset, .target_count = target_count};
    selection.begin = subset ? subset->begin : 0;
    selection.end = subset ? subset->end : target_count;
    return selection;
}

static int32_t block_of_place(const struct sphgi_grid *grid, int32_t place)
{
    int32_t low = 0, high = grid->block_count;
    while (high - low > 1) {
        const int32_t middle = low + (high - low) / 2;
        if (grid->blocks[middle].first <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

bool sphgi_selection_mark(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *n)
{
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const size_t targets = sphgi_round_up((size_t)n->target_count + 1, SPHGI_ALIGNMENT);
    const size_t blocks = targets; /* at most as many */
    const size_t before = context->selection.size;
    if (!sphgi_reserve(&context->allocator, &context->selection,
                       targets + blocks * (1 + sizeof(int32_t)), 1))
        return false;
    if (context->selection.size != before) /* marks are all taken back between calls */
        memset(context->selection.data, 0, context->selection.size);
    /* Marks stand at fixed ends of the buffer, the list of blocks between them is scratch. */
    uint8_t *base = context->selection.data;
    uint8_t *marked = base + context->selection.size - blocks;
    selection->active = base;
    selection->blocks = (int32_t *)(void *)(base + targets);
    selection->block_count = 0;
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target < 0 || selection->active[place[target]])
            continue;
        selection->active[place[target]] = 1;
        const int32_t block = block_of_place(grid, place[target]);
        if (!marked[block]) {
            marked[block] = 1;
            selection->blocks[selection->block_count++] = block;
        }
    }
    for (int32_t k = 0; k < selection->block_count; ++k)
        marked[selection->blocks[k]] = 0;
    return true;
}

void sphgi_selection_unmark(struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target >= 0)
            selection->active[place[target]] = 0;
    }
    memset(selection->blocks, 0, (size_t)selection->block_count * sizeof *selection->blocks);
    selection->active = NULL;
    selection->blocks = NULL;
}
