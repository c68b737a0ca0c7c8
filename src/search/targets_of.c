/* SPDX-License-Identifier: MIT */
#include "targets_of.h"
#include "core/parallel.h"
#include "extremes.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

/* ---- Instead of a view ----------------------------------------------------------------------- */

void sphgi_put_targets_of(sphg_geometry *geometry)
{
    const sphg_neighbors *other = geometry->targets_of;
    const size_t number = sphgi_size_of_type(other->position_type);
    const sphg_view rows = {
        sphgi_target_row(other, 0), NULL,         NULL, (ptrdiff_t)(SPHGI_ROW * number),
        other->position_type,       SPHG_AS_SHAPE};
    geometry->targets = rows;
    geometry->target_count = other->target_count;
    if (other->radii) {
        geometry->target_support = rows;
        geometry->target_support.x = (const char *)rows.x + (SPHGI_ROW - 1) * number;
    }
}

/* ---- What is known of them ------------------------------------------------------------------- */

bool sphgi_knows_targets_of(const sphg_neighbors *other, const sphg_geometry *given,
                            struct sphgi_geometry *g)
{
    if (given->skin > 0 || other->skin > 0 || other->graded != g->graded)
        return false; /* with a skin, they may have moved since it was found out */
    for (int32_t a = 0; a < 3; ++a)
        g->largest[a] = fmax(g->largest[a], other->largest[a]);
    return true;
}

bool sphgi_may_share_targets(const sphg_neighbors *other, const struct sphgi_raster *raster)
{
    const struct sphgi_grid *grid = sphgi_target_grid(other);
    return grid->sorted && sphgi_same_raster(&grid->raster, raster);
}

/* ---- Copies ---------------------------------------------------------------------------------- */

struct copying {
    const sphg_neighbors *other;
    struct sphgi_geometry *g;
    sphgi_extreme largest[3];
};

static void copy_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct copying *copying = data;
    const struct sphgi_grid *grid = sphgi_target_grid(copying->other);
    const int32_t *order = grid->order.data;
    double largest[3] = {0};
    (void)worker;
    for (int32_t k = begin; k < end; ++k) {
        const char *row = sphgi_target_row(copying->other, k);
        memcpy(copying->g->target_rows + (size_t)order[k] * copying->g->row_size, row,
               copying->g->row_size);
        for (int32_t a = 0; a < 3; ++a) {
            const double x = grid->type == SPHG_F64 ? ((const double *)(const void *)row)[a]
                                                    : (double)((const float *)(const void *)row)[a];
            largest[a] = fmax(largest[a], fabs(x));
        }
    }
    for (int32_t a = 0; a < 3; ++a)
        sphgi_raise(&copying->largest[a], largest[a]);
}

void sphgi_copy_targets(sphg_context *context, const sphg_neighbors *other,
                        struct sphgi_geometry *g)
{
    struct copying copying = {.other = other, .g = g};
    for (int32_t a = 0; a < 3; ++a)
        sphgi_extreme_set(&copying.largest[a], 0);
    sphgi_parallel_for(context, copy_task, &copying, g->target_count, GRAIN);
    for (int32_t a = 0; a < 3; ++a)
        g->largest[a] = fmax(g->largest[a], sphgi_extreme_get(&copying.largest[a]));
}

/* ---- One grid for two objects ---------------------------------------------------------------- */

void sphgi_share_targets(sphg_neighbors *n, const sphg_neighbors *other)
{
    sphgi_grid_free(&n->targets, &n->allocator);
    sphgi_free(&n->allocator, &n->target_place);
    n->targets = *sphgi_target_grid(other);
    n->target_place = other->target_place;
    n->targets_of = other->targets_of ? other->targets_of : other;
    n->builds_of_targets = n->targets_of->builds;
}

void sphgi_give_up_targets(sphg_neighbors *n)
{
    if (!n->targets_of)
        return;
    n->targets = (struct sphgi_grid){.sorted = false};
    n->target_place = (struct sphgi_buffer){NULL, 0};
    n->targets_of = NULL;
}
