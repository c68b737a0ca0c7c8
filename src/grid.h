/* The uniform grid: cells a little wider than the search radius, gathered in blocks. Only blocks
 * that hold a particle exist, so that memory depends on the number of particles alone. Particles
 * are sorted by block along a Morton curve, inside a block by cell, inside a cell by number. */
#ifndef SPHGI_GRID_H
#define SPHGI_GRID_H
#include "context.h"

enum {
    SPHGI_BLOCK_CELLS_MOST = 32,   /* 4 x 4 x 2 in 3D, 8 x 4 in 2D */
    SPHGI_STAGED_CELLS_MOST = 144, /* a block and the cells around it: 6 x 6 x 4, 10 x 6 */
    SPHGI_STAGED_ROWS_MOST = 24,
    SPHGI_STAGED_WIDTH_MOST = 10
};

struct sphgi_axis {
    double inverse;    /* open: 1 / cell width */
    double length;     /* of the period; 0: open */
    int64_t cells;     /* of the period */
    int32_t shift;     /* a block is 2^shift cells long */
    int32_t low, high; /* neighbouring cells that are cells of their own: -1 .. 1, fewer where the
                          period holds less than three */
};

/* How space is cut: shared by the grids of sources and targets. */
struct sphgi_lattice {
    struct sphgi_axis axis[3];
    int32_t dimension;
    double slack; /* rounding of differences between periodic images [L] */
};

struct sphgi_block {
    int64_t at[3];
};

struct sphgi_grid {
    struct sphgi_lattice lattice;
    int32_t count; /* particles */
    int32_t block_count;
    int32_t cells;   /* per block */
    int32_t fullest; /* particles in the fullest cell */
    uint32_t hash_mask;
    struct sphgi_buffer blocks;     /* struct sphgi_block */
    struct sphgi_buffer cell_start; /* int32_t, block_count * cells + 1 */
    struct sphgi_buffer hash;       /* int32_t, block + 1, 0: empty */
    struct sphgi_buffer rows;       /* positions in grid order, and SPHGI_LANES_MOST rows of 0 */
    struct sphgi_buffer order;      /* int32_t: the particle behind each row */
};

/* period[a] 0: open. largest[a]: the largest |coordinate| along a periodic axis. */
struct sphgi_lattice sphgi_lattice_of(int32_t dimension, double reach, const double *period,
                                      const double *largest, sphg_type type);

/* Sorts the rows (x y z 0, finite) of count particles; type is that of the positions. Gives OK or
 * MEMORY. Cost: O(count), and O(blocks log blocks) for the curve. */
sphg_result sphgi_grid_build(sphg_context *context, struct sphgi_grid *grid,
                             const struct sphgi_allocator *allocator,
                             const struct sphgi_lattice *lattice, sphg_type type, const void *rows,
                             int32_t count);
/* The block's number, -1: no particle is there. */
int32_t sphgi_find_block(const struct sphgi_grid *grid, const int64_t *at);
void sphgi_grid_free(struct sphgi_grid *grid, const struct sphgi_allocator *allocator);

/* The sources around one block, in the order in which they are staged: along x through rows of
 * cells. Number 0 is a dummy; offset[row][x] is the first number of a staged cell. */
struct sphgi_surroundings {
    int32_t block; /* of the targets */
    int32_t ranges;
    int32_t begin[SPHGI_STAGED_CELLS_MOST], count[SPHGI_STAGED_CELLS_MOST];
    int32_t staged; /* dummy included */
    int32_t offset[SPHGI_STAGED_ROWS_MOST][SPHGI_STAGED_WIDTH_MOST + 1];
};

/* The up to 3 x 3 x 3 blocks of sources that the staged cells of a block lie in, -1 where nobody
 * is: looked up once per search. */
enum { SPHGI_AROUND = 27 };
void sphgi_find_around(const struct sphgi_grid *sources, const int64_t *block, int32_t *blocks);

void sphgi_surroundings_of(const struct sphgi_grid *sources, const int64_t *block,
                           const int32_t *blocks, struct sphgi_surroundings *around);

/* Where the candidates of a cell are staged. */
struct sphgi_runs sphgi_candidate_runs(const struct sphgi_lattice *lattice,
                                       const struct sphgi_surroundings *around, int32_t cell);

#endif
