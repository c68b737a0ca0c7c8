/* SPDX-License-Identifier: MIT */
#include "grids.h"
#include "core/parallel.h"

enum { GRAIN = 4096 }; /* particles */

/* ---- Places ---------------------------------------------------------------------------------- */

struct inversion {
    const int32_t *order;
    int32_t *place;
};

static void invert_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct inversion *inversion = data;
    (void)worker;
    for (int32_t k = begin; k < end; ++k)
        inversion->place[inversion->order[k]] = k;
}

static bool invert_order(sphg_context *context, const sphg_neighbors *n,
                         const struct sphgi_grid *grid, struct sphgi_buffer *place)
{
    if (!sphgi_reserve(&n->allocator, place, (size_t)grid->count, sizeof(int32_t)))
        return false;
    struct inversion inversion = {grid->order.data, place->data};
    sphgi_parallel_for(context, invert_task, &inversion, grid->count, GRAIN);
    return true;
}

/* ---- Grids ----------------------------------------------------------------------------------- */

/* What the tables of the grids can take at most; those of the lists too, which keep a number per
 * group of targets. */
static size_t tables_most(const sphg_neighbors *n)
{
    size_t bytes = sphgi_grid_tables(n->source_count, n->graded) + SPHGI_ALIGNMENT;
    if (!n->same)
        bytes += sphgi_grid_tables(n->target_count, n->graded) + SPHGI_ALIGNMENT;
    if (!n->list_free)
        bytes += (size_t)sphgi_group_count(n->target_count) * sizeof(int64_t) + SPHGI_ALIGNMENT;
    return bytes;
}

sphg_result sphgi_grids_build(sphg_context *context, sphg_neighbors *n,
                              const struct sphgi_geometry *g)
{
    struct sphgi_raster raster = sphgi_raster_of(n->dimension, n->radius + n->skin, &g->periods,
                                                 g->largest, n->position_type);
    raster.top = n->radius;
    raster.octaves = n->graded ? sphgi_octaves_for(&raster, n->least, g->largest) : 0;
    if (!sphgi_reserve(&n->allocator, &n->shared, tables_most(n), 1))
        return SPHG_ERROR_MEMORY;
    char *tables = n->shared.data;
    sphg_result result =
        sphgi_grid_build(context, &n->sources, &n->allocator, &raster, n->position_type,
                         g->source_rows, n->source_count, tables);
    if (!result && !n->same) {
        tables +=
            sphgi_round_up(sphgi_grid_tables(n->sources.block_count, n->graded), SPHGI_ALIGNMENT);
        result = sphgi_grid_build(context, &n->targets, &n->allocator, &raster, n->position_type,
                                  g->target_rows, n->target_count, tables);
    }
    if (!result && !invert_order(context, n, sphgi_target_grid(n), &n->target_place))
        result = SPHG_ERROR_MEMORY;
    if (!result && n->graded && n->part_of && !n->same &&
        !invert_order(context, n, &n->sources, &n->source_place))
        result = SPHG_ERROR_MEMORY;
    return result;
}
