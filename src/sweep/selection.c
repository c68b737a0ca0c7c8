#include "selection.h"
#include "core/parallel.h"
#include <string.h>

enum {
    FEW = 4,      /* items are few if there are so many times as many blocks */
    SPARSE = 16,  /* a block has few active targets if it has so many times as many */
    GRAIN = 4096, /* items of a task that marks */
    BLOCKS = 64   /* of a task that looks at places */
};

/* What is known of a block. */
enum { NONE_ACTIVE, FEW_ACTIVE, MANY_ACTIVE };

struct sphgi_selection sphgi_selection_of(const sphg_subset *subset, int32_t target_count)
{
    struct sphgi_selection selection = {.subset = subset, .target_count = target_count};
    selection.begin = subset ? subset->begin : 0;
    selection.end = subset ? subset->end : target_count;
    return selection;
}

static int32_t targets_of(const struct sphgi_grid *grid, int32_t block)
{
    return grid->blocks[block + 1].first - grid->blocks[block].first;
}

static void list_block(struct sphgi_selection *selection, int32_t block, bool few)
{
    selection->blocks[selection->block_count++] = few ? ~block : block;
    selection->full_blocks += !few;
}

/* ---- Few items: the block of each is looked up ---------------------------------------------- */

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

/* seen: a byte per block, 0, and 0 again afterwards. */
static void mark_few(struct sphgi_selection *selection, const sphg_neighbors *n, uint8_t *seen)
{
    const struct sphgi_grid *grid = sphgi_target_grid(n);
    const int32_t *place = n->target_place.data;
    for (int32_t k = selection->begin; k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target < 0 || selection->active[place[target]])
            continue;
        selection->active[place[target]] = 1;
        const int32_t block = block_of_place(grid, place[target]);
        if (!seen[block])
            selection->blocks[selection->block_count++] = block;
        seen[block] = (uint8_t)(seen[block] + (seen[block] < UINT8_MAX));
    }
    const int32_t listed = selection->block_count;
    selection->block_count = 0;
    for (int32_t k = 0; k < listed; ++k) {
        const int32_t block = selection->blocks[k];
        list_block(selection, block, seen[block] * SPARSE <= targets_of(grid, block));
        seen[block] = 0;
    }
}

/* ---- Many: all blocks are looked at --------------------------------------------------------- */

struct marking {
    const struct sphgi_selection *selection;
    const sphg_neighbors *neighbors;
    uint8_t *seen;
};

static void mark_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct marking *marking = data;
    const struct sphgi_selection *selection = marking->selection;
    const int32_t *place = marking->neighbors->target_place.data;
    (void)worker;
    for (int32_t k = selection->begin + begin; k < selection->begin + end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target >= 0)
            selection->active[place[target]] = 1;
    }
}

/* Stops when it is clear that many are active. */
static uint8_t look_at_block(const struct marking *marking, int32_t block)
{
    const struct sphgi_grid *grid = sphgi_target_grid(marking->neighbors);
    const int32_t *order = grid->order.data;
    const int32_t behind = grid->blocks[block + 1].first;
    const int32_t few = targets_of(grid, block) / SPARSE;
    int32_t active = 0;
    for (int32_t place = grid->blocks[block].first; place < behind && active <= few; ++place)
        active += sphgi_is_selected(marking->selection, place, order[place]);
    return active > few ? MANY_ACTIVE : active ? FEW_ACTIVE : NONE_ACTIVE;
}

static void look_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct marking *marking = data;
    (void)worker;
    for (int32_t b = begin; b < end; ++b)
        marking->seen[b] = look_at_block(marking, b);
}

static void look_at_blocks(sphg_context *context, struct sphgi_selection *selection,
                           const sphg_neighbors *n, uint8_t *seen)
{
    struct marking marking = {selection, n, seen};
    const int32_t items = selection->end - selection->begin;
    const int32_t count = sphgi_target_grid(n)->block_count;
    if (selection->active)
        sphgi_parallel_for(context, mark_task, &marking, items, GRAIN);
    sphgi_parallel_for(context, look_task, &marking, count, BLOCKS);
    for (int32_t b = 0; b < count; ++b)
        if (seen[b] != NONE_ACTIVE)
            list_block(selection, b, seen[b] == FEW_ACTIVE);
    memset(seen, 0, (size_t)count);
}

/* ---- Both ----------------------------------------------------------------------------------- */

static bool are_few(const struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int64_t items = selection->end - selection->begin;
    return items * FEW < sphgi_target_grid(n)->block_count;
}

bool sphgi_selection_open(sphg_context *context, struct sphgi_selection *selection,
                          const sphg_neighbors *n)
{
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
    uint8_t *seen = base + context->selection.size - blocks;
    const bool few = are_few(selection, n);
    selection->active = few || selection->subset->indices ? base : NULL;
    selection->blocks = (int32_t *)(void *)(base + targets);
    selection->block_count = selection->full_blocks = 0;
    if (few)
        mark_few(selection, n, seen);
    else
        look_at_blocks(context, selection, n, seen);
    return true;
}

void sphgi_selection_close(struct sphgi_selection *selection, const sphg_neighbors *n)
{
    const int32_t *place = n->target_place.data;
    const bool few = are_few(selection, n);
    for (int32_t k = selection->begin; few && k < selection->end; ++k) {
        const int32_t target = sphgi_selected(selection, k);
        if (target >= 0)
            selection->active[place[target]] = 0;
    }
    if (selection->active && !few)
        memset(selection->active, 0, (size_t)n->target_count);
    memset(selection->blocks, 0, (size_t)selection->block_count * sizeof *selection->blocks);
    selection->active = NULL;
    selection->blocks = NULL;
}
