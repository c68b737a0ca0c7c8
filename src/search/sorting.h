/* SPDX-License-Identifier: MIT */
/* What the files share that sort particles into the blocks and cells of a grid. */
#ifndef SPHGI_SORTING_H
#define SPHGI_SORTING_H
#include "grid.h"

/* A block of a chunk, as the pass names it, and its number plus 1; 0: none. */
struct sphgi_seen {
    int32_t at[4], number;
};

/* Each chunk of particles collects the blocks it meets on its own; the results are merged in order,
 * so that nothing depends on the number of chunks. */
struct sphgi_chunk {
    int32_t begin, end;
    int32_t block_count;
    uint32_t slots;
    struct sphgi_key *keys;  /* of the blocks, in order of appearance */
    int32_t *hash;           /* block + 1; grows inside its share */
    int32_t *counts;         /* particles per block; later: where the next one goes */
    int32_t *cells;          /* the same per cell, as long as blocks hold enough on average */
    int32_t cells_most;      /* blocks that there is room for then; 0: none */
    int32_t *global;         /* number in the grid */
    struct sphgi_seen *seen; /* 2^seen_bits places for blocks that were met */
    int32_t seen_bits;
};

struct sphgi_sort {
    const struct sphgi_raster *raster;
    struct sphgi_cutting cutting;
    const struct sphgi_passes *passes;
    sphg_type type;
    const void *rows;
    struct sphgi_chunk *chunks;
    int32_t chunk_count;
    int32_t *block; /* per particle: block of its chunk */
    uint8_t *cell;  /* per particle */
    int32_t *order; /* particles by block, or the chunks' counts of cells */
    uint8_t *sorted_cell;
    struct sphgi_key *keys; /* of all blocks, in order of appearance */
    int32_t *numbers, *scratch;
    int32_t *place; /* of each particle in the grid, or NULL */
    struct sphgi_grid *grid;
    atomic_int_least32_t fullest;
};

/* The slot that holds the key, or the free one where it belongs. */
static inline uint32_t sphgi_find_slot(const int32_t *hash, uint32_t slots,
                                       const struct sphgi_key *keys, struct sphgi_key key)
{
    uint32_t slot = sphgi_slot_of(key, slots);
    while (hash[slot] && !sphgi_same_key(keys[hash[slot] - 1], key))
        slot = slot + 1 < slots ? slot + 1 : 0;
    return slot;
}

/* x, y, z or, where there are radii, the radius of a particle. */
static inline double sphgi_number_of_row(const struct sphgi_sort *sort, int32_t i, int32_t number)
{
    const size_t k = SPHGI_ROW * (size_t)i + (size_t)number;
    return sort->type == SPHG_F64 ? ((const double *)sort->rows)[k]
                                  : (double)((const float *)sort->rows)[k];
}

enum { SPHGI_SLOTS_LEAST = 1024 }; /* of a chunk's hash table */

/* A task over chunks: finds the block and the cell of each of their particles, and counts these. */
void sphgi_collect_chunks(void *sort, int32_t begin, int32_t end, int32_t worker);

/* From counts by cell to counts by block, of the first so many blocks. */
void sphgi_count_by_block(struct sphgi_chunk *chunk, int32_t blocks);

/* Keys of all chunks without repetitions, and their numbers in chunk->global. Returns how many. */
int32_t sphgi_merge_keys(struct sphgi_sort *sort, int32_t *hash);

/* Blocks in the order of their keys; chunk->global becomes their number there. */
void sphgi_number_blocks(struct sphgi_sort *sort, int32_t count, void *tables);

/* First particle of each block and, in chunk->counts, of each chunk's share of it. */
void sphgi_place_blocks(struct sphgi_sort *sort);

#endif
