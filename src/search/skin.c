/* SPDX-License-Identifier: MIT */
#include "skin.h"
#include "core/parallel.h"
#include "extremes.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

/* Radii of their own may change from one time to the next. */
static bool has_the_same_radii(const sphg_neighbors *n, const struct sphgi_geometry *g,
                               const sphg_geometry *given, double radius)
{
    if (n->graded || g->graded)
        return n->graded && g->graded && n->mutual == (given->mutual != 0);
    return n->radius == radius && n->radii == g->radii;
}

bool sphgi_skin_asks_the_same(const sphg_neighbors *n, const struct sphgi_geometry *g,
                              const sphg_geometry *given, double radius)
{
    return n->kind == SPHGI_SEARCHED && n->skin > 0 && n->skin == given->skin &&
           has_the_same_radii(n, g, given, radius) && n->dimension == g->dimension &&
           n->part_of == g->part_of && n->position_type == g->position_type &&
           n->source_count == g->source_count && n->target_count == g->target_count &&
           n->period[0] == given->period[0] && n->period[1] == given->period[1] &&
           n->period[2] == given->period[2];
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
    grid->sorted = false;
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
    const double then = n->sources.raster.slack;
    const double now = sphgi_slack_of(&g->periods, g->largest, g->position_type);
    return (n->skin / 2 + n->radius) * unit + 2 * (then > now ? then : now);
}

/* ---- Radii of their own ---------------------------------------------------------------------- */

/* Lists hold r < (1 + s) max(H_i, H_j). A pair that is closer than H_i' <= H_i + g_i now was closer
 * than H_i + g_i + m_i + m_j then, which is at most that where g + m <= s H / 2 for everybody:
 * growth counts like a move. */
struct shares {
    const struct sphgi_periods *periods;
    const void *then, *now;
    sphg_type type;
    sphgi_extreme largest;
};

static double number_of(const struct shares *shares, const void *rows, int32_t k, int32_t number)
{
    const size_t at = SPHGI_ROW * (size_t)k + (size_t)number;
    return shares->type == SPHG_F64 ? ((const double *)rows)[at]
                                    : (double)((const float *)rows)[at];
}

/* (m + g) / H of one particle; infinite where that is no number. */
static double share_of(const struct shares *shares, int32_t k)
{
    const double then = number_of(shares, shares->then, k, SPHGI_ROW - 1);
    const double growth = number_of(shares, shares->now, k, SPHGI_ROW - 1) - then;
    double square = 0;
    for (int32_t a = 0; a < 3; ++a) {
        const double period = shares->periods->length[a];
        double move = number_of(shares, shares->now, k, a) - number_of(shares, shares->then, k, a);
        if (period > 0 && fabs(move) > period / 2)
            move = remainder(move, period);
        square += move * move;
    }
    const double share = (sqrt(square) + (growth > 0 ? growth : 0)) / then;
    return share < (double)INFINITY ? share : (double)INFINITY;
}

static void share_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct shares *shares = data;
    double largest = 0;
    (void)worker;
    for (int32_t k = begin; k < end; ++k) {
        const double share = share_of(shares, k);
        largest = share > largest ? share : largest;
    }
    sphgi_raise(&shares->largest, largest);
}

static double largest_share(sphg_context *context, const struct sphgi_geometry *g, const void *then,
                            const void *now, int32_t count)
{
    struct shares shares = {
        .periods = &g->periods, .then = then, .now = now, .type = g->position_type};
    sphgi_extreme_set(&shares.largest, 0);
    sphgi_parallel_for(context, share_task, &shares, count, GRAIN);
    return sphgi_extreme_get(&shares.largest);
}

/* As skin_reserve, of the smallest radius. */
static double share_reserve(const sphg_neighbors *n, const struct sphgi_geometry *g)
{
    const double unit = g->position_type == SPHG_F64 ? 0x1p-50 : 0x1p-21;
    const double then = n->sources.raster.slack;
    const double now = sphgi_slack_of(&g->periods, g->largest, g->position_type);
    const double least = n->least < g->least ? n->least : g->least;
    return n->stretch * unit + 2 * (then > now ? then : now) / least;
}

static double left_of_shares(sphg_context *context, const sphg_neighbors *n,
                             const struct sphgi_geometry *g)
{
    double share = largest_share(context, g, n->sources_then.data, g->source_rows, g->source_count);
    if (!g->part_of) {
        const double targets =
            largest_share(context, g, n->targets_then.data, g->target_rows, g->target_count);
        share = targets > share ? targets : share;
    }
    return n->sources.raster.top * ((n->stretch - 1) / 2 - share - share_reserve(n, g));
}

/* ---- Both ------------------------------------------------------------------------------------ */

static double left_of_moves(sphg_context *context, const sphg_neighbors *n,
                            const struct sphgi_geometry *g)
{
    double moved = largest_move(context, g, n->sources_then.data, g->source_rows, g->source_count);
    if (!g->part_of) {
        const double targets =
            largest_move(context, g, n->targets_then.data, g->target_rows, g->target_count);
        moved = targets > moved ? targets : moved;
    }
    return n->skin / 2 - moved - skin_reserve(n, g);
}

double sphgi_skin_left(sphg_context *context, const sphg_neighbors *n,
                       const struct sphgi_geometry *g)
{
    return n->graded ? left_of_shares(context, n, g) : left_of_moves(context, n, g);
}

void sphgi_skin_keep(sphg_context *context, sphg_neighbors *n, const struct sphgi_geometry *g,
                     double radius, double left)
{
    n->radius = radius;
    n->least = n->graded ? g->least : radius;
    refresh_rows(context, &n->sources, g->source_rows, g->row_size);
    if (!n->same)
        refresh_rows(context, &n->targets, g->target_rows, g->row_size);
    atomic_store(&n->places, 0);
    n->rebuilt = false;
    n->skin_left = left;
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
    const double reserve = n->graded ? n->radius * share_reserve(n, g) : skin_reserve(n, g);
    const double left = n->skin / 2 - reserve;
    n->skin_left = left > 0 ? left : 0;
    return true;
}
