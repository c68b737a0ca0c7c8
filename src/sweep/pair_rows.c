/* SPDX-License-Identifier: MIT */
#include "pair_rows.h"
#include <string.h>

/* Where the pairs of a lane stand in the arrays, and their ids: what is no pair has the dummy's.
 * Returns how many. */
static int32_t pairs_of_lane(const struct sphgi_worker *w, int32_t lane, int32_t *at, uint32_t *ids)
{
    const int32_t lanes = w->passes->lanes, count = w->batch.pairs[lane];
    const uint32_t *id = w->tile.ids + lane;
    int32_t kept = 0;
    if (!w->gather.masked && w->sweep->set->neighbors->kind == SPHGI_SEARCHED) { /* no gaps */
        for (int32_t k = 0; k < count; ++k) {
            at[k] = k * lanes + lane;
            ids[k] = id[k * w->tile.id_stride];
        }
        return count;
    }
    for (int32_t k = 0; k < count; ++k, id += w->tile.id_stride) {
        at[kept] = k * lanes + lane;
        ids[kept] = *id;
        kept += *id != w->gather.dummy;
    }
    return kept;
}

/* Two or three components a pair, all of them in one loop. */
#define COPY_NUMBERS(type)                                                                         \
    for (int32_t k = 0; k < count; ++k, x += stride, y += stride, z += stride) {                   \
        const type *number = (const type *)from + at[k];                                           \
        *(type *)(void *)x = number[SPHGI_GX * SPHGI_TILE];                                        \
        *(type *)(void *)y = number[SPHGI_GY * SPHGI_TILE];                                        \
        if (three)                                                                                 \
            *(type *)(void *)z = number[SPHGI_GZ * SPHGI_TILE];                                    \
    }

/* The same into blocks, as far as each of them goes. A type takes no parentheses.
 * NOLINTBEGIN(bugprone-macro-parentheses) */
#define COPY_TO_BLOCKS(type)                                                                       \
    for (int32_t k = 0, end; k < count; k = end) {                                                 \
        type *x = (type *)(void *)sphgi_pair_number(to, 0, place + k);                             \
        end = sphgi_min32(count, k + block - (int32_t)((place + k) & (block - 1)));                \
        for (; k < end; ++k, ++x) {                                                                \
            const type *number = (const type *)from + at[k];                                       \
            x[0] = number[SPHGI_GX * SPHGI_TILE];                                                  \
            x[block] = number[SPHGI_GY * SPHGI_TILE];                                              \
            if (three)                                                                             \
                x[2 * block] = number[SPHGI_GZ * SPHGI_TILE];                                      \
        }                                                                                          \
    }
/* NOLINTEND(bugprone-macro-parentheses) */

static void copy_to_blocks(const struct sphgi_worker *w, const int32_t *at, int32_t count,
                           int64_t place)
{
    const struct sphgi_pair_numbers *to = &w->sweep->pairs->gradient;
    const void *from = w->tile.arrays;
    const int32_t block = to->block;
    const bool three = to->columns.count == 3;
    if (to->size == sizeof(double))
        COPY_TO_BLOCKS(double)
    else
        COPY_TO_BLOCKS(float)
}

static void copy_gradients(const struct sphgi_worker *w, const int32_t *at, int32_t count,
                           int64_t place)
{
    const struct sphgi_columns *to = &w->sweep->pairs->gradient.columns;
    const void *from = w->tile.arrays;
    const ptrdiff_t stride = to->stride, first = (ptrdiff_t)place * stride;
    const bool three = to->count == 3;
    char *x = (char *)(uintptr_t)(to->at[0] + first), *y = (char *)(uintptr_t)(to->at[1] + first);
    char *z = three ? (char *)(uintptr_t)(to->at[2] + first) : y;
    if (w->sweep->plan->type == SPHG_F64)
        COPY_NUMBERS(double)
    else
        COPY_NUMBERS(float)
}

#undef COPY_NUMBERS
#undef COPY_TO_BLOCKS

void sphgi_write_lane(struct sphgi_worker *w, int32_t lane, int32_t of)
{
    const struct sphgi_pair_sink *pairs = w->sweep->pairs;
    const int32_t row = pairs->row_of_target[w->bundle.target[of]];
    int32_t at[SPHGI_CHUNK + 1];
    uint32_t ids[SPHGI_CHUNK + 1];
    const int32_t count = pairs_of_lane(w, lane, at, ids);
    const int64_t place = pairs->offsets ? pairs->offsets[row] + w->bundle.written[of] : 0;
    w->bundle.written[of] += count;
    if (!pairs->offsets)
        return;
    int32_t *to = pairs->indices + place;
    const int32_t *items = w->rows.items;
    /* NOLINTBEGIN(clang-analyzer-core.UndefinedBinaryOperatorResult): there are `count` ids */
    if (items)
        for (int32_t k = 0; k < count; ++k)
            to[k] = items[ids[k] / SPHGI_ID_STEP];
    else
        for (int32_t k = 0; k < count; ++k)
            to[k] = (int32_t)(ids[k] / SPHGI_ID_STEP);
    /* NOLINTEND(clang-analyzer-core.UndefinedBinaryOperatorResult) */
    if (pairs->gradient.block)
        copy_to_blocks(w, at, count, place);
    else if (pairs->gradient.columns.count)
        copy_gradients(w, at, count, place);
}

void sphgi_fill_up_row(const struct sphgi_pair_numbers *gradient, int32_t *indices, int64_t first,
                       int64_t count)
{
    const int64_t places = sphgi_in_blocks(count, gradient->block);
    for (int64_t k = count; k < places; ++k) {
        indices[first + k] = indices[first + count - 1];
        for (int32_t c = 0; c < gradient->columns.count; ++c)
            memset(sphgi_pair_number(gradient, c, first + k), 0, gradient->size);
    }
}
