/* SPDX-License-Identifier: MIT */
/* Factors s_ij that stay in memory beside the ids of their pairs: written after a sweep has formed
 * them, read by later ones, which need the offsets alone. */

SPHGI_TEMPLATE void offsets_of_pairs(const struct sphgi_gather *g, const real *kept,
                                     const int32_t *targets, struct sphgi_tile *tile, bool three,
                                     bool volumes)
{
    const struct four own = target_rows(g, targets);
    const real *rows = g->rows;
    const uint32_t *ids = tile->ids;
    const ptrdiff_t stride = tile->id_stride;
    const uint32_t *to_come = ids_ahead(tile);
    const real *also = tile->also ? tile->also : rows;
    real *at = tile->arrays;
    for (int32_t k = 0; k < tile->steps; ++k, at += LANES, ids += stride, kept += SPHGI_GROUP) {
        __builtin_prefetch(ids + AHEAD * stride);
        __builtin_prefetch(kept + AHEAD * SPHGI_GROUP);
        ask_for_rows(rows, also, to_come, tile->scattered);
        ask_for_more_rows(tile, to_come);
        to_come += stride;
        const struct four row = gather_rows(rows, ids);
        store(at + SPHGI_X * SPHGI_TILE, own.x - row.x);
        store(at + SPHGI_Y * SPHGI_TILE, own.y - row.y);
        if (three)
            store(at + SPHGI_Z * SPHGI_TILE, own.z - row.z);
        if (volumes)
            store(at + SPHGI_V * SPHGI_TILE, row.w);
        store(at + SPHGI_S * SPHGI_TILE, load(kept));
    }
}

static void gather_offsets(const struct sphgi_gather *g, const void *kept, const int32_t *targets,
                           struct sphgi_tile *tile)
{
    WITH(three, g->dimension == 3,
         WITH(volumes, g->volumes, offsets_of_pairs(g, kept, targets, tile, three, volumes)));
}

static void keep_factors(const struct sphgi_tile *tile, void *kept)
{
    const real *from = (const real *)tile->arrays + SPHGI_S * SPHGI_TILE;
    real *to = kept;
    for (int32_t k = 0; k < tile->steps; ++k, from += LANES, to += SPHGI_GROUP)
        store(to, load(from));
}
