/* What lies around a block of the grid. */
#include "grid.h"

/* The staged cells along one axis: one before the block, the block, one behind it. They lie in at
 * most three blocks: the one before, its own, the one behind, or what a period makes of them. */
struct line {
    int32_t count, blocks, parts;
    int64_t block[3];
    int32_t owner[SPHGI_STAGED_WIDTH_MOST];    /* per cell: its block ... */
    int32_t local[SPHGI_STAGED_WIDTH_MOST];    /* ... and its number there */
    int32_t part_end[SPHGI_STAGED_WIDTH_MOST]; /* parts: cells that follow one another in a block */
};

static void add_cell(struct line *line, int64_t block, int32_t local)
{
    const int32_t k = line->count++;
    if (!k || block != line->block[line->blocks - 1])
        line->block[line->blocks++] = block;
    line->owner[k] = line->blocks - 1;
    line->local[k] = local;
    if (!k || line->owner[k] != line->owner[k - 1] || local != line->local[k - 1] + 1)
        ++line->parts;
    line->part_end[line->parts - 1] = line->count;
}

static struct line line_of(const struct sphgi_axis *axis, int64_t block, bool used)
{
    struct line line = {.count = 0};
    const int64_t length = (int64_t)1 << axis->shift;
    if (!used)
        add_cell(&line, block, 0);
    for (int64_t k = -1; k <= length && used; ++k) {
        int64_t cell = block * length + k;
        if (axis->cells)
            cell = (cell % axis->cells + axis->cells) % axis->cells;
        add_cell(&line, cell >> axis->shift, (int32_t)(cell & (length - 1)));
    }
    return line;
}

static void lines_of(const struct sphgi_lattice *lattice, struct sphgi_key block, struct line *line)
{
    int64_t at[3];
    sphgi_key_open(block, at);
    for (int32_t a = 0; a < 3; ++a)
        line[a] = line_of(&lattice->axis[a], at[a], a < lattice->dimension);
}

/* The blocks of sources that the lines meet in, NULL where nobody is. */
struct meeting {
    const struct sphgi_block *block[3][3][3];
};

static void find_blocks(const struct sphgi_grid *sources, const struct line *line,
                        struct meeting *meeting)
{
    enum { LINE = SPHGI_ALIGNMENT / sizeof(int32_t) };
    for (int32_t z = 0; z < line[2].blocks; ++z)
        for (int32_t y = 0; y < line[1].blocks; ++y)
            for (int32_t x = 0; x < line[0].blocks; ++x) {
                const int64_t at[3] = {line[0].block[x], line[1].block[y], line[2].block[z]};
                const int32_t found = sphgi_find_block(sources, at);
                meeting->block[z][y][x] = NULL;
                if (found < 0)
                    continue;
                const struct sphgi_block *block = &sources->blocks[found];
                const int32_t *start = (const int32_t *)sources->cell_start.data + block->first;
                meeting->block[z][y][x] = block;
                for (int32_t c = 0; c <= sources->cells; c += LINE) /* all on their way at once */
                    __builtin_prefetch(start + c);
            }
}

static uint32_t bits_below(uint32_t bits, int32_t place)
{
    bits &= ((uint32_t)1 << place) - 1;
    bits -= bits >> 1 & 0x55555555u;
    bits = (bits & 0x33333333u) + (bits >> 2 & 0x33333333u);
    return ((bits + (bits >> 4)) & 0x0F0F0F0Fu) * 0x01010101u >> 24;
}

static void add_range(struct sphgi_surroundings *around, int32_t begin, int32_t end)
{
    const int32_t last = around->ranges - 1;
    if (last >= 0 && around->begin[last] + around->count[last] == begin)
        around->count[last] += end - begin;
    else if (end > begin) {
        around->begin[around->ranges] = begin;
        around->count[around->ranges++] = end - begin;
    }
    around->staged += end - begin;
}

/* Ranges and offsets of one row of staged cells. local: the cell's number without its x. */
static void stage_row(const struct sphgi_grid *sources, const struct line *line, int32_t local,
                      const struct sphgi_block *const *blocks, struct sphgi_surroundings *around,
                      int32_t *offset)
{
    for (int32_t part = 0, x = 0; part < line->parts; ++part) {
        const struct sphgi_block *block = blocks[line->owner[x]];
        const int32_t end = line->part_end[part], first = local + line->local[x];
        if (!block) {
            for (; x < end; ++x)
                offset[x] = around->staged;
            continue;
        }
        const int32_t *start = (const int32_t *)sources->cell_start.data + block->first +
                               bits_below(block->occupied, first);
        const int32_t begin = *start;
        uint32_t occupied = block->occupied >> first;
        for (; x < end; ++x, occupied >>= 1) {
            offset[x] = around->staged + *start - begin;
            start += occupied & 1;
        }
        add_range(around, begin, *start);
    }
    offset[line->count] = around->staged;
}

void sphgi_surroundings_of(const struct sphgi_grid *sources, struct sphgi_key block,
                           struct sphgi_surroundings *around)
{
    const struct sphgi_lattice *lattice = &sources->lattice;
    struct line line[3];
    struct meeting meeting;
    lines_of(lattice, block, line);
    find_blocks(sources, line, &meeting);
    const int32_t shift_x = lattice->axis[0].shift;
    const int32_t shift_xy = shift_x + lattice->axis[1].shift;
    around->ranges = 0;
    around->staged = 1;
    int32_t row = 0;
    for (int32_t z = 0; z < line[2].count; ++z)
        for (int32_t y = 0; y < line[1].count; ++y, ++row)
            stage_row(sources, &line[0], line[2].local[z] << shift_xy | line[1].local[y] << shift_x,
                      meeting.block[line[2].owner[z]][line[1].owner[y]], around,
                      around->offset[row]);
}

/* Position of a cell of the block among the staged ones. */
static void staged_position(const struct sphgi_lattice *lattice, int32_t cell, int32_t *at)
{
    for (int32_t a = 0; a < 3; ++a) {
        const int32_t shift = lattice->axis[a].shift;
        at[a] = (cell & ((1 << shift) - 1)) + (a < lattice->dimension);
        cell >>= shift;
    }
}

static int32_t staged_row(const struct sphgi_lattice *lattice, int32_t y, int32_t z)
{
    return z * ((1 << lattice->axis[1].shift) + 2) + y;
}

void sphgi_candidate_runs(const struct sphgi_lattice *lattice,
                          const struct sphgi_surroundings *around, int32_t cell,
                          struct sphgi_runs *runs)
{
    int32_t at[3], count = 1;
    const struct sphgi_axis *axis = lattice->axis;
    staged_position(lattice, cell, at);
    const int32_t low = at[0] + axis[0].low, behind = at[0] + axis[0].high + 1;
    const int32_t *own = around->offset[staged_row(lattice, at[1], at[2])];
    int32_t candidates = own[behind] - own[low];
    runs->own = own[at[0]];
    runs->begin[0] = own[low];
    runs->length[0] = candidates;
    for (int32_t z = at[2] + axis[2].low; z <= at[2] + axis[2].high; ++z) {
        const int32_t *offset = around->offset[staged_row(lattice, at[1] + axis[1].low, z)];
        for (int32_t y = axis[1].low; y <= axis[1].high; ++y) {
            const int32_t begin = offset[low], length = offset[behind] - begin;
            if (offset != own && length) {
                runs->begin[count] = begin;
                runs->length[count++] = length;
                candidates += length;
            }
            offset += SPHGI_STAGED_WIDTH_MOST + 1;
        }
    }
    runs->count = count;
    runs->candidates = candidates;
}
