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

/* How many octaves radii of these sizes need: no more than keys of blocks have room for, where
 * coordinates go as far as that. */
int32_t sphgi_octaves_for(const struct sphgi_lattice *lattice, double least,
                          const double *largest_x);
int32_t sphgi_octave_of(const struct sphgi_lattice *lattice, double radius);

/* Key of a block of that octave from its place there, and back. */
void sphgi_raise_octave(int32_t octave, int64_t *at);
int32_t sphgi_lower_octave(int64_t *at);

/* The runs of candidates of a few targets, octave by octave. */
struct sphgi_span { /* of cells along an axis: two where a period parts them */
    int32_t count;
    int64_t low[2], high[2];
};
struct sphgi_walk {
    const struct sphgi_grid *sources;
    double low[3], high[3]; /* of the targets */
    double reach, stretch;  /* of the targets; of the radii of others where these count, else 0 */
    int32_t octave, part, block;
    double octave_reach;
    struct sphgi_span span[3];
};

void sphgi_walk_open(struct sphgi_walk *walk, const struct sphgi_grid *sources, sphg_type type,
                     const void *targets, int32_t count, double stretch, bool mutual);
/* The next runs, as many as there is room for. False: there are no more. */
bool sphgi_walk_on(struct sphgi_walk *walk, struct sphgi_runs *runs);

/* Blocks within reach of many targets: a few of these after the other look there alone. */
enum { SPHGI_NEAR_MOST = 256 };
struct sphgi_near {
    int32_t block, octave;
    int64_t at[3];
};
struct sphgi_nearby {
    int32_t count; /* -1: there are more */
    struct sphgi_near near[SPHGI_NEAR_MOST];
};
/* False: there are more. */
bool sphgi_look_nearby(struct sphgi_walk *walk, struct sphgi_nearby *nearby);
/* The runs of some of these targets. False: there are more. */
bool sphgi_walk_nearby(struct sphgi_walk *walk, const struct sphgi_nearby *nearby,
                       struct sphgi_runs *runs);

#endif
