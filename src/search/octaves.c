#include "grid.h"
#include <string.h>

/* ---- Octaves -------------------------------------------------------------------------------- */

enum { Z_SHIFT = 38 }; /* blocks of an octave have |z| below half of 2^Z_SHIFT */

/* Positive numbers rise as their bits do: the quotient's exponent, rounded down. */
static int32_t octaves_between(double large, double small)
{
    int64_t a, b;
    memcpy(&a, &large, sizeof a);
    memcpy(&b, &small, sizeof b);
    return (int32_t)((a - b) >> 52);
}

int32_t sphgi_octaves_for(const struct sphgi_lattice *lattice, double least,
                          const double *largest_x)
{
    int32_t octaves = sphgi_min32(octaves_between(lattice->top, least) + 1, SPHGI_OCTAVES_MOST);
    for (int32_t a = 0; a < lattice->dimension; ++a) {
        const struct sphgi_axis *axis = &lattice->axis[a];
        double cells = axis->cells ? (double)axis->cells : largest_x[a] * axis->inverse;
        cells *= (double)((int64_t)1 << (octaves - 1));
        for (; octaves > 1 && !(cells < 0x1p36); cells /= 2)
            --octaves;
    }
    return octaves;
}

int32_t sphgi_octave_of(const struct sphgi_lattice *lattice, double radius)
{
    return sphgi_min32(octaves_between(lattice->top, radius), lattice->octaves - 1);
}

/* An only octave may reach as far as keys do. */
void sphgi_raise_octave(int32_t octave, int64_t *at)
{
    at[2] += (int64_t)octave << Z_SHIFT;
}

int32_t sphgi_lower_octave(int64_t *at)
{
    const int64_t octave = (at[2] + ((int64_t)1 << (Z_SHIFT - 1))) >> Z_SHIFT;
    at[2] -= octave << Z_SHIFT;
    return (int32_t)octave;
}

/* ---- The tree ------------------------------------------------------------------------------- */

static int32_t groups_of(int32_t items)
{
    return items / SPHGI_TREE_WIDTH + (items % SPHGI_TREE_WIDTH != 0);
}

size_t sphgi_tree_size(int32_t blocks)
{
    int32_t groups = groups_of(blocks);
    size_t bytes = sphgi_round_up((size_t)groups * sizeof(struct sphgi_leaf), SPHGI_ALIGNMENT);
    for (; groups > 1; bytes += (size_t)groups * sizeof(struct sphgi_node))
        groups = groups_of(groups);
    return sphgi_round_up(bytes, SPHGI_ALIGNMENT);
}

void sphgi_tree_use(struct sphgi_tree *tree, int32_t blocks, void *memory)
{
    int32_t groups = groups_of(blocks);
    tree->height = 0;
    tree->groups[0] = groups;
    tree->leaves = memory;
    struct sphgi_node *node =
        (void *)((char *)memory +
                 sphgi_round_up((size_t)groups * sizeof(*tree->leaves), SPHGI_ALIGNMENT));
    while (groups > 1) {
        groups = groups_of(groups);
        tree->groups[++tree->height] = groups;
        tree->nodes[tree->height] = node;
        node += groups;
    }
}

static void fill_leaves(struct sphgi_grid *grid)
{
    struct sphgi_tree *tree = &grid->tree;
    int32_t octave = -1;
    for (int32_t b = 0; b < tree->groups[0] * SPHGI_TREE_WIDTH; ++b) {
        int64_t at[3] = {INT32_MIN, INT32_MIN, INT32_MIN}; /* nobody looks there */
        struct sphgi_leaf *leaf = &tree->leaves[b / SPHGI_TREE_WIDTH];
        if (b < grid->block_count) {
            sphgi_key_open(grid->blocks[b].key, at);
            const int32_t own = grid->lattice.octaves > 1 ? sphgi_lower_octave(at) : 0;
            while (octave < own)
                tree->first[++octave] = b;
        }
        for (int32_t a = 0; a < 3; ++a)
            leaf->at[a][b % SPHGI_TREE_WIDTH] =
                b < grid->block_count ? sphgi_narrowed(at[a]) : INT32_MIN;
    }
    while (octave < grid->lattice.octaves)
        tree->first[++octave] = grid->block_count;
}

/* What group number g of a height spans along an axis; places without an item span nothing. */
static void span_of(const struct sphgi_tree *tree, int32_t height, int32_t g, int32_t axis,
                    int32_t *low, int32_t *high)
{
    *low = INT32_MAX;
    *high = INT32_MIN;
    for (int32_t k = 0; k < SPHGI_TREE_WIDTH; ++k) {
        const int32_t l =
            height ? tree->nodes[height][g].low[axis][k] : tree->leaves[g].at[axis][k];
        const int32_t h = height ? tree->nodes[height][g].high[axis][k] : l;
        if (h == INT32_MIN)
            continue;
        *low = sphgi_min32(*low, l);
        *high = sphgi_max32(*high, h);
    }
}

void sphgi_tree_build(struct sphgi_grid *grid)
{
    struct sphgi_tree *tree = &grid->tree;
    fill_leaves(grid);
    for (int32_t height = 1; height <= tree->height; ++height)
        for (int32_t k = 0; k < tree->groups[height] * SPHGI_TREE_WIDTH; ++k) {
            struct sphgi_node *node = &tree->nodes[height][k / SPHGI_TREE_WIDTH];
            const int32_t at = k % SPHGI_TREE_WIDTH;
            for (int32_t a = 0; a < 3; ++a) {
                node->low[a][at] = INT32_MAX;
                node->high[a][at] = INT32_MIN;
                if (k < tree->groups[height - 1])
                    span_of(tree, height - 1, k, a, &node->low[a][at], &node->high[a][at]);
            }
        }
}
