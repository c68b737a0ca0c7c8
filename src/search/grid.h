/* SPDX-License-Identifier: MIT */
/* The uniform grid: cells gathered in blocks. Only blocks that hold a particle exist, so that
 * memory depends on the number of particles alone. Particles are sorted by z, y and x of their
 * cells, inside a cell by number: whatever lies in neighbouring cells along x follows one another.
 */
#ifndef SPHGI_GRID_H
#define SPHGI_GRID_H
#include "core/context.h"
#include "block.h"
#include "raster.h"
#include "tree.h"

/* Blocks may be as many as particles: what there is per block must be small. The starts of a
 * block's occupied cells, and the end of the last one, stand in cell_start from the number of its
 * first particle on. */
struct sphgi_grid {
    struct sphgi_raster raster;
    sphg_type type; /* of the rows */
    bool sorted;    /* rows stand in the cells in which they were sorted */
    int32_t count;  /* particles */
    int32_t block_count;
    int32_t fullest; /* particles in the fullest cell */
    uint32_t slots;
    struct sphgi_block *blocks;     /* and one behind the last, with `first` only */
    int32_t *hash;                  /* slots: block + 1, 0: empty */
    struct sphgi_buffer cell_start; /* int32_t, count + 1 */
    struct sphgi_buffer rows;       /* positions in grid order, and SPHGI_LANES_MOST more: the dummy
                                       of dummy.h, then 0 */
    struct sphgi_buffer order;      /* int32_t: the particle behind each row */
    struct sphgi_tree tree;         /* over the blocks, if there are octaves */
};

/* Of the hash: two thirds are taken. */
static inline size_t sphgi_slots_for(size_t blocks)
{
    return blocks + blocks / 2 + 2;
}

/* Bytes of `blocks`, `hash` and, with octaves, `tree` of that many blocks; a grid has at most as
 * many as particles. */
size_t sphgi_grid_tables(int32_t blocks, bool octaves);

/* Of a grid that was built, rounded up. */
static inline size_t sphgi_tables_of(const struct sphgi_grid *grid)
{
    return sphgi_round_up(sphgi_grid_tables(grid->block_count, grid->raster.octaves > 0),
                          SPHGI_ALIGNMENT);
}

/* The tables stand there. */
void sphgi_grid_use_tables(struct sphgi_grid *grid, void *tables);

/* Sorts the rows (x y z 0, finite; SPHGI_LANES_MOST - 1 more are read) of count particles; type is
 * that of the positions. tables: memory for the tables of as many blocks as particles, which is
 * used from its beginning on. place: becomes the number of each particle's row; or NULL. Gives OK
 * or MEMORY. Cost: O(count), and O(blocks log blocks) where
 * the host's order is another one. */
sphg_result sphgi_grid_build(sphg_context *context, struct sphgi_grid *grid,
                             const struct sphgi_allocator *allocator,
                             const struct sphgi_raster *raster, sphg_type type, const void *rows,
                             int32_t count, void *tables, struct sphgi_buffer *place);
/* The number of each particle's row, of a grid that stands. */
bool sphgi_grid_places(sphg_context *context, const struct sphgi_grid *grid,
                       const struct sphgi_allocator *allocator, struct sphgi_buffer *place);
void sphgi_grid_free(struct sphgi_grid *grid, const struct sphgi_allocator *allocator);

/* A number in [0, slots). */
static inline uint32_t sphgi_slot_of(struct sphgi_key key, uint32_t slots)
{
    uint64_t h = (key.low ^ key.high << 29 ^ key.high >> 35) * 0x9E3779B97F4A7C15u;
    h = (h ^ h >> 32) * 0xD6E8FEB86659FD93u;
    return (uint32_t)((h >> 32) * slots >> 32);
}

/* The block's number, -1: no particle is there. */
int32_t sphgi_find_block(const struct sphgi_grid *grid, const int64_t *at);

/* The block of the particle that has this place in storage. */
int32_t sphgi_block_of_place(const struct sphgi_grid *grid, int32_t place);

static inline int32_t sphgi_bits_in(uint32_t bits)
{
    bits -= bits >> 1 & 0x55555555u;
    bits = (bits & 0x33333333u) + (bits >> 2 & 0x33333333u);
    return (int32_t)(((bits + (bits >> 4)) & 0x0F0F0F0Fu) * 0x01010101u >> 24);
}

/* The first particle of a block in that cell or one behind it; else the one behind the block. */
static inline int32_t sphgi_first_of_cell(const struct sphgi_grid *grid, int32_t block,
                                          int32_t cell)
{
    const struct sphgi_block *own = &grid->blocks[block];
    const uint32_t before = (uint32_t)(((uint64_t)1 << cell) - 1);
    return (
        (const int32_t *)grid->cell_start.data)[own->first + sphgi_bits_in(own->occupied & before)];
}

/* Numbers of the first particles of all cells of a block, and the number behind the last. */
void sphgi_cell_starts(const struct sphgi_grid *grid, int32_t block, int32_t *start);

#endif
