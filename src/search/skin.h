/* Pairs found up to H + skin serve until a particle has moved skin / 2. */
#ifndef SPHGI_SKIN_H
#define SPHGI_SKIN_H
#include "neighbors.h"

/* What a build is about; becomes the object's only when it succeeds. */
struct sphgi_geometry {
    int32_t source_count, target_count, dimension;
    sphg_type position_type, type;
    bool part_of, periodic;
    struct sphgi_periods periods;
    double largest[3]; /* |coordinate|, of a periodic geometry */
    size_t row_size;
    char *source_rows, *target_rows; /* in the order of the host, in context->input */
};

/* The object holds pairs with a skin, found for the same question. */
bool sphgi_skin_asks_the_same(const sphg_neighbors *neighbors,
                              const struct sphgi_geometry *geometry, const sphg_geometry *given,
                              double radius);

/* True: the pairs still cover everything, and the rows hold the new positions. */
bool sphgi_skin_holds(sphg_context *context, sphg_neighbors *neighbors,
                      const struct sphgi_geometry *geometry);

/* Keeps the positions that the pairs were found at, and says how far particles may move. False: out
 * of memory. */
bool sphgi_skin_remember(sphg_neighbors *neighbors, const struct sphgi_geometry *geometry);

#endif
