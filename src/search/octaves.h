/* Particles whose radii differ: each stands in the cells of its octave. Those of octave k hold the
 * radii from 2^-(k + 1) up to 2^-k of the largest, and are 2^-k as wide as those of octave 0; all
 * of them are in one grid, one octave behind the other. Where many small cells are within the reach
 * of a large particle, most of them empty, a tree over the blocks that there are finds those that
 * count. */
#ifndef SPHGI_OCTAVES_H
#define SPHGI_OCTAVES_H
#include "core/memory.h"
#include "passes/passes.h"

enum {
    SPHGI_OCTAVES_MOST = 32,
    SPHGI_TREE_WIDTH = 8,
    SPHGI_TREE_HEIGHT = 11 /* more than any count of blocks needs */
};

/* Coordinates of SPHGI_TREE_WIDTH blocks, and what as many items of the height below span. */
struct sphgi_leaf {
    int32_t at[3][SPHGI_TREE_WIDTH];
};
struct sphgi_node {
    int32_t low[3][SPHGI_TREE_WIDTH], high[3][SPHGI_TREE_WIDTH];
};

/* Item number k of a height has the items 8 k .. 8 k + 7 of the height below; those of height 0 are
 * the blocks, in the order of storage. */
struct sphgi_tree {
    int32_t height;                    /* the largest: of one node, or 0 */
    int32_t groups[SPHGI_TREE_HEIGHT]; /* leaves, then nodes of each height */
    struct sphgi_leaf *leaves;
    struct sphgi_node *nodes[SPHGI_TREE_HEIGHT]; /* [0]: unused */
    int32_t first[SPHGI_OCTAVES_MOST + 1];       /* block of each octave */
};

struct sphgi_grid;
struct sphgi_lattice;

size_t sphgi_tree_size(int32_t blocks);
/* The tree stands there. */
void sphgi_tree_use(struct sphgi_tree *tree, int32_t blocks, void *memory);
void sphgi_tree_build(struct sphgi_grid *grid);

/* A place as the tree has it. Far out, places that are neighbours may become one: the order stays.
 */
static inline int32_t sphgi_narrowed(int64_t at)
{
    const int64_t most = 1 << 30;
    return (int32_t)(at < -most ? -most : at > most ? most : at);
}

/* How many octaves radii of these sizes need: no more than keys of blocks have room for, where
 * coordinates go as far as that. */
int32_t sphgi_octaves_for(const struct sphgi_lattice *lattice, double least,
                          const double *largest_x);
int32_t sphgi_octave_of(const struct sphgi_lattice *lattice, double radius);

/* Key of a block of that octave from its place there, and back. */
void sphgi_raise_octave(int32_t octave, int64_t *at);
int32_t sphgi_lower_octave(int64_t *at);

#endif
