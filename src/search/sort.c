/* SPDX-License-Identifier: MIT */
/* Sorting particles into the blocks and cells of a grid. */
#include "grid.h"
#include "core/parallel.h"
#include <float.h>
#include <string.h>

enum {
    CHUNK_LEAST = 4096, /* particles */
    SLOTS_LEAST = 1024,
    BATCH = 256,
    RECENT = 4, /* blocks that are not looked up again: one for each of four beside each other */
    BLOCK_GRAIN = 16,
    GRAIN = 4096 /* particles */
};

/* Each chunk of particles collects the blocks it meets on its own; the results are merged in order,
 * so that nothing depends on the number of chunks. */
struct chunk {
    int32_t begin, end;
    int32_t block_count;
    uint32_t slots;
    struct sphgi_key *keys; /* of the blocks, in order of appearance */
    int32_t *hash;          /* block + 1; grows inside its share */
    int32_t *counts;        /* particles per block; later: where the next one goes */
    int32_t *cells;         /* the same per cell, as long as blocks hold enough on average */
    int32_t cells_most;     /* blocks that there is room for then; 0: none */
    int32_t *global;        /* number in the grid */
};

struct sort {
    const struct sphgi_raster *raster;
    struct sphgi_cutting cutting;
    const struct sphgi_passes *passes;
    sphg_type type;
    const void *rows;
    struct chunk *chunks;
    int32_t chunk_count;
    int32_t *block; /* per particle: block of its chunk */
    uint8_t *cell;  /* per particle */
    int32_t *order; /* particles by block, or the chunks' counts of cells */
    uint8_t *sorted_cell;
    struct sphgi_key *keys; /* of all blocks, in order of appearance */
    int32_t *numbers, *scratch;
    int32_t *place; /* of each particle in the grid, or NULL */
    struct sphgi_grid *grid;
    atomic_int_least32_t fullest;
};

/* ---- Blocks of a chunk ---------------------------------------------------------------------- */

/* The slot that holds the key, or the free one where it belongs. */
static uint32_t find_slot(const int32_t *hash, uint32_t slots, const struct sphgi_key *keys,
                          struct sphgi_key key)
{
    uint32_t slot = sphgi_slot_of(key, slots);
    while (hash[slot] && !sphgi_same_key(keys[hash[slot] - 1], key))
        slot = slot + 1 < slots ? slot + 1 : 0;
    return slot;
}

static void rehash(struct chunk *chunk, uint32_t slots)
{
    chunk->slots = slots;
    memset(chunk->hash, 0, slots * sizeof *chunk->hash);
    for (int32_t b = 0; b < chunk->block_count; ++b)
        chunk->hash[find_slot(chunk->hash, slots, chunk->keys, chunk->keys[b])] = b + 1;
}

/* Blocks beyond those whose cells can be counted: particles are sorted by block first. */
static void count_by_block(struct chunk *chunk, int32_t blocks)
{
    for (int32_t b = 0; b < blocks; ++b) {
        chunk->counts[b] = 0;
        for (int32_t c = 0; c < SPHGI_BLOCK_CELLS; ++c)
            chunk->counts[b] += chunk->cells[b * SPHGI_BLOCK_CELLS + c];
    }
    chunk->cells_most = 0;
}

static void open_counts(struct chunk *chunk, int32_t b)
{
    if (chunk->cells_most && b == chunk->cells_most)
        count_by_block(chunk, b);
    if (chunk->cells_most)
        memset(chunk->cells + (ptrdiff_t)b * SPHGI_BLOCK_CELLS, 0,
               SPHGI_BLOCK_CELLS * sizeof *chunk->cells);
    else
        chunk->counts[b] = 0;
}

static void count_particle(struct chunk *chunk, int32_t block, int32_t cell)
{
    if (chunk->cells_most)
        ++chunk->cells[block * SPHGI_BLOCK_CELLS + cell];
    else
        ++chunk->counts[block];
}

static int32_t block_in_chunk(struct chunk *chunk, struct sphgi_key key)
{
    const uint32_t slot = find_slot(chunk->hash, chunk->slots, chunk->keys, key);
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

/* Particles [begin, begin + count) of the chunk, whose blocks and cells the pass has found. Those
 * that follow one another along x often change between the blocks on either side of a face. */
static void collect_cut(const struct sort *sort, struct chunk *chunk, int32_t begin, int32_t count,
                        int32_t (*block)[4])
{
    int32_t seen[RECENT][4], number[RECENT];
    memset(number, -1, sizeof number);
    for (int32_t k = 0; k < count; ++k) {
        const uint32_t r = ((uint32_t)block[k][1] & 1) | ((uint32_t)block[k][2] & 1) << 1;
        if (number[r] < 0 || memcmp(block[k], seen[r], sizeof *seen) != 0) {
            int64_t at[3] = {block[k][0], block[k][1], block[k][2]};
            sphgi_raise_octave(block[k][3], at);
            number[r] = block_in_chunk(chunk, sphgi_key_of(at));
            memcpy(seen[r], block[k], sizeof *seen);
        }
        sort->block[begin + k] = number[r];
        count_particle(chunk, number[r], sort->cell[begin + k]);
    }
}

static double number_of(const struct sort *sort, int32_t i, int32_t number)
{
    const size_t k = SPHGI_ROW * (size_t)i + (size_t)number;
    return sort->type == SPHG_F64 ? ((const double *)sort->rows)[k]
                                  : (double)((const float *)sort->rows)[k];
}

/* The same for particles of any coordinates. */
static void collect_any(const struct sort *sort, struct chunk *chunk, int32_t begin, int32_t count)
{
    const struct sphgi_axis *axis = sort->raster->axis;
    for (int32_t i = begin; i < begin + count; ++i) {
        double x[3];
        int64_t cell[3];
        for (int32_t a = 0; a < 3; ++a)
            x[a] = number_of(sort, i, a);
        sphgi_cell_of(sort->raster, x, cell);
        sort->cell[i] = (uint8_t)sphgi_local_cell(sort->raster, cell);
        for (int32_t a = 0; a < 3; ++a)
            cell[a] >>= axis[a].shift;
        sort->block[i] = block_in_chunk(chunk, sphgi_key_of(cell));
        count_particle(chunk, sort->block[i], sort->cell[i]);
    }
}

/* Far out cells are no wholes of the place. */
static int32_t quarter_of(double inside)
{
    return inside <= 0 ? 0 : inside < 1 ? (int32_t)(inside * SPHGI_QUARTERS) : SPHGI_QUARTERS - 1;
}

/* The same for particles of octaves. Those of a cell are sorted by its quarters. */
static void collect_octaves(const struct sort *sort, struct chunk *chunk, int32_t begin,
                            int32_t count)
{
    const struct sphgi_raster *raster = sort->raster;
    for (int32_t i = begin; i < begin + count; ++i) {
        const int32_t octave = sphgi_octave_of(raster, number_of(sort, i, 3));
        int64_t cell[3] = {0};
        double place[3] = {0};
        for (int32_t a = 0; a < raster->dimension; ++a)
            place[a] =
                sphgi_place_on_axis(&raster->axis[a], octave,
                                    number_of(sort, i, sphgi_number_of_axis(raster, a)), &cell[a]);
        const int32_t quarter = quarter_of(place[0] - (double)cell[0]);
        sort->cell[i] = (uint8_t)(sphgi_local_cell(raster, cell) * SPHGI_QUARTERS + quarter);
        for (int32_t a = 0; a < 3; ++a)
            cell[a] >>= raster->axis[a].shift;
        sphgi_raise_octave(octave, cell);
        sort->block[i] = block_in_chunk(chunk, sphgi_key_of(cell));
        count_particle(chunk, sort->block[i], sort->cell[i]);
    }
}

static void collect_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sort *sort = data;
    const size_t row_size = SPHGI_ROW * sphgi_size_of_type(sort->type);
    bool (*const cut)(const struct sphgi_cutting *, const void *, int32_t, int32_t(*)[4],
                      uint8_t *) =
        sort->raster->octaves ? sort->passes->cut_octaves : sort->passes->cut;
    int32_t block[BATCH][4];
    (void)worker;
    for (int32_t c = begin; c < end; ++c) {
        struct chunk *chunk = &sort->chunks[c];
        rehash(chunk, SLOTS_LEAST);
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

/* ---- Blocks of the grid --------------------------------------------------------------------- */

/* Two runs in order become one. */
static void merge_runs(const struct sphgi_key *keys, const int32_t *from, int32_t *to,
                       int32_t begin, int32_t middle, int32_t end)
{
    int32_t a = begin, b = middle;
    for (int32_t k = begin; k < end; ++k) {
        const bool take_b =
            a >= middle || (b < end && sphgi_is_before(keys[from[b]], keys[from[a]]));
        to[k] = take_b ? from[b++] : from[a++];
    }
}

static bool are_in_order(const struct sphgi_key *keys, int32_t count)
{
    for (int32_t k = 1; k < count; ++k)
        if (sphgi_is_before(keys[k], keys[k - 1]))
            return false;
    return true;
}

/* Numbers of the blocks in the order of their keys, by merging; scratch holds as many. */
static int32_t *sort_blocks(const struct sphgi_key *keys, int32_t count, int32_t *numbers,
                            int32_t *scratch)
{
    for (int32_t b = 0; b < count; ++b)
        numbers[b] = b;
    if (are_in_order(keys, count))
        return numbers;
    for (int64_t width = 1; width < count; width *= 2) {
        for (int64_t begin = 0; begin < count; begin += 2 * width) {
            const int64_t middle = begin + width < count ? begin + width : count;
            const int64_t end = middle + width < count ? middle + width : count;
            merge_runs(keys, numbers, scratch, (int32_t)begin, (int32_t)middle, (int32_t)end);
        }
        int32_t *swap = numbers;
        numbers = scratch;
        scratch = swap;
    }
    return numbers;
}

/* Keys of all chunks without repetitions, and their numbers in chunk->global. */
static int32_t merge_keys(struct sort *sort, int32_t *hash)
{
    int32_t count = 0;
    size_t total = 0;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        total += (size_t)sort->chunks[c].block_count;
    const uint32_t slots = (uint32_t)sphgi_slots_for(total);
    memset(hash, 0, slots * sizeof *hash);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            const struct sphgi_key key = sort->chunks[c].keys[b];
            const uint32_t slot = find_slot(hash, slots, sort->keys, key);
            if (!hash[slot]) {
                sort->keys[count++] = key;
                hash[slot] = count;
            }
            sort->chunks[c].global[b] = hash[slot] - 1;
        }
    return count;
}

/* Blocks in the order of their keys; chunk->global becomes their number there. */
static void number_blocks(struct sort *sort, int32_t count, void *tables)
{
    struct sphgi_grid *grid = sort->grid;
    grid->block_count = count;
    grid->slots = (uint32_t)sphgi_slots_for((size_t)count);
    sphgi_grid_use_tables(grid, tables);
    const int32_t *sorted = sort_blocks(sort->keys, count, sort->numbers, sort->scratch);
    int32_t *rank = sorted == sort->numbers ? sort->scratch : sort->numbers;
    memset(grid->hash, 0, grid->slots * sizeof *grid->hash);
    for (int32_t k = 0; k < count; ++k) {
        const struct sphgi_key key = sort->keys[sorted[k]];
        grid->blocks[k] = (struct sphgi_block){.key = key};
        rank[sorted[k]] = k;
        uint32_t slot = sphgi_slot_of(key, grid->slots);
        while (grid->hash[slot])
            slot = slot + 1 < grid->slots ? slot + 1 : 0;
        grid->hash[slot] = k + 1;
    }
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            sort->chunks[c].global[b] = rank[sort->chunks[c].global[b]];
}

/* First particle of each block and, in chunk->counts, of each chunk's share of it. */
static void place_blocks(struct sort *sort)
{
    struct sphgi_block *blocks = sort->grid->blocks;
    int32_t *cursor = sort->scratch, next = 0;
    memset(cursor, 0, (size_t)sort->grid->block_count * sizeof *cursor);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            cursor[sort->chunks[c].global[b]] += sort->chunks[c].counts[b];
    for (int32_t b = 0; b < sort->grid->block_count; ++b) {
        blocks[b].first = next;
        next += cursor[b];
        cursor[b] = blocks[b].first;
    }
    blocks[sort->grid->block_count].first = next;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            int32_t *place = &cursor[sort->chunks[c].global[b]];
            const int32_t size = sort->chunks[c].counts[b];
            sort->chunks[c].counts[b] = *place;
            *place += size;
        }
}

/* ---- Cells of a block ----------------------------------------------------------------------- */

/* Starts of the block's cells, of which place[] holds the sizes; these become places. Returns the
 * size of the fullest. */
SPHGI_TEMPLATE int32_t place_cells(struct sphgi_block *block, int32_t *place, int32_t *cell_start,
                                   int32_t parts)
{
    int32_t next = block->first, fullest = 0;
    int32_t *start = cell_start + next;
    block->occupied = 0;
    for (int32_t c = 0; c < SPHGI_BLOCK_CELLS; ++c) {
        int32_t size = 0;
        for (int32_t k = c * parts; k < (c + 1) * parts; ++k) {
            const int32_t here = place[k];
            place[k] = next + size;
            size += here;
        }
        if (!size)
            continue;
        *start++ = next;
        next += size;
        block->occupied |= 1u << c;
        fullest = sphgi_max32(size, fullest);
    }
    if (start < cell_start + next) /* else the next block's first start is the same number */
        *start = next;
    return fullest;
}

static void note_fullest(struct sort *sort, int32_t fullest)
{
    int_least32_t seen = atomic_load(&sort->fullest);
    while (seen < fullest && !atomic_compare_exchange_weak(&sort->fullest, &seen, fullest))
        ;
}

/* ---- Particles by cell ---------------------------------------------------------------------- */

/* Where every chunk has counted its cells, each particle goes to its place at once. */
static bool are_cells_counted(const struct sort *sort)
{
    bool all = true;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        all &= sort->chunks[c].cells_most > 0;
    return all;
}

static void count_blocks_of_chunks(struct sort *sort)
{
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        if (sort->chunks[c].cells_most)
            count_by_block(&sort->chunks[c], sort->chunks[c].block_count);
}

/* Particles in each cell of the grid, 32 numbers a block: no more than particles. */
static int32_t *add_up_cells(struct sort *sort)
{
    int32_t *total = sort->numbers;
    memset(total, 0, (size_t)sort->grid->block_count * SPHGI_BLOCK_CELLS * sizeof *total);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            const int32_t *cells = sort->chunks[c].cells + (ptrdiff_t)b * SPHGI_BLOCK_CELLS;
            int32_t *sum = total + (ptrdiff_t)sort->chunks[c].global[b] * SPHGI_BLOCK_CELLS;
            for (int32_t k = 0; k < SPHGI_BLOCK_CELLS; ++k)
                sum[k] += cells[k];
        }
    return total;
}

static void place_cells_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sort *sort = data;
    struct sphgi_grid *grid = sort->grid;
    int32_t fullest = 0;
    (void)worker;
    for (int32_t b = begin; b < end; ++b) {
        int32_t *place = sort->numbers + (ptrdiff_t)b * SPHGI_BLOCK_CELLS;
        const int32_t most = place_cells(&grid->blocks[b], place, grid->cell_start.data, 1);
        fullest = sphgi_max32(fullest, most);
    }
    note_fullest(sort, fullest);
}

/* Sizes of the cells of all blocks become the places of their first particles, and the chunks'
 * counts those of their own first. */
static void place_counted_cells(sphg_context *context, struct sort *sort)
{
    struct sphgi_block *blocks = sort->grid->blocks;
    int32_t *next = add_up_cells(sort);
    blocks[0].first = 0;
    for (int32_t b = 0; b < sort->grid->block_count; ++b) {
        int32_t size = 0;
        for (int32_t k = 0; k < SPHGI_BLOCK_CELLS; ++k)
            size += next[(ptrdiff_t)b * SPHGI_BLOCK_CELLS + k];
        blocks[b + 1].first = blocks[b].first + size;
    }
    sphgi_parallel_for(context, place_cells_task, sort, sort->grid->block_count, BLOCK_GRAIN);
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            int32_t *cells = sort->chunks[c].cells + (ptrdiff_t)b * SPHGI_BLOCK_CELLS;
            int32_t *place = next + (ptrdiff_t)sort->chunks[c].global[b] * SPHGI_BLOCK_CELLS;
            for (int32_t k = 0; k < SPHGI_BLOCK_CELLS; ++k) {
                const int32_t size = cells[k];
                cells[k] = place[k];
                place[k] += size;
            }
        }
}

SPHGI_TEMPLATE void move_chunk(const struct sort *sort, const struct chunk *chunk, size_t row_size,
                               bool places)
{
    int32_t *order = sort->grid->order.data;
    char *rows = sort->grid->rows.data;
    for (int32_t i = chunk->begin; i < chunk->end; ++i) {
        const int32_t to = chunk->cells[sort->block[i] * SPHGI_BLOCK_CELLS + sort->cell[i]]++;
        memcpy(rows + (size_t)to * row_size, (const char *)sort->rows + (size_t)i * row_size,
               row_size);
        order[to] = i;
        if (places)
            sort->place[i] = to;
    }
}

static void move_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sort *sort = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c)
        if (sort->type == SPHG_F64)
            move_chunk(sort, &sort->chunks[c], SPHGI_ROW * sizeof(double), sort->place != NULL);
        else if (sort->place)
            move_chunk(sort, &sort->chunks[c], SPHGI_ROW * sizeof(float), true);
        else
            move_chunk(sort, &sort->chunks[c], SPHGI_ROW * sizeof(float), false);
}

/* ---- Particles by block, then by cell ------------------------------------------------------- */

static void scatter_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sort *sort = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c) {
        const struct chunk *chunk = &sort->chunks[c];
        for (int32_t i = chunk->begin; i < chunk->end; ++i) {
            const int32_t place = chunk->counts[sort->block[i]]++;
            sort->order[place] = i;
            sort->sorted_cell[place] = sort->cell[i];
        }
    }
}

/* A counting sort by cell, or by quarters of cells, and the rows follow. */
SPHGI_TEMPLATE int32_t sort_block(const struct sort *sort, int32_t b, size_t row_size,
                                  int32_t parts)
{
    struct sphgi_grid *grid = sort->grid;
    int32_t *order = grid->order.data, place[SPHGI_BLOCK_CELLS * SPHGI_QUARTERS];
    memset(place, 0, (size_t)(SPHGI_BLOCK_CELLS * parts) * sizeof *place);
    char *rows = grid->rows.data;
    const int32_t first = grid->blocks[b].first, last = grid->blocks[b + 1].first;
    for (int32_t k = first; k < last; ++k)
        ++place[sort->sorted_cell[k]];
    const int32_t fullest = place_cells(&grid->blocks[b], place, grid->cell_start.data, parts);
    for (int32_t k = first; k < last; ++k) {
        const int32_t to = place[sort->sorted_cell[k]]++, i = sort->order[k];
        order[to] = i;
        memcpy(rows + (size_t)to * row_size, (const char *)sort->rows + (size_t)i * row_size,
               row_size);
    }
    return fullest;
}

/* The largest radius of a block, for the leaves of the tree. */
static float radius_of_block(const struct sort *sort, int32_t b)
{
    const struct sphgi_grid *grid = sort->grid;
    const int32_t first = grid->blocks[b].first, last = grid->blocks[b + 1].first;
    double largest = 0;
    for (int32_t k = first; k < last; ++k) {
        const double radius = number_of(sort, ((const int32_t *)grid->order.data)[k], 3);
        largest = radius > largest ? radius : largest;
    }
    return largest < (double)FLT_MAX ? (float)largest : FLT_MAX;
}

static void cells_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sort *sort = data;
    int32_t fullest = 0;
    (void)worker;
    for (int32_t b = begin; b < end; ++b) {
        int32_t most;
        if (sort->raster->octaves) {
            most = sort_block(sort, b, SPHGI_ROW * sphgi_size_of_type(sort->type), SPHGI_QUARTERS);
            sort->grid->tree.leaves[b / SPHGI_TREE_WIDTH].radius[b % SPHGI_TREE_WIDTH] =
                radius_of_block(sort, b);
        } else
            most = sort->type == SPHG_F64 ? sort_block(sort, b, SPHGI_ROW * sizeof(double), 1)
                                          : sort_block(sort, b, SPHGI_ROW * sizeof(float), 1);
        fullest = sphgi_max32(fullest, most);
    }
    note_fullest(sort, fullest);
}

struct inversion {
    const int32_t *order;
    int32_t *place;
};

static void invert_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct inversion *inversion = data;
    (void)worker;
    for (int32_t k = begin; k < end; ++k)
        inversion->place[inversion->order[k]] = k;
}

bool sphgi_grid_places(sphg_context *context, const struct sphgi_grid *grid,
                       const struct sphgi_allocator *allocator, struct sphgi_buffer *place)
{
    if (!sphgi_reserve(allocator, place, (size_t)grid->count, sizeof(int32_t)))
        return false;
    struct inversion inversion = {grid->order.data, place->data};
    sphgi_parallel_for(context, invert_task, &inversion, grid->count, GRAIN);
    return true;
}

static void sort_by_block(sphg_context *context, struct sort *sort)
{
    count_blocks_of_chunks(sort);
    place_blocks(sort);
    sphgi_parallel_for(context, scatter_task, sort, sort->chunk_count, 1);
    sphgi_parallel_for(context, cells_task, sort, sort->grid->block_count, BLOCK_GRAIN);
}

/* ---- Memory --------------------------------------------------------------------------------- */

/* Scratch is carved from one buffer; base NULL: only measured. */
struct carver {
    char *base;
    size_t used;
};

static void *carve(struct carver *carver, size_t count, size_t size)
{
    void *here = carver->base ? carver->base + carver->used : NULL;
    carver->used += sphgi_round_up(count * size, SPHGI_ALIGNMENT);
    return here;
}

/* Enough for a table that doubles as soon as half of it is taken. */
static size_t chunk_slots(int32_t particles)
{
    size_t slots = SLOTS_LEAST;
    while (slots / 2 < (size_t)particles)
        slots *= 2;
    return slots;
}

static void carve_chunk(struct chunk *chunk, struct carver *carver, int32_t particles)
{
    chunk->keys = carve(carver, (size_t)particles, sizeof *chunk->keys);
    chunk->hash = carve(carver, chunk_slots(particles), sizeof *chunk->hash);
    chunk->counts = carve(carver, (size_t)particles, sizeof *chunk->counts);
    chunk->global = carve(carver, (size_t)particles, sizeof *chunk->global);
}

/* Returns the bytes. */
static size_t carve_sort(struct sort *sort, char *base, int32_t count)
{
    struct carver carver = {base, 0};
    const size_t n = (size_t)count;
    const int32_t each = (count + sort->chunk_count - 1) / sort->chunk_count;
    sort->chunks = carve(&carver, (size_t)sort->chunk_count, sizeof *sort->chunks);
    sort->block = carve(&carver, n, sizeof *sort->block);
    sort->order = carve(&carver, n, sizeof *sort->order);
    sort->cell = carve(&carver, n, 1);
    sort->sorted_cell = carve(&carver, n, 1);
    sort->keys = carve(&carver, n, sizeof *sort->keys);
    sort->numbers = carve(&carver, n, sizeof *sort->numbers);
    sort->scratch = carve(&carver, n, sizeof *sort->scratch);
    for (int32_t c = 0; c < sort->chunk_count; ++c) {
        const int64_t begin = (int64_t)c * each, end = begin + each;
        struct chunk chunk = {.begin = begin < count ? (int32_t)begin : count,
                              .end = end < count ? (int32_t)end : count};
        carve_chunk(&chunk, &carver, each);
        if (!base)
            continue;
        chunk.cells = sort->order + chunk.begin;
        if (!sort->raster->octaves)
            chunk.cells_most = (chunk.end - chunk.begin) / SPHGI_BLOCK_CELLS;
        sort->chunks[c] = chunk;
    }
    return carver.used;
}

sphg_result sphgi_grid_build(sphg_context *context, struct sphgi_grid *grid,
                             const struct sphgi_allocator *allocator,
                             const struct sphgi_raster *raster, sphg_type type, const void *rows,
                             int32_t count, void *tables, struct sphgi_buffer *place)
{
    const size_t n = (size_t)count, row_size = SPHGI_ROW * sphgi_size_of_type(type);
    struct sort sort = {.raster = raster,
                        .cutting = sphgi_cutting_of(raster),
                        .passes = sphgi_passes_of(context, type),
                        .type = type,
                        .rows = rows,
                        .grid = grid};
    sort.chunk_count = sphgi_max32(1, sphgi_min32(context->threads, count / CHUNK_LEAST));
    grid->sorted = false;
    if (!sphgi_reserve(&context->allocator, &context->sort, carve_sort(&sort, NULL, count), 1) ||
        !sphgi_reserve(allocator, &grid->rows, n + SPHGI_LANES_MOST, row_size) ||
        !sphgi_reserve(allocator, &grid->cell_start, n + 1, sizeof(int32_t)) ||
        !sphgi_reserve(allocator, &grid->order, n, sizeof(int32_t)) ||
        (place && !sphgi_reserve(allocator, place, n, sizeof(int32_t))))
        return SPHG_ERROR_MEMORY;
    sort.place = place ? place->data : NULL;
    carve_sort(&sort, context->sort.data, count);
    grid->raster = *raster;
    grid->type = type;
    grid->count = count;
    sphgi_parallel_for(context, collect_task, &sort, sort.chunk_count, 1);
    number_blocks(&sort, merge_keys(&sort, tables), tables); /* the tables are scratch at first */
    ((int32_t *)grid->cell_start.data)[count] = count;
    if (are_cells_counted(&sort)) {
        place_counted_cells(context, &sort);
        sphgi_parallel_for(context, move_task, &sort, sort.chunk_count, 1);
    } else {
        sort_by_block(context, &sort);
        if (place)
            (void)sphgi_grid_places(context, grid, allocator, place); /* there is room */
    }
    memset((char *)grid->rows.data + n * row_size, 0, SPHGI_LANES_MOST * row_size);
    grid->fullest = (int32_t)atomic_load(&sort.fullest);
    if (raster->octaves)
        sphgi_tree_build(&grid->tree, grid->blocks, grid->block_count, raster->octaves);
    grid->sorted = true;
    return SPHG_OK;
}
