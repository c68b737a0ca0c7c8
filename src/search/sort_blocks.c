/* SPDX-License-Identifier: MIT */
/* The blocks that chunks have met become those of the grid, in the order of their keys. */
#include "sorting.h"
#include <string.h>

/* Two runs in order become one. */
static void merge_runs(const struct sphgi_key *keys, const int32_t *from, int32_t *to,
                       int32_t begin, int32_t middle, int32_t end)
{
    int32_t a = begin, b = middle;
    for (int32_t k = begin; k < end; ++k) {
        const bool take_b =
            a >= middle || (b < end && sphgi_is_before(keys[from[b]], keys[from[a]]));
        to[k] = take_b ? from[b++] : from[a++];
    }
}

static bool are_in_order(const struct sphgi_key *keys, int32_t count)
{
    for (int32_t k = 1; k < count; ++k)
        if (sphgi_is_before(keys[k], keys[k - 1]))
            return false;
    return true;
}

/* Numbers of the blocks in the order of their keys, by merging; scratch holds as many. */
static int32_t *sort_blocks(const struct sphgi_key *keys, int32_t count, int32_t *numbers,
                            int32_t *scratch)
{
    for (int32_t b = 0; b < count; ++b)
        numbers[b] = b;
    if (are_in_order(keys, count))
        return numbers;
    for (int64_t width = 1; width < count; width *= 2) {
        for (int64_t begin = 0; begin < count; begin += 2 * width) {
            const int64_t middle = begin + width < count ? begin + width : count;
            const int64_t end = middle + width < count ? middle + width : count;
            merge_runs(keys, numbers, scratch, (int32_t)begin, (int32_t)middle, (int32_t)end);
        }
        int32_t *swap = numbers;
        numbers = scratch;
        scratch = swap;
    }
    return numbers;
}

int32_t sphgi_merge_keys(struct sphgi_sort *sort, int32_t *hash)
{
    int32_t count = 0;
    size_t total = 0;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        total += (size_t)sort->chunks[c].block_count;
    const uint32_t slots = (uint32_t)sphgi_slots_for(total);
    memset(hash, 0, slots * sizeof *hash);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            const struct sphgi_key key = sort->chunks[c].keys[b];
            const uint32_t slot = sphgi_find_slot(hash, slots, sort->keys, key);
            if (!hash[slot]) {
                sort->keys[count++] = key;
                hash[slot] = count;
            }
            sort->chunks[c].global[b] = hash[slot] - 1;
        }
    return count;
}

void sphgi_number_blocks(struct sphgi_sort *sort, int32_t count, void *tables)
{
    struct sphgi_grid *grid = sort->grid;
    grid->block_count = count;
    grid->slots = (uint32_t)sphgi_slots_for((size_t)count);
    sphgi_grid_use_tables(grid, tables);
    const int32_t *sorted = sort_blocks(sort->keys, count, sort->numbers, sort->scratch);
    int32_t *rank = sorted == sort->numbers ? sort->scratch : sort->numbers;
    memset(grid->hash, 0, grid->slots * sizeof *grid->hash);
    for (int32_t k = 0; k < count; ++k) {
        const struct sphgi_key key = sort->keys[sorted[k]];
        grid->blocks[k] = (struct sphgi_block){.key = key};
        rank[sorted[k]] = k;
        uint32_t slot = sphgi_slot_of(key, grid->slots);
        while (grid->hash[slot])
            slot = slot + 1 < grid->slots ? slot + 1 : 0;
        grid->hash[slot] = k + 1;
    }
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            sort->chunks[c].global[b] = rank[sort->chunks[c].global[b]];
}

void sphgi_place_blocks(struct sphgi_sort *sort)
{
    struct sphgi_block *blocks = sort->grid->blocks;
    int32_t *cursor = sort->scratch, next = 0;
    memset(cursor, 0, (size_t)sort->grid->block_count * sizeof *cursor);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            cursor[sort->chunks[c].global[b]] += sort->chunks[c].counts[b];
    for (int32_t b = 0; b < sort->grid->block_count; ++b) {
        blocks[b].first = next;
        next += cursor[b];
        cursor[b] = blocks[b].first;
    }
    blocks[sort->grid->block_count].first = next;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            int32_t *place = &cursor[sort->chunks[c].global[b]];
            const int32_t size = sort->chunks[c].counts[b];
            sort->chunks[c].counts[b] = *place;
            *place += size;
        }
}
