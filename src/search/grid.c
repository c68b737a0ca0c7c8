#include "grid.h"

/* ---- Keys ----------------------------------------------------------------------------------- */

enum { KEY_BITS = 42, LOW_BITS = 64 - KEY_BITS };

struct sphgi_key sphgi_key_of(const int64_t *at)
{
    const uint64_t mask = ((uint64_t)1 << KEY_BITS) - 1;
    const uint64_t x = (uint64_t)at[0] & mask, y = (uint64_t)at[1] & mask;
    return (struct sphgi_key){x | y << KEY_BITS, y >> LOW_BITS | (uint64_t)at[2] << LOW_BITS};
}

static int64_t sign_extended(uint64_t bits)
{
    const uint64_t sign = (uint64_t)1 << (KEY_BITS - 1), mask = 2 * sign - 1;
    return (int64_t)((bits & mask) ^ sign) - (int64_t)sign;
}

void sphgi_key_open(struct sphgi_key key, int64_t *at)
{
    at[0] = sign_extended(key.low);
    at[1] = sign_extended(key.low >> KEY_BITS | key.high << LOW_BITS);
    at[2] = sign_extended(key.high >> LOW_BITS);
}

/* ---- Tables --------------------------------------------------------------------------------- */

size_t sphgi_grid_tables(int32_t blocks)
{
    const size_t count = (size_t)blocks;
    return (count + 1) * sizeof(struct sphgi_block) +
           sphgi_round_up(sphgi_slots_for(count) * sizeof(int32_t), SPHGI_ALIGNMENT);
}

void sphgi_grid_use_tables(struct sphgi_grid *grid, void *tables)
{
    grid->blocks = tables;
    grid->hash = (int32_t *)(void *)(grid->blocks + grid->block_count + 1);
}

int32_t sphgi_find_block(const struct sphgi_grid *grid, const int64_t *at)
{
    const struct sphgi_key key = sphgi_key_of(at);
    uint32_t slot = sphgi_slot_of(key, grid->slots);
    while (grid->hash[slot] && !sphgi_same_key(grid->blocks[grid->hash[slot] - 1].key, key))
        slot = slot + 1 < grid->slots ? slot + 1 : 0;
    return grid->hash[slot] - 1;
}

void sphgi_cell_starts(const struct sphgi_grid *grid, int32_t block, int32_t *start)
{
    const struct sphgi_block *own = &grid->blocks[block];
    const int32_t *next = (const int32_t *)grid->cell_start.data + own->first;
    for (int32_t c = 0; c < grid->cells; ++c) {
        start[c] = *next;
        next += own->occupied >> c & 1;
    }
    start[grid->cells] = *next;
}

void sphgi_grid_free(struct sphgi_grid *grid, const struct sphgi_allocator *allocator)
{
    struct sphgi_buffer *buffers[] = {&grid->cell_start, &grid->rows, &grid->order};
    for (size_t k = 0; k < sizeof buffers / sizeof *buffers; ++k)
        sphgi_free(allocator, buffers[k]);
}
