/* A group of targets from its pairs to its results: pieces are filled, summed, finished. */
#include "worker.h"
#include "clean.h"
#include "corrections.h"
#include "finish.h"
#include "sums.h"
#include "view.h"
#include <string.h>

static void empty_piece(struct sphgi_worker *w)
{
    w->regular = false;
    w->piece.parts = 0;
    w->piece.begin[0] = 0;
}

/* The lanes from `first` on. Those without a target repeat one: they are read like the others, and
 * never written. */
static void put_to_work(struct sphgi_worker *w, int32_t first)
{
    struct sphgi_group *group = &w->group;
    w->first = first;
    w->targets = group->lanes - first;
    w->width = (int32_t)sphgi_round_up((size_t)w->targets, (size_t)w->passes->lanes);
    for (int32_t l = group->lanes; l < first + w->width; ++l) {
        group->target[l] = group->target[first];
        group->place[l] = group->place[first];
    }
}

static void begin(struct sphgi_worker *w)
{
    put_to_work(w, w->summed);
    w->targets_loaded = false;
    w->pieces = 0;
    if (w->sweep->pairs)
        memset(w->written + w->first, 0, (size_t)w->targets * sizeof w->written[0]);
    w->summing = w->sweep->steps & (SPHGI_SUM_MOMENTS | SPHGI_SUM_FIELDS);
    if (w->coefficients_first) {
        if (w->summing & SPHGI_SUM_MOMENTS)
            w->summing = SPHGI_SUM_MOMENTS;
        else
            sphgi_load_corrections(w);
    }
}

void sphgi_group_begin(struct sphgi_worker *w)
{
    empty_piece(w);
    w->touched = 0;
    begin(w);
}

/* One part of the piece: pairs of one lane, at most what is left of it. */
static void add_part(struct sphgi_worker *w, int32_t lane, const void *ids, int32_t count)
{
    struct sphgi_piece *piece = &w->piece;
    const int32_t part = piece->parts++;
    piece->ids[part] = ids;
    piece->lane[part] = lane;
    piece->count[part] = count;
    piece->fresh[part] = !(w->touched >> lane & 1);
    w->touched |= 1u << lane;
    piece->begin[part + 1] = piece->begin[part] + ((count + w->pad - 1) & -w->pad);
}

static void gather(struct sphgi_worker *w, int32_t first, bool wide)
{
    w->piece.wide = wide;
    w->sweep->position_passes->gather[w->sweep->plan->type == SPHG_F64](
        &w->gather, w->group.x + w->first, &w->piece, first, w->masked_ids);
}

static int32_t room_of(struct sphgi_worker *w, int64_t wanted)
{
    struct sphgi_piece *piece = &w->piece;
    const int32_t room = SPHGI_PIECE - piece->begin[piece->parts];
    const bool fits = piece->parts < SPHGI_LANES_MOST && wanted <= room;
    if (!fits && piece->parts) {
        sphgi_evaluate_piece(w);
        empty_piece(w);
        return SPHGI_PIECE;
    }
    return room;
}

/* Ids in the host's numbers, or in those of rows: cleaned, and copied if rows are local. */
static void add_listed(struct sphgi_worker *w, int32_t lane, const void *ids, int64_t count)
{
    const sphg_neighbors *n = w->sweep->set->neighbors;
    while (count > 0) {
        const int32_t part = (int32_t)(count < SPHGI_PIECE ? count : SPHGI_PIECE);
        room_of(w, part);
        const int32_t at = w->piece.begin[w->piece.parts];
        uint32_t *clean = (uint32_t *)(void *)w->clean_ids + at;
        int32_t kept = part;
        if (n->kind == SPHGI_HOST_LISTS)
            kept = sphgi_clean_list(w, sphgi_targets(w)[lane], ids, part, clean);
        else
            memcpy(clean, ids, (size_t)part * sizeof *clean);
        if (w->local)
            sphgi_make_local(w, clean, kept, at);
        for (int32_t k = 0; k < kept; ++k)
            clean[k] *= SPHGI_ID_STEP;
        const int32_t padded = (int32_t)sphgi_round_up((size_t)kept, SPHGI_PAD);
        for (int32_t k = kept; k < padded; ++k)
            clean[k] = w->gather.dummy;
        if (kept) {
            add_part(w, lane, clean, kept);
            gather(w, w->piece.parts - 1, true);
        }
        ids = (const char *)ids + (size_t)part * sizeof(int32_t);
        count -= part;
    }
}

void sphgi_group_add(struct sphgi_worker *w, int32_t lane, const void *ids, int64_t count,
                     bool wide)
{
    if (wide) {
        add_listed(w, lane, ids, count);
        return;
    }
    while (count > 0) {
        const int32_t room = room_of(w, count);
        const int32_t part = (int32_t)(count < room ? count : room);
        add_part(w, lane, ids, part);
        gather(w, w->piece.parts - 1, false);
        ids = (const char *)ids + (size_t)part * sizeof(uint16_t);
        count -= part;
    }
}

/* Sums [first, first + count); lanes that saw no pair have none. */
static void reduce(struct sphgi_worker *w, int32_t first, int32_t count)
{
    const int32_t lanes = w->passes->lanes;
    if (w->touched != (1u << lanes) - 1)
        for (int32_t l = 0; l < lanes; ++l)
            if (!(w->touched >> l & 1))
                w->passes->clear_partial(sphgi_partial(w, first), count, l);
    w->passes->reduce(sphgi_partial(w, first), count, sphgi_lane(w, w->reduced, first));
}

/* After all pairs were added: is another round needed? Classic, corrections and fields in one
 * sweep: the first round gives the coefficients. If one piece held everything, the second round
 * reads it again by itself. */
bool sphgi_group_again(struct sphgi_worker *w)
{
    const bool rest = w->piece.parts > 0;
    if (rest)
        sphgi_evaluate_piece(w);
    const bool first_round = w->coefficients_first && (w->sweep->steps & SPHGI_SUM_MOMENTS) &&
                             w->summing == SPHGI_SUM_MOMENTS;
    if (!first_round)
        return false;
    reduce(w, 0, w->sweep->plan->moment_sums);
    sphgi_finish_corrections(w);
    w->summing = SPHGI_SUM_FIELDS;
    if (w->pieces == 0 || (w->pieces == 1 && rest)) {
        if (rest)
            sphgi_evaluate_piece(w);
        empty_piece(w);
        return false;
    }
    empty_piece(w);
    w->touched = 0;
    return true;
}

/* ---- The arena: sums of several source sets ------------------------------------------------- */

static void each_arena_part(struct sphgi_worker *w, bool load)
{
    const struct sphgi_sweep *sweep = w->sweep;
    const struct sphgi_plan *plan = sweep->plan;
    const size_t size = sphgi_size_of_type(plan->type);
    for (int32_t s = 0; s < plan->sums; s += SPHGI_COLUMNS_MOST) {
        const int32_t count = sphgi_min32(SPHGI_COLUMNS_MOST, plan->sums - s);
        const struct sphgi_columns columns =
            sphgi_dense_columns(sweep->arena + (size_t)s * size, count, plan->sums, plan->type);
        char *lanes = sphgi_lane(w, w->reduced, s);
        if (load)
            w->passes->load_lanes(w->width, &columns, sphgi_targets(w), lanes);
        else
            w->passes->store_lanes(w->targets, &columns, sphgi_targets(w), lanes,
                                   sweep->set_number > 0);
    }
}

static void finish(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const unsigned steps = w->sweep->steps;
    const bool done = w->coefficients_first; /* corrections, before the fields */
    if (!done && (steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_corrections(w);
    else if (!done && plan->corrects)
        sphgi_load_corrections(w);
    if (steps & SPHGI_SUM_FIELDS)
        sphgi_finish_fields(w);
}

/* The pair of a target with itself, whose classic gradient is not 0. */
static void write_self(struct sphgi_worker *w, int32_t lane)
{
    const struct sphgi_pair_sink *pairs = w->sweep->pairs;
    const struct sphgi_plan *plan = w->sweep->plan;
    const int32_t target = w->group.target[lane], d = plan->dimension;
    const int64_t place = pairs->offsets[pairs->row_of_target[target]] + w->written[lane];
    const size_t size = sphgi_size_of_type(plan->type);
    pairs->indices[place] = target;
    if (!pairs->gradient.count)
        return;
    sphgi_self_gradient(w, w->extra);
    for (int32_t a = 0; a < d; ++a)
        memcpy((char *)(uintptr_t)(pairs->gradient.at[a] + place * pairs->gradient.stride),
               sphgi_lane(w, w->extra, a) + (size_t)lane * size, size);
}

static void finish_pairs(struct sphgi_worker *w)
{
    const struct sphgi_pair_sink *pairs = w->sweep->pairs;
    for (int32_t l = 0; l < w->group.lanes; ++l) {
        if (w->sweep->plan->classic && w->sweep->plan->own_set >= 0) {
            if (pairs->offsets)
                write_self(w, l);
            ++w->written[l];
        }
        if (!pairs->offsets)
            pairs->counts[pairs->row_of_target[w->group.target[l]]] = w->written[l];
    }
}

void sphgi_group_end(struct sphgi_worker *w)
{
    w->summed = w->group.lanes;
    if (w->sweep->pairs)
        return;
    if (w->summing & SPHGI_SUM_FIELDS)
        sphgi_load_targets(w); /* no pair may have asked for them */
    const int32_t first = w->coefficients_first ? w->sweep->plan->moment_sums : 0;
    reduce(w, first, w->sweep->plan->sums - first);
}

void sphgi_group_finish(struct sphgi_worker *w)
{
    put_to_work(w, 0);
    if (w->sweep->pairs)
        finish_pairs(w);
    else if (w->sweep->steps & SPHGI_FINISH)
        finish(w);
    else
        each_arena_part(w, false);
    w->group.lanes = w->summed = 0;
}

/* One part a lane, whole and fresh. False: a piece cannot hold them. */
static bool make_regular(struct sphgi_worker *w)
{
    struct sphgi_piece *piece = &w->piece;
    const int32_t lanes = w->group.lanes - w->summed;
    int64_t at = 0;
    for (int32_t l = 0; l < lanes; ++l) {
        at += ((int64_t)piece->count[l] + w->pad - 1) & -w->pad;
        piece->begin[l + 1] = (int32_t)at;
    }
    piece->begin[0] = 0;
    piece->parts = lanes;
    w->touched = (1u << lanes) - 1;
    for (int32_t l = 0; !w->regular && l < SPHGI_LANES_MOST; ++l) {
        piece->lane[l] = l;
        piece->fresh[l] = true;
    }
    w->regular = true;
    return at <= SPHGI_PIECE;
}

/* More pairs than a piece holds. */
static void run_in_pieces(struct sphgi_worker *w, bool wide)
{
    const void *ids[SPHGI_LANES_MOST];
    int32_t count[SPHGI_LANES_MOST];
    memcpy(ids, w->piece.ids, sizeof ids);
    memcpy(count, w->piece.count, sizeof count);
    sphgi_group_begin(w);
    do
        for (int32_t l = 0; l < w->targets; ++l)
            sphgi_group_add(w, l, ids[l], count[l], wide);
    while (sphgi_group_again(w));
    sphgi_group_end(w);
}

void sphgi_group_run(struct sphgi_worker *w, bool wide)
{
    if (!make_regular(w) || (wide && w->local)) {
        run_in_pieces(w, wide);
        return;
    }
    begin(w);
    if (wide && w->sweep->set->neighbors->kind == SPHGI_HOST_LISTS)
        sphgi_clean_piece(w);
    gather(w, 0, wide);
    sphgi_group_again(w); /* a whole piece never needs its pairs again */
    sphgi_group_end(w);
}

void sphgi_group_finish_from_arena(struct sphgi_worker *w)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    put_to_work(w, 0);
    w->targets_loaded = false;
    sphgi_load_targets(w);
    each_arena_part(w, true);
    if ((w->sweep->steps & SPHGI_SUM_MOMENTS) && plan->computes)
        sphgi_finish_corrections(w);
    else if (plan->corrects)
        sphgi_load_corrections(w);
    if (w->sweep->coefficients && (w->sweep->steps & SPHGI_SUM_MOMENTS))
        w->passes->store_lanes(w->targets, w->sweep->coefficients, sphgi_targets(w),
                               w->coefficients, false);
    if (w->sweep->steps & SPHGI_SUM_FIELDS)
        sphgi_finish_fields(w);
    w->group.lanes = 0;
}
