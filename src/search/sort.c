/* SPDX-License-Identifier: MIT */
/* Sorting particles into the blocks and cells of a grid. */
#include "sorting.h"
#include "core/parallel.h"
#include <float.h>
#include <string.h>

enum {
    CHUNK_LEAST = 4096, /* particles */
    BLOCK_GRAIN = 16,
    GRAIN = 4096 /* particles */
};

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

static void note_fullest(struct sphgi_sort *sort, int32_t fullest)
{
    int_least32_t seen = atomic_load(&sort->fullest);
    while (seen < fullest && !atomic_compare_exchange_weak(&sort->fullest, &seen, fullest))
        ;
}

/* ---- Particles by cell ---------------------------------------------------------------------- */

/* Where every chunk has counted its cells, each particle goes to its place at once. */
static bool are_cells_counted(const struct sphgi_sort *sort)
{
    bool all = true;
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        all &= sort->chunks[c].cells_most > 0;
    return all;
}

static void count_blocks_of_chunks(struct sphgi_sort *sort)
{
    for (int32_t c = 0; c < sort->chunk_count; ++c)
        if (sort->chunks[c].cells_most)
            sphgi_count_by_block(&sort->chunks[c], sort->chunks[c].block_count);
}

/* Particles in each cell of the grid, 32 numbers a block: no more than particles. */
static int32_t *add_up_cells(struct sphgi_sort *sort)
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
    struct sphgi_sort *sort = data;
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
static void place_counted_cells(sphg_context *context, struct sphgi_sort *sort)
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

SPHGI_TEMPLATE void move_chunk(const struct sphgi_sort *sort, const struct sphgi_chunk *chunk,
                               size_t row_size, bool places)
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
    const struct sphgi_sort *sort = data;
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
    const struct sphgi_sort *sort = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c) {
        const struct sphgi_chunk *chunk = &sort->chunks[c];
        for (int32_t i = chunk->begin; i < chunk->end; ++i) {
            const int32_t place = chunk->counts[sort->block[i]]++;
            sort->order[place] = i;
            sort->sorted_cell[place] = sort->cell[i];
        }
    }
}

/* A counting sort by cell, or by quarters of cells, and the rows follow. */
SPHGI_TEMPLATE int32_t sort_block(const struct sphgi_sort *sort, int32_t b, size_t row_size,
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
static float radius_of_block(const struct sphgi_sort *sort, int32_t b)
{
    const struct sphgi_grid *grid = sort->grid;
    const bool is_f64 = sort->type == SPHG_F64;
    double largest = 0;
    for (int32_t k = grid->blocks[b].first; k < grid->blocks[b + 1].first; ++k) {
        const size_t at = SPHGI_ROW * (size_t)k + 3;
        const double radius = is_f64 ? ((const double *)grid->rows.data)[at]
                                     : (double)((const float *)grid->rows.data)[at];
        largest = radius > largest ? radius : largest;
    }
    return largest < (double)FLT_MAX ? (float)largest : FLT_MAX;
}

SPHGI_TEMPLATE int32_t sort_block_as(const struct sphgi_sort *sort, int32_t b, size_t row_size)
{
    if (!sort->raster->octaves)
        return sort_block(sort, b, row_size, 1);
    const int32_t fullest = sort_block(sort, b, row_size, SPHGI_QUARTERS);
    struct sphgi_leaf *leaf = &sort->grid->tree.leaves[b / SPHGI_TREE_WIDTH];
    leaf->radius[b % SPHGI_TREE_WIDTH] = radius_of_block(sort, b);
    return fullest;
}

static void cells_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sphgi_sort *sort = data;
    int32_t fullest = 0;
    (void)worker;
    for (int32_t b = begin; b < end; ++b) {
        const int32_t most = sort->type == SPHG_F64
                                 ? sort_block_as(sort, b, SPHGI_ROW * sizeof(double))
                                 : sort_block_as(sort, b, SPHGI_ROW * sizeof(float));
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

static void sort_by_block(sphg_context *context, struct sphgi_sort *sort)
{
    count_blocks_of_chunks(sort);
    sphgi_place_blocks(sort);
    sphgi_parallel_for(context, scatter_task, sort, sort->chunk_count, 1);
    sphgi_parallel_for(context, cells_task, sort, sort->grid->block_count, BLOCK_GRAIN);
}

/* ---- Memory --------------------------------------------------------------------------------- */

/* Enough for a table that doubles as soon as half of it is taken. */
static size_t chunk_slots(int32_t particles)
{
    size_t slots = SPHGI_SLOTS_LEAST;
    while (slots / 2 < (size_t)particles)
        slots *= 2;
    return slots;
}

/* A dozen times as many as a dense cloud has blocks, so that two of these seldom share a place. */
static int32_t bits_seen(int32_t particles)
{
    int32_t bits = 4;
    while (particles >> (bits + 4))
        ++bits;
    return bits;
}

static void place_chunk(struct sphgi_chunk *chunk, struct sphgi_layout *layout, int32_t particles)
{
    chunk->keys = sphgi_place(layout, (size_t)particles, sizeof *chunk->keys);
    chunk->hash = sphgi_place(layout, chunk_slots(particles), sizeof *chunk->hash);
    chunk->counts = sphgi_place(layout, (size_t)particles, sizeof *chunk->counts);
    chunk->global = sphgi_place(layout, (size_t)particles, sizeof *chunk->global);
    chunk->seen_bits = bits_seen(particles);
    chunk->seen = sphgi_place(layout, (size_t)1 << chunk->seen_bits, sizeof *chunk->seen);
}

/* Returns the bytes. */
static size_t place_sort(struct sphgi_sort *sort, char *base, int32_t count)
{
    struct sphgi_layout layout = {base, 0};
    const size_t n = (size_t)count;
    const int32_t each = (count + sort->chunk_count - 1) / sort->chunk_count;
    sort->chunks = sphgi_place(&layout, (size_t)sort->chunk_count, sizeof *sort->chunks);
    sort->block = sphgi_place(&layout, n, sizeof *sort->block);
    sort->order = sphgi_place(&layout, n, sizeof *sort->order);
    sort->cell = sphgi_place(&layout, n, 1);
    sort->sorted_cell = sphgi_place(&layout, n, 1);
    sort->keys = sphgi_place(&layout, n, sizeof *sort->keys);
    sort->numbers = sphgi_place(&layout, n, sizeof *sort->numbers);
    sort->scratch = sphgi_place(&layout, n, sizeof *sort->scratch);
    for (int32_t c = 0; c < sort->chunk_count; ++c) {
        const int64_t begin = (int64_t)c * each, end = begin + each;
        struct sphgi_chunk chunk = {.begin = begin < count ? (int32_t)begin : count,
                                    .end = end < count ? (int32_t)end : count};
        place_chunk(&chunk, &layout, each);
        if (!base)
            continue;
        chunk.cells = sort->order + chunk.begin;
        if (!sort->raster->octaves)
            chunk.cells_most = (chunk.end - chunk.begin) / SPHGI_BLOCK_CELLS;
        sort->chunks[c] = chunk;
    }
    return layout.used;
}

sphg_result sphgi_grid_build(sphg_context *context, struct sphgi_grid *grid,
                             const struct sphgi_allocator *allocator,
                             const struct sphgi_raster *raster, sphg_type type, const void *rows,
                             int32_t count, void *tables, struct sphgi_buffer *place)
{
    const size_t n = (size_t)count, row_size = SPHGI_ROW * sphgi_size_of_type(type);
    struct sphgi_sort sort = {.raster = raster,
                              .cutting = sphgi_cutting_of(raster),
                              .passes = sphgi_passes_of(context, type),
                              .type = type,
                              .rows = rows,
                              .grid = grid};
    sort.chunk_count = sphgi_max32(1, sphgi_min32(context->threads, count / CHUNK_LEAST));
    grid->sorted = false;
    if (!sphgi_reserve(&context->allocator, &context->sort, place_sort(&sort, NULL, count), 1) ||
        !sphgi_reserve(allocator, &grid->rows, n + SPHGI_LANES_MOST, row_size) ||
        !sphgi_reserve(allocator, &grid->cell_start, n + 1, sizeof(int32_t)) ||
        !sphgi_reserve(allocator, &grid->order, n, sizeof(int32_t)) ||
        (place && !sphgi_reserve(allocator, place, n, sizeof(int32_t))))
        return SPHG_ERROR_MEMORY;
    sort.place = place ? place->data : NULL;
    place_sort(&sort, context->sort.data, count);
    grid->raster = *raster;
    grid->type = type;
    grid->count = count;
    sphgi_parallel_for(context, sphgi_collect_chunks, &sort, sort.chunk_count, 1);
    sphgi_number_blocks(&sort, sphgi_merge_keys(&sort, tables),
                        tables); /* the tables are scratch at first */
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
