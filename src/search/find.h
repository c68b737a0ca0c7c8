/* Neighbours of the targets of one cell: staging their surroundings and running the search pass. */
#ifndef SPHGI_FIND_H
#define SPHGI_FIND_H
#include "neighbors.h"

enum {
    SPHGI_STAGED_MOST = 32000,  /* what 16-bit ids can tell apart; more take the wide way */
    SPHGI_UNITS_MOST = 1 << 19, /* ids of a block that are collected before they are stored */
    SPHGI_WOVEN_MOST = 1 << 15  /* ... and laid side by side in the cache */
};

/* Scratch of one worker. */
struct sphgi_finder {
    const struct sphgi_passes *passes; /* for the positions */
    struct sphgi_find find;
    void *x, *y, *z; /* staged coordinates */
    uint16_t *ids;   /* SPHGI_UNITS_MOST + room for one more batch */
    uint16_t *lengths;
    uint16_t *woven; /* SPHGI_WOVEN_MOST */
    int32_t room;    /* staged numbers that fit */
};

/* Bytes of scratch per worker, and its parts; room as sphgi_finder_room(). */
size_t sphgi_finder_size(const sphg_neighbors *neighbors, int32_t room);
struct sphgi_finder sphgi_finder_at(const sphg_context *context, const sphg_neighbors *neighbors,
                                    int32_t room, void *memory);
int32_t sphgi_finder_room(const sphg_neighbors *neighbors);

/* Asks for the rows that will be staged. */
void sphgi_prefetch_rows(const sphg_neighbors *neighbors, const struct sphgi_surroundings *around);

/* Coordinates of the surroundings into x, y, z. */
void sphgi_stage_coordinates(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                             const struct sphgi_surroundings *around);

/* Too many around the block for 16-bit ids? */
static inline bool sphgi_is_crowded(const struct sphgi_surroundings *around)
{
    return around->staged > SPHGI_STAGED_MOST;
}

/* Pairs of targets [begin, end) in grid order, all of cell `cell` of the staged block, at most
 * SPHGI_FIND_MOST. Returns the ids written, padding included. */
int64_t sphgi_find_targets(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                           const struct sphgi_surroundings *around, const struct sphgi_runs *runs,
                           int32_t cell, int32_t begin, int32_t end, uint16_t *ids,
                           uint16_t *lengths);

/* Wide: the same for one target, slice by slice of its surroundings. take() gets the rows of the
 * neighbours, 32-bit and not padded, at most SPHGI_STAGED_MOST at a time. */
typedef void sphgi_take(void *data, const uint32_t *rows, int32_t count);
void sphgi_find_wide(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                     const struct sphgi_surroundings *around, int32_t cell, int32_t target,
                     sphgi_take *take, void *data);

#endif
