#include "grid.h"
#include "parallel.h"
#include <string.h>

enum { CHUNK_LEAST = 4096, HASH_LEAST = 1024 };

/* ---- Cells ---------------------------------------------------------------------------------- */

/* The cell of a coordinate must be monotone, and particles closer than the reach must lie in the
 * same or in adjacent cells, for every finite coordinate. t is the coordinate in cells, with a
 * relative error of 2^-52.
 *   |t| < 2^40   floor(t): the error is below 2^-11 cells, and cells are wider than the reach by
 * 2^-9 |t| < 2^54   2^14 times coarser beyond 2^40: monotone, slope at most 1, and the error stays
 * small beyond       neighbouring coordinates there are more than a reach apart, so that neighbours
 *                have equal coordinates: any monotone map will do, the bits themselves serve. */
static double far_cell(double a)
{
    const double first = 0x1p40, second = 0x1p54;
    if (a < second)
        return first + (a - first) * 0x1p-14;
    uint64_t bits, base;
    memcpy(&bits, &a, sizeof bits);
    memcpy(&base, &second, sizeof base);
    return 2 * first + (double)((bits - base) >> 22);
}

static int64_t floor_to_int(double t)
{
    const int64_t whole = (int64_t)t;
    return whole - (t < (double)whole);
}

static int64_t open_cell(double t)
{
    if (t < 0x1p40 && t > -0x1p40)
        return floor_to_int(t);
    return t > 0 ? floor_to_int(far_cell(t)) : floor_to_int(-far_cell(-t));
}

static int64_t periodic_cell(const struct sphgi_axis *axis, double x)
{
    double turns = x / axis->length;
    turns -= __builtin_floor(turns);
    const int64_t cell = (int64_t)(turns * (double)axis->cells);
    return cell < axis->cells ? cell : axis->cells - 1;
}

static int64_t cell_of(const struct sphgi_axis *axis, double x)
{
    return axis->cells ? periodic_cell(axis, x) : open_cell(x * axis->inverse);
}

struct sphgi_lattice sphgi_lattice_of(int32_t dimension, double reach, const double *period,
                                      const double *largest, sphg_type type)
{
    static const int32_t shift[2][3] = {{3, 2, 0}, {2, 2, 1}};
    struct sphgi_lattice lattice = {.dimension = dimension};
    const double unit = type == SPHG_F64 ? 0x1p-53 : 0x1p-24;
    const double wide = reach * (1 + 0x1p-9);
    for (int32_t a = 0; a < 3; ++a) {
        struct sphgi_axis *axis = &lattice.axis[a];
        *axis = (struct sphgi_axis){.inverse = 1 / wide, .low = -1, .high = 1};
        axis->shift = shift[dimension == 3][a];
        if (a >= dimension)
            *axis = (struct sphgi_axis){.shift = 0};
        else if (period[a] > 0) {
            const double slack = 16 * unit * largest[a];
            const double cells = period[a] / (wide + slack);
            lattice.slack = slack > lattice.slack ? slack : lattice.slack;
            axis->length = period[a];
            axis->cells = cells < 1 ? 1 : cells < 0x1p40 ? (int64_t)cells : (int64_t)1 << 40;
            axis->low = axis->cells >= 3 ? -1 : 0;
            axis->high = axis->cells >= 2 ? 1 : 0;
        }
    }
    return lattice;
}

static int32_t cells_per_block(const struct sphgi_lattice *lattice)
{
    return 1 << (lattice->axis[0].shift + lattice->axis[1].shift + lattice->axis[2].shift);
}

static int32_t local_cell(const struct sphgi_lattice *lattice, const int64_t *cell)
{
    int32_t local = 0;
    for (int32_t a = 2; a >= 0; --a) {
        const int32_t shift = lattice->axis[a].shift;
        local = local << shift | (int32_t)(cell[a] & ((1 << shift) - 1));
    }
    return local;
}

/* ---- Hash of blocks ------------------------------------------------------------------------- */

static uint32_t hash_of(const int64_t *at)
{
    uint64_t h = (uint64_t)at[0] * 0x9E3779B97F4A7C15u;
    h = (h ^ h >> 29) + (uint64_t)at[1] * 0xBF58476D1CE4E5B9u;
    h = (h ^ h >> 32) + (uint64_t)at[2] * 0x94D049BB133111EBu;
    h = (h ^ h >> 30) * 0x9E3779B97F4A7C15u;
    return (uint32_t)(h >> 32);
}

static bool same_block(const int64_t *a, const int64_t *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* The slot that holds the block, or the free one where it belongs. */
static uint32_t find_slot(const int32_t *hash, uint32_t mask, const struct sphgi_block *blocks,
                          const int64_t *at)
{
    uint32_t slot = hash_of(at) & mask;
    while (hash[slot] && !same_block(blocks[hash[slot] - 1].at, at))
        slot = (slot + 1) & mask;
    return slot;
}

static uint32_t power_of_two_above(int64_t value)
{
    uint32_t power = HASH_LEAST;
    while ((int64_t)power < value)
        power *= 2;
    return power;
}

/* ---- Sorting into blocks -------------------------------------------------------------------- */

/* Each chunk of particles collects the blocks it meets on its own; the results are merged in order,
 * so that nothing depends on the number of chunks. */
struct chunk {
    int32_t begin, end;
    int32_t block_count;
    struct sphgi_block *blocks; /* in order of appearance */
    int32_t *hash;              /* grows from HASH_LEAST inside its share */
    int32_t *counts;            /* particles per block; later: where the next one goes */
    int32_t *global;            /* number in the grid */
};

struct sort {
    const struct sphgi_lattice *lattice;
    sphg_type type;
    const void *rows;
    struct chunk *chunks;
    int32_t *block; /* per particle: block of its chunk */
    uint8_t *cell;  /* per particle */
    int32_t *order; /* particles by block */
    uint8_t *sorted_cell;
    struct sphgi_grid *grid;
    atomic_int_least32_t fullest;
};

static void rehash(struct chunk *chunk, uint32_t mask)
{
    memset(chunk->hash, 0, ((size_t)mask + 1) * sizeof *chunk->hash);
    for (int32_t b = 0; b < chunk->block_count; ++b)
        chunk->hash[find_slot(chunk->hash, mask, chunk->blocks, chunk->blocks[b].at)] = b + 1;
}

static int32_t block_in_chunk(struct chunk *chunk, uint32_t *mask, const int64_t *at)
{
    uint32_t slot = find_slot(chunk->hash, *mask, chunk->blocks, at);
    if (chunk->hash[slot])
        return chunk->hash[slot] - 1;
    const int32_t b = chunk->block_count++;
    memcpy(chunk->blocks[b].at, at, sizeof chunk->blocks[b].at);
    chunk->counts[b] = 0;
    chunk->hash[slot] = b + 1;
    if ((uint32_t)chunk->block_count > *mask / 2) {
        *mask = 2 * *mask + 1;
        rehash(chunk, *mask);
    }
    return b;
}

SPHGI_TEMPLATE void collect_chunk(const struct sort *sort, struct chunk *chunk, bool f64)
{
    uint32_t mask = HASH_LEAST - 1;
    int64_t last[3] = {INT64_MIN, 0, 0};
    int32_t b = 0;
    rehash(chunk, mask);
    for (int32_t i = chunk->begin; i < chunk->end; ++i) {
        int64_t cell[3], at[3];
        for (int32_t a = 0; a < 3; ++a) {
            const size_t k = SPHGI_ROW * (size_t)i + (size_t)a;
            const double x =
                f64 ? ((const double *)sort->rows)[k] : (double)((const float *)sort->rows)[k];
            cell[a] = a < sort->lattice->dimension ? cell_of(&sort->lattice->axis[a], x) : 0;
            at[a] = cell[a] >> sort->lattice->axis[a].shift;
        }
        if (!same_block(at, last)) {
            b = block_in_chunk(chunk, &mask, at);
            memcpy(last, at, sizeof last);
        }
        sort->block[i] = b;
        sort->cell[i] = (uint8_t)local_cell(sort->lattice, cell);
        ++chunk->counts[b];
    }
}

static void collect_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sort *sort = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c)
        if (sort->type == SPHG_F64)
            collect_chunk(sort, &sort->chunks[c], true);
        else
            collect_chunk(sort, &sort->chunks[c], false);
}

/* Along the Morton curve: the axis with the highest differing bit decides. */
static bool before_on_curve(const struct sphgi_block *a, const struct sphgi_block *b,
                            const int64_t *low)
{
    int32_t axis = 2;
    uint64_t highest = 0;
    for (int32_t k = 2; k >= 0; --k) {
        const uint64_t difference =
            ((uint64_t)a->at[k] - (uint64_t)low[k]) ^ ((uint64_t)b->at[k] - (uint64_t)low[k]);
        if (highest < difference && highest < (highest ^ difference)) {
            axis = k;
            highest = difference;
        }
    }
    return a->at[axis] < b->at[axis];
}

static void merge_runs(const struct sphgi_block *blocks, const int64_t *low, const int32_t *from,
                       int32_t *to, int32_t begin, int32_t middle, int32_t end)
{
    int32_t a = begin, b = middle;
    for (int32_t k = begin; k < end; ++k) {
        const bool take_b =
            a >= middle || (b < end && before_on_curve(&blocks[from[b]], &blocks[from[a]], low));
        to[k] = take_b ? from[b++] : from[a++];
    }
}

/* Numbers of the blocks in curve order, by merging; scratch holds as many. */
static int32_t *sort_blocks(const struct sphgi_block *blocks, int32_t count, int32_t *numbers,
                            int32_t *scratch)
{
    int64_t low[3] = {INT64_MAX, INT64_MAX, INT64_MAX};
    for (int32_t b = 0; b < count; ++b) {
        numbers[b] = b;
        for (int32_t a = 0; a < 3; ++a)
            low[a] = blocks[b].at[a] < low[a] ? blocks[b].at[a] : low[a];
    }
    for (int64_t width = 1; width < count; width *= 2) {
        for (int64_t begin = 0; begin < count; begin += 2 * width) {
            const int64_t middle = begin + width < count ? begin + width : count;
            const int64_t end = middle + width < count ? middle + width : count;
            merge_runs(blocks, low, numbers, scratch, (int32_t)begin, (int32_t)middle,
                       (int32_t)end);
        }
        int32_t *swap = numbers;
        numbers = scratch;
        scratch = swap;
    }
    return numbers;
}

/* Places: first particle of each block and, in chunk->counts, of each chunk's share of it. */
static void place_blocks(struct sort *sort, int32_t chunk_count, int32_t *cursor)
{
    struct sphgi_grid *grid = sort->grid;
    memset(cursor, 0, (size_t)grid->block_count * sizeof *cursor);
    for (int32_t c = 0; c < chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            cursor[sort->chunks[c].global[b]] += sort->chunks[c].counts[b];
    int32_t *start = grid->cell_start.data, next = 0;
    for (int32_t b = 0; b < grid->block_count; ++b) {
        const int32_t size = cursor[b];
        cursor[b] = start[(size_t)b * (size_t)grid->cells] = next;
        next += size;
    }
    start[(size_t)grid->block_count * (size_t)grid->cells] = next;
    for (int32_t c = 0; c < chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            int32_t *place = &cursor[sort->chunks[c].global[b]];
            const int32_t size = sort->chunks[c].counts[b];
            sort->chunks[c].counts[b] = *place;
            *place += size;
        }
}

static void scatter_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sort *sort = data;
    (void)worker;
    for (int32_t c = begin; c < end; ++c) {
        struct chunk *chunk = &sort->chunks[c];
        for (int32_t i = chunk->begin; i < chunk->end; ++i) {
            const int32_t place = chunk->counts[sort->block[i]]++;
            sort->order[place] = i;
            sort->sorted_cell[place] = sort->cell[i];
        }
    }
}

/* Inside the blocks: a counting sort by cell, and the rows follow. */
static void cells_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct sort *sort = data;
    struct sphgi_grid *grid = sort->grid;
    const size_t row_size = SPHGI_ROW * sphgi_size_of_type(sort->type);
    char *rows = grid->rows.data;
    int32_t *order = grid->order.data, fullest = 0;
    (void)worker;
    for (int32_t b = begin; b < end; ++b) {
        int32_t *start = (int32_t *)grid->cell_start.data + (size_t)b * (size_t)grid->cells;
        int32_t place[SPHGI_BLOCK_CELLS_MOST] = {0};
        const int32_t first = start[0], last = start[grid->cells];
        for (int32_t k = first; k < last; ++k)
            ++place[sort->sorted_cell[k]];
        for (int32_t c = 0, next = first; c < grid->cells; ++c) {
            const int32_t size = place[c];
            fullest = size > fullest ? size : fullest;
            place[c] = next;
            if (c)
                start[c] = next;
            next += size;
        }
        for (int32_t k = first; k < last; ++k) {
            const int32_t to = place[sort->sorted_cell[k]]++, i = sort->order[k];
            order[to] = i;
            memcpy(rows + (size_t)to * row_size, (const char *)sort->rows + (size_t)i * row_size,
                   row_size);
        }
    }
    int_least32_t seen = atomic_load(&sort->fullest);
    while (seen < fullest && !atomic_compare_exchange_weak(&sort->fullest, &seen, fullest))
        ;
}

/* Occupied blocks come and go while the number of particles stays: once an array has to grow, it
 * gets room for twice as much, up to what that many particles can need at all. */
static bool reserve_generously(const struct sphgi_allocator *allocator, struct sphgi_buffer *buffer,
                               size_t count, size_t most, size_t size)
{
    const bool enough = count * size <= buffer->size;
    return sphgi_reserve(allocator, buffer, enough ? count : sphgi_generous(count, most), size);
}

/* Blocks of all chunks, numbered along the curve. False: out of memory. */
static bool merge_chunks(struct sort *sort, const struct sphgi_allocator *allocator,
                         int32_t chunk_count, struct sphgi_block *all, int32_t *numbers,
                         int32_t *scratch)
{
    struct sphgi_grid *grid = sort->grid;
    int64_t total = 0;
    for (int32_t c = 0; c < chunk_count; ++c)
        total += sort->chunks[c].block_count;
    const uint32_t slots = power_of_two_above(2 * total);
    const size_t particles = (size_t)grid->count;
    if (!reserve_generously(allocator, &grid->hash, slots, 8 * particles + HASH_LEAST,
                            sizeof(int32_t)))
        return false;
    int32_t *hash = grid->hash.data, count = 0;
    grid->hash_mask = slots - 1;
    memset(hash, 0, slots * sizeof *hash);
    for (int32_t c = 0; c < chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b) {
            const struct sphgi_block *block = &sort->chunks[c].blocks[b];
            const uint32_t slot = find_slot(hash, grid->hash_mask, all, block->at);
            if (!hash[slot]) {
                all[count++] = *block;
                hash[slot] = count;
            }
            sort->chunks[c].global[b] = hash[slot] - 1;
        }
    grid->block_count = count;
    grid->cells = cells_per_block(sort->lattice);
    const size_t cells = (size_t)grid->cells;
    if (!reserve_generously(allocator, &grid->blocks, (size_t)count, particles,
                            sizeof(struct sphgi_block)) ||
        !reserve_generously(allocator, &grid->cell_start, (size_t)count * cells + 1,
                            particles * cells + 1, sizeof(int32_t)))
        return false;
    const int32_t *sorted = sort_blocks(all, count, numbers, scratch);
    int32_t *rank = sorted == numbers ? scratch : numbers;
    for (int32_t k = 0; k < count; ++k) {
        rank[sorted[k]] = k;
        ((struct sphgi_block *)grid->blocks.data)[k] = all[sorted[k]];
    }
    for (uint32_t slot = 0; slot < slots; ++slot)
        if (hash[slot])
            hash[slot] = rank[hash[slot] - 1] + 1;
    for (int32_t c = 0; c < chunk_count; ++c)
        for (int32_t b = 0; b < sort->chunks[c].block_count; ++b)
            sort->chunks[c].global[b] = rank[sort->chunks[c].global[b]];
    return true;
}

/* Scratch of the sort, carved from one buffer; per particle 24 + 24 + 16 + 4 * 6 + 2 bytes. */
struct carver {
    char *next;
};

static void *carve(struct carver *carver, size_t count, size_t size)
{
    void *here = carver->next;
    carver->next += sphgi_round_up(count * size, SPHGI_ALIGNMENT);
    return here;
}

static size_t chunk_hash_slots(int32_t particles)
{
    return 2 * (size_t)power_of_two_above(2 * (int64_t)particles);
}

static size_t scratch_size(int32_t count, int32_t chunk_count, int32_t per_chunk)
{
    const size_t n = (size_t)count, each = (size_t)per_chunk;
    const size_t chunk = each * (sizeof(struct sphgi_block) + 2 * sizeof(int32_t)) +
                         chunk_hash_slots(per_chunk) * sizeof(int32_t) + 4 * SPHGI_ALIGNMENT;
    return (size_t)chunk_count * (chunk + sizeof(struct chunk)) +
           n * (sizeof(struct sphgi_block) + 5 * sizeof(int32_t) + 2) + 16 * SPHGI_ALIGNMENT;
}

sphg_result sphgi_grid_build(sphg_context *context, struct sphgi_grid *grid,
                             const struct sphgi_allocator *allocator,
                             const struct sphgi_lattice *lattice, sphg_type type, const void *rows,
                             int32_t count)
{
    const int32_t chunk_count = sphgi_max32(1, sphgi_min32(context->threads, count / CHUNK_LEAST));
    const int32_t per_chunk = (count + chunk_count - 1) / chunk_count;
    const size_t n = (size_t)count, row_size = SPHGI_ROW * sphgi_size_of_type(type);
    if (!sphgi_reserve(&context->allocator, &context->sort,
                       scratch_size(count, chunk_count, per_chunk), 1) ||
        !sphgi_reserve(allocator, &grid->rows, n + SPHGI_LANES_MOST, row_size) ||
        !sphgi_reserve(allocator, &grid->order, n, sizeof(int32_t)))
        return SPHG_ERROR_MEMORY;
    struct carver carver = {context->sort.data};
    struct sort sort = {.lattice = lattice, .type = type, .rows = rows, .grid = grid};
    sort.chunks = carve(&carver, (size_t)chunk_count, sizeof *sort.chunks);
    sort.block = carve(&carver, n, sizeof *sort.block);
    sort.order = carve(&carver, n, sizeof *sort.order);
    sort.cell = carve(&carver, n, 1);
    sort.sorted_cell = carve(&carver, n, 1);
    struct sphgi_block *all = carve(&carver, n, sizeof *all);
    int32_t *numbers = carve(&carver, n, sizeof *numbers);
    int32_t *scratch = carve(&carver, n, sizeof *scratch);
    int32_t *cursor = carve(&carver, n, sizeof *cursor);
    for (int32_t c = 0; c < chunk_count; ++c) {
        struct chunk *chunk = &sort.chunks[c];
        const int64_t begin = (int64_t)c * per_chunk, end = begin + per_chunk;
        *chunk = (struct chunk){.begin = begin < count ? (int32_t)begin : count,
                                .end = end < count ? (int32_t)end : count};
        chunk->blocks = carve(&carver, (size_t)per_chunk, sizeof *chunk->blocks);
        chunk->hash = carve(&carver, chunk_hash_slots(per_chunk), sizeof *chunk->hash);
        chunk->counts = carve(&carver, (size_t)per_chunk, sizeof *chunk->counts);
        chunk->global = carve(&carver, (size_t)per_chunk, sizeof *chunk->global);
    }
    grid->lattice = *lattice;
    grid->count = count;
    sphgi_parallel_for(context, collect_task, &sort, chunk_count, 1);
    if (!merge_chunks(&sort, allocator, chunk_count, all, numbers, scratch))
        return SPHG_ERROR_MEMORY;
    place_blocks(&sort, chunk_count, cursor);
    sphgi_parallel_for(context, scatter_task, &sort, chunk_count, 1);
    sphgi_parallel_for(context, cells_task, &sort, grid->block_count, 16);
    memset((char *)grid->rows.data + n * row_size, 0, SPHGI_LANES_MOST * row_size);
    grid->fullest = (int32_t)atomic_load(&sort.fullest);
    return SPHG_OK;
}

int32_t sphgi_find_block(const struct sphgi_grid *grid, const int64_t *at)
{
    const int32_t *hash = grid->hash.data;
    return hash[find_slot(hash, grid->hash_mask, grid->blocks.data, at)] - 1;
}

void sphgi_grid_free(struct sphgi_grid *grid, const struct sphgi_allocator *allocator)
{
    struct sphgi_buffer *buffers[] = {&grid->blocks, &grid->cell_start, &grid->hash, &grid->rows,
                                      &grid->order};
    for (size_t k = 0; k < sizeof buffers / sizeof *buffers; ++k)
        sphgi_free(allocator, buffers[k]);
}
