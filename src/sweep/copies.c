/* SPDX-License-Identifier: MIT */
#include "copies.h"
#include "core/view.h"
#include "rows.h"
#include <string.h>

/* NULL: sources stand in the order of the host. */
static const int32_t *order_of(const sphg_neighbors *n)
{
    return n->kind != SPHGI_HOST_LISTS ? n->sources.order.data : NULL;
}

void sphgi_ask_for_numbering(const struct sphgi_worker *w, const uint32_t *ids, int32_t count,
                             int32_t stride)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const size_t size = SPHGI_ROW / SPHGI_ID_STEP * sphgi_size_of_type(n->position_type);
    const char *position = n->sources.rows.data;
    const int32_t *order = order_of(n);
    for (int32_t k = 0; k < count; ++k, ids += stride) {
        __builtin_prefetch(position + *ids * size);
        __builtin_prefetch(order + *ids / SPHGI_ID_STEP);
    }
    __asm__ volatile(""); /* GCC takes a function that only prefetches for one without effect */
}

void sphgi_number_copies(const struct sphgi_worker *w, struct sphgi_copies *copies, uint32_t *ids,
                         int32_t count, int32_t at)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    const uint32_t sources = (uint32_t)n->source_count;
    const int32_t *order = order_of(n);
    int32_t used = 0;
    for (int32_t k = 0; k < count; ++k) {
        const uint32_t row = ids[k] / SPHGI_ID_STEP;
        copies->rows[used] = row;
        ids[k] = row < sources ? (uint32_t)(at + used) * SPHGI_ID_STEP : w->gather.dummy;
        used += row < sources;
    }
    for (int32_t k = 0; k < used; ++k)
        copies->items[k] = order ? order[copies->rows[k]] : (int32_t)copies->rows[k];
    copies->count = used;
}

void sphgi_ask_for_copying(const struct sphgi_worker *w, const struct sphgi_copies *copies)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const struct sphgi_passes *p = w->passes;
    if (sweep->volumes)
        p->ask_for_lanes(copies->count, &sweep->set->volume, copies->items, false);
    for (int32_t k = 0; k < plan->field_count && sphgi_rows_read(sweep); ++k)
        p->ask_for_lanes(copies->count, &sweep->set->streams[plan->fields[k].stream].columns,
                         copies->items, false);
}

static void copy_positions(const char *from, const struct sphgi_copies *copies, sphg_type type,
                           char *to)
{
    enum { F32 = SPHGI_ROW * sizeof(float), F64 = SPHGI_ROW * sizeof(double) };
    const uint32_t *row = copies->rows;
    if (type == SPHG_F64)
        for (int32_t k = 0; k < copies->count; ++k)
            memcpy(to + (size_t)k * F64, from + (size_t)row[k] * F64, F64);
    else
        for (int32_t k = 0; k < copies->count; ++k)
            memcpy(to + (size_t)k * F32, from + (size_t)row[k] * F32, F32);
}

void sphgi_copy_rows(struct sphgi_worker *w, const struct sphgi_copies *copies, int32_t at)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const sphg_type type = sweep->plan->type;
    const size_t row = SPHGI_ROW * sphgi_size_of_type(type);
    char *positions =
        w->rows.positions + (size_t)at * SPHGI_ROW * sphgi_size_of_type(n->position_type);
    copy_positions(n->sources.rows.data, copies, n->position_type, positions);
    if (sweep->volumes && !sweep->position_passes->put_volumes[type == SPHG_F64](
                              positions, &sweep->set->volume, sphgi_volume_unit(sweep),
                              copies->items, 0, copies->count, positions))
        w->tally->bad_volume = true;
    if (sphgi_rows_read(sweep) &&
        !sphgi_fill_rows(sweep, copies->items, 0, copies->count, w->rows.numbers + (size_t)at * row,
                         (size_t)(SPHGI_TILE + 1) * row))
        w->tally->bad_volume = true;
}

void sphgi_make_local(struct sphgi_worker *w, uint32_t *ids, int32_t count, int32_t at)
{
    struct sphgi_copies *copies = &w->rows.copies[SPHGI_MIXED_MOST];
    sphgi_number_copies(w, copies, ids, count, at);
    sphgi_copy_rows(w, copies, at);
    memcpy(w->rows.own_items + at, copies->items, (size_t)copies->count * sizeof(int32_t));
}
