/* SPDX-License-Identifier: MIT */
/* Particles of a chunk: which block and cell each is in, and how many these hold. */
#include "sorting.h"
#include <string.h>

enum {
    BATCH = 256,
    RECENT = 4,   /* blocks that are compared first: one for each of four beside each other */
    MET_AGAIN = 8 /* particles a block, or more: its number is noted */
};

static void rehash(struct sphgi_chunk *chunk, uint32_t slots)
{
    chunk->slots = slots;
    memset(chunk->hash, 0, slots * sizeof *chunk->hash);
    for (int32_t b = 0; b < chunk->block_count; ++b)
        chunk->hash[sphgi_find_slot(chunk->hash, slots, chunk->keys, chunk->keys[b])] = b + 1;
}

/* Where there are blocks beyond those whose cells can be counted, particles are sorted by block
 * first. */
void sphgi_count_by_block(struct sphgi_chunk *chunk, int32_t blocks)
{
    for (int32_t b = 0; b < blocks; ++b) {
        chunk->counts[b] = 0;
        for (int32_t c = 0; c < SPHGI_BLOCK_CELLS; ++c)
            chunk->counts[b] += chunk->cells[b * SPHGI_BLOCK_CELLS + c];
    }
    chunk->cells_most = 0;
}

static void open_counts(struct sphgi_chunk *chunk, int32_t b)
{
    if (chunk->cells_most && b == chunk->cells_most)
        sphgi_count_by_block(chunk, b);
    if (chunk->cells_most)
        memset(chunk->cells + (ptrdiff_t)b * SPHGI_BLOCK_CELLS, 0,
               SPHGI_BLOCK_CELLS * sizeof *chunk->cells);
    else
        chunk->counts[b] = 0;
}

static void count_particle(struct sphgi_chunk *chunk, int32_t block, int32_t cell)
{
    if (chunk->cells_most)
        ++chunk->cells[block * SPHGI_BLOCK_CELLS + cell];
    else
        ++chunk->counts[block];
}

static int32_t block_in_chunk(struct sphgi_chunk *chunk, struct sphgi_key key)
{
    const uint32_t slot = sphgi_find_slot(chunk->hash, chunk->slots, chunk->keys, key);
    if (chunk->hash[slot])
        return chunk->hash[slot] - 1;
    const int32_t b = chunk->block_count++;
    chunk->keys[b] = key;
    open_counts(chunk, b);
    chunk->hash[slot] = b + 1;
    if ((uint32_t)chunk->block_count > chunk->slots / 2)
        rehash(chunk, 2 * chunk->slots);
    return b;
}

/* Number of a block that the pass has found. */
static int32_t look_up(struct sphgi_chunk *chunk, const int32_t *block)
{
    int64_t at[3] = {block[0], block[1], block[2]};
    sphgi_raise_octave(block[3], at);
    return block_in_chunk(chunk, sphgi_key_of(at));
}

/* The same where blocks are met again and again. Each is noted in its one place, until another one
 * of that place is. */
static int32_t look_up_again(struct sphgi_chunk *chunk, const int32_t *block)
{
    const uint32_t mixed = (uint32_t)block[0] * 0x9E3779B1u + (uint32_t)block[1] * 0x85EBCA77u +
                           (uint32_t)block[2] * 0xC2B2AE3Du + (uint32_t)block[3] * 0x27D4EB2Fu;
    struct sphgi_seen *seen = &chunk->seen[mixed >> (32 - chunk->seen_bits)];
    if (!seen->number || memcmp(block, seen->at, sizeof seen->at) != 0) {
        seen->number = look_up(chunk, block) + 1;
        memcpy(seen->at, block, sizeof seen->at);
    }
    return seen->number - 1;
}

/* Particles [begin, begin + count) of the chunk, whose blocks and cells the pass has found. Those
 * that follow one another along x often change between the blocks on either side of a face. */
static void collect_cut(const struct sphgi_sort *sort, struct sphgi_chunk *chunk, int32_t begin,
                        int32_t count, int32_t (*block)[4])
{
    const bool again = chunk->block_count < (begin - chunk->begin) / MET_AGAIN;
    int32_t seen[RECENT][4], number[RECENT];
    memset(number, -1, sizeof number);
    for (int32_t k = 0; k < count; ++k) {
        const uint32_t r = ((uint32_t)block[k][1] & 1) | ((uint32_t)block[k][2] & 1) << 1;
        if (number[r] < 0 || memcmp(block[k], seen[r], sizeof *seen) != 0) {
            number[r] = again ? look_up_again(chunk, block[k]) : look_up(chunk, block[k]);
            memcpy(seen[r], block[k], sizeof *seen);
        }
        sort->block[begin + k] = number[r];
        count_particle(chunk, number[r], sort->cell[begin + k]);
    }
}

/* The same for particles of any coordinates. */
static void collect_any(const struct sphgi_sort *sort, struct sphgi_chunk *chunk, int32_t begin,
                        int32_t count)
{
    const struct sphgi_axis *axis = sort->raster->axis;
    for (int32_t i = begin; i < begin + count; ++i) {
        double x[3];
        int64_t cell[3];
        for (int32_t a = 0; a < 3; ++a)
            x[a] = sphgi_number_of_row(sort, i, a);
        sphgi_cell_of(sort->raster, x, cell);
        sort->cell[i] = (uint8_t)sphgi_local_cell(sort->raster, cell);
        for (int32_t a = 0; a < 3; ++a)
            cell[a] >>= axis[a].shift;
        sort->block[i] = block_in_chunk(chunk, sphgi_key_of(cell));
        count_particle(chunk, sort->block[i], sort->cell[i]);
    }
}

/* The same for particles of octaves. Those of a cell are sorted by its quarters. */
static void collect_octaves(const struct sphgi_sort *sort, struct sphgi_chunk *chunk, int32_t begin,
                            int32_t count)
{
    const struct sphgi_raster *raster = sort->raster;
    for (int32_t i = begin; i < begin + count; ++i) {
        const int32_t octave = sphgi_octave_of(raster, sphgi_number_of_row(sort, i, 3));
        int64_t cell[3] = {0};
        double place[3] = {0};
        for (int32_t a = 0; a < raster->dimension; ++a)
            place[a] = sphgi_place_on_axis(
                &raster->axis[a], octave,
                sphgi_number_of_row(sort, i, sphgi_number_of_axis(raster, a)), &cell[a]);
        const int32_t quarter = sphgi_quarter_of(place[0] - (double)cell[0]);
        sort->cell[i] = (uint8_t)(sphgi_local_cell(raster, cell) * SPHGI_QUARTERS + quarter);
        for (int32_t a = 0; a < 3; ++a)
            cell[a] >>= raster->axis[a].shift;
        sphgi_raise_octave(octave, cell);
        sort->block[i] = block_in_chunk(chunk, sphgi_key_of(cell));
        count_particle(chunk, sort->block[i], sort->cell[i]);
    }
}

void sphgi_collect_chunks(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sphgi_sort *sort = data;
    const size_t row_size = SPHGI_ROW * sphgi_size_of_type(sort->type);
    bool (*const cut)(const struct sphgi_cutting *, const void *, int32_t, int32_t(*)[4],
                      uint8_t *) =
        sort->raster->octaves ? sort->passes->cut_octaves : sort->passes->cut;
    int32_t block[BATCH][4];
    (void)worker;
    for (int32_t c = begin; c < end; ++c) {
        struct sphgi_chunk *chunk = &sort->chunks[c];
        rehash(chunk, SPHGI_SLOTS_LEAST);
        memset(chunk->seen, 0, sizeof *chunk->seen << chunk->seen_bits);
        for (int32_t i = chunk->begin; i < chunk->end; i += BATCH) {
            const int32_t count = sphgi_min32(BATCH, chunk->end - i);
            const char *rows = (const char *)sort->rows + (size_t)i * row_size;
            if (!sort->raster->periodic && cut(&sort->cutting, rows, count, block, sort->cell + i))
                collect_cut(sort, chunk, i, count, block);
            else if (sort->raster->octaves)
                collect_octaves(sort, chunk, i, count);
            else
                collect_any(sort, chunk, i, count);
        }
    }
}
