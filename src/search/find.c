#include "find.h"
#include <string.h>

/* ---- Scratch -------------------------------------------------------------------------------- */

/* Scratch depends on the number of sources alone, not on how crowded they are: memory that is not
 * needed is not touched. A short period stages sources several times. */
int32_t sphgi_finder_room(const sphg_neighbors *neighbors)
{
    const int32_t most = SPHGI_STAGED_MOST - 1;
    return 1 + (neighbors->periodic ? most : sphgi_min32(neighbors->source_count, most));
}

struct layout {
    size_t coordinates, scratch, ids, lengths, woven, total;
};

static struct layout layout_of(const sphg_neighbors *neighbors, int32_t room)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    const size_t padded = sphgi_round_up((size_t)room + (size_t)2 * SPHGI_PAD, SPHGI_ALIGNMENT);
    struct layout layout = {.coordinates = padded * size};
    const size_t candidates = padded + (size_t)2 * SPHGI_ALIGNMENT;
    layout.scratch = sphgi_round_up(candidates * (3 * size + 2 + 1), SPHGI_ALIGNMENT);
    const size_t targets = (size_t)sphgi_min32(SPHGI_FIND_MOST, neighbors->target_count);
    const size_t batch = targets * (padded + SPHGI_PAD) + SPHGI_PAD;
    const size_t units = SPHGI_UNITS_MOST > batch ? SPHGI_UNITS_MOST + SPHGI_PAD : batch;
    const size_t wide = padded * sizeof(uint32_t), narrow = units * sizeof(uint16_t);
    layout.ids = sphgi_round_up(wide > narrow ? wide : narrow, SPHGI_ALIGNMENT);
    layout.lengths = SPHGI_ALIGNMENT;
    layout.woven = SPHGI_WOVEN_MOST * sizeof(uint16_t);
    layout.total =
        3 * layout.coordinates + layout.scratch + layout.ids + layout.lengths + layout.woven;
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
    struct sphgi_finder finder = {.room = room};
    finder.passes = sphgi_passes_of(context, neighbors->position_type);
    finder.x = next;
    finder.y = next + layout.coordinates;
    finder.z = next + 2 * layout.coordinates;
    next += 3 * layout.coordinates;
    finder.find = (struct sphgi_find){.x = finder.x,
                                      .y = finder.y,
                                      .z = finder.z,
                                      .reach = neighbors->radius + neighbors->skin,
                                      .slack = neighbors->sources.lattice.slack,
                                      .periodic = neighbors->periodic,
                                      .scratch = next,
                                      .pack_order = context->pack_order,
                                      .pack_bytes = context->pack_bytes};
    memcpy(finder.find.period, neighbors->period, sizeof finder.find.period);
    finder.ids = (uint16_t *)(void *)(next += layout.scratch);
    finder.lengths = (uint16_t *)(void *)(next += layout.ids);
    finder.woven = (uint16_t *)(void *)(next + layout.lengths);
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

/* NaN behind the last staged source: passes read whole vectors, and no target is near it. */
static void end_staging(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                        int32_t at)
{
    const size_t size = sphgi_size_of_type(neighbors->position_type);
    char *const coordinates[] = {finder->x, finder->y, finder->z};
    for (int32_t a = 0; a < 3; ++a)
        memset(coordinates[a] + (size_t)at * size, 0xff, (size_t)2 * SPHGI_PAD * size);
}

void sphgi_prefetch_rows(const sphg_neighbors *neighbors, const struct sphgi_surroundings *around)
{
    enum { MOST = 4096 }; /* rows: what the second-level cache takes without pain */
    const size_t size = SPHGI_ROW * sphgi_size_of_type(neighbors->position_type);
    const char *rows = neighbors->sources.rows.data;
    for (int32_t r = 0; r < around->ranges && around->staged <= MOST; ++r) {
        const char *row = rows + (size_t)around->begin[r] * size;
        const char *end = row + (size_t)around->count[r] * size;
        for (; row < end; row += SPHGI_ALIGNMENT)
            __builtin_prefetch(row, 0, 2);
    }
    __asm__ volatile(""); /* GCC takes a function that only prefetches for one without effect */
}

void sphgi_stage_coordinates(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                             const struct sphgi_surroundings *around)
{
    int32_t at = 1;
    for (int32_t r = 0; r < around->ranges; at += around->count[r++])
        stage_rows(finder, neighbors, around->begin[r], around->count[r], at);
    end_staging(finder, neighbors, at);
}

/* Staged number of a target of that cell, if it is a source, or -1. Targets that are part of the
 * sources come first among them: in a cell, both stand in the order of their numbers. */
static int32_t staged_self(const sphg_neighbors *neighbors, const struct sphgi_surroundings *around,
                           const struct sphgi_runs *runs, int32_t cell, int32_t target)
{
    return neighbors->part_of ? runs->own + target - around->start[cell] : -1;
}

int64_t sphgi_find_targets(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                           const struct sphgi_surroundings *around, const struct sphgi_runs *runs,
                           int32_t cell, int32_t begin, int32_t end, uint16_t *ids,
                           uint16_t *lengths)
{
    return finder->passes->find(&finder->find, runs, sphgi_target_row(neighbors, begin),
                                end - begin, staged_self(neighbors, around, runs, cell, begin), ids,
                                lengths);
}

/* ---- Clumps --------------------------------------------------------------------------------- */

/* A target of a clump, and the staged numbers of a slice of its candidates. */
struct slice {
    const char *target;
    int32_t row;   /* of the first one */
    int32_t begin; /* its staged number among all; in the slice it is 1 */
    int32_t count;
    int32_t self; /* among all, or -1 */
};

/* Hands on what is found in a slice. */
static void take_slice(const struct sphgi_finder *finder, const struct slice *slice,
                       sphgi_take *take, void *data)
{
    const bool inside = slice->self >= slice->begin && slice->self < slice->begin + slice->count;
    const struct sphgi_runs runs = {
        .count = 1, .candidates = slice->count, .own = 1, .begin = {1}, .length = {slice->count}};
    uint32_t *rows = (uint32_t *)(void *)finder->ids;
    finder->passes->find(&finder->find, &runs, slice->target, 1,
                         inside ? slice->self - slice->begin + 1 : -1, finder->ids,
                         finder->lengths);
    const int32_t found = finder->lengths[0];
    for (int32_t k = found - 1; k >= 0; --k) /* in place: widening from behind */
        rows[k] = (uint32_t)(slice->row + finder->ids[k] / SPHGI_ID_STEP - 1);
    take(data, rows, found);
}

/* Rows of the staged run [number, number + length), range by range. */
void sphgi_find_wide(const struct sphgi_finder *finder, const sphg_neighbors *neighbors,
                     const struct sphgi_surroundings *around, int32_t cell, int32_t target,
                     sphgi_take *take, void *data)
{
    struct sphgi_runs runs;
    sphgi_candidate_runs(&neighbors->sources.lattice, around, cell, &runs);
    struct slice slice = {.target = sphgi_target_row(neighbors, target),
                          .self = staged_self(neighbors, around, &runs, cell, target)};
    for (int32_t run = 0; run < runs.count; ++run) {
        int32_t at = 1;
        for (int32_t r = 0; r < around->ranges; at += around->count[r++]) {
            const int32_t end =
                sphgi_min32(at + around->count[r], runs.begin[run] + runs.length[run]);
            slice.begin = sphgi_max32(at, runs.begin[run]);
            for (; slice.begin < end; slice.begin += slice.count) {
                slice.count = sphgi_min32(end - slice.begin, finder->room - 1);
                slice.row = around->begin[r] + slice.begin - at;
                stage_rows(finder, neighbors, slice.row, slice.count, 1);
                end_staging(finder, neighbors, 1 + slice.count);
                take_slice(finder, &slice, take, data);
            }
        }
    }
}
