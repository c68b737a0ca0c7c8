#include "find.h"
#include <string.h>

/* ---- Scratch -------------------------------------------------------------------------------- */

/* The most that can be staged around any block: every staged cell as full as the fullest, rounded
 * up to a power of two so that scratch does not grow with each particle that joins a cell. */
int32_t sphgi_finder_room(const sphg_neighbors *neighbors)
{
    const int64_t cells = neighbors->dimension == 3 ? 6 * 6 * 4 : 10 * 6;
    int64_t fullest = 16;
    while (fullest < neighbors->sources.fullest)
        fullest *= 2;
    const int64_t most = cells * fullest + 1;
    return most < SPHGI_STAGED_MOST ? (int32_t)most : SPHGI_STAGED_MOST;
}

struct layout {
    size_t coordinates, scratch, ids, lengths, total;
};

static struct layout layout_of(const sphg_neighbors *neighbors, int32_t room)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t padded = sphgi_round_up((size_t)room + 2 * SPHGI_PAD, SPHGI_ALIGNMENT);
    struct layout layout = {.coordinates = padded * size};
    const size_t candidates = padded + 2 * SPHGI_ALIGNMENT;
    layout.scratch = sphgi_round_up(candidates * (3 * size + 2 + 1), SPHGI_ALIGNMENT);
    const size_t batch = (size_t)SPHGI_FIND_MOST * (padded + SPHGI_PAD) + SPHGI_PAD;
    const size_t units = SPHGI_UNITS_MOST > batch ? SPHGI_UNITS_MOST + SPHGI_PAD : batch;
    layout.ids = sphgi_round_up(units * sizeof(uint32_t), SPHGI_ALIGNMENT);
    layout.lengths = SPHGI_ALIGNMENT;
    layout.total = 3 * layout.coordinates + layout.scratch + layout.ids + layout.lengths;
    return layout;
}

size_t sphgi_finder_size(const sphg_neighbors *neighbors, int32_t room)
{
    return layout_of(neighbors, room).total;
}

struct sphgi_finder sphgi_finder_at(const sphg_context *context, const sphg_neighbors *neighbors,
                                    int32_t room, void *memory)
{
    const struct layout layout = layout_of(neighbors, room);
    char *next = memory;
    struct sphgi_finder finder = {.room = room, .pack_order = context->pack_order};
    finder.passes = sphgi_passes_of(context, neighbors->position_type);
    finder.x = next;
    finder.y = next + layout.coordinates;
    finder.z = next + 2 * layout.coordinates;
    next += 3 * layout.coordinates;
    finder.scratch = next;
    finder.ids = (uint16_t *)(void *)(next += layout.scratch);
    finder.lengths = (uint16_t *)(void *)(next + layout.ids);
    return finder;
}

/* ---- 16-bit ids ----------------------------------------------------------------------------- */

static void stage_rows(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                       int32_t begin, int32_t count, int32_t at)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const char *rows = neighbors->sources.rows.data;
    finder->passes->transpose_rows(
        rows + (size_t)begin * SPHGI_ROW * size, count, (char *)finder->x + (size_t)at * size,
        (char *)finder->y + (size_t)at * size, (char *)finder->z + (size_t)at * size);
}

void sphgi_stage_coordinates(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                             const struct sphgi_surroundings *around)
{
    int32_t at = 1;
    for (int32_t r = 0; r < around->ranges; at += around->count[r++])
        stage_rows(finder, neighbors, around->begin[r], around->count[r], at);
}

static struct sphgi_find find_of(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                                 int32_t begin, int32_t end)
{
    struct sphgi_find find = {.x = finder->x,
                              .y = finder->y,
                              .z = finder->z,
                              .targets = sphgi_target_row(neighbors, begin),
                              .target_count = end - begin,
                              .reach = neighbors->radius + neighbors->skin,
                              .slack = neighbors->sources.lattice.slack,
                              .periodic = neighbors->periodic,
                              .dimension = neighbors->dimension,
                              .scratch = finder->scratch,
                              .pack_order = finder->pack_order};
    memcpy(find.period, neighbors->period, sizeof find.period);
    return find;
}

/* Row of the source that target `place` is; -1: it is none. */
static int32_t own_row(const sphg_neighbors *neighbors, int32_t place)
{
    if (neighbors->same)
        return place;
    if (!neighbors->part_of)
        return -1;
    const int32_t target = ((const int32_t *)neighbors->targets.order.data)[place];
    return ((const int32_t *)neighbors->source_place.data)[target];
}

/* First row of the sources' cell that the targets' cell `cell` coincides with. */
static int32_t first_row_staged(const struct sphgi_surroundings *around, int32_t number)
{
    int32_t at = 1;
    for (int32_t r = 0; r < around->ranges; at += around->count[r++])
        if (number < at + around->count[r])
            return around->begin[r] + number - at;
    return -1;
}

int64_t sphgi_find_targets(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                           const struct sphgi_surroundings *around, const struct sphgi_runs *runs,
                           int32_t cell, int32_t begin, int32_t end, uint16_t *ids,
                           uint16_t *lengths)
{
    const struct sphgi_lattice *lattice = &neighbors->sources.lattice;
    struct sphgi_find find = find_of(finder, neighbors, begin, end);
    int32_t self[SPHGI_FIND_MOST];
    const int32_t staged = sphgi_staged_cell(lattice, around, cell);
    const int32_t first = neighbors->part_of ? first_row_staged(around, staged) : 0;
    for (int32_t k = begin; k < end; ++k) {
        const int32_t own = own_row(neighbors, k);
        self[k - begin] = own < 0 ? -1 : SPHGI_ID_STEP * (staged + own - first);
    }
    find.self = self;
    find.runs = runs->count;
    memcpy(find.run_begin, runs->begin, sizeof find.run_begin);
    memcpy(find.run_length, runs->length, sizeof find.run_length);
    return finder->passes->find(&find, ids, lengths);
}

/* ---- Clumps --------------------------------------------------------------------------------- */

/* Hands on what was found in the slice of `count` rows from row `begin`, staged from number 1 on.
 */
static void take_slice(const struct sphgi_finder *finder, struct sphgi_find *find, int32_t begin,
                       int32_t count, int32_t own, sphgi_take *take, void *data)
{
    const int32_t self =
        own >= begin && own < begin + count ? SPHGI_ID_STEP * (own - begin + 1) : -1;
    find->self = &self;
    find->runs = 1;
    find->run_begin[0] = 1;
    find->run_length[0] = count;
    uint32_t *rows = (uint32_t *)(void *)finder->ids;
    finder->passes->find(find, finder->ids, finder->lengths);
    const int32_t found = finder->lengths[0];
    for (int32_t k = found - 1; k >= 0; --k) /* in place: widening from behind */
        rows[k] = (uint32_t)(begin + finder->ids[k] / SPHGI_ID_STEP - 1);
    take(data, rows, found);
}

/* Rows of the staged run [number, number + length), range by range. */
void sphgi_find_wide(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                     const struct sphgi_surroundings *around, int32_t cell, int32_t target,
                     sphgi_take *take, void *data)
{
    struct sphgi_find find = find_of(finder, neighbors, target, target + 1);
    const int32_t own = own_row(neighbors, target);
    const struct sphgi_runs runs = sphgi_candidate_runs(&neighbors->sources.lattice, around, cell);
    for (int32_t run = 0; run < runs.count; ++run) {
        int32_t at = 1;
        for (int32_t r = 0; r < around->ranges; at += around->count[r++]) {
            int32_t from = sphgi_max32(at, runs.begin[run]);
            const int32_t end =
                sphgi_min32(at + around->count[r], runs.begin[run] + runs.length[run]);
            while (from < end) {
                const int32_t count = sphgi_min32(end - from, finder->room - 1);
                const int32_t row = around->begin[r] + from - at;
                stage_rows(finder, neighbors, row, count, 1);
                take_slice(finder, &find, row, count, own, take, data);
                from += count;
            }
        }
    }
}
