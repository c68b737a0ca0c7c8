#include "clean.h"
#include "view.h"
#include <string.h>

static struct sphgi_cleaning cleaning_of(const struct sphgi_worker *w, int32_t target)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    return (struct sphgi_cleaning){.mask = n->lists.index_mask ? (uint32_t)n->lists.index_mask
                                                               : UINT32_MAX,
                                   .sources = (uint32_t)n->source_count,
                                   .self = n->part_of ? (uint32_t)target : UINT32_MAX};
}

/* Remembers the first target whose list holds what is no source, and what that is. */
static void note_bad_index(struct sphgi_tally *tally, int32_t target, const int32_t *list,
                           int32_t count, const struct sphgi_cleaning *how)
{
    if (tally->bad_target >= 0 && target >= tally->bad_target)
        return;
    tally->bad_target = target;
    for (int32_t k = count - 1; k >= 0; --k)
        if (((uint32_t)list[k] & how->mask) >= how->sources)
            tally->bad_index = (int32_t)((uint32_t)list[k] & how->mask); /* -1 reads as -1 */
}

int32_t sphgi_clean_list(struct sphgi_worker *w, int32_t target, const int32_t *list, int32_t count,
                         uint32_t *clean)
{
    const struct sphgi_cleaning how = cleaning_of(w, target);
    int32_t kept = 0;
    bool bad = false;
    for (int32_t k = 0; k < count; ++k) {
        const uint32_t id = (uint32_t)list[k] & how.mask;
        clean[kept] = id;
        bad |= id >= how.sources;
        kept += id < how.sources && id != how.self;
    }
    if (bad)
        note_bad_index(w->tally, target, list, count, &how);
    return kept;
}

void sphgi_clean_piece(struct sphgi_worker *w)
{
    struct sphgi_piece *piece = &w->piece;
    const int32_t *target = sphgi_targets(w);
    for (int32_t l = 0; l < w->targets; ++l) {
        const int32_t *list = piece->ids[l];
        const struct sphgi_cleaning how = cleaning_of(w, target[l]);
        uint32_t *clean = (uint32_t *)(void *)w->clean_ids + piece->begin[l];
        if (w->passes->clean_ids(list, piece->count[l], &how, clean))
            note_bad_index(w->tally, target[l], list, piece->count[l], &how);
        piece->ids[l] = clean;
    }
}

void sphgi_make_local(struct sphgi_worker *w, uint32_t *rows, int32_t count, int32_t at)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t position = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    const size_t row = SPHGI_ROW * sphgi_size_of_type(sweep->plan->type);
    const bool searched = n->kind == SPHGI_SEARCHED;
    char *positions = w->staged_positions + (size_t)at * position;
    int32_t *items = (int32_t *)(void *)w->local_items + at;
    for (int32_t k = 0; k < count; ++k) {
        memcpy(positions + (size_t)k * position,
               (const char *)n->sources.rows.data + (size_t)rows[k] * position, position);
        items[k] = searched ? ((const int32_t *)n->sources.order.data)[rows[k]] : (int32_t)rows[k];
    }
    if (!sweep->position_passes->stage[sweep->plan->type == SPHG_F64](
            positions, &sweep->set->volume, sphgi_volume_unit(sweep), items, 0, count, positions))
        w->tally->bad_volume = true;
    for (int32_t s = 0; s < sweep->plan->stream_count; ++s) {
        const struct sphgi_stream *stream = &sweep->set->streams[s];
        char *to = w->staged_rows + ((size_t)s * (size_t)(SPHGI_PIECE + 1) + (size_t)at) * row;
        w->passes->load_rows(&stream->columns, items, 0, count, stream->first,
                             stream->columns.count ? stream->count : 0, to);
    }
    for (int32_t k = 0; k < count; ++k)
        rows[k] = (uint32_t)(at + k);
}
