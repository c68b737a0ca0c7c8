/* SPDX-License-Identifier: MIT */
#include "targets_of.h"
#include "core/parallel.h"
#include "core/refuse.h"
#include "extremes.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

/* ---- What fits ------------------------------------------------------------------------------- */

static sphg_result check_object(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                const sphg_neighbors *other, bool searched)
{
    const char *f = checker.function;
    if (!searched)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.targets_of is set, it is for searches only", f);
    if (other == neighbors)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.targets_of is the object that is to be built", f);
    if (other->kind != SPHGI_SEARCHED)
        REFUSE(SPHG_ERROR_STATE, "%s: geometry.targets_of holds no search", f);
    if (!sphgi_has_its_targets(other))
        REFUSE(SPHG_ERROR_STATE,
               "%s: geometry.targets_of has targets of an object that was built anew since", f);
    return SPHG_OK;
}

static sphg_result check_fit(struct sphgi_checker checker, const sphg_geometry *geometry,
                             const struct sphgi_scheme *scheme)
{
    const char *f = checker.function;
    const sphg_neighbors *other = geometry->targets_of;
    if (geometry->targets.x || geometry->target_support.x)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.%s and targets_of are both set", f,
               geometry->targets.x ? "targets" : "target_support");
    if (geometry->target_count && geometry->target_count != other->target_count)
        REFUSE(SPHG_ERROR_SIZE, "%s: geometry.target_count is %d, but targets_of has %d", f,
               (int)geometry->target_count, (int)other->target_count);
    if (scheme->dimension != other->dimension)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.dimension is %d, but %d in geometry.targets_of", f,
               (int)scheme->dimension, (int)other->dimension);
    if (geometry->sources.x && geometry->sources.type != other->position_type)
        REFUSE(SPHG_ERROR_TYPE,
               "%s: geometry.sources.type is %d, but positions of targets_of are %d", f,
               (int)geometry->sources.type, (int)other->position_type);
    for (int32_t a = 0; a < scheme->dimension; ++a)
        if (geometry->period[a] != other->period[a])
            REFUSE(SPHG_ERROR_ARGUMENT,
                   "%s: geometry.period[%d] is another one than that of targets_of", f, (int)a);
    if (geometry->source_count > 0 && !geometry->source_support.x == other->radii)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.source_support is %s, but targets_of has %s", f,
               other->radii ? "absent" : "set", other->radii ? "radii" : "none");
    return SPHG_OK;
}

sphg_result sphgi_take_targets_of(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                  const struct sphgi_scheme *scheme, bool searched,
                                  sphg_geometry *geometry)
{
    const sphg_neighbors *other = geometry->targets_of;
    if (!other)
        return SPHG_OK;
    sphg_result result = check_object(checker, neighbors, other, searched);
    if (!result)
        result = check_fit(checker, geometry, scheme);
    if (result)
        return result;
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
    return SPHG_OK;
}

/* ---- What is known of them ------------------------------------------------------------------- */

bool sphgi_knows_targets_of(const sphg_neighbors *other, const sphg_geometry *given,
                            struct sphgi_geometry *g)
{
    if (given->skin > 0 || other->graded != g->graded)
        return false;
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
