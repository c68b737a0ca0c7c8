#include "rows.h"
#include "core/parallel.h"
#include <string.h>

enum { PACK_GRAIN = 4096 /* particles */ };

static size_t row_size(sphg_type type)
{
    return SPHGI_ROW * sphgi_size_of_type(type);
}

/* NaN: nobody is near. */
static void make_dummy(char *row, sphg_type type)
{
    memset(row, 0xff, row_size(type));
}

/* Rows are copied pair by pair; the one behind the last is the dummy. */
static void use_local_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_type type = sweep->set->neighbors->position_type;
    const size_t size = row_size(sweep->plan->type);
    make_dummy(w->local_positions + SPHGI_TILE * row_size(type), type);
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        char *rows = w->local_rows + (size_t)s * (SPHGI_TILE + 1) * size;
        memset(rows + SPHGI_TILE * size, 0, size);
        w->rows[s] = rows;
    }
    w->gather.rows = w->local_positions;
    w->gather.dummy = SPHGI_ID_STEP * SPHGI_TILE;
    w->gather.guarded = true;
    w->items = (const int32_t *)(const void *)w->local_items;
}

static void use_packed_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t rows = (size_t)n->source_count + 1, size = row_size(sweep->plan->type);
    w->gather.rows = sweep->volumes ? sweep->packed_positions : n->sources.rows.data;
    w->gather.dummy = (uint32_t)(SPHGI_ID_STEP * (rows - 1));
    w->items = n->kind != SPHGI_HOST_LISTS ? n->sources.order.data : NULL;
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s)
        w->rows[s] = sweep->packed_rows + (size_t)s * rows * size;
}

void sphgi_use_rows(struct sphgi_worker *w)
{
    w->local = !w->sweep->packed;
    if (w->local)
        use_local_rows(w);
    else
        use_packed_rows(w);
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
    if (positions) {
        const size_t row = row_size(n->position_type), dummy = (rows - 1) * row;
        memcpy(memory + dummy, (const char *)n->sources.rows.data + dummy, row);
    }
    sweep->packed_positions = packing.positions;
    sweep->packed_rows = packing.rows;
    *bad_volume |= atomic_load(&packing.bad_volume);
    return SPHG_OK;
}
