/* SPDX-License-Identifier: MIT */
#include "rows.h"
#include "fold.h"
#include "records.h"
#include "tables_by_radius.h"
#include "core/parallel.h"
#include <string.h>

enum {
    PACK_GRAIN = 4096, /* particles */
    ASKED_MOST = 4     /* arrays of rows that are asked for before they are read */
};

static size_t row_size(sphg_type type)
{
    return SPHGI_ROW * sphgi_size_of_type(type);
}

/* Rows are copied pair by pair; the one behind the last is the dummy. NaN where pairs are tested:
 * nobody is near. */
static void use_local_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t size = row_size(sweep->plan->type), position = row_size(n->position_type);
    char *dummy = w->rows.positions + SPHGI_TILE * position;
    if (w->gather.masked)
        memset(dummy, 0xff, position);
    else
        memcpy(dummy, (const char *)n->sources.rows.data + (size_t)n->source_count * position,
               position);
    for (int32_t k = 0; k < sweep->plan->row_count; ++k) {
        char *rows = w->rows.numbers + (size_t)k * (SPHGI_TILE + 1) * size;
        memset(rows + SPHGI_TILE * size, 0, size);
        w->rows.at[k] = rows;
    }
    w->gather.rows = w->rows.positions;
    w->gather.dummy = SPHGI_ID_STEP * SPHGI_TILE;
    w->rows.items = w->rows.own_items;
}

static void use_packed_rows(struct sphgi_worker *w)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t rows = (size_t)n->source_count + 1, size = row_size(sweep->plan->type);
    w->gather.rows = sphgi_reads_volumes(sweep) ? sweep->packed_positions : n->sources.rows.data;
    w->gather.dummy = (uint32_t)(SPHGI_ID_STEP * (rows - 1));
    w->rows.items = n->kind != SPHGI_HOST_LISTS ? n->sources.order.data : NULL;
    for (int32_t k = 0; k < sweep->plan->row_count; ++k) /* none where there are records */
        w->rows.at[k] = sweep->packed_rows ? sweep->packed_rows + (size_t)k * rows * size : NULL;
    w->both = w->gather; /* rows as the search left them hold the radii of the sources */
    w->both.rows = n->sources.rows.data;
    w->both.either = sphgi_is_superset(sweep);
    w->both.volumes = true;
    w->near = w->gather;
    w->near.all = false;
    w->near.masked = true;
}

void sphgi_use_rows(struct sphgi_worker *w)
{
    w->rows.local = !w->sweep->packed;
    if (w->rows.local)
        use_local_rows(w);
    else
        use_packed_rows(w);
    if (w->rows.local || w->sweep->records || !sphgi_rows_read(w->sweep))
        return;
    w->tile.also = w->rows.at[0];
    w->tile.also_arrays = sphgi_min32(w->sweep->plan->row_count, ASKED_MOST);
    w->tile.also_numbers = ((ptrdiff_t)w->sweep->set->neighbors->source_count + 1) * SPHGI_ROW;
}

/* ---- What the host has becomes rows --------------------------------------------------------- */

static void load_stream(const struct sphgi_sweep *sweep, int32_t number, const int32_t *order,
                        int64_t begin, int64_t end, char *rows)
{
    const struct sphgi_stream *stream = &sweep->set->streams[number];
    sweep->passes->load_rows(&stream->columns, order, begin, end, stream->first,
                             stream->columns.count ? stream->count : 0, rows);
}

bool sphgi_fill_rows(const struct sphgi_sweep *sweep, const int32_t *order, int64_t begin,
                     int64_t end, char *to, size_t array)
{
    const struct sphgi_plan *plan = sweep->plan;
    bool good = true;
    for (int32_t k = 0; k < plan->field_count; ++k) {
        const struct sphgi_field_plan *field = &plan->fields[k];
        if (field->fold)
            good &= sphgi_fold_rows(sweep, field, order, begin, end,
                                    to + (size_t)field->folded_row * array, array);
        for (int32_t s = 0; s < field->rows; ++s)
            load_stream(sweep, field->stream + s, order, begin, end,
                        to + (size_t)(field->row + s) * array);
        if (field->volume_row >= 0)
            load_stream(sweep, field->volume_stream, order, begin, end,
                        to + (size_t)field->volume_row * array);
        if (field->coefficient_row >= 0)
            load_stream(sweep, field->coefficient_stream, order, begin, end,
                        to + (size_t)field->coefficient_row * array);
        for (int32_t s = 0; s < field->lent_rows; ++s)
            load_stream(sweep, field->lent_stream + s, order, begin, end,
                        to + (size_t)(field->lent_row + s) * array);
    }
    for (int32_t k = 0; plan->correction_row >= 0 && k < sphgi_correction_rows(plan); ++k)
        load_stream(sweep, plan->correction_stream + k, order, begin, end,
                    to + (size_t)(plan->correction_row + k) * array);
    if (plan->density_row >= 0)
        load_stream(sweep, plan->density_stream, order, begin, end,
                    to + (size_t)plan->density_row * array);
    return good;
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
    const size_t size = row_size(type), rows = (size_t)n->source_count + 1;
    (void)worker;
    if (sweep->reads_records && packing->rows &&
        !sphgi_fill_records(sweep, packing->order, begin, end,
                            packing->rows + (size_t)begin * sphgi_record_size(sweep)))
        atomic_store(&packing->bad_volume, true);
    if (!sweep->reads_records && sphgi_rows_read(sweep) &&
        !sphgi_fill_rows(sweep, packing->order, begin, end, packing->rows + (size_t)begin * size,
                         rows * size))
        atomic_store(&packing->bad_volume, true);
    if (!sweep->reads_records && sphgi_rows_read(sweep) && sweep->plan->radius_row >= 0)
        sphgi_fill_radii(sweep, packing->order, begin, end,
                         packing->rows +
                             ((size_t)sweep->plan->radius_row * rows + (size_t)begin) * size);
    if (sphgi_rows_read(sweep) && sweep->plan->classic && sweep->plan->both_sides)
        sphgi_scale_tables(sweep, packing->order, begin, end,
                           packing->rows +
                               ((size_t)sweep->plan->correction_row * rows + (size_t)begin) * size,
                           rows * size);
    if (packing->positions &&
        !sweep->position_passes->put_volumes[type == SPHG_F64](
            n->sources.rows.data, &sweep->set->volume, sphgi_volume_unit(sweep), packing->order,
            begin, end - begin, packing->positions + (size_t)begin * row_size(n->position_type)))
        atomic_store(&packing->bad_volume, true);
}

static char *put_dummies(const struct sphgi_sweep *sweep, char *arrays, char *positions)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t row = row_size(sweep->plan->type), rows = (size_t)n->source_count + 1;
    for (size_t k = 0; !sweep->reads_records && k < (size_t)sphgi_rows_read(sweep); ++k)
        memset(arrays + ((k + 1) * rows - 1) * row, 0, row);
    if (positions) {
        const size_t position = row_size(n->position_type), dummy = (rows - 1) * position;
        memcpy(positions + dummy, (const char *)n->sources.rows.data + dummy, position);
    }
    return arrays;
}

/* Positions with volumes, where there are volumes, and so many bytes of fields. Returns all bytes.
 */
static size_t place_rows(struct packing *packing, char *base, size_t fields)
{
    const struct sphgi_sweep *sweep = packing->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    struct sphgi_layout layout = {base, 0};
    const size_t rows = sweep->volumes ? (size_t)n->source_count + 1 : 0;
    packing->positions = sphgi_place(&layout, rows, row_size(n->position_type));
    packing->rows = sphgi_place(&layout, fields, 1);
    return layout.used;
}

/* Positions with volumes, and fields as rows in storage order, or records in their place. */
sphg_result sphgi_pack(struct sphgi_sweep *sweep, bool *bad_volume)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t rows = (size_t)n->source_count + 1;
    const bool positions = sphgi_reads_volumes(sweep), arrays = sphgi_rows_read(sweep);
    size_t size = (size_t)sphgi_rows_read(sweep) * rows * row_size(sweep->plan->type);
    if (sweep->reads_records && !arrays)
        sweep->records = n->sources.rows.data;
    if (!positions && !arrays)
        return SPHG_OK;
    if (sweep->may_read_records && sphgi_record_bytes(sweep) > size)
        size = sphgi_record_bytes(sweep);
    struct packing packing = {.sweep = sweep,
                              .order = n->kind == SPHGI_HOST_LISTS ? NULL : n->sources.order.data};
    if (!sphgi_reserve(&sweep->context->allocator, &sweep->context->packed,
                       place_rows(&packing, NULL, size), 1))
        return SPHG_ERROR_MEMORY;
    place_rows(&packing, sweep->context->packed.data, size);
    packing.positions = positions ? packing.positions : NULL;
    packing.rows = arrays ? packing.rows : NULL;
    atomic_store(&packing.bad_volume, false);
    sphgi_parallel_for(sweep->context, pack_task, &packing, n->source_count, PACK_GRAIN);
    sweep->packed_positions = packing.positions;
    sweep->packed_rows = put_dummies(sweep, packing.rows, packing.positions);
    if (sweep->reads_records && arrays)
        sweep->records = sphgi_put_dummy_record(sweep, packing.rows);
    *bad_volume |= atomic_load(&packing.bad_volume);
    return SPHG_OK;
}
