/* Neighbours: a copy of the positions, and who sums over whom. */
#ifndef SPHGI_NEIGHBORS_H
#define SPHGI_NEIGHBORS_H
#include "grid.h"

/* Found pairs, target by target in grid order. A target's ids are padded to a multiple of SPHGI_PAD
 * with 0. Normally they are staged numbers (struct sphgi_surroundings) times SPHGI_ID_STEP in 16
 * bits; in a clump too dense for that ("wide" block) they are 32-bit numbers of rows, and behind
 * each target's length.
 */
struct sphgi_found {
    struct sphgi_buffer block_list;  /* int64_t per block of the targets: place in ids, in units */
    struct sphgi_buffer cell_offset; /* uint32_t per cell: from there on, in SPHGI_PAD units */
    struct sphgi_buffer lengths;     /* uint16_t per target; unused in wide blocks */
    struct sphgi_buffer wide;        /* uint8_t per block */
    struct sphgi_buffer ids;         /* uint16_t units */
    int64_t pairs, units;
};

enum sphgi_neighbors_kind { SPHGI_NEVER_BUILT, SPHGI_SEARCHED, SPHGI_HOST_LISTS };

struct sphg_neighbors {
    struct sphgi_allocator allocator;
    enum sphgi_neighbors_kind kind;
    int32_t dimension;
    sphg_type position_type, type; /* of positions; of fields and results */
    double radius;                 /* H that the pairs were found for */
    double skin;
    double period[3];
    bool periodic, list_free;
    bool part_of; /* targets are the first sources */
    bool same;    /* ... and all of them: one grid serves both */
    int32_t source_count, target_count;

    struct sphgi_grid sources, targets; /* targets: unused if same */
    struct sphgi_buffer target_place;   /* int32_t: place of each target in grid order */
    struct sphgi_buffer around;         /* int32_t, SPHGI_AROUND per block of the targets' grid */
    struct sphgi_found found;
    struct sphgi_buffer sources_then, targets_then; /* rows at the last search, with a skin */
    bool rebuilt;
    double skin_left;

    sphg_lists lists; /* the host's; rows of sources stand in its order in sources.rows */
};

/* Of the targets: the grid they are sorted in. */
static inline const struct sphgi_grid *sphgi_target_grid(const sphg_neighbors *neighbors)
{
    return neighbors->same ? &neighbors->sources : &neighbors->targets;
}

/* What is staged for one block of the targets. */
static inline void sphgi_block_surroundings(const sphg_neighbors *neighbors, int32_t block,
                                            struct sphgi_surroundings *around)
{
    const struct sphgi_grid *grid = sphgi_target_grid(neighbors);
    around->block = block;
    sphgi_surroundings_of(
        &neighbors->sources, ((const struct sphgi_block *)grid->blocks.data)[block].at,
        (const int32_t *)neighbors->around.data + (ptrdiff_t)block * SPHGI_AROUND, around);
}

/* Row (x y z .) of a target; place: in grid order, with the host's lists the target itself. */
static inline const char *sphgi_target_row(const sphg_neighbors *neighbors, int32_t place)
{
    const size_t size = SPHGI_ROW * sphgi_size_of_type(neighbors->position_type);
    return (const char *)sphgi_target_grid(neighbors)->rows.data + (size_t)place * size;
}

#endif
