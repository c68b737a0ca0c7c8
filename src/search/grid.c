/* SPDX-License-Identifier: MIT */
#include "grid.h"
#include <string.h>

static size_t hash_bytes(size_t blocks)
{
    return sphgi_round_up(sphgi_slots_for(blocks) * sizeof(int32_t), SPHGI_ALIGNMENT);
}

size_t sphgi_grid_tables(int32_t blocks, bool octaves)
{
    const size_t count = (size_t)blocks;
    return (count + 1) * sizeof(struct sphgi_block) + hash_bytes(count) +
           (octaves ? sphgi_tree_size(blocks) : 0);
}

void sphgi_grid_use_tables(struct sphgi_grid *grid, void *tables)
{
    grid->blocks = tables;
    grid->hash = (int32_t *)(void *)(grid->blocks + grid->block_count + 1);
    if (grid->raster.octaves)
        sphgi_tree_use(&grid->tree, grid->block_count,
                       (char *)grid->hash + hash_bytes((size_t)grid->block_count));
}

int32_t sphgi_find_block(const struct sphgi_grid *grid, const int64_t *at)
{
    const struct sphgi_key key = sphgi_key_of(at);
    uint32_t slot = sphgi_slot_of(key, grid->slots);
    while (grid->hash[slot] && !sphgi_same_key(grid->blocks[grid->hash[slot] - 1].key, key))
        slot = slot + 1 < grid->slots ? slot + 1 : 0;
    return grid->hash[slot] - 1;
}

int32_t sphgi_block_of_place(const struct sphgi_grid *grid, int32_t place)
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

void sphgi_cell_starts(const struct sphgi_grid *grid, int32_t block, int32_t *start)
{
    const struct sphgi_block *own = &grid->blocks[block];
    const int32_t *next = (const int32_t *)grid->cell_start.data + own->first;
    const uint32_t gaps = ~own->occupied;
    int32_t c = gaps ? __builtin_ctz(gaps) : SPHGI_BLOCK_CELLS; /* most have none before the last */
    memcpy(start, next, (size_t)c * sizeof *start);
    next += c;
    if (c < SPHGI_BLOCK_CELLS && !(own->occupied >> c)) {
        for (; c < SPHGI_BLOCK_CELLS; ++c)
            start[c] = *next;
    }
    for (; c < SPHGI_BLOCK_CELLS; ++c) {
        start[c] = *next;
        next += own->occupied >> c & 1;
    }
    start[SPHGI_BLOCK_CELLS] = *next;
}

void sphgi_grid_free(struct sphgi_grid *grid, const struct sphgi_allocator *allocator)
{
    struct sphgi_buffer *buffers[] = {&grid->cell_start, &grid->rows, &grid->order};
    for (size_t k = 0; k < sizeof buffers / sizeof *buffers; ++k)
        sphgi_free(allocator, buffers[k]);
}
