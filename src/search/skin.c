#include "skin.h"
#include "core/parallel.h"
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

bool sphgi_skin_asks_the_same(const sphg_neighbors *n, const struct sphgi_geometry *g,
                              const sphg_geometry *given, double radius)
{
    return !g->graded && !n->graded && n->radii == g->radii && n->kind == SPHGI_SEARCHED &&
           n->skin > 0 && n->skin == given->skin && n->radius == radius &&
           n->dimension == g->dimension && n->part_of == g->part_of &&
           n->position_type == g->position_type && n->source_count == g->source_count &&
           n->target_count == g->target_count && n->period[0] == given->period[0] &&
           n->period[1] == given->period[1] && n->period[2] == given->period[2];
}

struct moves {
    const struct sphgi_passes *passes;
    const struct sphgi_periods *periods;
    const void *then, *now;
    double *largest; /* a slot per task range start: see moved_task */
    int32_t chunk;
};

static void moved_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct moves *moves = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c)
        moves->largest[c] =
            moves->passes->largest_move(moves->periods, moves->then, moves->now,
                                        (int64_t)c * moves->chunk, (int64_t)(c + 1) * moves->chunk);
}

static double largest_move(sphg_context *context, const struct sphgi_geometry *g, const void *then,
                           const void *now, int32_t count)
{
    enum { CHUNKS = 64 };
    double largest[CHUNKS + 1] = {0};
    struct moves moves = {sphgi_passes_of(context, g->position_type),
                          &g->periods,
                          then,
                          now,
                          largest,
                          count / CHUNKS};
    if (moves.chunk)
        sphgi_parallel_for(context, moved_task, &moves, CHUNKS, 1);
    largest[CHUNKS] =
        moves.passes->largest_move(&g->periods, then, now, (int64_t)moves.chunk * CHUNKS, count);
    for (int32_t c = 0; c < CHUNKS; ++c)
        largest[CHUNKS] = largest[c] > largest[CHUNKS] ? largest[c] : largest[CHUNKS];
    return largest[CHUNKS];
}

struct refresh {
    const int32_t *order;
    const char *from;
    char *to;
    size_t row_size;
};

static void refresh_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct refresh *r = data;
    (void)worker;
    for (int32_t k = begin; k < end; ++k)
        memcpy(r->to + (size_t)k * r->row_size, r->from + (size_t)r->order[k] * r->row_size,
               r->row_size);
}

static void refresh_rows(sphg_context *context, struct sphgi_grid *grid, const char *rows,
                         size_t row_size)
{
    struct refresh refresh = {grid->order.data, rows, grid->rows.data, row_size};
    sphgi_parallel_for(context, refresh_task, &refresh, grid->count, GRAIN);
}

/* What rounding can take of half the skin. A pair that is decided to be closer than H now was so
 * within H + skin when pairs were found if
 *   H + rounding now + 2 moved + rounding then <= H + skin - rounding of the decision.
 * Decisions are off by a few units of H + skin; between images a distance is off by sqrt(3) 5 u m,
 * now and then, and a move (f64) by sqrt(3) 2 u m, twice: 25 u m, half of which is less than the
 * slack of 8 u m twice. */
static double skin_reserve(const sphg_neighbors *n, const struct sphgi_geometry *g)
{
    const double unit = g->position_type == SPHG_F64 ? 0x1p-50 : 0x1p-21;
    const double then = n->sources.lattice.slack;
    const double now = sphgi_slack_of(&g->periods, g->largest, g->position_type);
    return (n->skin / 2 + n->radius) * unit + 2 * (then > now ? then : now);
}

bool sphgi_skin_holds(sphg_context *context, sphg_neighbors *n, const struct sphgi_geometry *g)
{
    double moved = largest_move(context, g, n->sources_then.data, g->source_rows, g->source_count);
    if (!g->part_of) {
        const double targets =
            largest_move(context, g, n->targets_then.data, g->target_rows, g->target_count);
        moved = targets > moved ? targets : moved;
    }
    const double left = n->skin / 2 - moved - skin_reserve(n, g);
    if (!(left >= 0))
        return false;
    refresh_rows(context, &n->sources, g->source_rows, g->row_size);
    if (!n->same)
        refresh_rows(context, &n->targets, g->target_rows, g->row_size);
    atomic_store(&n->places, 0);
    n->rebuilt = false;
    n->skin_left = left;
    return true;
}

bool sphgi_skin_remember(sphg_neighbors *n, const struct sphgi_geometry *g)
{
    const size_t sources = (size_t)g->source_count, targets = (size_t)g->target_count;
    if (!sphgi_reserve(&n->allocator, &n->sources_then, sources, g->row_size) ||
        (!g->part_of && !sphgi_reserve(&n->allocator, &n->targets_then, targets, g->row_size)))
        return false;
    if (sources)
        memcpy(n->sources_then.data, g->source_rows, sources * g->row_size);
    if (!g->part_of && targets)
        memcpy(n->targets_then.data, g->target_rows, targets * g->row_size);
    const double left = n->skin / 2 - skin_reserve(n, g);
    n->skin_left = left > 0 ? left : 0;
    return true;
}
