/* SPDX-License-Identifier: MIT */
#include "build.h"
#include "dummy.h"
#include "extremes.h"
#include "geometry.h"
#include "grids.h"
#include "core/kernel.h"
#include "core/parallel.h"
#include "core/view.h"
#include "lists.h"
#include "octaves.h"
#include "radii.h"
#include "skin.h"
#include "targets_of.h"
#include "weights.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

/* ---- Reading positions ----------------------------------------------------------------------- */

struct reading {
    const struct sphgi_passes *passes;
    struct sphgi_columns columns;
    char *rows;
    size_t row_size;
    const struct sphgi_periods *periods; /* NULL: all axes are open */
    bool trusted;
    atomic_int_least64_t bad; /* first item that is not finite, or INT64_MAX */
    sphgi_extreme largest[3]; /* |coordinate| */
};

static void take_into_box(struct reading *reading, int32_t begin, int32_t end)
{
    double largest[3] = {0};
    reading->passes->take_into_box(reading->periods, end - begin,
                                   reading->rows + (size_t)begin * reading->row_size, largest);
    for (int32_t a = 0; a < 3; ++a)
        sphgi_raise(&reading->largest[a], largest[a]);
}

static void reading_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct reading *reading = data;
    (void)worker;
    const bool finite = reading->passes->read_positions(
        &reading->columns, begin, end, reading->rows + (size_t)begin * reading->row_size);
    if (reading->periods)
        take_into_box(reading, begin, end);
    if (finite || reading->trusted)
        return;
    const int64_t bad = reading->passes->first_not_finite(&reading->columns, begin, end);
    int_least64_t first = atomic_load(&reading->bad);
    while (bad < first && !atomic_compare_exchange_weak(&reading->bad, &first, bad))
        ;
}

static sphg_result read_positions(struct sphgi_checker checker, const sphg_view *view,
                                  const char *name, int32_t count, char *rows,
                                  struct sphgi_geometry *g)
{
    struct reading reading = {.passes = sphgi_passes_of(checker.context, view->type),
                              .columns = sphgi_columns_of(view, SPHG_VECTOR, g->dimension),
                              .rows = rows,
                              .row_size = SPHGI_ROW * sphgi_size_of_type(view->type),
                              .periods = g->periodic || g->graded ? &g->periods : NULL,
                              .trusted = checker.context->config.trusted != 0};
    atomic_store(&reading.bad, INT64_MAX);
    for (int32_t a = 0; a < 3; ++a)
        sphgi_extreme_set(&reading.largest[a], 0);
    sphgi_parallel_for(checker.context, reading_task, &reading, count, GRAIN);
    for (int32_t a = 0; a < 3; ++a)
        g->largest[a] = fmax(g->largest[a], sphgi_extreme_get(&reading.largest[a]));
    const int64_t bad = atomic_load(&reading.bad);
    if (bad == INT64_MAX)
        return SPHG_OK;
    return sphgi_fail(checker.context, SPHG_ERROR_NOT_FINITE, "%s: %s[%lld] is not finite",
                      checker.function, name, (long long)bad);
}

static struct sphgi_geometry geometry_of(const sphg_geometry *given,
                                         const struct sphgi_scheme *scheme)
{
    struct sphgi_geometry g = {.source_count = given->source_count,
                               .target_count = given->target_count,
                               .dimension = scheme->dimension,
                               .part_of = !given->targets.x,
                               .targets_of = given->targets_of};
    g.position_type = sphgi_type_of_positions(given);
    g.type = given->precision ? given->precision : g.position_type;
    g.row_size = SPHGI_ROW * sphgi_size_of_type(g.position_type);
    g.periods = sphgi_periods_of(g.dimension, scheme->radius, given->period, g.position_type);
    for (int32_t a = 0; a < 3; ++a)
        g.periodic |= g.periods.length[a] > 0;
    return g;
}

/* The largest radius takes the place of the scheme's. */
static sphg_result read_radii(struct sphgi_checker checker, const sphg_geometry *given,
                              struct sphgi_scheme *scheme, struct sphgi_radii *radii)
{
    if (!sphgi_has_radii(given))
        return SPHG_OK;
    sphg_result result = sphgi_look_at_radii(checker, given, radii);
    if (result)
        return result;
    scheme->radius = radii->least;
    result = sphgi_check_extent(checker, given, scheme);
    scheme->radius = radii->largest;
    return result ? result : sphgi_check_extent(checker, given, scheme);
}

static void take_radii(sphg_context *context, const sphg_geometry *given, struct sphgi_geometry *g)
{
    if (!sphgi_is_absent(&given->source_support))
        sphgi_put_radii(context, &given->source_support, g->source_count, g->source_rows);
    if (!g->part_of && !g->targets_of && !sphgi_is_absent(&given->target_support))
        sphgi_put_radii(context, &given->target_support, g->target_count, g->target_rows);
}

static struct sphgi_raster raster_for(const struct sphgi_geometry *g,
                                      const struct sphgi_scheme *scheme, double skin, int32_t along)
{
    const struct sphgi_bars bars = {along, g->graded ? SPHGI_OCTAVE_ACROSS : 1};
    struct sphgi_raster raster = sphgi_raster_of(g->dimension, scheme->radius + skin, bars,
                                                 &g->periods, g->largest, g->position_type);
    raster.top = scheme->radius;
    raster.octaves = g->graded ? sphgi_octaves_for(&raster, g->least, g->largest) : 0;
    return raster;
}

/* Of bars: as the targets have it, whose grid may serve several objects. */
static int32_t axis_of_bars(const struct sphgi_geometry *g, const struct sphgi_scheme *scheme)
{
    const struct sphgi_strewn targets = {g->target_rows, g->position_type, g->target_count,
                                         g->dimension, scheme->radius};
    return g->graded ? sphgi_longest_axis(&targets) : 0;
}

static sphg_result read_geometry(struct sphgi_checker checker, const sphg_geometry *given,
                                 const struct sphgi_scheme *scheme, struct sphgi_geometry *g)
{
    sphg_context *context = checker.context;
    const size_t own_targets = g->part_of ? 0 : (size_t)g->target_count;
    if (!sphgi_reserve(&context->allocator, &context->input,
                       (size_t)g->source_count + own_targets + SPHGI_LANES_MOST, g->row_size))
        return sphgi_fail_memory(context, checker.function);
    g->source_rows = context->input.data;
    g->target_rows = g->source_rows + (size_t)g->source_count * g->row_size;
    sphg_result result = read_positions(checker, &given->sources, "geometry.sources",
                                        g->source_count, g->source_rows, g);
    const sphg_neighbors *other = given->targets_of;
    const bool known = other && sphgi_knows_targets_of(other, given, g);
    if (!result && other && !known)
        sphgi_copy_targets(context, other, g);
    else if (!result && !other && !g->part_of)
        result = read_positions(checker, &given->targets, "geometry.targets", g->target_count,
                                g->target_rows, g);
    if (g->part_of)
        g->target_rows = g->source_rows;
    if (result)
        return result;
    take_radii(context, given, g);
    g->raster =
        raster_for(g, scheme, given->skin,
                   known ? sphgi_target_grid(other)->raster.along : axis_of_bars(g, scheme));
    g->shares = known && sphgi_may_share_targets(other, &g->raster);
    if (known && !g->shares) {
        sphgi_copy_targets(context, other, g);
        g->raster = raster_for(g, scheme, given->skin, axis_of_bars(g, scheme));
    }
    return SPHG_OK;
}

/* ---- Search ---------------------------------------------------------------------------------- */

static void adopt(sphg_neighbors *n, const struct sphgi_geometry *g, const sphg_geometry *given,
                  double radius)
{
    n->kind = SPHGI_NEVER_BUILT;
    ++n->builds;
    n->dimension = g->dimension;
    n->position_type = g->position_type;
    n->type = g->type;
    n->radius = radius;
    n->skin = given->skin;
    n->periodic = g->periodic;
    for (int32_t a = 0; a < 3; ++a)
        n->period[a] = a < g->dimension ? given->period[a] : 0;
    n->list_free = given->list_free != 0;
    n->keeps_weights = given->keep_weights != 0;
    n->part_of = g->part_of;
    n->same = g->part_of && g->target_count == g->source_count;
    n->source_count = g->source_count;
    n->target_count = g->target_count;
    n->found.pairs = 0;
    n->radii = g->radii;
    n->graded = g->graded;
    n->mutual = g->graded && given->mutual;
    n->least = g->radii ? g->least : radius;
    n->stretch = 1 + given->skin / radius;
    memcpy(n->largest, g->largest, sizeof n->largest);
    sphgi_give_up_targets(n);
    atomic_store(&n->places, 0);
    memset(&n->lists, 0, sizeof n->lists);
}

/* What is to be built. scheme: its radius becomes the largest there is. */
static sphg_result read_question(struct sphgi_checker checker, const sphg_geometry *given,
                                 struct sphgi_scheme *scheme, struct sphgi_geometry *g)
{
    struct sphgi_radii radii = {0, 0};
    const sphg_result result = read_radii(checker, given, scheme, &radii);
    *g = geometry_of(given, scheme);
    g->radii = sphgi_has_radii(given);
    g->least = radii.least;
    g->graded = radii.least < radii.largest;
    return result ? result : read_geometry(checker, given, scheme, g);
}

/* How much of the skin is left; negative or NaN: the pairs that the object holds do not serve. */
static double left_of_skin(sphg_context *context, const sphg_neighbors *n,
                           const struct sphgi_geometry *g, const sphg_geometry *given,
                           double radius)
{
    if (!sphgi_skin_asks_the_same(n, g, given, radius) || n->type != g->type)
        return -1;
    return sphgi_skin_left(context, n, g);
}

sphg_result sphgi_would_rebuild(struct sphgi_checker checker, const sphg_neighbors *n,
                                const struct sphgi_scheme *checked, const sphg_geometry *given,
                                int32_t *rebuild)
{
    struct sphgi_scheme own = *checked;
    struct sphgi_geometry g;
    const sphg_result result = read_question(checker, given, &own, &g);
    if (!result)
        *rebuild = !(left_of_skin(checker.context, n, &g, given, own.radius) >= 0);
    return result;
}

sphg_result sphgi_build_by_search(struct sphgi_checker checker, sphg_neighbors *n,
                                  const struct sphgi_scheme *checked, const sphg_geometry *given)
{
    struct sphgi_scheme own = *checked;
    const struct sphgi_scheme *scheme = &own;
    struct sphgi_geometry g;
    sphg_result result = read_question(checker, given, &own, &g);
    if (result)
        return result;
    const double left = left_of_skin(checker.context, n, &g, given, scheme->radius);
    if (left >= 0) {
        sphgi_skin_keep(checker.context, n, &g, scheme->radius, left);
        return SPHG_OK;
    }
    adopt(n, &g, given, scheme->radius);
    result = sphgi_grids_build(checker.context, n, &g);
    if (!result)
        sphgi_place_dummy(n, true);
    if (!result && !n->list_free)
        result = sphgi_lists_build(checker.context, n);
    if (!result && !sphgi_weights_reserve(n))
        result = SPHG_ERROR_MEMORY;
    n->skin_left = 0;
    if (!result && n->skin > 0)
        result = sphgi_skin_remember(n, &g) ? SPHG_OK : SPHG_ERROR_MEMORY;
    if (result)
        return sphgi_fail_memory(checker.context, checker.function);
    n->kind = SPHGI_SEARCHED;
    n->rebuilt = true;
    return SPHG_OK;
}

/* ---- The host's lists ------------------------------------------------------------------------ */

/* Copies in the order of the host. */
static bool copy_rows(sphg_neighbors *n, const struct sphgi_geometry *g)
{
    const size_t sources = (size_t)g->source_count, targets = (size_t)g->target_count;
    n->sources.sorted = n->targets.sorted = false;
    if (!sphgi_reserve(&n->allocator, &n->sources.rows, sources + 1, g->row_size) ||
        (!n->part_of && !sphgi_reserve(&n->allocator, &n->targets.rows, targets + 1, g->row_size)))
        return false;
    memcpy(n->sources.rows.data, g->source_rows, sources * g->row_size);
    if (!n->part_of)
        memcpy(n->targets.rows.data, g->target_rows, targets * g->row_size);
    return true;
}

/* Each stands where it stands. */
static bool number(const sphg_neighbors *n, struct sphgi_buffer *buffer, int32_t count)
{
    if (!sphgi_reserve(&n->allocator, buffer, (size_t)count, sizeof(int32_t)))
        return false;
    int32_t *numbers = buffer->data;
    for (int32_t k = 0; k < count; ++k)
        numbers[k] = k;
    return true;
}

/* What a search would have made: grids in the order of the host, of no blocks. */
static bool open_grids(sphg_neighbors *n, const struct sphgi_geometry *g)
{
    n->sources.block_count = n->targets.block_count = 0;
    n->sources.count = n->source_count;
    n->targets.count = n->target_count;
    n->sources.raster = g->raster;
    return number(n, &n->sources.order, n->source_count) &&
           (n->part_of || number(n, &n->targets.order, n->target_count)) &&
           number(n, &n->target_place, n->target_count);
}

static sphg_result copy_lists(struct sphgi_checker checker, sphg_neighbors *n,
                              const struct sphgi_geometry *g, const sphg_lists *lists)
{
    if (!open_grids(n, g))
        return SPHG_ERROR_MEMORY;
    sphgi_place_dummy(n, true);
    return sphgi_lists_copy(checker, n, lists);
}

sphg_result sphgi_build_on_lists(struct sphgi_checker checker, sphg_neighbors *n,
                                 const struct sphgi_scheme *checked, const sphg_geometry *given,
                                 const sphg_lists *lists)
{
    struct sphgi_scheme own = *checked;
    struct sphgi_geometry g;
    sphg_result result = read_question(checker, given, &own, &g);
    if (result)
        return result;
    adopt(n, &g, given, own.radius);
    n->same = n->part_of;
    if (!copy_rows(n, &g))
        return sphgi_fail_memory(checker.context, checker.function);
    if (lists->copy) {
        result = copy_lists(checker, n, &g, lists);
        if (result)
            return result == SPHG_ERROR_MEMORY
                       ? sphgi_fail_memory(checker.context, checker.function)
                       : result;
    } else {
        sphgi_place_dummy(n, false);
        n->lists = *lists;
        n->found.pairs = lists->offsets ? lists->offsets[n->target_count] : 0;
    }
    n->kind = lists->copy ? SPHGI_COPIED_LISTS : SPHGI_HOST_LISTS;
    n->rebuilt = true;
    n->skin_left = 0;
    return SPHG_OK;
}
