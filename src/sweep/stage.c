#include "stage.h"
#include "core/parallel.h"
#include <math.h>
#include <string.h>

enum { PACK_GRAIN = 4096 /* particles */ };

static size_t row_size(sphg_type type)
{
    return SPHGI_ROW * sphgi_size_of_type(type);
}

/* Rows of one stream around the block, behind a dummy row of zeros. */
static void stage_stream(struct sphgi_worker *w, const struct sphgi_surroundings *around,
                         int32_t number, char *to)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const struct sphgi_stream *stream = &sweep->set->streams[number];
    const size_t size = row_size(sweep->plan->type);
    const char *packed = NULL;
    if (sweep->packed)
        packed = sweep->packed_rows + (size_t)number * ((size_t)n->source_count + 1) * size;
    w->rows[number] = to;
    memset(to, 0, size);
    to += size;
    for (int32_t r = 0; r < around->ranges; ++r) {
        const size_t count = (size_t)around->count[r];
        if (packed)
            memcpy(to, packed + (size_t)around->begin[r] * size, count * size);
        else
            w->passes->load_rows(&stream->columns, n->sources.order.data, around->begin[r],
                                 around->begin[r] + around->count[r], stream->first,
                                 stream->columns.count ? stream->count : 0, to);
        to += count * size;
    }
}

/* The sources behind the staged numbers. */
static void stage_items(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const int32_t *order = w->sweep->set->neighbors->sources.order.data;
    int32_t *to = (int32_t *)(void *)w->staged_items;
    *to++ = -1;
    for (int32_t r = 0; r < around->ranges; ++r)
        for (int32_t k = 0; k < around->count[r]; ++k)
            *to++ = order[around->begin[r] + k];
    w->items = (const int32_t *)(const void *)w->staged_items;
}

/* Positions with their volumes; packed rows were checked when they were packed. */
static void stage_positions(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = row_size(n->position_type);
    const char *ready = !sweep->volumes ? n->sources.rows.data
                        : sweep->packed ? sweep->packed_positions
                                        : NULL;
    char *to = w->staged_positions;
    memset(to, 0, size);
    to += size;
    for (int32_t r = 0; r < around->ranges; ++r) {
        const size_t count = (size_t)around->count[r];
        if (ready)
            memcpy(to, ready + (size_t)around->begin[r] * size, count * size);
        else if (!sweep->position_passes->stage[sweep->plan->type == SPHG_F64](
                     n->sources.rows.data, &sweep->set->volume, sphgi_volume_unit(sweep),
                     n->sources.order.data, around->begin[r], around->count[r], to))
            w->tally->bad_volume = true;
        to += count * size;
    }
}

/* NaN: nobody is near. What is read of it is dropped, which costs more than a row that is far. */
static void make_dummy(char *row, sphg_type type)
{
    memset(row, 0xff, row_size(type));
}

/* Moves the dummy away from everything around the block, so that padding has no weight. False: its
 * distance, squared, could leave the range of the type. */
static bool move_away(struct sphgi_worker *w, double reach)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const bool wide = sweep->set->neighbors->position_type == SPHG_F64;
    const double most = sweep->plan->type == SPHG_F64 ? 0x1p500 : 0x1p60;
    const double near = wide
                            ? ((const double *)(const void *)w->staged_positions)[SPHGI_ROW]
                            : (double)((const float *)(const void *)w->staged_positions)[SPHGI_ROW];
    const double distance = fmax(64 * reach, fabs(near));
    const double far = near > 0 ? near - distance : near + distance;
    if (wide)
        *(double *)(void *)w->staged_positions = far;
    else
        *(float *)(void *)w->staged_positions = (float)far;
    return distance < most;
}

void sphgi_stage_block(struct sphgi_worker *w, const struct sphgi_surroundings *around)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t stream_size = (size_t)around->staged * row_size(sweep->plan->type);
    stage_positions(w, around);
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s)
        stage_stream(w, around, s, w->staged_rows + (size_t)s * stream_size);
    if (sweep->pairs)
        stage_items(w, around);
    w->gather.rows = w->staged_positions;
    w->gather.dummy = 0;
    w->gather.guarded = w->gather.periodic || w->gather.superset || around->staged < 2 ||
                        !move_away(w, n->radius + n->skin);
    if (w->gather.guarded)
        make_dummy(w->staged_positions, n->position_type);
    w->local = false;
}

/* Rows are copied pair by pair; the one behind the last is the dummy. */
void sphgi_use_local_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_type type = sweep->set->neighbors->position_type;
    const size_t size = row_size(sweep->plan->type);
    make_dummy(w->staged_positions + SPHGI_TILE * row_size(type), type);
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        char *rows = w->staged_rows + (size_t)s * (SPHGI_TILE + 1) * size;
        memset(rows + SPHGI_TILE * size, 0, size);
        w->rows[s] = rows;
    }
    w->gather.rows = w->staged_positions;
    w->gather.dummy = SPHGI_ID_STEP * SPHGI_TILE;
    w->gather.guarded = true;
    w->items = (const int32_t *)(const void *)w->local_items;
    w->local = true;
}

void sphgi_use_packed_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const size_t rows = (size_t)sweep->set->neighbors->source_count + 1;
    const size_t size = row_size(sweep->plan->type);
    w->gather.rows =
        sweep->volumes ? sweep->packed_positions : sweep->set->neighbors->sources.rows.data;
    w->gather.dummy = (uint32_t)(SPHGI_ID_STEP * (rows - 1));
    w->gather.guarded = true;
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s)
        w->rows[s] = sweep->packed_rows + (size_t)s * rows * size;
}

/* ---- Packing -------------------------------------------------------------------------------- */

struct packing {
    const struct sphgi_sweep *sweep;
    char *rows, *positions;
    const int32_t *order; /* NULL: rows stand in the order of the host */
    atomic_bool bad_volume;
};

static void pack_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct packing *packing = data;
    const struct sphgi_sweep *sweep = packing->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const sphg_type type = sweep->plan->type;
    const size_t size = row_size(type);
    (void)worker;
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        const struct sphgi_stream *stream = &sweep->set->streams[s];
        const size_t at = (size_t)s * ((size_t)n->source_count + 1) + (size_t)begin;
        sweep->passes->load_rows(&stream->columns, packing->order, begin, end, stream->first,
                                 stream->columns.count ? stream->count : 0,
                                 packing->rows + at * size);
    }
    if (packing->positions &&
        !sweep->position_passes->stage[type == SPHG_F64](
            n->sources.rows.data, &sweep->set->volume, sphgi_volume_unit(sweep), packing->order,
            begin, end - begin, packing->positions + (size_t)begin * row_size(n->position_type)))
        atomic_store(&packing->bad_volume, true);
}

/* Positions with volumes, and fields, as rows in storage order. */
sphg_result sphgi_pack(struct sphgi_sweep *sweep, bool *bad_volume)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const sphg_type type = sweep->plan->type;
    const size_t rows = (size_t)n->source_count + 1, streams = (size_t)sweep->plan->stream_count;
    const bool positions = sweep->volumes;
    const size_t positions_size =
        positions ? sphgi_round_up(rows * row_size(n->position_type), SPHGI_ALIGNMENT) : 0;
    if (!positions && !streams)
        return SPHG_OK;
    if (!sphgi_reserve(&sweep->context->allocator, &sweep->context->packed,
                       positions_size + streams * rows * row_size(type), 1))
        return SPHG_ERROR_MEMORY;
    char *memory = sweep->context->packed.data;
    struct packing packing = {.sweep = sweep,
                              .positions = positions ? memory : NULL,
                              .rows = memory + positions_size,
                              .order = n->kind == SPHGI_HOST_LISTS ? NULL : n->sources.order.data};
    atomic_store(&packing.bad_volume, false);
    sphgi_parallel_for(sweep->context, pack_task, &packing, n->source_count, PACK_GRAIN);
    for (size_t s = 0; s < streams; ++s) /* the dummy rows */
        memset(packing.rows + ((s + 1) * rows - 1) * row_size(type), 0, row_size(type));
    if (positions)
        make_dummy(memory + (rows - 1) * row_size(n->position_type), n->position_type);
    sweep->packed_positions = packing.positions;
    sweep->packed_rows = packing.rows;
    *bad_volume |= atomic_load(&packing.bad_volume);
    return SPHG_OK;
}
