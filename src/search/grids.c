/* SPDX-License-Identifier: MIT */
#include "grids.h"
#include "core/parallel.h"
#include "targets_of.h"
#include <stdatomic.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

/* ---- Particles that have not moved ----------------------------------------------------------- */

struct comparison {
    const struct sphgi_grid *grid;
    const char *rows; /* in the order of the host */
    atomic_bool moved;
};

static void compare_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct comparison *comparison = data;
    const struct sphgi_grid *grid = comparison->grid;
    const int32_t *order = grid->order.data;
    const bool f64 = grid->type == SPHG_F64;
    const size_t size = SPHGI_ROW * sphgi_size_of_type(grid->type);
    (void)worker;
    if (atomic_load(&comparison->moved))
        return;
    for (int32_t k = begin; k < end; ++k) {
        const char *then = (const char *)grid->rows.data + (size_t)k * size;
        const char *now = comparison->rows + (size_t)order[k] * size;
        if (f64 ? memcmp(then, now, SPHGI_ROW * sizeof(double)) != 0
                : memcmp(then, now, SPHGI_ROW * sizeof(float)) != 0) {
            atomic_store(&comparison->moved, true);
            return;
        }
    }
}

/* Whether these particles are sorted already, as those of a wall are from step to step. Where they
 * have moved, the first one tells. */
static bool stands(sphg_context *context, struct sphgi_grid *grid,
                   const struct sphgi_raster *raster, sphg_type type, const char *rows,
                   int32_t count)
{
    if (!grid->sorted || grid->type != type || grid->count != count ||
        !sphgi_same_raster(&grid->raster, raster))
        return false;
    struct comparison comparison = {.grid = grid, .rows = rows};
    atomic_store(&comparison.moved, false);
    sphgi_parallel_for(context, compare_task, &comparison, count, GRAIN);
    grid->raster = *raster;
    return !atomic_load(&comparison.moved);
}

/* ---- Grids ----------------------------------------------------------------------------------- */

/* Bytes of tables for so many particles, at most. */
static size_t most_of(const sphg_neighbors *n, int32_t count)
{
    return sphgi_round_up(sphgi_grid_tables(count, n->graded), SPHGI_ALIGNMENT);
}

/* Those of the lists too, which keep a number per group of targets. */
static size_t tables_most(const sphg_neighbors *n)
{
    size_t bytes = most_of(n, n->source_count);
    if (sphgi_sorts_targets(n))
        bytes += most_of(n, n->target_count);
    if (!n->list_free)
        bytes += (size_t)sphgi_group_count(n->target_count) * sizeof(int64_t) + SPHGI_ALIGNMENT;
    return bytes;
}

static void move_tables(struct sphgi_grid *grid, char *to)
{
    memmove(to, grid->blocks, sphgi_tables_of(grid));
    sphgi_grid_use_tables(grid, to);
}

static sphg_result build_sources(sphg_context *context, sphg_neighbors *n,
                                 const struct sphgi_raster *raster, const struct sphgi_geometry *g,
                                 struct sphgi_buffer *place)
{
    return sphgi_grid_build(context, &n->sources, &n->allocator, raster, n->position_type,
                            g->source_rows, n->source_count, n->shared.data, place);
}

/* Each grid is built that does not stand already. Tables of targets follow those of the sources,
 * which may become more or fewer: meanwhile they stand where nobody's reach. */
static sphg_result build_both(sphg_context *context, sphg_neighbors *n,
                              const struct sphgi_raster *raster, const struct sphgi_geometry *g)
{
    const sphg_type type = n->position_type;
    char *tables = n->shared.data;
    const bool targets = sphgi_sorts_targets(n) && stands(context, &n->targets, raster, type,
                                                          g->target_rows, n->target_count);
    if (!stands(context, &n->sources, raster, type, g->source_rows, n->source_count)) {
        if (targets)
            move_tables(&n->targets, tables + most_of(n, n->source_count));
        if (build_sources(context, n, raster, g, NULL))
            return SPHG_ERROR_MEMORY;
    }
    tables += sphgi_tables_of(&n->sources);
    if (targets)
        move_tables(&n->targets, tables);
    if (targets || n->targets_of)
        return SPHG_OK;
    return sphgi_grid_build(context, &n->targets, &n->allocator, raster, type, g->target_rows,
                            n->target_count, tables, &n->target_place);
}

/* One grid serves both: who searches again for particles of which none has moved is not helped. */
static sphg_result build_same(sphg_context *context, sphg_neighbors *n,
                              const struct sphgi_raster *raster, const struct sphgi_geometry *g)
{
    n->targets.sorted = false;
    return build_sources(context, n, raster, g, &n->target_place);
}

sphg_result sphgi_grids_build(sphg_context *context, sphg_neighbors *n,
                              const struct sphgi_geometry *g)
{
    const size_t before = n->shared.size;
    if (g->shares)
        sphgi_share_targets(n, g->targets_of);
    if (!sphgi_reserve(&n->allocator, &n->shared, tables_most(n), 1))
        return SPHG_ERROR_MEMORY;
    if (n->shared.size != before) { /* the tables are gone */
        n->sources.sorted = false;
        n->targets.sorted &= !sphgi_sorts_targets(n);
    }
    const sphg_result result =
        n->same ? build_same(context, n, &g->raster, g) : build_both(context, n, &g->raster, g);
    if (!result && n->graded && n->part_of && !n->same &&
        !sphgi_grid_places(context, &n->sources, &n->allocator, &n->source_place))
        return SPHG_ERROR_MEMORY;
    return result;
}
