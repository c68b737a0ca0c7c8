/* What lies around a block of the grid. */
#include "grid.h"

/* The staged cells along one axis: one before the block, the block, one behind it. They lie in at
 * most three runs of cells of one block each: the one before, its own, the one behind, or what a
 * period makes of them. */
struct line {
    int64_t block[SPHGI_STAGED_WIDTH_MOST];
    int32_t local[SPHGI_STAGED_WIDTH_MOST];
    int32_t run[SPHGI_STAGED_WIDTH_MOST];
    int32_t count;
};

static struct line line_of(const struct sphgi_axis *axis, int64_t block, bool used)
{
    struct line line = {.count = 1, .block = {block}};
    const int64_t length = (int64_t)1 << axis->shift;
    if (!used)
        return line;
    line.count = (int32_t)length + 2;
    for (int32_t k = 0; k < line.count; ++k) {
        int64_t cell = block * length + k - 1;
        if (axis->cells)
            cell = (cell % axis->cells + axis->cells) % axis->cells;
        line.block[k] = cell >> axis->shift;
        line.local[k] = (int32_t)(cell & (length - 1));
        if (k)
            line.run[k] = line.run[k - 1] + (line.block[k] != line.block[k - 1]);
    }
    return line;
}

static int32_t place_around(int32_t x, int32_t y, int32_t z)
{
    return (z * 3 + y) * 3 + x;
}

static bool goes_on(const struct line *line, int32_t k)
{
    return k && line->run[k] == line->run[k - 1];
}

void sphgi_find_around(const struct sphgi_grid *sources, const int64_t *block, int32_t *blocks)
{
    const struct sphgi_lattice *lattice = &sources->lattice;
    struct line line[3];
    for (int32_t a = 0; a < 3; ++a)
        line[a] = line_of(&lattice->axis[a], block[a], a < lattice->dimension);
    for (int32_t k = 0; k < SPHGI_AROUND; ++k)
        blocks[k] = -1;
    for (int32_t z = 0; z < line[2].count; ++z)
        for (int32_t y = 0; y < line[1].count && !goes_on(&line[2], z); ++y)
            for (int32_t x = 0; x < line[0].count && !goes_on(&line[1], y); ++x)
                if (!goes_on(&line[0], x))
                    blocks[place_around(line[0].run[x], line[1].run[y], line[2].run[z])] =
                        sphgi_find_block(sources,
                                         (const int64_t[3]){line[0].block[x], line[1].block[y],
                                                            line[2].block[z]});
}

/* Ranges and offsets of one row of staged cells. local: the cell's number without its x; found: the
 * blocks of the row. */
static void stage_row(const struct sphgi_grid *sources, const struct line *x_line, int32_t local,
                      const int32_t *found, struct sphgi_surroundings *around, int32_t *offset)
{
    int32_t behind = -1; /* where the last range ends, if it may go on */
    for (int32_t x = 0; x < x_line->count; ++x) {
        offset[x] = around->staged;
        const int32_t block = found[x_line->run[x]];
        if (block < 0)
            continue;
        const int32_t *at = (const int32_t *)sources->cell_start.data +
                            (ptrdiff_t)block * sources->cells + local + x_line->local[x];
        const int32_t count = at[1] - at[0];
        if (!count)
            continue;
        if (at[0] == behind)
            around->count[around->ranges - 1] += count;
        else {
            around->begin[around->ranges] = at[0];
            around->count[around->ranges++] = count;
        }
        behind = at[1];
        around->staged += count;
    }
    offset[x_line->count] = around->staged;
}

void sphgi_surroundings_of(const struct sphgi_grid *sources, const int64_t *block,
                           const int32_t *blocks, struct sphgi_surroundings *around)
{
    const struct sphgi_lattice *lattice = &sources->lattice;
    struct line line[3];
    for (int32_t a = 0; a < 3; ++a)
        line[a] = line_of(&lattice->axis[a], block[a], a < lattice->dimension);
    const int32_t shift_x = lattice->axis[0].shift;
    const int32_t shift_xy = shift_x + lattice->axis[1].shift;
    around->ranges = 0;
    around->staged = 1;
    int32_t row = 0;
    for (int32_t z = 0; z < line[2].count; ++z)
        for (int32_t y = 0; y < line[1].count; ++y, ++row) {
            const int32_t local = line[2].local[z] << shift_xy | line[1].local[y] << shift_x;
            stage_row(sources, &line[0], local,
                      blocks + place_around(0, line[1].run[y], line[2].run[z]), around,
                      around->offset[row]);
        }
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

struct sphgi_runs sphgi_candidate_runs(const struct sphgi_lattice *lattice,
                                       const struct sphgi_surroundings *around, int32_t cell)
{
    int32_t at[3], count = 1;
    const struct sphgi_axis *axis = lattice->axis;
    staged_position(lattice, cell, at);
    const int32_t low = at[0] + axis[0].low, behind = at[0] + axis[0].high + 1;
    const int32_t *own = around->offset[staged_row(lattice, at[1], at[2])];
    struct sphgi_runs runs = {
        .own = own[at[0]], .begin = {own[low]}, .length = {own[behind] - own[low]}};
    int32_t candidates = runs.length[0];
    for (int32_t z = at[2] + axis[2].low; z <= at[2] + axis[2].high; ++z) {
        const int32_t *offset = around->offset[staged_row(lattice, at[1] + axis[1].low, z)];
        for (int32_t y = axis[1].low; y <= axis[1].high; ++y) {
            const int32_t begin = offset[low], length = offset[behind] - begin;
            if (offset != own && length) {
                runs.begin[count] = begin;
                runs.length[count++] = length;
                candidates += length;
            }
            offset += SPHGI_STAGED_WIDTH_MOST + 1;
        }
    }
    runs.count = count;
    runs.candidates = candidates;
    return runs;
}
