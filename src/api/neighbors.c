/* SPDX-License-Identifier: MIT */
#include "core/check.h"
#include "entries.h"
#include "search/build.h"
#include "search/check_targets.h"
#include "search/radii.h"
#include "search/targets_of.h"
#include <string.h>

sphg_neighbors *sphgi_neighbors_make(sphg_context *context)
{
    sphg_neighbors *made = sphgi_allocate(&context->allocator, sizeof *made);
    if (made) {
        memset(made, 0, sizeof *made);
        made->found.most_pairs = -1;
        made->allocator = context->allocator;
    }
    return made;
}

sphg_result sphg_neighbors_create(sphg_context *context, sphg_neighbors **neighbors)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_create"};
    if (neighbors)
        *neighbors = NULL;
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_pointer(checker, neighbors, "neighbors");
    if (!result) {
        *neighbors = sphgi_neighbors_make(context);
        if (!*neighbors)
            result = sphgi_fail_memory(context, checker.function);
    }
    return sphgi_leave(context, result);
}

struct buffers {
    struct sphgi_buffer *list[8];
};

static struct buffers own_buffers(sphg_neighbors *n)
{
    return (struct buffers){{&n->target_place, &n->found.lengths, &n->shared, &n->sources_then,
                             &n->targets_then, &n->weights, &n->weight_book, &n->source_place}};
}

void sphg_neighbors_destroy(sphg_neighbors *neighbors)
{
    if (!neighbors)
        return;
    const struct sphgi_allocator allocator = neighbors->allocator;
    sphgi_give_up_targets(neighbors);
    const struct buffers buffers = own_buffers(neighbors);
    for (size_t k = 0; k < sizeof buffers.list / sizeof *buffers.list; ++k)
        sphgi_free(&allocator, buffers.list[k]);
    sphgi_grid_free(&neighbors->sources, &allocator);
    sphgi_grid_free(&neighbors->targets, &allocator);
    sphgi_release(&allocator, neighbors, sizeof *neighbors);
}

/* given: the geometry with the targets that it names by another object. */
static sphg_result check_build(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                               const sphg_scheme *scheme, const sphg_geometry *geometry,
                               bool searched, struct sphgi_scheme *checked, sphg_geometry *given)
{
    sphg_result result = sphgi_check_pointer(checker, neighbors, "neighbors");
    if (!result)
        result = sphgi_check_pointer(checker, geometry, "geometry");
    if (result)
        return result;
    *given = *geometry;
    const bool radii = sphgi_has_radii(given) || (given->targets_of && given->targets_of->radii);
    result = radii ? sphgi_check_scheme_beside_radii(checker, scheme, checked)
                   : sphgi_check_scheme(checker, scheme, checked);
    if (!result && given->targets_of)
        result = sphgi_check_targets_of(checker, neighbors, checked, searched, given);
    if (!result && given->targets_of)
        sphgi_put_targets_of(given);
    if (!result)
        result = sphgi_check_geometry(checker, given, checked, searched);
    return result || radii ? result : sphgi_check_extent(checker, given, checked);
}

sphg_result sphg_neighbors_search(sphg_context *context, sphg_neighbors *neighbors,
                                  const sphg_scheme *scheme, const sphg_geometry *geometry)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_search"};
    struct sphgi_scheme checked = {0};
    sphg_geometry given;
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = check_build(checker, neighbors, scheme, geometry, true, &checked, &given);
    if (!result)
        result = sphgi_build_by_search(checker, neighbors, &checked, &given);
    return sphgi_leave(context, result);
}

sphg_result sphg_neighbors_would_rebuild(sphg_context *context, const sphg_neighbors *neighbors,
                                         const sphg_scheme *scheme, const sphg_geometry *geometry,
                                         int32_t *rebuild)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_would_rebuild"};
    struct sphgi_scheme checked = {0};
    sphg_geometry given;
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = check_build(checker, neighbors, scheme, geometry, true, &checked, &given);
    if (!result)
        result = sphgi_check_pointer(checker, rebuild, "rebuild");
    if (!result)
        result = sphgi_would_rebuild(checker, neighbors, &checked, &given, rebuild);
    return sphgi_leave(context, result);
}

sphg_result sphg_neighbors_use_lists(sphg_context *context, sphg_neighbors *neighbors,
                                     const sphg_scheme *scheme, const sphg_geometry *geometry,
                                     const sphg_lists *lists)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_use_lists"};
    struct sphgi_scheme checked = {0};
    sphg_geometry given;
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = check_build(checker, neighbors, scheme, geometry, false, &checked, &given);
    if (!result)
        result = sphgi_check_lists(checker, lists, given.target_count);
    if (!result)
        result = sphgi_build_on_lists(checker, neighbors, &checked, &given, lists);
    return sphgi_leave(context, result);
}

static int64_t grid_bytes(const struct sphgi_grid *grid)
{
    return (int64_t)(grid->cell_start.size + grid->rows.size + grid->order.size);
}

sphg_result sphg_neighbors_get_info(sphg_context *context, const sphg_neighbors *neighbors,
                                    sphg_neighbors_info *info)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_get_info"};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_pointer(checker, neighbors, "neighbors");
    if (!result)
        result = sphgi_check_pointer(checker, info, "info");
    if (!result) {
        const sphg_neighbors *n = neighbors;
        const struct buffers own = own_buffers((sphg_neighbors *)(uintptr_t)n);
        *info = (sphg_neighbors_info){.pairs = n->kind ? n->found.pairs : 0,
                                      .target_count = n->kind ? n->target_count : 0,
                                      .source_count = n->kind ? n->source_count : 0,
                                      .rebuilt = n->rebuilt,
                                      .skin_left = n->kind ? n->skin_left : 0};
        info->bytes = (int64_t)sizeof *n + grid_bytes(&n->sources) + grid_bytes(&n->targets);
        for (size_t k = 0; k < sizeof own.list / sizeof *own.list; ++k)
            info->bytes += (int64_t)own.list[k]->size;
        if (n->targets_of) /* whose memory it is */
            info->bytes -= grid_bytes(&n->targets) + (int64_t)n->target_place.size;
    }
    return sphgi_leave(context, result);
}

/* The host's lists have no order of their own: sort the positions as a search would, in a grid
 * whose memory stays with the context. */
static sphg_result order_of_lists(sphg_context *context, const sphg_neighbors *n, int32_t *order)
{
    static const struct sphgi_periods open;
    struct sphgi_grid grid = {.count = 0};
    const struct sphgi_raster raster = sphgi_raster_of(
        n->dimension, n->radius, (struct sphgi_bars){0, 1}, &open, NULL, n->position_type);
    struct sphgi_buffer *own[] = {&grid.cell_start, &grid.rows, &grid.order};
    for (int k = 0; k < 3; ++k)
        *own[k] = context->order_grid[k];
    struct sphgi_buffer *tables = &context->order_grid[3];
    sphg_result result = SPHG_ERROR_MEMORY;
    if (sphgi_reserve(&context->allocator, tables, sphgi_grid_tables(n->source_count, false), 1))
        result = sphgi_grid_build(context, &grid, &context->allocator, &raster, n->position_type,
                                  n->sources.rows.data, n->source_count, tables->data, NULL);
    if (!result)
        memcpy(order, grid.order.data, (size_t)n->source_count * sizeof *order);
    for (int k = 0; k < 3; ++k)
        context->order_grid[k] = *own[k];
    return result ? sphgi_fail_memory(context, "sphg_neighbors_get_order") : SPHG_OK;
}

sphg_result sphg_neighbors_get_order(sphg_context *context, const sphg_neighbors *neighbors,
                                     int32_t *order)
{
    const struct sphgi_checker checker = {context, "sphg_neighbors_get_order"};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_pointer(checker, neighbors, "neighbors");
    if (!result && !neighbors->kind)
        result = sphgi_fail(context, SPHG_ERROR_STATE, "%s: neighbors were never built",
                            checker.function);
    if (!result && neighbors->source_count > 0)
        result = sphgi_check_pointer(checker, order, "order");
    if (!result && neighbors->source_count > 0) {
        if (neighbors->kind != SPHGI_SEARCHED)
            result = order_of_lists(context, neighbors, order);
        else
            memcpy(order, neighbors->sources.order.data,
                   (size_t)neighbors->source_count * sizeof *order);
    }
    return sphgi_leave(context, result);
}
